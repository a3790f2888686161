/** @file Rows A1 to A3: the Fourier transform, filters by it, and the frequencies of what a picture aliases.
 */
#include "tests/support/device.hpp"

#include <heliograph/error.hpp>
#include <heliograph/fourier.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace helio {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Values = std::vector<std::complex<float>>;
using Size = std::array<std::uint32_t, 2>;

Values random(std::size_t count, std::uint32_t seed) {
    std::mt19937 engine(seed);
    const auto uniform = [&] { return float(double(engine()) / 2147483648.0 - 1.0); };
    Values values(count);
    for (auto& v : values) v = {uniform(), uniform()};
    return values;
}

/** The sum as it is written, in double. */
std::vector<std::complex<double>> direct(const Values& values, Size size, double sign = -1) {
    std::vector<std::complex<double>> result(values.size());
    for (std::size_t ky = 0; ky < size[1]; ++ky)
        for (std::size_t kx = 0; kx < size[0]; ++kx) {
            std::complex<double> sum = 0;
            for (std::size_t y = 0; y < size[1]; ++y)
                for (std::size_t x = 0; x < size[0]; ++x) {
                    const double turns =
                        double(kx * x % size[0]) / size[0] + double(ky * y % size[1]) / size[1];
                    sum += std::complex<double>(values[y * size[0] + x]) *
                           std::polar(1.0, sign * 2 * kPi * turns);
                }
            result[ky * size[0] + kx] = sum;
        }
    return result;
}

/** |a - b| / |b| over all values. */
template <typename A, typename B>
double relative(const std::vector<A>& a, const std::vector<B>& b) {
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference += std::norm(std::complex<double>(a[i]) - std::complex<double>(b[i]));
        norm += std::norm(std::complex<double>(b[i]));
    }
    return std::sqrt(difference / norm);
}

TEST(Fourier, IsTheSumItSays) {
    for (const Size size : {Size{1, 1}, {2, 1}, {1, 2}, {512, 1}, {1, 256}, {32, 16}, {8, 64}}) {
        const Values values = random(std::size_t(size[0]) * size[1], size[0]);
        const double count = double(values.size()), bound = 1e-6 * std::sqrt(std::max(count, 1.0));
        EXPECT_LT(relative(fourierTransform(test::device(), values, size), direct(values, size)),
                  std::min(bound, 1e-6));
        auto back = direct(values, size, 1);
        for (auto& v : back) v /= count;
        EXPECT_LT(relative(fourierTransform(test::device(), values, size, true), back),
                  std::min(bound, 1e-6));
    }
}

TEST(Fourier, ClosedFormsAndParseval) {
    constexpr std::uint32_t n = 4096;
    Values delta(n), cosine(n), gaussian(n);
    delta[5] = 1;
    for (std::uint32_t j = 0; j < n; ++j) {
        cosine[j] = float(std::cos(2 * kPi * 37 * j / n));
        const double x = double(std::min(j, n - j)) / 20;
        gaussian[j] = float(std::exp(-0.5 * x * x));
    }
    const Values flat = fourierTransform(test::device(), delta, {n, 1});
    const Values lines = fourierTransform(test::device(), cosine, {n, 1});
    const Values bell = fourierTransform(test::device(), gaussian, {n, 1});
    for (std::uint32_t k = 0; k < n; ++k) {
        const std::complex<double> turned = std::polar(1.0, -2 * kPi * double(5 * k % n) / n);
        ASSERT_LT(std::abs(std::complex<double>(flat[k]) - turned), 1e-6) << k;
        const double line = k == 37 || k == n - 37 ? n / 2 : 0;
        ASSERT_LT(std::abs(std::complex<double>(lines[k]) - line), 1e-6 * n) << k;
        const double f = 2 * kPi * double(std::min(k, n - k)) / n * 20;
        ASSERT_LT(std::abs(std::complex<double>(bell[k]) - 20 * std::sqrt(2 * kPi) * std::exp(-0.5 * f * f)),
                  1e-4)
            << k;
    }
    const Size size{512, 256};
    const Values values = random(std::size_t(size[0]) * size[1], 3);
    const Values spectrum = fourierTransform(test::device(), values, size);
    double energy = 0, spectral = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        energy += std::norm(std::complex<double>(values[i]));
        spectral += std::norm(std::complex<double>(spectrum[i]));
    }
    EXPECT_NEAR(spectral / double(values.size()) / energy, 1.0, 1e-6);
    EXPECT_LT(relative(fourierTransform(test::device(), spectrum, size, true), values), 1e-6);
}

