#include "passes/renderer/raster_render.hpp"
#include "passes/scene/device_scene.hpp"
#include "passes/shade/shade.hpp"
#include "tests/bench/price/features.hpp"
#include "tests/support/scene_features.hpp"
#include "tests/support/specialized_kernel.hpp"

#include <heliograph/renderer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace helio::test {
namespace {

constexpr std::uint32_t kSide = 256;
constexpr int kFrames = 9;

RenderOptions plainOptions() {
    RenderOptions options;
    options.size = {kSide, kSide};
    options.pipeline = Pipeline::Raster;
    options.auxiliary = false;
    options.shadows.kind = Shadows::Kind::None;
    options.textureFilter = TextureFilter::Bilinear;
    options.environment = Environment{};  // none in place of the one that unlit scenes get
    return options;
}

Scene roomWith(const std::string& feature) {
    SceneBuilder room = plainRoom();
    room.pointLight({0, 0.5f, 0}, glm::vec3(1.0f));
    for (const Feature& each : features())
        if (each.name == feature) each.add(room);
    return room.scene;
}

/** A scene and how it is drawn, on a device of its own, whose memory is then that of this alone. */
class Drawn {
public:
    Drawn(Scene scene, const RenderOptions& options)
        : scene_(std::move(scene)), options_(options), renderer_(std::make_unique<Renderer>()) {
        if (scene_.environment) options_.environment.reset();
        const RenderResult first = frame();
        bytes = first.deviceBytes;
        std::set<std::string> names;
        for (const RenderResult::PassTime& pass : first.passes) names.insert(pass.name);
        passes = names.size();
    }
    RenderResult frame() { return renderer_->render(scene_, options_); }
    double cpuSeconds() { return frame().renderCpuSeconds; }

    /** Of the kernel that shades surfaces. */
    std::size_t instructions() {
        Device& device = renderer_->device();
        DeviceScene uploaded(device, scene_, rasterPackOptions());
        ShadePipeline pipeline(device, uploaded, {glm::dvec3(-1), glm::dvec3(1)}, options_.shadows,
                               options_.textureFilter, options_.lightSamples, options_.shading);
        RasterView view;
        view.width = view.height = kSide;
        const auto [kernel, constants] = pipeline.surfaceKernel(view);
        return specialize(kernel, constants).instructions;
    }

    std::uint64_t bytes = 0;
    std::size_t passes = 0;

private:
    Scene scene_;
    RenderOptions options_;
    std::unique_ptr<Renderer> renderer_;
};

class Table {
public:
    Table() : plain_(roomWith(""), plainOptions()), instructions_(plain_.instructions()) {
        fmt::print(
            "| scene or setting | instructions that shade | more | bytes on the device | passes | "
            "CPU time / plain |\n|---|---|---|---|---|---|\n");
        row("a plain room with a point light", plain_, false);
    }
    void add(const std::string& name, Scene scene, const RenderOptions& options) {
        Drawn drawn(std::move(scene), options);
        row(name, drawn, true);
    }

private:
    void row(const std::string& name, Drawn& drawn, bool compared) {
        std::vector<double> ratios;
        for (int frame = 0; frame < kFrames; ++frame) {
            const double own = drawn.cpuSeconds();
            ratios.push_back(own / plain_.cpuSeconds());
        }
        std::ranges::nth_element(ratios, ratios.begin() + kFrames / 2);
        const std::size_t code = drawn.instructions();
        fmt::print("| {} | {} | {} | {} | {} | {:.2f} |\n", name, code,
                   compared ? fmt::format("{:+}", int(code) - int(instructions_)) : "", drawn.bytes,
                   drawn.passes, compared ? ratios[kFrames / 2] : 1.0);
        std::fflush(stdout);
    }
    Drawn plain_;
    std::size_t instructions_;
};

}  // namespace

int printRasterPrices() {
    Table table;
    // What paths alone have is left out, with a word, or drawn as triangles.
    const std::set<std::string> others = {"a choice among lights", "shapes", "a tree"};
    for (const Feature& feature : features())
        if (!others.contains(feature.name)) table.add(feature.name, roomWith(feature.name), plainOptions());
    const auto with = [&](const std::string& name, const char* feature, const auto& change) {
        RenderOptions options = plainOptions();
        change(options);
        table.add(name, roomWith(feature), options);
    };
    const std::pair<const char*, Shadows::Kind> shadows[] = {
        {"shadow maps, hard", Shadows::Kind::Hard},
        {"shadow maps, filtered", Shadows::Kind::Filtered},
        {"shadow maps, soft", Shadows::Kind::Soft},
        {"shadow maps, variance", Shadows::Kind::Variance}};
    for (const auto& [name, kind] : shadows)
        with(name, "", [kind = kind](RenderOptions& o) { o.shadows.kind = kind; });
    const std::pair<const char*, TextureFilter> filters[] = {
        {"textures, trilinear", TextureFilter::Trilinear},
        {"textures, anisotropic", TextureFilter::Anisotropic},
        {"textures, EWA", TextureFilter::Ewa}};
    for (const auto& [name, filter] : filters)
        with(name, "base colour textures", [filter = filter](RenderOptions& o) { o.textureFilter = filter; });
    for (const char* aa : {"fxaa", "msaa4", "ssaa4", "grid2", "taa"})
        with(fmt::format("antialiasing {}", aa), "", [&](RenderOptions& o) {
            o.antialiasing = antialiasing(aa);
            o.antialiasing.temporal.frames = 2;
        });
    with("Gouraud's shading", "", [](RenderOptions& o) { o.shading = Shading::Gouraud; });
    with("emissive triangles, all of them", "emissive triangles",
         [](RenderOptions& o) { o.lightSamples = 0; });
    return 0;
}

}  // namespace helio::test
