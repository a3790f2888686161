// A scene pays for nothing that it does not hold: feature by feature, the path tracer's specialised kernel
// without it is smaller than with it, uses none of its bindings, and counts none of its rays.
#include "passes/film/film.hpp"
#include "passes/pathtrace/path_tracer.hpp"
#include "passes/scene/device_scene.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/device.hpp"
#include "tests/support/specialized_kernel.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace helio::test {
namespace {

/** A box of one grey Lambertian material, seen from inside; no light at all. */
SceneBuilder plainRoom() {
    SceneBuilder b;
    const int grey = b.material(glm::vec3(0.5f));
    b.room({-1, -1, -1}, {1, 1, 1}, {grey, grey, grey, grey, grey, grey});
    b.camera({0, 0, 0.9f}, {0, 0, -1}, 1.0f);
    return b;
}

struct Built {
    SpecializedKernel code;
    std::uint64_t bytes = 0;  ///< of the scene on the device
    PathCounters counters;
};

Built build(Scene scene, bool counts = false) {
    PathTraceOptions options;
    options.size = {8, 8};
    const PlacedCamera placed = chooseCamera(scene, {}, 1.0);
    DeviceScene uploaded(device(), scene, PathTracer::packOptions(scene, options));
    Film film(device(), 8, 8);
    PathTracer tracer(device(), uploaded, scene.cameras[std::size_t(placed.camera)], placed.transform,
                      options, film);
    // The driver compiles at the first dispatch, which takes longest.
    while (counts && !tracer.advance(1)) {
    }
    return {specialize(tracer.traceKernel().kernel, tracer.traceKernel().constants), uploaded.deviceBytes(),
            tracer.counters()};
}

/** Gives the room's material a texture of one texel. */
TextureUse addTexture(Scene& scene, bool floats) {
    TextureImage image;
    image.width = image.height = 1;
    if (floats)
        image.texels = std::vector<float>{0.5f, 0.25f, 0.75f, 1.0f};
    else
        image.texels = std::vector<std::uint8_t>{128, 64, 192, 255};
    scene.images.push_back(image);
    Texture texture;
    texture.image = int(scene.images.size()) - 1;
    scene.textures.push_back(texture);
    for (Mesh& mesh : scene.meshes)
        for (Primitive& p : mesh.primitives) p.texcoords = {std::vector<glm::vec2>(p.positions.size())};
    TextureUse use;
    use.texture = int(scene.textures.size()) - 1;
    return use;
}

void forAll(Scene& scene, const std::function<void(Primitive&)>& change) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& p : mesh.primitives) change(p);
}

/** A triangle of a material of its own; returns the material. */
int another(SceneBuilder& b) {
    const int material = b.material(glm::vec3(0.5f));
    b.triangles({{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}}, material);
    return material;
}

struct Feature {
    const char* name;
    std::function<void(SceneBuilder&)> add;
    std::vector<std::string> bindings;  ///< that it needs and nothing else does
};

/** A material that glTF's model makes more than diffuse, to which `change` adds. */
std::function<void(SceneBuilder&)> glossy(const std::function<void(Material&)>& change) {
    return [change](SceneBuilder& b) {
        Material& m = b.scene.materials[0];
        m.specular = 1;
        m.roughness = 0.5f;
        change(m);
    };
}

const std::vector<Feature>& features() {
    static const std::vector<Feature> list = {
        {"constant surroundings",
         [](SceneBuilder& b) { b.scene.environment = Environment{glm::vec3(1.0f)}; },
         {}},
        {"surroundings of an image",
         [](SceneBuilder& b) {
             TextureImage image;
             image.width = 4;
             image.height = 2;
             image.texels = std::vector<float>(32, 1.0f);
             b.scene.images.push_back(image);
             b.scene.environment = Environment{glm::vec3(1.0f), 0};
         },
         {"uEnvironmentMap"}},
        {"emissive triangles",
         [](SceneBuilder& b) {
             b.triangles({{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}},
                         b.material(glm::vec3(0.5f), glm::vec3(1.0f)));
         },
         {}},
        {"emission textures",
         [](SceneBuilder& b) {
             b.scene.materials[0].emission = glm::vec3(1.0f);
             b.scene.materials[0].emissiveTexture = addTexture(b.scene, false);
         },
         {"uLights", "uTexels8", "uTextures", "uTexcoords"}},
        {"a point light",
         [](SceneBuilder& b) {
             b.pointLight({0, 0, 0}, glm::vec3(1.0f));
         },
         {}},
        {"a choice among lights",
         [](SceneBuilder& b) {
             for (int i = 0; i < 3; ++i) b.pointLight({0.1f * float(i), 0, 0}, glm::vec3(1.0f + float(i)));
         },
         {"uLights", "uLightSlots"}},
        {"vertex normals",
         [](SceneBuilder& b) {
             forAll(b.scene, [](Primitive& p) { p.normals.assign(p.positions.size(), glm::vec3(0, 0, 1)); });
         },
         {"uNormals"}},
        {"vertex colours",
         [](SceneBuilder& b) {
             forAll(b.scene, [](Primitive& p) { p.colors.assign(p.positions.size(), glm::vec4(0.5f)); });
         },
         {"uColors"}},
        {"base colour textures",
         [](SceneBuilder& b) { b.scene.materials[0].baseColorTexture = addTexture(b.scene, false); },
         {"uTexels8", "uTextures", "uTexcoords"}},
        {"textures of floats",
         [](SceneBuilder& b) { b.scene.materials[0].baseColorTexture = addTexture(b.scene, true); },
         {"uTexelsFloat", "uTextures", "uTexcoords"}},
        {"alpha", [](SceneBuilder& b) { b.scene.materials[0].alphaMode = AlphaMode::Blend; }, {}},
        {"normal maps",
         [](SceneBuilder& b) { b.scene.materials[0].normalTexture = addTexture(b.scene, false); },
         {"uTangents", "uTexels8", "uTextures", "uTexcoords"}},
        {"gloss", glossy([](Material&) {}), {}},
        {"transmission", glossy([](Material& m) { m.transmission = 0.5f; }), {}},
        {"clear coat", glossy([](Material& m) { m.clearcoat = 0.5f; }), {}},
        {"sheen", glossy([](Material& m) { m.sheenColor = glm::vec3(0.5f); }), {}},
        {"thin films", glossy([](Material& m) { m.iridescence = 0.5f; }), {}},
        {"anisotropy", glossy([](Material& m) { m.anisotropyStrength = 0.5f; }), {"uTangents"}},
        {"unlit surfaces",
         [](SceneBuilder& b) { b.scene.materials[std::size_t(another(b))].unlit = true; },
         {}},
        {"mirrors",
         [](SceneBuilder& b) {
             Material& m = b.scene.materials[std::size_t(another(b))];
             m.scattering = Scattering{};
             m.scattering->model = Scattering::Model::Mirror;
         },
         {}},
        {"a tree",
         [](SceneBuilder& b) {
             b.sphere({0, 0, 0}, 0.3f, 2, false, 0);
         },
         {"uNodes"}},
    };
    return list;
}

