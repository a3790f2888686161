#include "passes/scene/packed_scene.hpp"

#include "engine/scene/bvh.hpp"
#include "passes/scene/large_triangles.hpp"
#include "passes/scene/material_layout.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

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
    std::set<std::pair<std::string, std::string>> anywhere, byRaster;
};
NotShown materialsNotShown(const Scene& scene, const std::vector<bool>& materialUsed) {
    NotShown result;
    auto& named = result.anywhere;
    auto& raster = result.byRaster;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!materialUsed[i]) continue;
        const Material& m = scene.materials[i];
        if (m.occlusionTexture) named.emplace("occlusion textures", "occlusion is computed, not read");
        if (m.thicknessTexture) named.emplace("thickness textures", "thickness is that of the surfaces");
        if (pack::namesTooManySets(m))
            named.emplace("third texture coordinate sets", "a material's textures read two sets at most");
        const std::uint32_t features = pack::materialFeatures(m);
        const auto skipIf = [&](bool isAsked, const char* what, const char* why) {
            if (isAsked) raster.emplace(what, why);
        };
        using namespace pack;
        const bool shines = (features & (kSpecularFeature | kModelFeatures)) != 0;
        skipIf(shines, "gloss of area lights",
               "the raster pipeline shades gloss of punctual lights; surroundings "
               "are reflected as their mean");
        const bool through = m.scattering && (m.scattering->model == Scattering::Model::Dielectric ||
                                              m.scattering->model == Scattering::Model::ThinDielectric);
        skipIf((features & kTransmissionFeature) != 0 || through, "transmission",
               "the raster pipeline shows no light that goes through surfaces");
        const std::size_t filtered = std::size_t(bool(m.baseColorTexture)) +
                                     std::size_t(m.emissiveTexture && m.emission != glm::vec3(0.0f));
        skipIf(sampledTextures(m).size() > filtered, "filters of material textures",
               "the raster pipeline filters base colour and emission; other textures are bilinear at their "
               "base level");
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

/** The tree over all triangles but `left`, ascending. Its order goes by the triangles of the whole. */
Bvh treeWithout(std::span<const glm::vec3> positions, const std::vector<std::uint32_t>& left) {
    if (left.empty()) return buildBvh(positions);
    std::vector<std::uint32_t> rest;
    std::vector<glm::vec3> corners;
    rest.reserve(positions.size() / 3 - left.size());
    corners.reserve(positions.size() - left.size() * 3);
    auto next = left.begin();
    for (std::uint32_t g = 0; g < positions.size() / 3; ++g) {
        if (next != left.end() && *next == g) {
            ++next;
            continue;
        }
        rest.push_back(g);
        corners.insert(corners.end(), positions.begin() + g * 3, positions.begin() + g * 3 + 3);
    }
    Bvh tree = buildBvh(corners);
    for (std::uint32_t& place : tree.order) place = rest[place];
    return tree;
}

