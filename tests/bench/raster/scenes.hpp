#pragma once
/** @file What the rasterizers are timed on. */
#include "passes/raster/view.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace helio::bench {

struct BenchScene {
    std::string name;
    RasterView view;
    std::vector<glm::vec4> triangles;  ///< three texels each: xyz of a corner, then id, instance, material
};

/** `count` triangles whose corners lie in a square of `side` pixels about uniform places; at least a tenth of
 * the square each. */
BenchScene scattered(std::string name, std::uint32_t count, double side, std::array<std::uint32_t, 2> size);
/** `count` triangles that each cover the whole image. */
BenchScene fullScreen(std::string name, std::uint32_t count, std::array<std::uint32_t, 2> size);
/** `count` walls of `side` x `side` squares, two triangles each, that fill the image one behind another. */
BenchScene walls(std::string name, std::uint32_t count, std::uint32_t side,
                 std::array<std::uint32_t, 2> size);
/** A file or sample, seen by its first camera or framed. */
BenchScene fromFile(const std::string& file, std::array<std::uint32_t, 2> size);

}  // namespace helio::bench
