#pragma once
/** @file Where path tracing sums light by how often it scattered: the host's side of bounces.glsl. */
#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace helio {

/** Layers of light that scattered 0, 1, ... `bounces` times, and of what scattered more often. */
class BounceLayers {
public:
    /** The most bounces with a layer of their own that a picture of this size can have; negative: none. */
    static int most(const std::array<std::uint32_t, 2>& size);

    /** `bounces`: 0 to most(size). */
    BounceLayers(Device& device, const std::array<std::uint32_t, 2>& size, int bounces);

    /** What trace.comp is compiled and specialized with. */
    std::map<std::string, std::string> defines() const;
    SpecConstants constants() const;
    Image import(Graph& graph) { return graph.import(image_); }

    /** Mean radiance R G B of each pixel, layer by layer, from the film's number of samples per pixel, which
     * lies at `film[4 * pixel + 3]`. */
    std::vector<std::vector<float>> means(const std::vector<float>& film);

private:
    Device& device_;
    std::array<std::uint32_t, 2> size_;
    std::uint32_t layers_, columns_;
    DeviceImage image_;
};

}  // namespace helio
