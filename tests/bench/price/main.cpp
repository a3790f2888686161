/** @file
 * The price of the general engine: the path tracer's kernel for sample:cornell against one stripped by hand
 * (stripped.comp), run in turn on the same film, state and scene.
 *   bench_price [PAIRS] [SAMPLES] [SIZE]
 *   bench_price raster [PAIRS] [PICTURES] [SIZE]
 *   bench_price features [raster]
 * First: prints the median of the ratios of CPU time (general / stripped) over the pairs, with its 95 %
 * interval by order statistics. Exit 1 where the pictures differ. Second: the same of the raster pipeline's
 * shading, see shading.hpp. Third: what each feature of a scene costs, see features.hpp.
 */
#include "tests/bench/price/contender.hpp"
#include "tests/bench/price/features.hpp"
#include "tests/bench/price/ratios.hpp"
#include "tests/bench/price/shading.hpp"

#include <fmt/format.h>
#include <heliograph_kernels/price.hpp>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string_view>

namespace {

using namespace helio;
using test::Contender;

int compare(std::uint32_t pairs, std::uint32_t samples, std::uint32_t size) {
    Scene scene = load("sample:cornell");
    const PlacedCamera placed = chooseCamera(scene, {}, 1.0);
    Device device{DeviceOptions{}};
    PathTraceOptions options;
    options.size = {size, size};
    DeviceScene packed(device, scene, PathTracer::packOptions(scene, options));
    Contender general(device, packed, scene, placed, options);
    options.kernel = &shaders::stripped;
    Contender stripped(device, packed, scene, placed, options);
    general.run(1);  // compiles
    stripped.run(1);
    test::printRatios(
        pairs, samples, "samples", [&] { return general.run(samples); },
        [&] { return stripped.run(samples); });
    const bool same = general.picture() == stripped.picture();
    fmt::print("pictures {}\n", same ? "equal to the bit" : "differ");
    return same ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const auto argument = [&](int i, std::uint32_t fallback) {
        return argc > i ? std::uint32_t(std::max(1, std::atoi(argv[i]))) : fallback;
    };
    try {
        if (argc > 1 && std::string_view(argv[1]) == "features") {
            const bool raster = argc > 2 && std::string_view(argv[2]) == "raster";
            return raster ? test::printRasterPrices() : test::printFeaturePrices();
        }
        if (argc > 1 && std::string_view(argv[1]) == "raster")
            return test::compareShading(argument(2, 101), argument(3, 8), argument(4, 512));
        return compare(argument(1, 101), argument(2, 16), argument(3, 256));
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_price: {}\n", error.what());
        return 1;
    }
}
