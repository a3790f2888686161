#include "passes/environment/specular_environment.hpp"

#include "passes/mip/mip_chain.hpp"
#include "passes/scene/material_layout.hpp"

#include <heliograph/graph.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/environment.hpp>

#include <cstdint>
#include <vector>

namespace helio {
namespace {

// As shaders/scene/specular_environment.glsl.
constexpr std::uint32_t kAlbedoTexels = 32 * 32;
constexpr std::int32_t kLevels = 8;
constexpr std::uint32_t levelWidth(std::int32_t level) {
    return level == 1 ? 256 : level == 2 ? 128 : 64;
}
constexpr std::uint32_t levelTexels(std::int32_t level) {
    return levelWidth(level) * levelWidth(level) / 2;
}

/** Directions a texel takes: narrow lobes are smooth over a mip level's texels. */
constexpr std::int32_t directions(std::int32_t level) {
    return level <= 2 ? 64 : 256;
}

struct PrefilterPush {
    std::int32_t level, samples;
};

}  // namespace

bool needsSpecularEnvironment(const DeviceScene& scene) {
    constexpr std::uint32_t glossy = pack::kSpecularFeature | pack::kModelFeatures | pack::kClearcoatFeature |
                                     pack::kSheenFeature | pack::kIridescenceFeature;
    return (scene.info().materialFeatures & glossy) != 0 &&
           (scene.hasEnvironmentImage() || scene.info().environment != glm::vec3(0.0f));
}

DeviceBuffer makeSpecularEnvironment(Device& device, DeviceScene& scene, bool needed) {
    if (!needed) return makeBuffer(device, "environment.specular", std::vector<glm::vec4>(1));
    std::uint64_t texels = kAlbedoTexels;
    if (scene.hasEnvironmentImage())
        for (std::int32_t level = 1; level <= kLevels; ++level) texels += levelTexels(level);
    DeviceBuffer result(device, "environment.specular", texels * 16);

    Graph graph(device);
    const Buffer specular = graph.import(result);
    graph.compute("environment.albedo", shaders::environmentAlbedo)
        .writes({{"uSpecular", specular, Format::RGBA32F}})
        .record([](Commands& c) { c.dispatchInvocations(kAlbedoTexels); });

    // The image as a texture of its own, that repeats in u and is clamped in v: shaders/scene/textures.glsl.
    const auto [width, height] = scene.info().environmentSize;
    constexpr std::uint32_t clampV = 2u << 2, floats = 1u << 5, mipmaps = 1u << 6;
    const std::vector<glm::uvec4> header{{kEnvironmentHeader, width, height, clampV | floats | mipmaps}};
    DeviceBuffer headers = makeBuffer(device, "environment.texture", header),
                 none = makeBuffer(device, "environment.none", std::vector<std::uint32_t>(4));
    MipChains mips(device, scene.hasEnvironmentImage() ? header : std::vector<glm::uvec4>());
    if (scene.hasEnvironmentImage()) {
        const Binding map = scene.bindings(graph, {"uEnvironmentMap"}).at(0);
        const std::vector<Binding> image{{"uTextures", graph.import(headers)},
                                         {"uTexels8", graph.import(none), Format::R32UI},
                                         {"uTexelsFloat", Buffer{map.resource, map.graph}, Format::RGBA32F}};
        mips.declare(graph, image, {});
        for (std::int32_t level = 1; level <= kLevels; ++level)
            graph.compute("environment.prefilter", shaders::environmentPrefilter)
                .reads(image)
                .reads(mips.bindings(graph))
                .writes({{"uSpecular", specular, Format::RGBA32F}})
                .record([level](Commands& c) {
                    c.push(PrefilterPush{level, directions(level)}).dispatchInvocations(levelTexels(level));
                });
    }
    Plan plan = graph.compile({.executionsInFlight = 1});
    plan.wait(plan.execute());
    return result;
}

}  // namespace helio
