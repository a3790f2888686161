// The flattened scene: order and ids, mirrored transforms, the light table, what is refused.
#include "passes/scene/alias_table.hpp"
#include "passes/scene/inversion_tree.hpp"
#include "passes/scene/material_layout.hpp"
#include "passes/scene/packed_scene.hpp"

#include <heliograph/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace helio {
namespace {

/** Two instances of one mesh of two primitives; the second mirrored. */
Scene twoInstances() {
    Scene scene;
    scene.name = "two";
    scene.materials.resize(2);
    scene.materials[1].emission = glm::vec3(2.0f);
    Primitive first;
    first.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    first.indices = {0, 1, 2, 0, 2, 3};
    first.material = 0;
    Primitive second;
    second.positions = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    second.indices = {0, 1, 2};
    second.material = 1;
    scene.meshes.push_back({"mesh", {first, second}});
    Node plain, mirrored;
    plain.mesh = mirrored.mesh = 0;
    mirrored.scale = {-1, 1, 1};
    mirrored.translation = {5, 0, 0};
    scene.nodes = {plain, mirrored};
    scene.roots = {0, 1};
    return scene;
}

std::uint32_t bits(float value) {
    return glm::floatBitsToUint(value);
}

Material withScattering(Scattering::Model model, float alpha) {
    Material m;
    m.scattering = Scattering{};
    m.scattering->model = model;
    m.scattering->alpha = glm::vec2(alpha);
    return m;
}

TEST(PackScene, TrianglesInOnePlaceCountOnce) {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[1].alphaMode = AlphaMode::Mask;
    scene.materials[2].emission = glm::vec3(1.0f);
    const std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const auto left = [&](std::vector<int> materials, std::vector<std::vector<int>> orders, bool rays) {
        std::vector<pack::Surface> surfaces;
        std::vector<glm::vec3> positions;
        for (std::size_t g = 0; g < materials.size(); ++g) {
            surfaces.push_back({0, std::uint32_t(materials[g])});
            for (const int corner : orders[g]) positions.push_back(corners[std::size_t(corner)]);
        }
        const std::size_t collapsed = pack::collapseTwins(scene, surfaces, rays, positions);
        std::vector<std::size_t> whole;
        for (std::size_t g = 0; g < materials.size(); ++g)
            if (positions[g * 3] != positions[g * 3 + 1]) whole.push_back(g);
        EXPECT_EQ(whole.size() + collapsed, materials.size());
        return whole;
    };
    using Whole = std::vector<std::size_t>;
    const std::vector<int> one = {0, 1, 2}, turned = {1, 2, 0}, back = {0, 2, 1};
    EXPECT_EQ(left({0, 0, 0}, {one, turned, one}, true), Whole({0}));
    EXPECT_EQ(left({0, 0}, {one, back}, true), Whole({0}));
    EXPECT_EQ(left({0, 0}, {one, back}, false), Whole({0, 1})) << "either may be culled";
    EXPECT_EQ(left({1, 0, 0}, {one, one, one}, true), Whole({0, 1})) << "what lies behind a mask shows";
    EXPECT_EQ(left({0, 1}, {one, one}, true), Whole({0}));
    EXPECT_EQ(left({2, 2}, {one, one}, true), Whole({0}));
    EXPECT_EQ(left({2, 2}, {one, back}, true), Whole({0, 1})) << "each lights its own side";
    EXPECT_EQ(left({0, 2}, {one, back}, true), Whole({0, 1}));
}

TEST(PackScene, LobesAreKnownByTheirMaterials) {
    using Model = Scattering::Model;
    Material diffuse, black, polished, brushed, glass, halfGlass, unlit;
    diffuse.metallic = diffuse.specular = 0;
    black = diffuse;
    black.baseColor = glm::vec4(0, 0, 0, 1);
    polished.roughness = 0;
    brushed.roughness = 0.3f;
    glass.metallic = glass.roughness = 0;
    halfGlass = glass;
    glass.transmission = 1;
    halfGlass.transmission = 0.5f;
    unlit.unlit = true;
    struct Expected {
        const char* name;
        Material material;
        bool rough, wide;
    };
    for (const Expected& e : {Expected{"diffuse", diffuse, false, true},
                              {"black", black, false, false},
                              {"polished metal", polished, false, false},
                              {"brushed metal", brushed, true, true},
                              {"glass", glass, false, false},
                              {"half glass", halfGlass, false, true},
                              {"unlit", unlit, false, false},
                              {"mirror", withScattering(Model::Mirror, 0), false, false},
                              {"smooth dielectric", withScattering(Model::Dielectric, 0), false, false},
                              {"rough dielectric", withScattering(Model::Dielectric, 0.1f), true, true},
                              {"rough conductor", withScattering(Model::Conductor, 0.1f), true, true},
                              {"Phong", withScattering(Model::Phong, 0), false, true}}) {
        EXPECT_EQ(pack::hasRoughFacets(e.material), e.rough) << e.name;
        EXPECT_EQ(pack::hasWideLobes(e.material), e.wide) << e.name;
    }
}

TEST(PackScene, TiltedLobesTakeNormalsOnSurfacesThatNeedThem) {
    Scene scene = twoInstances();
    scene.materials[0].roughness = 0;  // a mirror
    scene.meshes[0].primitives[0].normals.assign(4, glm::vec3(0, 0, 1));
    EXPECT_FALSE(packScene(scene).tiltedLobes);
    EXPECT_FALSE(packScene(scene).normals.empty());
    scene.materials[0].roughness = 0.5f;
    EXPECT_TRUE(packScene(scene).tiltedLobes);
    EXPECT_TRUE(packScene(scene).roughFacets);
}

/** A square floor of two triangles, of which the first is large only in the box of the whole, and small ones.
 */
Scene floorAndPebbles(int pebbles) {
    Scene scene;
    Primitive p;
    p.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    p.indices = {0, 2, 1, 0, 3, 2};
    for (int i = 0; i < pebbles; ++i) {
        const float x = -0.9f + 1.8f * float(i) / float(pebbles);
        const auto first = std::uint32_t(p.positions.size());
        p.positions.insert(p.positions.end(), {{x, 0.01f, 0}, {x + 0.01f, 0.01f, 0}, {x, 0.02f, 0.01f}});
        p.indices.insert(p.indices.begin(), {first, first + 1, first + 2});  // the floor comes last
    }
    scene.meshes.push_back({"mesh", {p}});
    Node node;
    node.mesh = 0;
    scene.nodes = {node};
    scene.roots = {0};
    return scene;
}

TEST(PackScene, LargeTrianglesAreWrittenOutBesideTheTree) {
    const PackedScene packed = packScene(floorAndPebbles(100), {.writeOutLargest = true});
    ASSERT_EQ(packed.triangleCount, 102u);
    EXPECT_EQ(packed.firstWrittenOut, 100u);
    ASSERT_EQ(packed.writtenOut.size(), 6u);
    EXPECT_EQ(bits(packed.writtenOut[0].w), 100u);
    EXPECT_EQ(bits(packed.writtenOut[3].w), 101u);
    EXPECT_TRUE(packed.writtenOutEmitters.empty());
    std::set<std::uint32_t> seen;
    for (std::uint32_t slot = 0; slot < 102; ++slot) seen.insert(bits(packed.triangles[slot * 3].w));
    EXPECT_EQ(seen.size(), 102u);

    EXPECT_TRUE(packScene(floorAndPebbles(100)).writtenOut.empty());
    const PackedScene small = packScene(floorAndPebbles(10), {.tree = false});
    EXPECT_EQ(small.writtenOut, small.triangles);
    EXPECT_EQ(small.firstWrittenOut, 0u);
}

TEST(PackScene, TrianglesAreInSceneOrderWithoutATree) {
    const PackedScene packed = packScene(twoInstances(), {.tree = false, .sampleSurfaces = true});
    ASSERT_EQ(packed.triangleCount, 6u);
    EXPECT_EQ(packed.instanceFirst, (std::vector<std::uint32_t>{0, 3, 6}));
    for (std::uint32_t slot = 0; slot < 6; ++slot) {
        EXPECT_EQ(bits(packed.triangles[slot * 3].w), slot);
        EXPECT_EQ(bits(packed.triangles[slot * 3 + 1].w), slot / 3);
        EXPECT_EQ(bits(packed.triangles[slot * 3 + 2].w), slot % 3 == 2 ? 1u : 0u);
    }
    EXPECT_TRUE(packed.nodes.empty());
    EXPECT_TRUE(packed.normals.empty());
    EXPECT_TRUE(packed.texcoords.empty());
    EXPECT_TRUE(packed.colors.empty());
}

TEST(PackScene, ATreeKeepsEveryTriangle) {
    const PackedScene packed = packScene(twoInstances());
    std::set<std::uint32_t> seen;
    for (std::size_t slot = 0; slot < 6; ++slot) seen.insert(bits(packed.triangles[slot * 3].w));
    EXPECT_EQ(seen.size(), 6u);
    EXPECT_EQ(packed.nodes.size(), packed.nodeCount * 5u);
}

TEST(PackScene, MirroredTransformsKeepTheFront) {
    const PackedScene packed = packScene(twoInstances(), {.tree = false, .sampleSurfaces = true});
    for (std::size_t slot = 0; slot < 6; ++slot) {
        const glm::vec3 a(packed.triangles[slot * 3]), b(packed.triangles[slot * 3 + 1]),
            c(packed.triangles[slot * 3 + 2]);
        EXPECT_GT(glm::cross(b - a, c - a).z, 0.0f) << slot;
    }
}

TEST(PackScene, LightsAreChosenByPower) {
    Scene scene = twoInstances();
    scene.lights.push_back({});
    scene.lights[0].intensity = glm::vec3(0.5f);
    Node lamp;
    lamp.light = 0;
    scene.nodes.push_back(lamp);
    scene.roots.push_back(2);
    const PackedScene packed = packScene(scene);
    ASSERT_EQ(packed.lightCount, 3u);
    // Power of a one-sided surface of area 1/2 and radiance 2: pi; of the point light: 4 pi / 2.
    const double pi = 3.14159265358979;
    const double total = pi + pi + 2 * pi;
    EXPECT_FLOAT_EQ(packed.lights[5].z, float(pi / total));
    EXPECT_FLOAT_EQ(packed.lights[2 * kLightTexels + 5].z, float(2 * pi / total));
    EXPECT_FLOAT_EQ(packed.lights[3].w, float(pi / total / 0.5));                       // per area
    EXPECT_FLOAT_EQ(packed.materials[kMaterialTexels + 2].x, float(pi / total / 0.5));  // what a ray finds
    EXPECT_EQ(packScene(scene, {.tree = true, .sampleSurfaces = false}).lightCount, 1u);
}

TEST(PackScene, TwoTrianglesOfAQuadAreOneLight) {
    Scene scene = twoInstances();
    scene.materials[0].emission = glm::vec3(1.0f);
    scene.materials[1].emission = glm::vec3(0.0f);
    const PackedScene packed = packScene(scene);
    EXPECT_EQ(packed.lightCount, 2u);
    EXPECT_FALSE(packed.triangleLights);
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::vec3 e1(packed.lights[i * kLightTexels + 1]), e2(packed.lights[i * kLightTexels + 2]);
        EXPECT_FLOAT_EQ(glm::length(glm::cross(e1, e2)), 1.0f);
    }
}

