#include "engine/scene/extras/extras.hpp"
#include "engine/scene/gltf/build.hpp"
#include "engine/scene/gltf/cube_map.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace helio::gltf {
namespace {

using nlohmann::json;

glm::quat rotationOf(const json& light) {
    const auto found = light.find("rotation");
    if (found == light.end()) return {1, 0, 0, 0};
    const glm::dquat q((*found)[3].get<double>(), (*found)[0].get<double>(), (*found)[1].get<double>(),
                       (*found)[2].get<double>());
    const double length = glm::length(q);
    return length > 1e-6 ? glm::quat(q / length) : glm::quat(1, 0, 0, 0);
}

/** EXT_lights_image_based: the cube map's first level is the light. Further levels and the coefficients are
 * what a rasterizer needs of it, filtered before; they are not read. */
void buildImageBased(const Asset& asset, const json& light, const std::string& place, MemoryBudget& memory,
                     LoadMonitor& monitor, helio::Scene& scene) {
    const json& first = light["specularImages"][0];
    ImageLoader loader(asset, memory);
    std::array<std::size_t, 6> at{};
    for (std::size_t f = 0; f < 6; ++f) at[f] = std::size_t(loader.use(int(first[f].get<double>())));
    helio::Scene decoded;
    loader.decodeAll(monitor, decoded);
    std::array<const TextureImage*, 6> faces{};
    std::uint32_t size = 1;  // of those of more than one colour
    for (std::size_t f = 0; f < 6; ++f) {
        faces[f] = &decoded.images[at[f]];
        const glm::uvec2 stored = loader.fileSize(at[f]);
        if (stored.x != stored.y || stored.x != loader.fileSize(at[0]).x) {
            throw InputError(asset.file(), fmt::format("{}.specularImages[0][{}]", place, f),
                             fmt::format("is {} x {}", stored.x, stored.y), "give six squares of one size");
        }
        size = std::max(size, faces[f]->width);
    }
    memory.take(place, latLongTexels(size) * 4 * sizeof(float),
                std::size_t(size) * size * 6 * sizeof(glm::vec3));
    Environment environment;
    environment.radiance = glm::vec3(light.value("intensity", 1.0f));
    environment.rotation = rotationOf(light);
    environment.image = int(scene.images.size());
    scene.images.push_back(latLongOf(faces));
    scene.images.back().name = light.value("name", "");
    scene.environment = environment;
}

}  // namespace

void buildEnvironment(const Asset& asset, MemoryBudget& memory, LoadMonitor& monitor, helio::Scene& scene) {
    const json& document = asset.document().root();
    if (asset.document().size("scenes") == 0) return;
    const auto shown = std::size_t(document.value("scene", 0.0));
    const json from = asset.document().element("scenes", shown);
    const json::json_pointer path("/extensions/EXT_lights_image_based/light");
    if (from.contains(path)) {
        const auto light = std::size_t(from[path].get<double>());
        buildImageBased(asset, document["extensions"]["EXT_lights_image_based"]["lights"][light],
                        fmt::format("extensions.EXT_lights_image_based.lights[{}]", light), memory, monitor,
                        scene);
    }
    ImageBudget budget(memory.left());
    extras::readScene(asset.file(), fmt::format("/scenes/{}", shown), from, budget, scene);
}

}  // namespace helio::gltf
