#pragma once
/** @file What the benchmark measures: scenes by methods. */
#include <heliograph/renderer.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace helio::cli {

/** One method on one scene, measured over a series of samples per pixel. */
struct BenchCase {
    std::string group;  ///< "samplers", "lights", "errors", "integrators", "accelerators", "antialiasing",
                        ///< "filters", "mips", "traversal"
    std::string scene;   ///< as benchScene() knows it
    std::string method;  ///< one of its group
    RenderOptions options;
    bool denoised = false;  ///< the filtered picture is judged
    /** It converges to another picture than the truth it is held against, on purpose. */
    bool biased = false;
    /** Of the raster pipeline: the antialiasing's name, "{}" for its number; that number squared is the
     * samples where `squared`. */
    std::string pattern;
    bool squared = false;
    std::vector<std::uint32_t> samples;  ///< per pixel, ascending; of groups "mips", "traversal" sizes
    /** What `samples` counts where it is no samples: "texels a side", "triangles"; see bench_sizes.hpp. */
    std::string unit;
    /** Between which the exponent of relMSE over samples is by theory; nothing where it says little. */
    struct Order {
        double low, high;
    };
    std::optional<Order> order;

    /** Options of a render with so many samples. */
    RenderOptions with(std::uint32_t samples, std::uint32_t seed) const;
    /** What identifies the truth it is held against: cases of one scene share it unless they differ here. */
    std::string truth() const;
};

struct BenchSettings {
    bool quick = false;
    std::array<std::uint32_t, 2> size;  ///< pixels
    std::uint32_t repeats;              ///< renders of a point, each with its own seed
    std::uint32_t reference;            ///< samples of each half of a reference of paths
    std::uint32_t referenceSide;        ///< and of one of the rasterizer, side by side
    std::uint32_t rays;                 ///< of a traversal
};
BenchSettings benchSettings(bool quick);

/** All cases, a scene's together, so that it is made ready once. */
std::vector<BenchCase> benchCases(bool quick);

/** Those whose group, scene, method or "scene/method" is among the names; all where there are no names.
 * Throws InputError for a name that is none. */
std::vector<BenchCase> chosenCases(const std::vector<BenchCase>& cases,
                                   const std::vector<std::string>& names);

}  // namespace helio::cli
