#include <heliograph/photometry.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace helio {
namespace {

constexpr double first = 360, last = 830, step = 5;
constexpr std::array<double, 95> table = {
    3.917e-06,  6.965e-06,  1.239e-05,  2.202e-05,  3.9e-05,   6.4e-05,    0.00012,    0.000217,   0.000396,
    0.00064,    0.00121,    0.00218,    0.004,      0.0073,    0.0116,     0.01684,    0.023,      0.0298,
    0.038,      0.048,      0.06,       0.0739,     0.09098,   0.1126,     0.13902,    0.1693,     0.20802,
    0.2586,     0.323,      0.4073,     0.503,      0.6082,    0.71,       0.7932,     0.862,      0.9148501,
    0.954,      0.9803,     0.9949501,  1.0,        0.995,     0.9786,     0.952,      0.9154,     0.87,
    0.8163,     0.757,      0.6949,     0.631,      0.5668,    0.503,      0.4412,     0.381,      0.321,
    0.265,      0.217,      0.175,      0.1382,     0.107,     0.0816,     0.061,      0.04458,    0.032,
    0.0232,     0.017,      0.01192,    0.00821,    0.005723,  0.004102,   0.002929,   0.002091,   0.001484,
    0.001047,   0.00074,    0.00052,    0.0003611,  0.0002492, 0.0001719,  0.00012,    8.48e-05,   6e-05,
    4.24e-05,   3e-05,      2.12e-05,   1.499e-05,  1.06e-05,  7.4657e-06, 5.2578e-06, 3.7029e-06, 2.6078e-06,
    1.8366e-06, 1.2934e-06, 9.1093e-07, 6.4153e-07, 4.5181e-07};

}  // namespace

double luminousEfficiency(double nanometres) {
    if (!(nanometres >= first && nanometres <= last)) return 0;
    const double place = (nanometres - first) / step;
    const std::size_t i = std::min(std::size_t(place), table.size() - 2);
    return std::lerp(table[i], table[i + 1], place - double(i));
}

double photometric(std::span<const double> wavelengths, std::span<const double> values) {
    assert(wavelengths.size() == values.size());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < wavelengths.size(); ++i) {
        const double a = wavelengths[i], b = wavelengths[i + 1];
        assert(a < b);
        // Both factors are linear between the knots of either: Simpson's rule is exact there.
        for (double from = std::max(a, first), end = std::min(b, last); from < end;) {
            const double to = std::min(end, (std::floor(from / step) + 1) * step);
            const auto product = [&](double x) {
                return luminousEfficiency(x) * std::lerp(values[i], values[i + 1], (x - a) / (b - a));
            };
            sum += (to - from) / 6 * (product(from) + 4 * product(0.5 * (from + to)) + product(to));
            from = to;
        }
    }
    return kLuminousEfficacy * sum;
}

}  // namespace helio
