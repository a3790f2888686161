#include "passes/pathtrace/bounce_layers.hpp"

#include <algorithm>
#include <cassert>

namespace helio {
namespace {

/** What the engine requires of images, texels each way. */
constexpr std::uint32_t kLargestImage = 16384;
constexpr std::uint32_t kMostBounces = 64;

std::uint32_t columnsOf(const std::array<std::uint32_t, 2>& size, std::uint32_t layers) {
    return std::min(layers, kLargestImage / (2 * size[0]));
}

}  // namespace

int BounceLayers::most(const std::array<std::uint32_t, 2>& size) {
    const std::uint64_t layers = std::uint64_t(kLargestImage / (2 * size[0])) * (kLargestImage / size[1]);
    return int(std::min<std::uint64_t>(layers, kMostBounces + 2)) - 2;
}

BounceLayers::BounceLayers(Device& device, const std::array<std::uint32_t, 2>& size, int bounces)
    : device_(device),
      size_(size),
      layers_(std::uint32_t(bounces) + 2),
      columns_(columnsOf(size, layers_)),
      image_(device, "pathtrace.bounces", 2 * size[0] * columns_,
             size[1] * ((layers_ + columns_ - 1) / columns_), Format::RGBA32F) {
    assert(bounces >= 0 && bounces <= most(size));
}

std::map<std::string, std::string> BounceLayers::defines() const {
    return {{"BOUNCES", std::to_string(layers_ - 2) + "u"}};
}

SpecConstants BounceLayers::constants() const {
    SpecConstants spec;
    spec["BOUNCE_COLUMNS"] = columns_;
    return spec;
}

std::vector<std::vector<float>> BounceLayers::means(const std::vector<float>& film) {
    assert(film.size() == std::size_t(size_[0]) * size_[1] * 4);
    Graph graph(device_);
    const auto read = graph.readback<float>(graph.import(image_));
    Plan plan = graph.compile({.executionsInFlight = 1});
    const std::vector<float> texels = read.wait(plan.execute());
    std::vector<std::vector<float>> result(layers_);
    const std::size_t pitch = std::size_t(2) * size_[0] * columns_;
    for (std::uint32_t layer = 0; layer < layers_; ++layer) {
        std::vector<float>& mean = result[layer];
        mean.reserve(film.size() / 4 * 3);
        for (std::uint32_t y = 0; y < size_[1]; ++y)
            for (std::uint32_t x = 0; x < size_[0]; ++x) {
                const float samples = film[(std::size_t(y) * size_[0] + x) * 4 + 3];
                const std::size_t texel = (layer / columns_ * size_[1] + y) * pitch +
                                          2 * (std::size_t(layer % columns_) * size_[0] + x);
                for (std::size_t c = 0; c < 3; ++c)
                    mean.push_back(samples > 0 ? texels[4 * texel + c] / samples : 0.0f);
            }
    }
    return result;
}

}  // namespace helio
