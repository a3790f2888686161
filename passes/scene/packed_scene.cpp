#include "passes/scene/packed_scene.hpp"

#include "engine/scene/bvh.hpp"

#include <heliograph/error.hpp>

#include <chrono>
#include <cstring>
#include <set>

namespace helio {
namespace {

template <typename T>
std::uint64_t bytesOf(const std::vector<T>& values) {
    return std::uint64_t(values.size()) * sizeof(T);
}

glm::vec4 withBits(const glm::vec3& v, std::uint32_t bits) {
    return {v, glm::uintBitsToFloat(bits)};
}

}  // namespace

// A pass that learns to shade one of these takes its line out.
std::vector<std::pair<std::string, std::string>> pack::notShown(const Scene& scene,
                                                                const std::vector<bool>& materialUsed) {
    std::set<std::pair<std::string, std::string>> named;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!materialUsed[i]) continue;
        const Material& m = scene.materials[i];
        if (m.metallic > 0.0f || m.specular > 0.0f)
            named.emplace("specular reflection", "surfaces scatter as Lambert with their base colour");
        if (m.metallicRoughnessTexture || m.specularTexture || m.specularColorTexture)
            named.emplace("metallic, roughness and specular textures",
                          "surfaces scatter as Lambert with their base colour");
        if (m.normalTexture) named.emplace("normal maps", "vertex normals are used");
        if (m.alphaMode != AlphaMode::Opaque)
            named.emplace("alpha masks and blending", "surfaces are opaque");
        if (m.unlit) named.emplace("unlit materials", "surfaces scatter as Lambert with their base colour");
        if (m.occlusionTexture) named.emplace("occlusion textures", "occlusion is computed, not read");
        const auto skipIf = [&](bool isAsked, const char* what) {
            if (isAsked) named.emplace(what, "surfaces scatter as Lambert with their base colour");
        };
        skipIf(m.transmission > 0.0f, "transmission");
        skipIf(m.thickness > 0.0f, "volumes");
        skipIf(m.dispersion > 0.0f, "dispersion");
        skipIf(m.clearcoat > 0.0f, "clearcoat");
        skipIf(m.sheenColor != glm::vec3(0.0f), "sheen");
        skipIf(m.anisotropyStrength > 0.0f, "anisotropy");
        skipIf(m.iridescence > 0.0f, "iridescence");
        skipIf(m.scattering.has_value(), "scattering models");
        for (const std::string& what : m.unsupported) named.emplace(what, "not in the material model");
    }
    return {named.begin(), named.end()};
}

std::uint64_t PackedScene::bytes() const {
    return bytesOf(triangles) + bytesOf(instanceFirst) + bytesOf(nodes) + bytesOf(normals) +
           bytesOf(texcoords) + bytesOf(colors) + bytesOf(materials) + bytesOf(lights) + bytesOf(textures) +
           bytesOf(texels8) + bytesOf(texelsFloat) + bytesOf(environmentMap) + bytesOf(lightSlots) +
           bytesOf(lightCells) + bytesOf(lightRanges) + bytesOf(lightOfTriangle);
}

PackedScene packScene(const Scene& scene, const PackOptions& options) {
    PackedScene packed;
    std::vector<pack::Surface> surfaces;
    const std::vector<glm::vec3> positions = pack::geometry(scene, packed, surfaces);

    std::vector<bool> materialUsed(scene.materials.size() + 1, false);
    for (const pack::Surface& surface : surfaces) materialUsed[surface.material] = true;
    pack::materials(scene, materialUsed, packed);
    pack::environment(scene, packed);
    pack::lights(scene, positions, surfaces, options, packed);

    std::vector<std::uint32_t> order;
    if (options.tree && packed.triangleCount > 0) {
        const auto start = std::chrono::steady_clock::now();
        Bvh tree = buildBvh(positions);
        packed.treeSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        packed.nodeCount = std::uint32_t(tree.nodes.size());
        packed.treeDepth = tree.depth;
        static_assert(sizeof(BvhNode) == 5 * sizeof(glm::uvec4));
        packed.nodes.resize(tree.nodes.size() * 5);
        std::memcpy(packed.nodes.data(), tree.nodes.data(), tree.nodes.size() * sizeof(BvhNode));
        order = std::move(tree.order);
    } else {
        order.resize(packed.triangleCount);
        for (std::uint32_t i = 0; i < packed.triangleCount; ++i) order[i] = i;
    }
    packed.triangles.reserve(std::size_t(packed.triangleCount) * 3);
    for (std::uint32_t g : order) {
        packed.triangles.push_back(withBits(positions[g * 3 + 0], g));
        packed.triangles.push_back(withBits(positions[g * 3 + 1], surfaces[g].instance));
        packed.triangles.push_back(withBits(positions[g * 3 + 2], surfaces[g].material));
    }
    packed.skipped = pack::notShown(scene, materialUsed);
    return packed;
}

}  // namespace helio