TEST(PackScene, AnyTwoTextureCoordinateSetsArePacked) {
    Scene scene = twoInstances();
    scene.images.push_back({"white", 1, 1, std::vector<std::uint8_t>(4, 255)});
    scene.textures.push_back({});
    scene.textures[0].image = 0;
    Material& material = scene.materials[0];
    material.emission = glm::vec3(1.0f);
    material.baseColorTexture = {0, 3, glm::mat3(1.0f)};
    material.emissiveTexture = {0, 2, glm::mat3(1.0f)};
    Primitive& primitive = scene.meshes[0].primitives[0];
    for (int set = 0; set < 4; ++set) primitive.texcoords.emplace_back(4, glm::vec2(set, -set));
    const auto firstTexcoords = [&] { return packScene(scene).texcoords.at(0); };
    EXPECT_EQ(firstTexcoords(), glm::vec4(3, -3, 2, -2));
    // Packed, both textures read the half that holds their set.
    const PackedScene packed = packScene(scene);
    EXPECT_EQ(bits(packed.materials[4].w), 0u);
    EXPECT_EQ(bits(packed.materials[6].w), 1u);
    material.baseColorTexture.texcoord = 2;
    EXPECT_EQ(firstTexcoords(), glm::vec4(2, -2, 0, 0));  // one set serves both
    material.baseColorTexture.texcoord = 4;               // not there
    EXPECT_EQ(firstTexcoords(), glm::vec4(0, 0, 2, -2));
    primitive.texcoords.clear();
    EXPECT_EQ(firstTexcoords(), glm::vec4(0));
}

