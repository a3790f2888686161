// A scene pays for nothing that it does not hold: feature by feature, the path tracer's specialised kernel
// without it is smaller than with it, uses none of its bindings, and counts none of its rays.
#include "passes/film/film.hpp"
#include "passes/pathtrace/path_tracer.hpp"
#include "passes/scene/device_scene.hpp"
#include "passes/scene/material_layout.hpp"
#include "tests/support/device.hpp"
#include "tests/support/scene_features.hpp"
#include "tests/support/specialized_kernel.hpp"

#include <heliograph/kernel.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace helio::test {
namespace {

struct Built {
    SpecializedKernel code;
    std::uint64_t bytes = 0;  ///< of the scene on the device
    PathCounters counters;
};

Built build(Scene scene, bool counts = false, int bounces = -1,
            Placing placing = PathTraceOptions{}.placing) {
    PathTraceOptions options;
    options.placing = placing;
    options.size = {8, 8};
    options.bounces = bounces;
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

TEST(FeaturesOff, LightByBouncesCostsNothingUnlessAskedFor) {
    const SpecializedKernel plain = build(plainRoom().scene).code,
                            split = build(plainRoom().scene, false, 2).code;
    EXPECT_GT(split.instructions, plain.instructions);
    EXPECT_TRUE(split.bindings.contains("uBounces"));
    for (const char* name : {"uBounces", "uPatchSlots", "uPatchRadiance"})
        EXPECT_FALSE(plain.bindings.contains(name)) << name;
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

/** The words that the driver gets, before its constants are known. */
TEST(FeaturesOff, OneMaterialInTheSceneIsOneMaterialInTheKernel) {
    using Model = Scattering::Model;
    const std::map<std::string, std::optional<Model>> materials = {{"gltfValue(", {}},
                                                                   {"orenNayarValue(", Model::OrenNayar},
                                                                   {"conductorValue(", Model::Conductor},
                                                                   {"phongValue(", Model::Phong}};
    for (const auto& [own, model] : materials) {
        Material material;
        material.scattering = model ? std::optional(Scattering{.model = *model}) : std::nullopt;
        const std::string features = fmt::format("0x{:x}u", pack::materialFeatures(material));
        const Kernel kernel = compileVariant({"pathtrace/trace", {}, "passes/pathtrace/trace.comp"},
                                             {.defines = {{"SURFACE_MATERIALS", features}}, .generated = ""});
        const std::string_view bytes(reinterpret_cast<const char*>(kernel.spirv.data()),
                                     kernel.spirv.size_bytes());
        // Functions keep their names.
        for (const auto& [name, other] : materials)
            EXPECT_EQ(bytes.find(name) != std::string_view::npos, name == own) << own << " has " << name;
    }
}

/** Placing a mesh twice puts triangles into the world and nothing into the kernel, but where meshes are
 * packed once for all of many placements. */
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
    const SpecializedKernel placed = build(twice.scene, false, -1, Placing::Always).code;
    EXPECT_TRUE(placed.bindings.contains("uPlaced"));
    EXPECT_FALSE(two.bindings.contains("uPlaced"));
    EXPECT_EQ(build(once.scene, false, -1, Placing::Always).code.bindings, one.bindings);
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
