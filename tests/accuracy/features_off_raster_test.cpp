// A scene pays for nothing that it does not hold, in the raster pipeline too: feature by feature, the kernel
// that shades is smaller without it and uses none of its bindings, and its passes and counters are not there.
#include "passes/renderer/raster_render.hpp"
#include "passes/scene/device_scene.hpp"
#include "passes/shade/shade.hpp"
#include "tests/support/renderer.hpp"
#include "tests/support/scene_features.hpp"
#include "tests/support/specialized_kernel.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace helio::test {
namespace {

struct Setting {
    Shadows::Kind shadows = Shadows::Kind::None;
    TextureFilter filter = TextureFilter::Bilinear;
    std::uint32_t lightSamples = 0;
    Shading shading = Shading::Material;
};

SpecializedKernel shading(const Scene& scene, const Setting& setting = {}) {
    DeviceScene uploaded(device(), scene, rasterPackOptions());
    Shadows shadows;
    shadows.kind = setting.shadows;
    shadows.resolution = 16;
    ShadePipeline pipeline(device(), uploaded, {glm::dvec3(-1), glm::dvec3(1)}, shadows, setting.filter,
                           setting.lightSamples, setting.shading);
    RasterView view;
    view.width = view.height = 8;
    const auto [kernel, constants] = pipeline.surfaceKernel(view);
    return specialize(kernel, constants);
}

Scene roomWith(const char* feature) {
    SceneBuilder b = plainRoom();
    const auto found = std::ranges::find(features(), std::string_view(feature), &Feature::name);
    EXPECT_NE(found, features().end()) << feature;
    found->add(b);
    return b.scene;
}

TEST(RasterFeaturesOff, NoCodeAndNoBindingsForWhatASceneLacks) {
    const SpecializedKernel plain = shading(plainRoom().scene);
    fmt::print("{:28} {:6} instructions, bindings:", "plain room", plain.instructions);
    for (const std::string& name : plain.bindings) fmt::print(" {}", name);
    fmt::print("\n");
    // What paths alone have: the rasterizer leaves it out and says so, or has it in other passes.
    const std::set<std::string> others = {"a choice among lights", "shapes", "a tree"};
    for (const Feature& feature : features()) {
        if (others.contains(feature.name)) continue;
        SCOPED_TRACE(feature.name);
        const SpecializedKernel code = shading(roomWith(feature.name));
        fmt::print("{:28} {:6} instructions\n", feature.name, code.instructions);
        EXPECT_GT(code.instructions, plain.instructions);
        for (const std::string& name : feature.bindings) {
            EXPECT_TRUE(code.bindings.contains(name)) << name;
            EXPECT_FALSE(plain.bindings.contains(name)) << name;
        }
    }
}

TEST(RasterFeaturesOff, NoCodeAndNoBindingsForWhatIsNotAskedFor) {
    const Scene lit = roomWith("a point light"), textured = roomWith("base colour textures"),
                emitters = roomWith("emissive triangles");
    struct Case {
        const char* name;
        const Scene& scene;
        Setting with;
        const char* binding;
    };
    const std::vector<Case> cases = {
        {"shadow maps", lit, {.shadows = Shadows::Kind::Hard}, "uShadowMaps"},
        {"filtered shadows", lit, {.shadows = Shadows::Kind::Filtered}, "uShadowMaps"},
        {"soft shadows", lit, {.shadows = Shadows::Kind::Soft}, "uShadowMaps"},
        {"anisotropic filtering", textured, {.filter = TextureFilter::Anisotropic}, nullptr},
        {"EWA filtering", textured, {.filter = TextureFilter::Ewa}, nullptr},
        {"ripmaps", textured, {.filter = TextureFilter::Ripmap}, nullptr},
        {"Gouraud's shading", lit, {.shading = Shading::Gouraud}, "uCornerLight"},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        const SpecializedKernel with = shading(c.scene, c.with), without = shading(c.scene);
        fmt::print("{:28} {:6} instructions, {:6} without\n", c.name, with.instructions,
                   without.instructions);
        EXPECT_NE(with.spirv, without.spirv);
        if (c.with.shading == Shading::Material) {
            EXPECT_GT(with.instructions, without.instructions);
        }
        if (!c.binding) continue;
        EXPECT_TRUE(with.bindings.contains(c.binding));
        EXPECT_FALSE(without.bindings.contains(c.binding));
    }
}

/** OpLoopMerge in a module. */
std::size_t loops(const std::vector<std::uint32_t>& spirv) {
    std::size_t count = 0;
    for (std::size_t at = 5; at < spirv.size(); at += std::max(spirv[at] >> 16, 1u))
        count += (spirv[at] & 0xffffu) == 246;
    return count;
}

TEST(RasterFeaturesOff, NoLoopForFewLights) {
    SceneBuilder room = plainRoom();
    EXPECT_EQ(loops(shading(room.scene).spirv), 0u);
    room.pointLight({0, 0.5f, 0}, glm::vec3(1.0f));
    const SpecializedKernel one = shading(room.scene);
    for (int i = 1; i < 4; ++i) room.pointLight({0.2f * float(i), 0.5f, 0}, glm::vec3(1.0f));
    const SpecializedKernel four = shading(room.scene);
    room.pointLight({-0.2f, 0.5f, 0}, glm::vec3(1.0f));
    const SpecializedKernel five = shading(room.scene);
    fmt::print("loops: {} with one light, {} with four, {} with five\n", loops(one.spirv), loops(four.spirv),
               loops(five.spirv));
    EXPECT_EQ(loops(one.spirv), 0u);
    EXPECT_EQ(loops(four.spirv), 0u);
    EXPECT_GT(four.instructions, one.instructions);
    EXPECT_EQ(loops(five.spirv), 1u);
    EXPECT_LT(five.instructions, four.instructions);
}

TEST(RasterFeaturesOff, NoPassesAndNoWorkForWhatIsNotThere) {
    const auto draw = [](const Scene& scene, const char* aa, Shading rate) {
        RenderOptions options;
        options.size = {16, 16};
        options.pipeline = Pipeline::Raster;
        options.auxiliary = false;
        options.antialiasing = antialiasing(aa);
        options.antialiasing.temporal.frames = 2;
        options.shading = rate;
        return renderer().render(scene, options);
    };
    const auto passes = [](const RenderResult& result) {
        std::set<std::string> names;
        for (const RenderResult::PassTime& pass : result.passes) names.insert(pass.name);
        return names;
    };
    const Scene scene = roomWith("a point light");
    const RenderResult plain = draw(scene, "none", Shading::Material);
    const std::set<std::string> without = passes(plain);
    EXPECT_TRUE(without.contains("shade.surface"));
    for (const auto& [name, value] : plain.counters) {
        EXPECT_NE(name, "corners_shaded");
        EXPECT_NE(name, "alpha_layers");
        EXPECT_NE(name, "refraction_pictures");
    }
    struct Case {
        const char* pass;
        RenderResult with;
        const char* counter;
    };
    std::vector<Case> cases;
    cases.push_back({"antialias.fxaa", draw(scene, "fxaa", Shading::Material), nullptr});
    cases.push_back({"antialias.add", draw(scene, "ssaa2", Shading::Material), nullptr});
    cases.push_back({"shade.multisample", draw(scene, "msaa2", Shading::Material), nullptr});
    cases.push_back({"temporal.resolve", draw(scene, "taa", Shading::Material), nullptr});
    cases.push_back({"shade.corners", draw(scene, "none", Shading::Gouraud), "corners_shaded"});
    cases.push_back({"shade.layer", draw(roomWith("alpha"), "none", Shading::Material), "alpha_layers"});
    // Layers without any light through surfaces have no pictures of what refracts.
    for (const std::string& name : passes(cases.back().with)) EXPECT_EQ(name.find("refraction"), name.npos);
    cases.push_back({"refraction.passAll", draw(roomWith("transmission"), "none", Shading::Material),
                     "refraction_pictures"});
    for (const Case& c : cases) {
        SCOPED_TRACE(c.pass);
        EXPECT_TRUE(passes(c.with).contains(c.pass));
        EXPECT_FALSE(without.contains(c.pass));
        if (!c.counter) continue;
        EXPECT_TRUE(std::ranges::any_of(c.with.counters, [&](const auto& counter) {
            return counter.first == c.counter && counter.second > 0;
        }));
    }
}

}  // namespace
}  // namespace helio::test
