#include "scene_description.hpp"

#include "console.hpp"

#include <heliograph/features.hpp>
#include <heliograph/pose.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace helio::cli {
namespace {

/** Materials that some instance shows. */
std::vector<const Material*> shownMaterials(const Scene& scene, const std::vector<Instance>& instances) {
    std::vector<bool> isShown(scene.materials.size(), false);
    for (const Instance& instance : instances) {
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives) {
            if (primitive.material >= 0) isShown[std::size_t(primitive.material)] = true;
        }
    }
    std::vector<const Material*> shown;
    for (std::size_t i = 0; i < isShown.size(); ++i) {
        if (isShown[i]) shown.push_back(&scene.materials[i]);
    }
    return shown;
}

/** How many of the materials have each feature. */
Json materialFeatures(const std::vector<const Material*>& materials) {
    using Test = bool (*)(const Material&);
    const std::pair<const char*, Test> features[] = {
        {"base colour texture", [](const Material& m) { return bool(m.baseColorTexture); }},
        {"metal", [](const Material& m) { return m.metallic > 0; }},
        {"metallic-roughness texture", [](const Material& m) { return bool(m.metallicRoughnessTexture); }},
        {"normal map", [](const Material& m) { return bool(m.normalTexture); }},
        {"occlusion texture", [](const Material& m) { return bool(m.occlusionTexture); }},
        {"emission", [](const Material& m) { return m.emission != glm::vec3(0); }},
        {"alpha mask", [](const Material& m) { return m.alphaMode == AlphaMode::Mask; }},
        {"alpha blending", [](const Material& m) { return m.alphaMode == AlphaMode::Blend; }},
        {"double-sided", [](const Material& m) { return m.doubleSided; }},
        {"unlit", [](const Material& m) { return m.unlit; }},
        {"specular", [](const Material& m) { return m.specular != 1 || m.specularColor != glm::vec3(1); }},
        {"ior", [](const Material& m) { return m.ior != 1.5f; }},
        {"transmission", [](const Material& m) { return m.transmission > 0; }},
        {"volume", [](const Material& m) { return m.thickness > 0; }},
        {"dispersion", [](const Material& m) { return m.dispersion > 0; }},
        {"clearcoat", [](const Material& m) { return m.clearcoat > 0; }},
        {"sheen", [](const Material& m) { return m.sheenColor != glm::vec3(0); }},
        {"anisotropy", [](const Material& m) { return m.anisotropyStrength > 0; }},
        {"iridescence", [](const Material& m) { return m.iridescence > 0; }},
        {"scattering model beyond glTF", [](const Material& m) { return m.scattering.has_value(); }},
    };
    Json counts = Json::object();
    for (const auto& [name, test] : features) {
        const auto count = std::ranges::count_if(materials, [&](const Material* m) { return test(*m); });
        if (count > 0) counts[name] = count;
    }
    return counts;
}

Json images(const Scene& scene) {
    constexpr const char* formats[] = {"8 bits", "16 bits", "float"};
    Json list = Json::array();
    for (const TextureImage& image : scene.images) {
        list.push_back({{"name", image.name},
                        {"width", image.width},
                        {"height", image.height},
                        {"format", formats[image.texels.index()]}});
    }
    return list;
}

Json lights(const Scene& scene) {
    constexpr const char* types[] = {"point", "spot", "directional"};
    Json list = Json::array();
    for (const PlacedLight& placed : scene.placedLights()) {
        const PunctualLight& light = scene.lights[std::size_t(placed.light)];
        list.push_back({{"name", light.name}, {"type", types[int(light.type)]}});
    }
    return list;
}

Json meters(const Scene& scene) {
    constexpr const char* quantities[] = {"irradiance", "flux", "radiance", "intensity"};
    Json list = Json::array();
    for (const PlacedMeter& placed : scene.placedMeters()) {
        const Meter& meter = scene.meters[std::size_t(placed.meter)];
        list.push_back({{"name", meter.name}, {"quantity", quantities[int(meter.quantity)]}});
    }
    return list;
}

Json cameras(const Scene& scene) {
    Json list = Json::array();
    for (const PlacedCamera& placed : scene.placedCameras()) {
        const Camera& camera = scene.cameras[std::size_t(placed.camera)];
        constexpr const char* wide[] = {"", "panorama", "equidistant fisheye", "equisolid fisheye"};
        const bool isPlane = camera.projection == Projection::Plane;
        Json entry = {{"name", camera.name}, {"type", wide[int(camera.projection)]}};
        if (isPlane) entry["type"] = camera.perspective ? "perspective" : "orthographic";
        if (camera.lens) {
            entry["aperture_diameter"] = camera.lens->apertureDiameter;
            entry["focus_distance"] = camera.lens->focusDistance;
        }
        if (camera.exposure) entry["ev100"] = exposureValue(*camera.exposure);
        list.push_back(std::move(entry));
    }
    return list;
}

