#include "engine/scene/extras/extras.hpp"

#include "engine/scene/extras/schema.hpp"
#include "engine/scene/folder.hpp"
#include "engine/scene/image_decoding.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <utility>

namespace helio::extras {
namespace {

using nlohmann::json;

/** The lists of a glTF document, and what the schema calls their elements. */
constexpr std::pair<const char*, const char*> kinds[] = {
    {"accessors", "accessor"}, {"animations", "animation"}, {"buffers", "buffer"}, {"cameras", "camera"},
    {"images", "image"},       {"materials", "material"},   {"meshes", "mesh"},    {"nodes", "node"},
    {"samplers", "sampler"},   {"scenes", "scene"},         {"skins", "skin"},     {"textures", "texture"},
};

/** object.extras.heliograph, or nullptr. */
const json* extrasOf(const json& object) {
    if (!object.is_object()) return nullptr;
    const auto extras = object.find("extras");
    if (extras == object.end() || !extras->is_object()) return nullptr;
    const auto own = extras->find("heliograph");
    return own == extras->end() ? nullptr : &*own;
}

void checkObject(const std::string& file, const std::string& pointer, const std::string& kind,
                 const json& object) {
    const json* const own = extrasOf(object);
    if (own == nullptr) return;
    const std::string place = pointer + "/extras/heliograph";
    if (!schema().at("properties").contains(kind)) {
        throw InputError(file, place,
                         fmt::format("nothing is known of a{} {}", kind[0] == 'a' ? "n" : "", kind),
                         "leave it out; see heliograph.schema.json");
    }
    if (const auto fault = faultOf({{kind, *own}})) {
        // The first step names the kind, which the place says already.
        throw InputError(file,
                         place + fault->pointer.substr(std::min(fault->pointer.size(), kind.size() + 1)),
                         fault->fault, "give " + fault->expected);
    }
}

glm::vec3 channels(const json& value) {
    return {value[0].get<float>(), value[1].get<float>(), value[2].get<float>()};
}

/** What `names` calls by a word of theirs, into `to`; check() refuses other words. */
template <class T, std::size_t N>
void readName(const json& word, const std::pair<const char*, T> (&names)[N], T& to) {
    for (const auto& [name, value] : names) {
        if (word == name) to = value;
    }
}

Scattering scatteringOf(const json& from) {
    using Model = Scattering::Model;
    constexpr std::pair<const char*, Model> models[] = {
        {"orenNayar", Model::OrenNayar},   {"mirror", Model::Mirror},
        {"dielectric", Model::Dielectric}, {"thinDielectric", Model::ThinDielectric},
        {"conductor", Model::Conductor},   {"phong", Model::Phong},
        {"blinnPhong", Model::BlinnPhong},
    };
    Scattering to;
    readName(from["model"], models, to.model);
    to.roughness = from.value("roughness", to.roughness);
    if (from.contains("alpha")) to.alpha = {from["alpha"][0].get<float>(), from["alpha"][1].get<float>()};
    to.beckmann = from.value("facets", "ggx") == "beckmann";
    to.schlick = from.value("fresnel", "exact") == "schlick";
    if (from.contains("n")) to.n = channels(from["n"]);
    if (from.contains("k")) to.k = channels(from["k"]);
    to.exponent = from.value("exponent", to.exponent);
    to.multipleScattering = from.value("multipleScattering", to.multipleScattering);
    return to;
}

SolidTexture solidOf(const json& from) {
    using Pattern = SolidTexture::Pattern;
    constexpr std::pair<const char*, Pattern> patterns[] = {{"noise", Pattern::Noise},
                                                            {"clouds", Pattern::Clouds},
                                                            {"marble", Pattern::Marble},
                                                            {"wood", Pattern::Wood}};
    SolidTexture to;
    readName(from["pattern"], patterns, to.pattern);
    if (from.contains("first")) to.first = channels(from["first"]);
    if (from.contains("second")) to.second = channels(from["second"]);
    to.scale = from.value("scale", to.scale);
    return to;
}

/** Refuses a camera whose parts do not go together, which the schema does not say. */
[[noreturn]] void refuseCamera(const std::string& file, int index, const std::string& member,
                               const std::string& fault, const std::string& remedy) {
    throw InputError(file, fmt::format("/cameras/{}/extras/heliograph/{}", index, member), fault, remedy);
}

ThinLens lensOf(const std::string& file, int index, const Camera& camera, const json& from) {
    if (!camera.perspective || camera.projection != Projection::Plane)
        refuseCamera(file, index, "lens", "belongs to a camera without perspective", "leave it out");
    if (from.contains("fNumber") == from.contains("apertureDiameter"))
        refuseCamera(file, index, "lens", "needs an aperture", "give either fNumber or apertureDiameter");
    ThinLens to;
    to.focusDistance = from.value("focusDistance", to.focusDistance);
    if (from.contains("fNumber")) {
        to = thinLens(camera, from["fNumber"].get<double>(), double(to.focusDistance),
                      from.value("sensorHeight", 0.024));
    } else {
        if (from.contains("sensorHeight"))
            refuseCamera(file, index, "lens/sensorHeight", "belongs to an fNumber", "leave it out");
        to.apertureDiameter = from["apertureDiameter"].get<float>();
    }
    to.blades = from.value("blades", to.blades);
    if (to.blades == 1 || to.blades == 2)
        refuseCamera(file, index, "lens/blades", fmt::format("is {}", to.blades), "give 0, or 3 to 64");
    if (to.blades == 0 && from.contains("bladeRotation"))
        refuseCamera(file, index, "lens/bladeRotation", "belongs to an aperture of blades", "leave it out");
    to.bladeRotation = from.value("bladeRotation", to.bladeRotation);
    return to;
}

LensTable lensTableOf(const json& from) {
    LensTable to;
    for (const json& row : from["surfaces"])
        to.surfaces.push_back(
            {row[0].get<float>(), row[1].get<float>(), row[2].get<float>(), row[3].get<float>()});
    to.scale = from.value("scale", to.scale);
    to.filmHeight = from.value("filmHeight", to.filmHeight);
    to.focusDistance = from.value("focusDistance", to.focusDistance);
    to.stop = from.value("stop", to.stop);
    return to;
}

Environment environmentOf(const std::string& file, const std::string& pointer, const json& from,
                          ImageBudget& budget, Scene& scene) {
    Environment to;
    to.radiance = from.contains("radiance") ? channels(from["radiance"]) : glm::vec3(1);
    if (from.contains("rotation")) {
        const json& q = from["rotation"];
        const glm::quat rotation(q[3].get<float>(), q[0].get<float>(), q[1].get<float>(), q[2].get<float>());
        if (glm::length(rotation) > 1e-6f) to.rotation = glm::normalize(rotation);
    }
    if (!from.contains("image")) return to;
    const auto& name = from["image"].get_ref<const std::string&>();
    const auto path = pathBelow(name);
    if (!path) {
        throw InputError(file, pointer + "/image", "leads out of the glTF file's folder",
                         "give a path relative to that folder and below it");
    }
    try {
        scene.images.push_back(loadTextureImage(fileBelow(file, *path), budget));
    } catch (const InputError& error) {
        throw InputError(file, pointer + "/image", error.fault, error.remedy);
    }
    to.image = int(scene.images.size()) - 1;
    return to;
}

Meter meterOf(const std::string& file, const std::string& place, const json& from, const std::string& name) {
    using Quantity = Meter::Quantity;
    constexpr std::pair<const char*, Quantity> quantities[] = {{"irradiance", Quantity::Irradiance},
                                                               {"flux", Quantity::Flux},
                                                               {"radiance", Quantity::Radiance},
                                                               {"intensity", Quantity::Intensity}};
    Meter meter;
    meter.name = name;
    readName(from["quantity"], quantities, meter.quantity);
    const bool isPoint = meter.quantity == Quantity::Irradiance || meter.quantity == Quantity::Radiance;
    for (const char* side : {"width", "height"}) {
        if (isPoint && from.contains(side))
            throw InputError(file, place + side, "belongs to a meter of flux or intensity", "leave it out");
    }
    meter.width = from.value("width", meter.width);
    meter.height = from.value("height", meter.height);
    return meter;
}

Primitive shapeOf(const std::string& file, const std::string& place, const json& from,
                  std::size_t materials) {
    using Kind = Shape::Kind;
    constexpr std::pair<const char*, Kind> shapes[] = {{"sphere", Kind::Sphere},
                                                       {"plane", Kind::Plane},
                                                       {"disc", Kind::Disc},
                                                       {"quad", Kind::Quad},
                                                       {"torus", Kind::Torus}};
    Primitive primitive;
    Shape& shape = primitive.shape.emplace();
    readName(from["kind"], shapes, shape.kind);
    const bool isRound = shape.kind != Kind::Plane && shape.kind != Kind::Quad;
    const auto belongs = [&](const char* member, bool has, const char* what) {
        if (from.contains(member) && !has)
            throw InputError(file, place + member, fmt::format("belongs to {}", what), "leave it out");
    };
    belongs("radius", isRound, "a sphere, disc or torus");
    belongs("tubeRadius", shape.kind == Kind::Torus, "a torus");
    belongs("width", shape.kind == Kind::Quad, "a quad");
    belongs("height", shape.kind == Kind::Quad, "a quad");
    shape.radius = from.value("radius", shape.radius);
    shape.tubeRadius = from.value("tubeRadius", shape.tubeRadius);
    shape.width = from.value("width", shape.width);
    shape.height = from.value("height", shape.height);
    if (shape.kind == Kind::Torus &&
        !(shape.tubeRadius >= 0.01f * shape.radius && shape.tubeRadius <= 0.99f * shape.radius))
        throw InputError(file, place + "tubeRadius",
                         fmt::format("is {} on a radius of {}", shape.tubeRadius, shape.radius),
                         "give 0.01 to 0.99 of the radius");
    primitive.material = from.value("material", -1);
    if (primitive.material >= int(materials))
        throw InputError(file, place + "material", fmt::format("is {}", primitive.material),
                         fmt::format("name one of the file's {} materials", materials));
    return primitive;
}

}  // namespace

void check(const std::string& file, std::string_view list, std::size_t index, const json& object) {
    if (extrasOf(object) == nullptr) return;
    for (const auto& [name, kind] : kinds) {
        if (name == list) checkObject(file, fmt::format("/{}/{}", list, index), kind, object);
    }
}

void checkDocument(const std::string& file, const json& document) {
    checkObject(file, "", "asset", document);
}

void readMaterial(const json& object, Material& material) {
    const json* const own = extrasOf(object);
    if (own == nullptr) return;
    if (own->contains("solid")) material.solid = solidOf((*own)["solid"]);
    if (own->contains("scattering")) material.scattering = scatteringOf((*own)["scattering"]);
}

void readCamera(const std::string& file, const json& object, int index, Camera& camera) {
    const json* const own = extrasOf(object);
    if (own == nullptr) return;
    constexpr std::pair<const char*, Projection> projections[] = {{"plane", Projection::Plane},
                                                                  {"latLong", Projection::LatLong},
                                                                  {"equidistant", Projection::Equidistant},
                                                                  {"equisolid", Projection::Equisolid}};
    readName(own->value("projection", "plane"), projections, camera.projection);
    if (own->contains("fieldOfView") &&
        (camera.projection == Projection::Plane || camera.projection == Projection::LatLong))
        refuseCamera(file, index, "fieldOfView", "belongs to a fisheye", "leave it out");
    camera.fieldOfView = own->value("fieldOfView", camera.fieldOfView);
    if (own->contains("lens")) camera.lens = lensOf(file, index, camera, (*own)["lens"]);
    if (own->contains("lensTable")) camera.lensTable = lensTableOf((*own)["lensTable"]);
    if (own->contains("shutter")) {
        const json& from = (*own)["shutter"];
        const Shutter shutter{from.value("open", 0.0), from.value("close", 0.0), from.value("rolling", 0.0)};
        if (shutter.close < shutter.open)
            refuseCamera(file, index, "shutter/close", "lies before open", "give a close of at least open");
        camera.shutter = shutter;
    }
    if (!own->contains("exposure")) return;
    const json& from = (*own)["exposure"];
    Exposure to;
    to.fNumber = from.value("fNumber", to.fNumber);
    to.shutterSeconds = from.value("shutter", to.shutterSeconds);
    to.iso = from.value("iso", to.iso);
    camera.exposure = to;
}

void readNode(const std::string& file, const json& object, std::size_t index, std::size_t materials,
              Node& node, Scene& scene) {
    const json* const own = extrasOf(object);
    if (own == nullptr) return;
    const std::string place = fmt::format("/nodes/{}/extras/heliograph/", index);
    if (own->contains("meter")) {
        node.meter = int(scene.meters.size());
        scene.meters.push_back(meterOf(file, place + "meter/", (*own)["meter"], node.name));
    }
    if (own->contains("shape")) {
        if (node.mesh >= 0)
            throw InputError(file, place + "shape", "stands at a node that has a mesh",
                             "give the shape a node of its own");
        node.mesh = int(scene.meshes.size());
        scene.meshes.push_back({node.name, {shapeOf(file, place + "shape/", (*own)["shape"], materials)}});
    }
}

void readScene(const std::string& file, const std::string& pointer, const json& object, ImageBudget& budget,
               Scene& scene) {
    const json* const own = extrasOf(object);
    if (own == nullptr) return;
    if (own->contains("environment"))
        scene.environment = environmentOf(file, pointer + "/extras/heliograph/environment",
                                          (*own)["environment"], budget, scene);
}

}  // namespace helio::extras
