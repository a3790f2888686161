#include "passes/scene/packed_scene.hpp"

#include "engine/scene/bvh.hpp"
#include "passes/scene/large_triangles.hpp"
#include "passes/scene/material_layout.hpp"
#include "passes/scene/placed_meshes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
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
NotShown materialsNotShown(const Scene& scene, const std::vector<bool>& materialUsed, bool occlusion) {
    NotShown result;
    auto& named = result.anywhere;
    auto& raster = result.byRaster;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!materialUsed[i]) continue;
        const Material& m = scene.materials[i];
        if (m.occlusionTexture && !occlusion)
            named.emplace("occlusion textures", "occlusion is computed, not read");
        if (m.lightmapTexture && !occlusion) named.emplace("lightmaps", "light is computed, not read");
        if (m.thicknessTexture) named.emplace("thickness textures", "thickness is that of the surfaces");
        if (pack::namesTooManySets(m, occlusion))
            named.emplace("third texture coordinate sets", "a material's textures read two sets at most");
        const std::uint32_t features = pack::materialFeatures(m);
        const auto skipIf = [&](bool isAsked, const char* what, const char* why) {
            if (isAsked) raster.emplace(what, why);
        };
        using namespace pack;
        const bool shines = (features & (kSpecularFeature | kModelFeatures)) != 0;
        skipIf(shines, "gloss of area lights",
               "the raster pipeline shades gloss of punctual lights and of surroundings");
        skipIf(m.emission != glm::vec3(0.0f) && m.alphaMode != AlphaMode::Opaque, "alpha of lamps",
               "the raster pipeline lights as if emissive surfaces were opaque");
        skipIf(shines && m.lightmapTexture, "gloss of surfaces with lightmaps",
               "a lightmap holds irradiance, of which the raster pipeline shows diffuse light");
        const bool through = m.scattering && (m.scattering->model == Scattering::Model::Dielectric ||
                                              m.scattering->model == Scattering::Model::ThinDielectric);
        const bool thick = hasVolume(m) || (through && m.scattering->model == Scattering::Model::Dielectric);
        skipIf((features & kTransmissionFeature) != 0 || through, "light through surfaces onto others",
               "the raster pipeline shows what is seen through surfaces");
        skipIf(
            thick, "shape of volumes",
            "the raster pipeline lets light leave a volume through a face parallel to the first, after the "
            "material's thickness (0 without one)");
        const std::size_t filtered =
            std::size_t(bool(m.baseColorTexture)) +
            std::size_t(m.emissiveTexture && m.emission != glm::vec3(0.0f)) +
            std::size_t(m.normalTexture && (features & kNormalMapFeature) != 0) +
            std::size_t(m.clearcoatNormalTexture && (features & kClearcoatTextureFeature) != 0);
        skipIf(
            sampledTextures(m, occlusion).size() > filtered, "filters of material textures",
            "the raster pipeline filters base colour, emission and normals; other textures are bilinear at "
            "their base level");
        for (const std::string& what : m.unsupported) named.emplace(what, "not in the material model");
    }
    return result;
}

}  // namespace

bool PackedScene::transmits() const {
    using Model = Scattering::Model;
    const auto bit = [](Model model) { return pack::kFirstModelFeature << std::uint32_t(model); };
    const std::uint32_t through =
        pack::kTransmissionFeature | bit(Model::Dielectric) | bit(Model::ThinDielectric);
    return (materialFeatures & through) != 0;
}

// A pass that learns to shade one of these takes its line out.
std::vector<std::pair<std::string, std::string>> pack::notShown(const Scene& scene,
                                                                const std::vector<bool>& materialUsed) {
    const NotShown result = materialsNotShown(scene, materialUsed, false);
    return {result.anywhere.begin(), result.anywhere.end()};
}