Json animations(const Scene& scene) {
    Json list = Json::array();
    for (const Animation& animation : scene.animations) {
        float end = 0;
        for (const AnimationChannel& channel : animation.channels) end = std::max(end, channel.times.back());
        list.push_back({{"name", animation.name}, {"seconds", end}, {"channels", animation.channels.size()}});
    }
    return list;
}

Json environment(const Scene& scene) {
    if (!scene.environment) return false;
    const glm::vec3& radiance = scene.environment->radiance;
    Json result = {{"radiance", {radiance.r, radiance.g, radiance.b}}};
    if (scene.environment->image >= 0) result["image"] = scene.environment->image;
    return result;
}

std::size_t morphTargets(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) {
        if (!mesh.primitives.empty()) count += mesh.primitives[0].targets.size();
    }
    return count;
}

std::string plain(const Json& value) {
    // Names come from files and may not be UTF-8.
    return value.is_string() ? value.get<std::string>()
                             : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/** "8 bits, name x": an object's members after its first. */
std::string members(const Json& object) {
    std::string text;
    for (auto member = std::next(object.begin()); member != object.end(); ++member)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", member.key(), plain(member.value()));
    return text;
}

}  // namespace

Json describeScene(const Scene& scene) {
    const SceneFeatures features(scene);
    const Scene::Bounds bounds = needsPose(scene) ? posed(scene).bounds() : scene.bounds();
    const std::vector<Instance> instances = scene.instances();
    const std::vector<const Material*> materials = shownMaterials(scene, instances);
    std::size_t vertices = 0;
    for (const Mesh& mesh : scene.meshes) {
        for (const Primitive& primitive : mesh.primitives) vertices += primitive.positions.size();
    }
    Json absent = Json::array(), skipped = Json::array();
    for (const SceneFeatures::Absent& feature : features.absent())
        absent.push_back({{"what", feature.name}, {"why", feature.why}});
    for (const auto& [what, why] : leftOut(scene)) skipped.push_back({{"what", what}, {"why", why}});
    Json result = {{"scene", scene.name},
                   {"meshes", scene.meshes.size()},
                   {"vertices", vertices},
                   {"instances", instances.size()},
                   {"triangles", scene.triangleCount()},
                   {"shapes", scene.shapeCount()},
                   {"skins", scene.skins.size()},
                   {"morph_targets", morphTargets(scene)},
                   {"materials", scene.materials.size()},
                   {"materials_shown", materials.size()},
                   {"materials_with", materialFeatures(materials)},
                   {"textures", scene.textures.size()},
                   {"images", images(scene)},
                   {"cameras", cameras(scene)},
                   {"lights", lights(scene)},
                   {"meters", meters(scene)},
                   {"environment", environment(scene)},
                   {"animations", animations(scene)},
                   {"variants", scene.variants},
                   {"needs", features.present()},
                   {"does_not_need", absent},
                   {"skipped", skipped},
                   {"warnings", scene.warnings}};
    if (!bounds.empty()) {
        result["bounds"] = {{"lower", {bounds.lower.x, bounds.lower.y, bounds.lower.z}},
                            {"upper", {bounds.upper.x, bounds.upper.y, bounds.upper.z}}};
    }
    return result;
}

void printScene(const Json& description) {
    for (const auto& [key, value] : description.items()) {
        if (!value.is_structured()) {
            printLine("{}: {}", key, plain(value));
            continue;
        }
        printLine("{}:{}", key, value.empty() ? " none" : "");
        if (value.is_object()) {
            for (const auto& [name, member] : value.items()) printLine("  {}: {}", name, plain(member));
            continue;
        }
        for (const Json& entry : value) {
            if (!entry.is_object()) {
                printLine("  {}", plain(entry));
            } else if (entry.contains("why")) {
                printLine("  {}: {}", plain(entry["what"]), plain(entry["why"]));
            } else {
                const std::string name = plain(*entry.begin());
                printLine("  {}: {}", name.empty() ? "(no name)" : name, members(entry));
            }
        }
    }
}

}  // namespace helio::cli