TEST(Fourier, ConvolutionIsAProductOfSpectra) {
    constexpr std::uint32_t n = 256;
    const Values f = random(n, 7), g = random(n, 8);
    std::vector<std::complex<double>> sum(n);
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j)
            sum[i] += std::complex<double>(f[j]) * std::complex<double>(g[(i + n - j) % n]);
    EXPECT_LT(relative(convolve(test::device(), f, g, {n, 1}), sum), 2e-6);
}

TEST(Fourier, ABoxBlurTakesAwayTheMultiplesOfItsFrequency) {
    constexpr std::uint32_t n = 256, width = 8;
    Values box(n), rest(n);
    for (std::uint32_t j = 0; j < width; ++j) box[j] = 1.0f / width;
    for (std::uint32_t j = 0; j < n; ++j) rest[j] = -box[j];
    rest[0] += 1.0f;  // what the low-pass filter takes away
    const Values spectrum = fourierTransform(test::device(), box, {n, 1});
    for (std::uint32_t k = 0; k <= n / 2; ++k) {
        const double x = kPi * k / n;
        const double expected = k == 0 ? 1 : std::abs(std::sin(width * x) / (width * std::sin(x)));
        EXPECT_NEAR(double(std::abs(spectrum[k])), expected, 2e-6) << k;
        if (k > 0 && k % (n / width) == 0) {
            EXPECT_LT(std::abs(spectrum[k]), 2e-6f) << k;
        }
    }
    const Values f = random(n, 9);
    const Values low = convolve(test::device(), f, box, {n, 1}),
                 high = convolve(test::device(), f, rest, {n, 1});
    Values both(n);
    for (std::uint32_t j = 0; j < n; ++j) both[j] = low[j] + high[j];
    EXPECT_LT(relative(both, f), 2e-6);
}

TEST(Fourier, SizesThatAreNoPowersOfTwoAreRefused) {
    for (const Size size : {Size{3, 1}, {0, 4}, {4, 6}, {8192, 4096}})
        EXPECT_THROW(fourierTransform(test::device(), Values(12), size), InputError);
    EXPECT_THROW(fourierTransform(test::device(), Values(12), {8, 1}), InputError);
}

#ifdef ALIASING
TEST(Aliasing, StripesAreSeenAtTheFrequencyThatTheorySays) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "heliograph_aliasing";
    std::filesystem::create_directories(folder);
    const std::string command = std::string("'") + ALIASING + "' '" + folder.string() + "' 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::array<char, 256> line;
    int rows = 0, wheels = 0;
    while (std::fgets(line.data(), int(line.size()), pipe)) {
        unsigned cycles, predicted, seen;
        double amplitude, filtered;
        double speed, turn, seenTurn;
        int bin, seenBin;
        // A wheel's row: its speed is no whole number.
        if (std::sscanf(line.data(), "%lf %lf %lf %d %d", &speed, &turn, &seenTurn, &bin, &seenBin) == 5 &&
            speed < 2) {
            ++wheels;
            EXPECT_NEAR(turn, speed - std::round(speed), 1e-4) << line.data();
            EXPECT_NEAR(seenTurn, turn, 5e-4) << line.data();
            EXPECT_EQ(bin, int(std::round(turn * 32))) << line.data();
            EXPECT_EQ(seenBin, bin) << line.data();
            continue;
        }
        if (std::sscanf(line.data(), "%u %u %u %lf %lf", &cycles, &predicted, &seen, &amplitude, &filtered) !=
            5)
            continue;
        ++rows;
        EXPECT_EQ(seen, predicted) << line.data();
        EXPECT_NEAR(amplitude, 0.5, 1e-3) << line.data();
        // Finer than half a cycle a pixel: gone; coarse: still there.
        if (cycles >= 300) {
            EXPECT_LT(filtered, 0.15) << line.data();
        }
        if (cycles == 40) {
            EXPECT_GT(filtered, 0.4) << line.data();
        }
    }
    EXPECT_EQ(pclose(pipe), 0);
    EXPECT_EQ(rows, 5);
    EXPECT_EQ(wheels, 4);
    EXPECT_TRUE(std::filesystem::exists(folder / "zone-plate-nearest.png"));
    std::filesystem::remove_all(folder);
}
#endif

}  // namespace
}  // namespace helio
