#include "passes/shade/refraction.hpp"

#include <algorithm>

namespace helio {
namespace {

/** The picture as a texture: shaders/scene/textures.glsl. Clamped, float, with mip levels. */
std::vector<glm::uvec4> pictureHeader(const RasterView& view, bool rough) {
    if (!rough) return {};
    return {{0u, view.width, view.height, 2u | 2u << 2 | 1u << 5 | 1u << 6}};
}

}  // namespace

DeviceBuffer perPixel(Device& device, const char* name, const RasterView& view, std::uint64_t bytes) {
    return {device, name, std::uint64_t(view.width) * view.height * bytes};
}

RefractionPictures::RefractionPictures(Device& device, const RasterView& view, bool refracts, bool rough)
    : refracts_(refracts),
      header_(pictureHeader(view, rough)),
      mips_(device, header_),
      passed_(perPixel(device, "refraction.passed", view, 16)),
      behind_(perPixel(device, "refraction.behind", view, 16)),
      behindDepth_(perPixel(device, "refraction.behindDepth", view, 16)),
      headers_(makeBuffer(device, "refraction.texture",
                          rough ? header_ : std::vector<glm::uvec4>(1, glm::uvec4(0u)))),
      none_(makeBuffer(device, "refraction.none", std::vector<std::uint32_t>(4))) {}

void RefractionPictures::declareTarget(Graph& graph, LayerTarget& target) {
    target.passed = graph.import(passed_);
    target.leftOut = leftOut_;
    target.behind = {{"uBehind", graph.import(behind_), Format::RGBA32F},
                     {"uBehindDepth", graph.import(behindDepth_), Format::RGBA32F}};
    if (header_.empty()) return;
    for (Binding binding : mips_.bindings(graph)) {
        const bool table = binding.name == "uMipTable";
        binding.name = table ? "uBehindTable" : "uBehindMips";
        binding.view = table ? Format::RGBA32UI : Format::RGBA32F;
        target.behind.push_back(binding);
    }
}

void RefractionPictures::declareClear(Graph& graph) {
    graph.fill("refraction.passAll", graph.import(passed_), 0x3f800000u);  // 1
}

void RefractionPictures::makeKeep(Device& device, DeviceBuffer& color, DeviceBuffer& albedoDepth) {
    Graph graph(device);
    const Buffer behind = graph.import(behind_);
    graph.copy("refraction.keep", graph.import(color), behind);
    graph.copy("refraction.keepDepth", graph.import(albedoDepth), graph.import(behindDepth_));
    if (mips_.needed())
        mips_.declare(graph,
                      {{"uTextures", graph.import(headers_)},
                       {"uTexels8", graph.import(none_), Format::R32UI},
                       {"uTexelsFloat", behind, Format::RGBA32F}},
                      {});
    keep_ = graph.compile({.executionsInFlight = 1});
}

void RefractionPictures::draw(const DrawPicture& picture,
                              const std::function<void(const std::vector<PassTiming>&)>& timings) {
    std::uint32_t pictures = 0;
    if (refracts_) {
        *leftOut_ = ~0u >> 8;  // of every pixel all
        pictures = std::min(picture(), kMaxPictures);
    }
    if (pictures == 0) {
        *leftOut_ = 0;
        picture();
    }
    for (std::uint32_t k = pictures; k-- > 0;) {
        const Execution kept = keep_.execute();
        keep_.wait(kept);
        if (timings) timings(keep_.timings(kept));
        *leftOut_ = k;
        picture();
    }
}

}  // namespace helio
