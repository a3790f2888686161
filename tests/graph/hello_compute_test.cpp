/** @file Runs samples/hello_compute and checks its picture against the set computed here in double. */
#include <heliograph/image.hpp>

#include <gtest/gtest.h>

#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace helio {
namespace {

/** Steps until |z| > 16, 256 for none. */
int escapeSteps(std::complex<double> c) {
    std::complex<double> z = 0;
    int steps = 0;
    while (steps < 256 && std::norm(z) < 256) {
        z = z * z + c;
        ++steps;
    }
    return steps;
}

TEST(HelloCompute, IsUnderFortyLines) {
    std::ifstream source(HELLO_COMPUTE_SOURCE);
    ASSERT_TRUE(source);
    int lines = 0;
    for (std::string line; std::getline(source, line);) ++lines;
    EXPECT_LT(lines, 40);
}

TEST(HelloCompute, DrawsTheMandelbrotSet) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / "heliograph_hello_compute";
    std::filesystem::create_directories(folder);
    const std::filesystem::path file = folder / "set.exr";
    const std::string command =
        std::string(HELLO_COMPUTE) + " " + file.string() + " > " + (folder / "out.txt").string();
    ASSERT_EQ(std::system(command.c_str()), 0);
    const ImageF image = loadImage(file);
    ASSERT_EQ(image.width, 640u);
    ASSERT_EQ(image.height, 480u);
    const auto r = std::size_t(image.channel("R"));
    int inside = 0, outside = 0;
    for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const std::complex<double> c(-0.6 + 1.2 * (2.0 * x + 1 - 640) / 480,
                                         -1.2 * (2.0 * y + 1 - 480) / 480);
            const int steps = escapeSteps(c);
            const float red = image.at(x, y, r);
            // Far from the boundary rounding cannot matter: quick escapes, and the two largest parts within.
            const double cardioid = std::norm(c - 0.25);
            const bool deep = cardioid * (cardioid + 0.99 * (c.real() - 0.25)) < 0.20 * c.imag() * c.imag();
            if (deep) {
                EXPECT_EQ(red, 0.0f) << x << ", " << y;
                ++inside;
            } else if (steps < 12) {
                EXPECT_GT(red, 0.0f) << x << ", " << y;
                ++outside;
            }
        }
    }
    EXPECT_GT(inside, 10000);
    EXPECT_GT(outside, 100000);
    std::ifstream text(folder / "out.txt");
    std::string first;
    std::getline(text, first);
    EXPECT_EQ(first.rfind("the Mandelbrot set, computed on ", 0), 0u) << first;
    std::filesystem::remove_all(folder);
}

TEST(HelloCompute, SaysWhatWentWrong) {
    EXPECT_EQ(WEXITSTATUS(std::system(
                  (std::string(HELLO_COMPUTE) + " /no/such/folder/set.png 2> /dev/null").c_str())),
              1);
}

}  // namespace
}  // namespace helio
