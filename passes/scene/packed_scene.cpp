#include "passes/scene/packed_scene.hpp"

#include "engine/scene/bvh.hpp"
#include "passes/scene/material_layout.hpp"

#include <heliograph/error.hpp>

#include <chrono>
#include <cstring>
#include <numeric>
#include <set>
#include <string>

namespace helio {
namespace {

template <typename T>
std::uint64_t bytesOf(const std::vector<T>& values) {
    return std::uint64_t(values.size()) * sizeof(T);
}

glm::vec4 withBits(const glm::vec3& v, std::uint32_t bits) {
    return {v, glm::uintBitsToFloat(bits)};
}

/** What the pictures lack for the materials in use: of all pipelines, and of those that take every surface
 * for Lambertian. */
struct NotShown {
    std::set<std::pair<std::string, std::string>> anywhere, byLambert;
};
NotShown materialsNotShown(const Scene& scene, const std::vector<bool>& materialUsed) {
    NotShown result;
    auto& named = result.anywhere;
    auto& lambert = result.byLambert;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!materialUsed[i]) continue;
        const Material& m = scene.materials[i];
        if (m.occlusionTexture) named.emplace("occlusion textures", "occlusion is computed, not read");
        if (m.thicknessTexture) named.emplace("thickness textures", "thickness is that of the surfaces");
        if (pack::namesTooManySets(m))
            named.emplace("third texture coordinate sets", "a material's textures read two sets at most");
        const auto skipIf = [&](bool isAsked, const char* what) {
            if (isAsked) lambert.emplace(what, "surfaces scatter as Lambert with their base colour");
        };
        const std::uint32_t features = pack::materialFeatures(m);
        const auto has = [&](std::uint32_t bits) { return (features & bits) != 0; };
        using namespace pack;
        skipIf(has(kSpecularFeature), "specular reflection");
        skipIf(has(kMetallicTextureFeature | kSpecularTextureFeature),
               "metallic, roughness and specular textures");
        if (has(kNormalMapFeature)) lambert.emplace("normal maps", "vertex normals are used");
        if (has(kAlphaFeature)) lambert.emplace("alpha masks and blending", "surfaces are opaque");
        skipIf(m.unlit, "unlit materials");
        skipIf(has(kTransmissionFeature), "transmission");
        skipIf(m.thickness > 0.0f, "volumes");
        skipIf(has(kDispersionFeature), "dispersion");
        skipIf(has(kClearcoatFeature), "clearcoat");
        skipIf(has(kSheenFeature), "sheen");
        skipIf(has(kAnisotropyFeature), "anisotropy");
        skipIf(has(kIridescenceFeature), "iridescence");
        skipIf(m.scattering.has_value(), "scattering models");
        for (const std::string& what : m.unsupported) named.emplace(what, "not in the material model");
    }
    return result;
}

}  // namespace

// A pass that learns to shade one of these takes its line out.
std::vector<std::pair<std::string, std::string>> pack::notShown(const Scene& scene,
                                                                const std::vector<bool>& materialUsed) {
    const NotShown result = materialsNotShown(scene, materialUsed);
    return {result.anywhere.begin(), result.anywhere.end()};
}

namespace {

/** Packs the accelerator; returns the triangle of every slot. */
std::vector<std::uint32_t> accelerate(std::span<const glm::vec3> positions, const PackOptions& options,
                                      PackedScene& packed) {
    std::vector<std::uint32_t> order(packed.triangleCount);
    std::iota(order.begin(), order.end(), 0u);
    if (!options.tree || packed.triangleCount == 0) return order;
    const auto start = std::chrono::steady_clock::now();
    packed.accelerator = options.accelerator;
    if (options.accelerator == AcceleratorKind::Bvh) {
        Bvh tree = buildBvh(positions);
        packed.nodeCount = std::uint32_t(tree.nodes.size());
        packed.treeDepth = tree.depth;
        static_assert(sizeof(BvhNode) == 5 * sizeof(glm::uvec4));
        packed.nodes.resize(tree.nodes.size() * 5);
        std::memcpy(packed.nodes.data(), tree.nodes.data(), tree.nodes.size() * sizeof(BvhNode));
        order = std::move(tree.order);
    } else {
        Comparator built = buildComparator(options.accelerator, positions);
        packed.nodeCount = std::uint32_t(built.words.size());
        packed.treeDepth = built.depth;
        packed.nodes = std::move(built.words);
    }
    packed.treeSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return order;
}

}  // namespace

std::uint64_t PackedScene::bytes() const {
    return bytesOf(triangles) + bytesOf(instanceFirst) + bytesOf(nodes) + bytesOf(normals) +
           bytesOf(texcoords) + bytesOf(tangents) + bytesOf(colors) + bytesOf(materials) + bytesOf(lights) +
           bytesOf(textures) + bytesOf(texels8) + bytesOf(texelsFloat) + bytesOf(environmentMap) +
           bytesOf(lightSlots) + bytesOf(lightCells) + bytesOf(lightRanges) + bytesOf(lightOfTriangle);
}

KernelVariant acceleratorVariant(AcceleratorKind kind) {
    return {.defines = {{"ACCELERATOR", std::to_string(int(kind))}}, .generated = {}};
}

PackedScene packScene(const Scene& scene, const PackOptions& options) {
    PackedScene packed;
    std::vector<pack::Surface> surfaces;
    const std::vector<glm::vec3> positions = pack::geometry(scene, packed, surfaces);

    std::vector<bool> materialUsed(scene.materials.size() + 1, false);
    for (const pack::Surface& surface : surfaces) materialUsed[surface.material] = true;
    pack::materials(scene, materialUsed, packed);
    pack::environment(scene, options, packed);
    pack::lights(scene, positions, surfaces, options, packed);

    const std::vector<std::uint32_t> order = accelerate(positions, options, packed);
    packed.triangles.reserve(std::size_t(packed.triangleCount) * 3);
    for (std::uint32_t g : order) {
        packed.triangles.push_back(withBits(positions[g * 3 + 0], g));
        packed.triangles.push_back(withBits(positions[g * 3 + 1], surfaces[g].instance));
        packed.triangles.push_back(withBits(positions[g * 3 + 2], surfaces[g].material));
    }
    const NotShown absent = materialsNotShown(scene, materialUsed);
    packed.skipped.assign(absent.anywhere.begin(), absent.anywhere.end());
    packed.lambertSkipped.assign(absent.byLambert.begin(), absent.byLambert.end());
    return packed;
}

}  // namespace helio