TEST(PackScene, AliasTableGivesTheWeights) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform;
    for (std::size_t n : {1u, 2u, 7u, 64u, 1000u, 100000u}) {
        std::vector<double> weights(n);
        double total = 0;
        for (double& w : weights) total += w = std::pow(uniform(random), 6);
        const AliasTable table = aliasTable(weights);
        ASSERT_EQ(table.slots.size(), std::size_t(1) << table.bits);
        ASSERT_EQ(table.chance.size(), n);
        // How many of the 2^32 random words choose each entry.
        std::vector<std::uint64_t> words(table.slots.size());
        const std::uint64_t capacity = std::uint64_t(1) << (32 - table.bits);
        for (std::size_t i = 0; i < table.slots.size(); ++i) {
            ASSERT_LE(table.slots[i].threshold, capacity);
            words[i] += table.slots[i].threshold;
            words.at(table.slots[i].alias) += capacity - table.slots[i].threshold;
        }
        for (std::size_t i = 0; i < words.size(); ++i)
            ASSERT_EQ(double(words[i]), i < n ? std::ldexp(table.chance[i], 32) : 0.0) << i << " of " << n;
        // Rounded down to whole words, at least one; the largest takes what is left.
        for (std::size_t i = 0; i < n; ++i)
            ASSERT_NEAR(table.chance[i], weights[i] / total, std::ldexp(double(n) + 1, -32)) << i;
        ASSERT_GT(*std::ranges::min_element(table.chance), 0.0);
    }
}