namespace {

/** Places in leaves that spatial splits may add, in parts of the triangles: docs/benchmarks.md. */
constexpr double kSpatialSplits = 0.3;

/** The tree over all triangles but `left`, ascending. Its order goes by the triangles of the whole. */
Bvh treeWithout(std::span<const glm::vec3> positions, const std::vector<std::uint32_t>& left,
                const BuildTree& build) {
    if (left.empty()) return build(positions);
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
    Bvh tree = build(corners);
    for (std::uint32_t& place : tree.order) place = rest[place];
    return tree;
}

/** Shapes that no tree holds, ascending: all of few ones, those without end, tori, whose test is long, and
 * where another accelerator than the tree is asked for all. */
std::vector<std::uint32_t> listedShapes(std::span<const pack::Surface> surfaces, const PackOptions& options) {
    std::vector<std::uint32_t> all, never;
    for (std::uint32_t g = 0; g < surfaces.size(); ++g) {
        if (surfaces[g].shape == 0) continue;
        all.push_back(g);
        const auto kind = Shape::Kind(surfaces[g].shape - 1);
        if (kind == Shape::Kind::Plane || kind == Shape::Kind::Torus) never.push_back(g);
    }
    const auto turns = [](std::size_t shapes, std::size_t longTests) {
        return shapes + longTests * (kTorusTurns - 1);
    };
    const auto tori = std::size_t(std::ranges::count_if(
        surfaces, [](const pack::Surface& s) { return s.shape == 1 + std::uint32_t(Shape::Kind::Torus); }));
    const bool tree = options.tree && options.accelerator == AcceleratorKind::Bvh;
    if (turns(tree ? never.size() : all.size(), tori) > kListedTurns)
        throw InputError(
            "", "shapes",
            fmt::format("{} tori, and {} shapes that are in no tree", tori, tree ? never.size() : all.size()),
            "give at most 40 tori and 300 planes, meshes in place of others, and leave out the "
            "accelerator");
    return tree && all.size() > kListedShapes ? never : all;
}

/** Packs the accelerator over triangles, or boxes of shapes, given by corners; returns the triangle of every
 * slot. */
std::vector<std::uint32_t> accelerate(std::span<const glm::vec3> corners,
                                      std::span<const pack::Surface> surfaces, const PackOptions& options,
                                      const BuildTree& build, PackedScene& packed) {
    const std::vector<std::uint32_t> listed = listedShapes(surfaces, options);
    packed.listedShapes = std::uint32_t(listed.size());
    const std::uint32_t others = packed.triangleCount - packed.listedShapes;
    std::vector<std::uint32_t> order;
    for (std::uint32_t g = 0; g < packed.triangleCount; ++g)
        if (!std::binary_search(listed.begin(), listed.end(), g)) order.push_back(g);
    const auto endWithListed = [&] {
        order.insert(order.end(), listed.begin(), listed.end());
        return std::move(order);
    };
    packed.firstWrittenOut = others <= kWrittenOutTriangles ? 0u : others;
    if (!options.tree || others == 0) return endWithListed();
    const auto start = std::chrono::steady_clock::now();
    packed.accelerator = options.accelerator;
    packed.firstWrittenOut = others;
    if (options.accelerator == AcceleratorKind::Bvh) {
        std::vector<std::uint32_t> out = options.writeOutLargest && others > kWrittenOutTriangles
                                             ? pack::largeTriangles(corners, kWrittenOutBesideTree)
                                             : std::vector<std::uint32_t>();
        std::erase_if(out, [&](std::uint32_t g) { return surfaces[g].shape > 0; });
        packed.shapesInTree = packed.hasShapes() && listed.size() < packed.shapeCount;
        std::vector<std::uint32_t> left;
        std::ranges::merge(out, listed, std::back_inserter(left));
        BvhOptions building;
        if (options.spatialSplits && !packed.shapesInTree) building.spatialSplits = kSpatialSplits;
        Bvh tree = treeWithout(
            corners, left,
            build ? build : [&](std::span<const glm::vec3> all) { return buildBvh(all, building); });
        packed.firstWrittenOut = std::uint32_t(tree.order.size());
        packed.triangleCount = packed.firstWrittenOut + std::uint32_t(left.size());
        packed.splitTree = packed.firstWrittenOut + std::uint32_t(out.size()) > others;
        packed.nodeCount = std::uint32_t(tree.nodes.size());
        packed.treeDepth = tree.depth;
        static_assert(sizeof(BvhNode) == 5 * sizeof(glm::uvec4));
        packed.nodes.resize(tree.nodes.size() * 5);
        std::memcpy(packed.nodes.data(), tree.nodes.data(), tree.nodes.size() * sizeof(BvhNode));
        order = std::move(tree.order);
        order.insert(order.end(), out.begin(), out.end());
    } else {
        std::vector<glm::vec3> rest;
        for (const std::uint32_t g : order) rest.insert(rest.end(), &corners[g * 3], &corners[g * 3] + 3);
        Comparator built = buildComparator(options.accelerator, rest);
        packed.nodeCount = std::uint32_t(built.words.size());
        packed.treeDepth = built.depth;
        packed.nodes = std::move(built.words);
    }
    packed.treeSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return endWithListed();
}

}  // namespace

