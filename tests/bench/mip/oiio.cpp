/** @file
 * Mip chains by OpenImageIO, the peer on the host of bench_mip: each level by ImageBufAlgo::resize with its
 * box filter from the one above, in floats; a base of 8 bits is decoded from sRGB first. All cores.
 *     bench_mip_oiio [--rounds N] [--size N]
 * Prints a Markdown table: milliseconds on the wall, CPU milliseconds, and the relMSE of all levels against
 * means in double precision.
 */
#include "tests/bench/timing.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace {

using helio::bench::cpuSeconds;
using helio::bench::median;

std::vector<OIIO::ImageBuf> chain(const OIIO::ImageBuf& base, bool isFloat) {
    std::vector<OIIO::ImageBuf> levels;
    levels.push_back(isFloat ? base : OIIO::ImageBufAlgo::colorconvert(base, "sRGB", "linear", false));
    for (int side = base.spec().width / 2; side > 0; side /= 2)
        levels.push_back(
            OIIO::ImageBufAlgo::resize(levels.back(), "box", 1.0f, OIIO::ROI(0, side, 0, side, 0, 1, 0, 4)));
    return levels;
}

/** Against means of 2 x 2 in double precision; the base's own decoding is taken as OpenImageIO has it. */
double relmse(const std::vector<OIIO::ImageBuf>& levels) {
    const auto read = [](const OIIO::ImageBuf& level) {
        std::vector<float> texels(std::size_t(level.spec().width) * level.spec().height * 4);
        level.get_pixels(level.roi(), OIIO::TypeDesc::FLOAT, texels.data());
        return texels;
    };
    const std::vector<float> base = read(levels.front());
    std::vector<double> finer(base.begin(), base.end());
    double sum = 0, count = 0;
    for (std::size_t k = 1; k < levels.size(); ++k) {
        const auto side = std::size_t(levels[k].spec().width);
        std::vector<double> truth(side * side * 4);
        const std::vector<float> made = read(levels[k]);
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const std::size_t c = i % 4, x = i / 4 % side, y = i / 4 / side;
            const auto at = [&](std::size_t u, std::size_t v) { return finer[(v * 2 * side + u) * 4 + c]; };
            truth[i] = 0.25 * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) +
                               at(2 * x + 1, 2 * y + 1));
            sum += std::pow(double(made[i]) - truth[i], 2) / (truth[i] * truth[i] + 0.01);
            ++count;
        }
        finer = std::move(truth);
    }
    return sum / count;
}

void measure(const char* name, bool isFloat, int size, int rounds) {
    std::mt19937 random(1);
    OIIO::ImageBuf base(
        OIIO::ImageSpec(size, size, 4, isFloat ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8));
    const std::size_t count = std::size_t(size) * std::size_t(size) * 4;
    if (isFloat) {
        std::vector<float> texels(count);
        for (float& x : texels) x = std::generate_canonical<float, 24>(random);
        base.set_pixels(base.roi(), OIIO::TypeDesc::FLOAT, texels.data());
    } else {
        std::vector<std::uint8_t> texels(count);
        for (std::uint8_t& x : texels) x = std::uint8_t(random());
        base.set_pixels(base.roi(), OIIO::TypeDesc::UINT8, texels.data());
    }
    std::vector<double> walls, cpus;
    double error = 0;
    for (int round = 0; round <= rounds; ++round) {
        const auto start = std::chrono::steady_clock::now();
        const double cpu = cpuSeconds();
        const std::vector<OIIO::ImageBuf> levels = chain(base, isFloat);
        if (round == 0) {  // the first one also starts threads
            error = relmse(levels);
            continue;
        }
        cpus.push_back((cpuSeconds() - cpu) * 1e3);
        walls.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    fmt::print("| {} | OpenImageIO {} | {:.1f} | {:.1f} | {:.1f} | {:.1e} |\n", name, OIIO_VERSION_STRING,
               median(walls), std::ranges::min(walls), median(cpus), error);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    int rounds = 9, size = 4096;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string option = argv[i];
        if (option == "--rounds") rounds = std::max(1, std::atoi(argv[i + 1]));
        if (option == "--size") size = std::clamp(std::atoi(argv[i + 1]), 2, 8192);
    }
    fmt::print("| base | what | median, ms | fastest, ms | CPU, ms | relMSE |\n|---|---|---|---|---|---|\n");
    measure("RGBA8, sRGB", false, size, rounds);
    measure("RGBA32F", true, size, rounds);
    return 0;
}
