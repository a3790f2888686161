/** @file
 * The price of the general engine: the path tracer's kernel for sample:cornell against one stripped by hand
 * (stripped.comp), run in turn on the same film, state and scene.
 *   bench_price [PAIRS] [SAMPLES] [SIZE]
 *   bench_price features
 * First: prints the median of the ratios of CPU time (general / stripped) over the pairs, with its 95 %
 * interval by order statistics. Exit 1 where the pictures differ. Second: what each feature of a scene costs,
 * see features.hpp.
 */
#include "tests/bench/price/contender.hpp"
#include "tests/bench/price/features.hpp"

#include <fmt/format.h>
#include <heliograph_kernels/price.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <vector>

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
    std::vector<double> ratios;
    for (std::uint32_t pair = 0; pair < pairs; ++pair) {
        double a = 0, b = 0;
        if (pair % 2 == 0) {
            a = general.run(samples);
            b = stripped.run(samples);
        } else {
            b = stripped.run(samples);
            a = general.run(samples);
        }
        ratios.push_back(a / b);
    }
    std::sort(ratios.begin(), ratios.end());
    // The rank of the median is binomial: 1.96 standard deviations of it.
    const double half = 0.98 * std::sqrt(double(pairs)), middle = 0.5 * double(pairs - 1);
    const auto at = [&](double rank) {
        return ratios[std::size_t(std::clamp(rank, 0.0, double(pairs - 1)))];
    };
    fmt::print("general / stripped: median {:.4f}, 95 % interval {:.4f} to {:.4f}, {} pairs of {} samples\n",
               at(middle), at(std::floor(middle - half)), at(std::ceil(middle + half)), pairs, samples);
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
        if (argc > 1 && std::string_view(argv[1]) == "features") return test::printFeaturePrices();
        return compare(argument(1, 101), argument(2, 16), argument(3, 256));
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_price: {}\n", error.what());
        return 1;
    }
}
