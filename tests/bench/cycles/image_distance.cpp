/** @file
 * Squared relative distance of what two renderers converge to, from two independent pictures of each:
 *   bench_cycles_distance A1 A2 B1 B2
 * The noises of (a1 - b1) and (a2 - b2) are independent, so that mean((a1 - b1)(a2 - b2) / (r^2 + 0.01)), r
 * the mean of the a's, has the expectation of relMSE without noise. Unlike a difference of squares it stands
 * outliers. Prints it, its standard error over pixels, and the ratio of the means b / a.
 */
#include <heliograph/image.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
    if (argc != 5) {
        std::fputs("usage: bench_cycles_distance A1 A2 B1 B2\n", stderr);
        return 2;
    }
    try {
        std::array<helio::ImageF, 4> images;
        for (std::size_t i = 0; i < 4; ++i) images[i] = helio::loadImage(argv[i + 1]);
        const std::size_t pixels = std::size_t(images[0].width) * images[0].height;
        double sum = 0, squares = 0, a = 0, b = 0;
        for (std::size_t p = 0; p < pixels; ++p) {
            double distance = 0;
            for (const char* channel : {"R", "G", "B"}) {
                std::array<double, 4> v{};
                for (std::size_t i = 0; i < 4; ++i) {
                    const int c = images[i].channel(channel);
                    if (c < 0 || images[i].data.size() < (p + 1) * images[i].channels.size()) {
                        std::fputs("bench_cycles_distance: sizes or channels differ\n", stderr);
                        return 1;
                    }
                    v[i] = double(images[i].data[p * images[i].channels.size() + std::size_t(c)]);
                }
                const double r = (v[0] + v[1]) / 2;
                distance += (v[0] - v[2]) * (v[1] - v[3]) / (r * r + 0.01) / 3;
                a += v[0] + v[1];
                b += v[2] + v[3];
            }
            sum += distance;
            squares += distance * distance;
        }
        const double n = double(pixels), mean = sum / n;
        std::printf("%.9g %.9g %.9g\n", mean, std::sqrt((squares / n - mean * mean) / n), b / a);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_cycles_distance: %s\n", error.what());
        return 1;
    }
    return 0;
}