std::uint64_t PackedScene::bytes() const {
    return bytesOf(triangles) + bytesOf(placed) + bytesOf(triangleKeys) + bytesOf(normalKeys) +
           bytesOf(instanceFirst) + bytesOf(nodes) + bytesOf(normals) + bytesOf(texcoords) +
           bytesOf(tangents) + bytesOf(colors) + bytesOf(solidPoints) + bytesOf(materials) + bytesOf(lights) +
           bytesOf(textures) + bytesOf(texels8) + bytesOf(texelsFloat) + bytesOf(environmentMap) +
           bytesOf(lightSlots) + bytesOf(lightCells) + bytesOf(lightRanges) + bytesOf(lightOfTriangle);
}

KernelVariant acceleratorVariant(AcceleratorKind kind) {
    return {.defines = {{"ACCELERATOR", std::to_string(int(kind))}}, .generated = {}};
}

PackedScene packScene(const Scene& scene, const PackOptions& options) {
    return packScene(scene, {}, options, {});
}

PackedScene packScene(const Scene& scene, std::span<const Scene> later, const PackOptions& options) {
    return packScene(scene, later, options, {});
}

PackedScene packScene(const Scene& scene, std::span<const Scene> later, const PackOptions& options,
                      const BuildTree& build) {
    if (options.shapesAsTriangles && scene.shapeCount() > 0) {
        PackOptions triangles = options;
        triangles.shapesAsTriangles = false;
        PackedScene packed = packScene(withoutShapes(scene), {}, triangles, build);
        packed.rasterSkipped.emplace_back("exact shapes", "spheres, discs and planes are shown as triangles");
        return packed;
    }
    PackedScene packed;
    packed.occlusionTextures =
        options.occlusion && scene.environment && std::ranges::any_of(scene.materials, [](const Material& m) {
            return m.occlusionTexture && m.occlusionStrength > 0.0f && !m.unlit;
        });
    packed.lightmaps = options.occlusion && std::ranges::any_of(scene.materials, [](const Material& m) {
                           return m.lightmapTexture && !m.unlit;
                       });
    packed.volumes = options.occlusion && std::ranges::any_of(scene.materials, pack::hasVolume);
    std::vector<pack::Surface> surfaces;
    const bool places = later.empty() && options.tree && options.accelerator == AcceleratorKind::Bvh;
    pack::PlacedMeshes placed = places ? pack::choosePlaced(scene, options) : pack::PlacedMeshes();
    std::vector<glm::vec3> positions = pack::geometry(scene, options.origin, packed, surfaces, &placed);
    const std::size_t flattened = packed.triangleCount;
    const std::span<const pack::Surface> inWorld = std::span(surfaces).first(flattened);
    std::vector<std::vector<glm::vec3>> keys;
    if (!later.empty()) {
        // What lies in one place now may part when it moves.
        keys = pack::motion(positions, later, options, packed, surfaces);
    } else {
        const auto collapse = [&](std::size_t first, std::size_t count) {
            return pack::collapseTwins(scene, std::span(surfaces).subspan(first, count), options.tree,
                                       std::span(positions).subspan(first * 3, count * 3));
        };
        std::size_t twins = collapse(0, flattened);
        for (const pack::PlacedMesh& mesh : placed.meshes) twins += collapse(mesh.firstG, mesh.triangles);
        if (twins > 0)
            packed.warnings.push_back(fmt::format(
                "{} triangles lie exactly on opaque ones before them and are left out; delete the doubles",
                twins));
    }
    std::optional<pack::PlacedTrees> trees;
    if (!placed.placements.empty()) trees.emplace(placed, positions);

    std::vector<bool> materialUsed(scene.materials.size() + 1, false);
    for (const pack::Surface& surface : surfaces) materialUsed[surface.material] = true;
    pack::materials(scene, materialUsed, packed);
    pack::environment(scene, options, packed);
    if (options.occlusion && packed.transmits())
        for (const Instance& instance : scene.instances())
            packed.instanceScales.push_back(
                float(std::cbrt(std::abs(glm::determinant(glm::dmat3(instance.transform))))));
    if (trees) {
        std::vector<glm::vec3> lit(positions.begin(), positions.begin() + std::ptrdiff_t(flattened * 3));
        const std::vector<glm::vec3> samples = pack::placedSamples(placed, positions);
        lit.insert(lit.end(), samples.begin(), samples.end());
        pack::lights(scene, lit, inWorld, options, packed);
        if (!packed.lightOfTriangle.empty()) packed.lightOfTriangle.resize(surfaces.size(), 0);
    } else {
        pack::lights(scene, positions, surfaces, options, packed);
    }

    for (const pack::Surface& surface : surfaces) packed.shapeCount += surface.shape > 0 ? 1 : 0;
    std::vector<std::vector<glm::vec3>> boxes;
    if (packed.hasShapes())
        for (const auto& key : keys) boxes.push_back(pack::treeCorners(key, surfaces));
    std::vector<std::uint32_t> order;
    if (trees) {
        const auto world = std::span(positions).first(flattened * 3);
        std::vector<glm::vec3> corners = pack::treeCorners(world, inWorld);
        const std::vector<glm::vec3> standing = trees->boxes();
        corners.insert(corners.end(), standing.begin(), standing.end());
        packed.triangleCount += std::uint32_t(placed.placements.size());
        PackOptions inTree = options;
        inTree.spatialSplits = false;
        inTree.writeOutLargest = false;  // nothing but trees knows which of equally near ones comes first
        order = accelerate(corners, inWorld, inTree, build, packed);
    } else {
        PackOptions whole = options;
        whole.spatialSplits = options.spatialSplits && keys.empty();
        order = accelerate(!keys.empty()
                               ? pack::waysBoxes(boxes.empty() ? keys : boxes)
                               : (packed.hasShapes() ? pack::treeCorners(positions, surfaces) : positions),
                           surfaces, whole, build, packed);
    }
    if (options.spatialSplits && (trees || !keys.empty() || packed.shapesInTree))
        packed.skipped.emplace_back("spatial splits",
                                    "boxes of shapes, placed meshes and moving triangles are not cut");
    for (const auto& key : keys)
        for (const std::uint32_t g : order)
            for (std::uint32_t k = 0; k < 3; ++k) packed.triangleKeys.emplace_back(key[g * 3 + k], 0.0f);
    packed.triangles.reserve(std::size_t(packed.triangleCount) * 3);
    for (std::uint32_t g : order) {
        if (g >= flattened && trees) {
            packed.triangles.push_back(withBits({}, 0x80000000u | std::uint32_t(g - flattened)));
            packed.triangles.insert(packed.triangles.end(), 2, glm::vec4(0.0f));
            continue;
        }
        packed.triangles.push_back(withBits(positions[g * 3 + 0], g));
        packed.triangles.push_back(withBits(positions[g * 3 + 1], surfaces[g].instance));
        packed.triangles.push_back(
            withBits(positions[g * 3 + 2], surfaces[g].material | (surfaces[g].shape << 28)));
    }
    const std::size_t others = order.size() - packed.listedShapes;
    packed.writtenOut.assign(packed.triangles.begin() + std::ptrdiff_t(packed.firstWrittenOut) * 3,
                             packed.triangles.begin() + std::ptrdiff_t(others) * 3);
    for (std::size_t slot = packed.firstWrittenOut; slot < others; ++slot) {
        const std::uint32_t material = surfaces[order[slot]].material;
        if (material < scene.materials.size() && scene.materials[material].emission != glm::vec3(0.0f))
            packed.writtenOutEmitters.push_back(order[slot]);
    }
    if (options.photons && !trees)
        packed.photonTargets = pack::photonTargets(scene, positions, surfaces, order, packed);
    if (trees) trees->append(positions, surfaces, packed);
    const NotShown absent = materialsNotShown(scene, materialUsed, options.occlusion);
    packed.skipped.insert(packed.skipped.end(), absent.anywhere.begin(), absent.anywhere.end());
    packed.rasterSkipped.assign(absent.byRaster.begin(), absent.byRaster.end());
    return packed;
}

}  // namespace helio