/** As shaders/scene/environment.glsl goes down: the entry of a word, and its first word and that of the next.
 */
std::array<std::uint64_t, 3> goDown(const InversionTree& tree, std::size_t entries, std::uint32_t word) {
    std::uint64_t low = 0, high = 0xffffffffu;
    std::size_t level = 0, node = 0;
    for (std::uint32_t l = 0; l < tree.levels; ++l) {
        const std::array<std::uint32_t, 4>& n = tree.nodes.at(level + node);
        std::size_t child = 0;
        while (child < 3 && word >= n[child]) ++child;
        if (child > 0) low = n[child - 1];
        if (child < 3) high = n[child];
        level += ((entries - 1) >> 2 * (tree.levels - l)) + 1;
        node = 4 * node + child;
    }
    EXPECT_EQ(level, tree.nodes.size());
    return {node, low, high};
}

TEST(PackScene, InversionTreesKeepTheOrderOfWords) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform;
    for (std::size_t n : {1u, 2u, 3u, 4u, 5u, 16u, 17u, 1000u, 4097u}) {
        std::vector<double> weights(n);
        for (double& w : weights) w = uniform(random) < 0.3 ? 0.0 : std::pow(uniform(random), 6);
        weights[n / 2] = 1;
        const std::vector<std::uint64_t> shares = wholeShares(weights);
        const InversionTree tree = inversionTree(shares);
        std::uint64_t first = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint64_t end = std::min<std::uint64_t>(first + shares[i], 0xffffffffu);
            for (std::uint64_t word : {first, (first + end) / 2, std::max(first, end - 1)})
                if (end > first) {
                    ASSERT_EQ(goDown(tree, n, std::uint32_t(word)),
                              (std::array<std::uint64_t, 3>{i, first, end}))
                        << n;
                }
            first += shares[i];
        }
    }
}

TEST(PackScene, AliasTablesOfExtremeWeights) {
    EXPECT_EQ(aliasTable(std::vector<double>{0.0, 0.0}).chance, (std::vector<double>{0.5, 0.5}));
    EXPECT_EQ(aliasTable(std::vector<double>{3.0}).chance, (std::vector<double>{1.0}));
    EXPECT_EQ(aliasTable(std::vector<double>{0.0, 1e300, 0.0}).chance, (std::vector<double>{0.0, 1.0, 0.0}));
    // A million that are far too weak for a word of their own still get one.
    std::vector<double> weights(1000000, 1e-30);
    weights[77] = 1e30;
    const AliasTable table = aliasTable(weights);
    EXPECT_EQ(table.chance[0], 0x1p-32);
    EXPECT_EQ(table.chance[77], 1.0 - 999999 * 0x1p-32);
}

TEST(PackScene, BadInputIsRefused) {
    Scene index = twoInstances();
    index.meshes[0].primitives[0].indices[4] = 99;
    EXPECT_THROW(packScene(index), InputError);
    Scene material = twoInstances();
    material.meshes[0].primitives[0].material = 2;
    EXPECT_THROW(packScene(material), InputError);
    Scene position = twoInstances();
    position.meshes[0].primitives[1].positions[2].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(packScene(position), InputError);
    Scene overflow = twoInstances();
    overflow.meshes[0].primitives[1].positions[1].x = 1e30f;
    overflow.nodes[1].scale = glm::vec3(1e30f);
    EXPECT_THROW(packScene(overflow), InputError);
    EXPECT_EQ(packScene(Scene{}).triangleCount, 0u);
}

}  // namespace
}  // namespace helio