/** Packs the accelerator; returns the triangle of every slot. */
std::vector<std::uint32_t> accelerate(std::span<const glm::vec3> positions, const PackOptions& options,
                                      PackedScene& packed) {
    std::vector<std::uint32_t> order(packed.triangleCount);
    std::iota(order.begin(), order.end(), 0u);
    packed.firstWrittenOut = packed.triangleCount <= kWrittenOutTriangles ? 0u : packed.triangleCount;
    if (!options.tree || packed.triangleCount == 0) return order;
    const auto start = std::chrono::steady_clock::now();
    packed.accelerator = options.accelerator;
    packed.firstWrittenOut = packed.triangleCount;
    if (options.accelerator == AcceleratorKind::Bvh) {
        const std::vector<std::uint32_t> large =
            options.writeOutLargest && packed.triangleCount > kWrittenOutTriangles
                ? pack::largeTriangles(positions, kWrittenOutBesideTree)
                : std::vector<std::uint32_t>();
        Bvh tree = treeWithout(positions, large);
        packed.firstWrittenOut = packed.triangleCount - std::uint32_t(large.size());
        packed.nodeCount = std::uint32_t(tree.nodes.size());
        packed.treeDepth = tree.depth;
        static_assert(sizeof(BvhNode) == 5 * sizeof(glm::uvec4));
        packed.nodes.resize(tree.nodes.size() * 5);
        std::memcpy(packed.nodes.data(), tree.nodes.data(), tree.nodes.size() * sizeof(BvhNode));
        order = std::move(tree.order);
        order.insert(order.end(), large.begin(), large.end());
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
    return bytesOf(triangles) + bytesOf(triangleKeys) + bytesOf(normalKeys) + bytesOf(instanceFirst) +
           bytesOf(nodes) + bytesOf(normals) + bytesOf(texcoords) + bytesOf(tangents) + bytesOf(colors) +
           bytesOf(solidPoints) +
           bytesOf(materials) + bytesOf(lights) + bytesOf(textures) + bytesOf(texels8) +
           bytesOf(texelsFloat) + bytesOf(environmentMap) + bytesOf(lightSlots) + bytesOf(lightCells) +
           bytesOf(lightRanges) + bytesOf(lightOfTriangle);
}

KernelVariant acceleratorVariant(AcceleratorKind kind) {
    return {.defines = {{"ACCELERATOR", std::to_string(int(kind))}}, .generated = {}};
}

PackedScene packScene(const Scene& scene, const PackOptions& options) {
    return packScene(scene, {}, options);
}

PackedScene packScene(const Scene& scene, std::span<const Scene> later, const PackOptions& options) {
    PackedScene packed;
    std::vector<pack::Surface> surfaces;
    std::vector<glm::vec3> positions = pack::geometry(scene, options.origin, packed, surfaces);
    std::vector<std::vector<glm::vec3>> keys;
    if (!later.empty()) {
        // What lies in one place now may part when it moves.
        keys = pack::motion(positions, later, options, packed, surfaces);
    } else if (const std::size_t twins = pack::collapseTwins(scene, surfaces, options.tree, positions)) {
        packed.warnings.push_back(fmt::format(
            "{} triangles lie exactly on opaque ones before them and are left out; delete the doubles",
            twins));
    }

    std::vector<bool> materialUsed(scene.materials.size() + 1, false);
    for (const pack::Surface& surface : surfaces) materialUsed[surface.material] = true;
    pack::materials(scene, materialUsed, packed);
    pack::environment(scene, options, packed);
    pack::lights(scene, positions, surfaces, options, packed);

    const std::vector<std::uint32_t> order =
        accelerate(keys.empty() ? positions : pack::waysBoxes(keys), options, packed);
    for (const auto& key : keys)
        for (const std::uint32_t g : order)
            for (std::uint32_t k = 0; k < 3; ++k) packed.triangleKeys.emplace_back(key[g * 3 + k], 0.0f);
    packed.triangles.reserve(std::size_t(packed.triangleCount) * 3);
    for (std::uint32_t g : order) {
        packed.triangles.push_back(withBits(positions[g * 3 + 0], g));
        packed.triangles.push_back(withBits(positions[g * 3 + 1], surfaces[g].instance));
        packed.triangles.push_back(withBits(positions[g * 3 + 2], surfaces[g].material));
    }
    packed.writtenOut.assign(packed.triangles.begin() + std::ptrdiff_t(packed.firstWrittenOut) * 3,
                             packed.triangles.end());
    for (std::size_t slot = packed.firstWrittenOut; slot < order.size(); ++slot) {
        const std::uint32_t material = surfaces[order[slot]].material;
        if (material < scene.materials.size() && scene.materials[material].emission != glm::vec3(0.0f))
            packed.writtenOutEmitters.push_back(order[slot]);
    }
    const NotShown absent = materialsNotShown(scene, materialUsed);
    packed.skipped.assign(absent.anywhere.begin(), absent.anywhere.end());
    packed.rasterSkipped.assign(absent.byRaster.begin(), absent.byRaster.end());
    return packed;
}

}  // namespace helio