/** The plain room with a feature, built once. */
const SpecializedKernel& with(const Feature& feature) {
    static std::map<std::string, SpecializedKernel> known;
    const auto [place, isNew] = known.try_emplace(feature.name);
    if (isNew) {
        SceneBuilder b = plainRoom();
        feature.add(b);
        place->second = build(b.scene).code;
    }
    return place->second;
}

TEST(FeaturesOff, EachCostsNothingWhereTheSceneLacksIt) {
    const Built plain = build(plainRoom().scene, true);
    fmt::print("{:28} {:6} instructions, bindings:", "plain room", plain.code.instructions);
    for (const std::string& name : plain.code.bindings) fmt::print(" {}", name);
    fmt::print("\n");
    EXPECT_EQ(plain.counters.shadowRays, 0u);
    EXPECT_GT(plain.counters.bounceRays, 0u);
    SceneBuilder lit = plainRoom();
    lit.pointLight({0, 0, 0}, glm::vec3(1.0f));
    EXPECT_GT(build(lit.scene, true).counters.shadowRays, 0u);
    for (const Feature& feature : features()) {
        SCOPED_TRACE(feature.name);
        const SpecializedKernel& code = with(feature);
        fmt::print("{:28} {:6} instructions\n", feature.name, code.instructions);
        EXPECT_GT(code.instructions, plain.code.instructions);
        for (const std::string& name : feature.bindings) {
            EXPECT_TRUE(code.bindings.contains(name)) << name;
            EXPECT_FALSE(plain.code.bindings.contains(name)) << name;
        }
    }
}

TEST(FeaturesOff, LayersOfAMaterialCostNothingWhereItHasNone) {
    const std::set<std::string> layers = {"transmission", "clear coat", "sheen", "thin films", "anisotropy"};
    const auto gloss = std::ranges::find(features(), std::string_view("gloss"), &Feature::name);
    ASSERT_NE(gloss, features().end());
    for (const Feature& feature : features()) {
        if (!layers.contains(feature.name)) continue;
        EXPECT_GT(with(feature).instructions, with(*gloss).instructions) << feature.name;
    }
}

/** Placing a mesh twice puts triangles into the world and nothing into the kernel. */
TEST(FeaturesOff, InstancesAreNoCode) {
    SceneBuilder once = plainRoom(), twice = plainRoom();
    once.sphere({0, 0, 0}, 0.3f, 2, false, 0);
    twice.sphere({0, 0, 0}, 0.3f, 2, false, 0);
    Node again = twice.scene.nodes.back();
    again.translation = {0.5f, 0.5f, 0};
    twice.scene.nodes.push_back(again);
    twice.scene.roots.push_back(int(twice.scene.nodes.size()) - 1);
    const SpecializedKernel two = build(twice.scene).code, one = build(once.scene).code;
    EXPECT_EQ(two.bindings, one.bindings);
    // Constants (the tree's depth) may differ.
    EXPECT_NEAR(double(two.instructions), double(one.instructions), 0.1 * double(one.instructions));
}

/** What nothing in use names takes no memory either. */
TEST(FeaturesOff, NoBufferHoldsWhatIsNotThere) {
    SceneBuilder textured = plainRoom();
    TextureImage big;
    big.width = big.height = 256;
    big.texels = std::vector<std::uint8_t>(256 * 256 * 4, 128);
    textured.scene.images.push_back(big);  // that no material in use names
    Texture texture;
    texture.image = 0;
    textured.scene.textures.push_back(texture);
    Material unused;
    unused.baseColorTexture.texture = 0;
    textured.scene.materials.push_back(unused);
    EXPECT_LT(build(textured.scene).bytes, build(plainRoom().scene).bytes + 2048);
}

}  // namespace
}  // namespace helio::test
