#include "passes/scene/albedo_tables.hpp"

#include "engine/core/shared.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <functional>

namespace helio::pack {
namespace {

constexpr double kPi = 3.14159265358979323846L;
constexpr std::size_t kNodes = std::size_t(kAlbedoNodes);

/** Sum of f over a midpoint grid of the unit square. */
template <typename Function>
double meanOver(int columns, int rows, const Function& f) {
    double sum = 0;
    for (int i = 0; i < columns; ++i)
        for (int k = 0; k < rows; ++k) sum += f((i + 0.5L) / columns, (k + 0.5L) / rows);
    return sum / (double(columns) * rows);
}

glm::dvec3 viewer(double cosine) {
    return {std::sqrt(std::max(double(0), 1 - cosine * cosine)), double(0), cosine};
}

using Table = std::vector<double>;

Table tabulate(const std::function<double(double, double)>& f) {
    Table values(kNodes * kNodes);
    tbb::parallel_for(std::size_t(0), kNodes, [&](std::size_t row) {
        for (std::size_t column = 0; column < kNodes; ++column)
            values[row * kNodes + column] = f(double(column) / (kNodes - 1), double(row) / (kNodes - 1));
    });
    return values;
}

void append(const Table& values, std::vector<glm::vec4>& texels) {
    for (std::size_t y = 0; y + 1 < kNodes; ++y)
        for (std::size_t x = 0; x + 1 < kNodes; ++x)
            texels.emplace_back(values[y * kNodes + x], values[y * kNodes + x + 1],
                                values[(y + 1) * kNodes + x], values[(y + 1) * kNodes + x + 1]);
}

}  // namespace

double sheenDirectionalAlbedo(double cosine, double roughness) {
    const glm::dvec3 wo = viewer(std::max(cosine, double(1e-4L)));
    // Half of the circle by symmetry; more nodes at grazing angles, where sheen is.
    return meanOver(48, 32, [&](double u, double v) -> double {
        const double theta = kPi / 2 * u * (2 - u), phi = kPi * v;
        const glm::dvec3 wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                            std::cos(theta));
        const double jacobian = kPi * (1 - u) * 2 * kPi * std::sin(theta);
        return shared64::sheenValue(roughness, wo, wi).value.x * jacobian;
    });
}

double ggxDirectionalAlbedo(double cosine, double alpha) {
    if (alpha < double(1e-3L)) return 1;
    const glm::dvec3 wo = viewer(std::max(cosine, double(1e-5L)));
    const glm::dvec2 widths(alpha);
    // Over the numbers that draw visible normals the weight is bounded by 1 and smooth but for the horizon.
    return meanOver(64, 64, [&](double u, double v) -> double {
        const glm::dvec3 h = shared64::ggxSampleNormal(wo, widths, glm::dvec2(u * double(0.5L), v));
        const glm::dvec3 wi = shared64::reflectedAbout(wo, h);
        if (!(wi.z > 0)) return 0;
        const double o = shared64::ggxStretch(wo, widths), i = shared64::ggxStretch(wi, widths);
        return wi.z * (wo.z + o) / (wi.z * o + wo.z * i);
    });
}

std::vector<glm::vec4> albedoTables(bool sheen, bool ggx) {
    std::vector<glm::vec4> texels;
    Table values(kNodes * kNodes), means(kNodes * kNodes);
    if (sheen) values = tabulate([](double x, double y) { return sheenDirectionalAlbedo(x * x, y); });
    append(values, texels);
    if (ggx) {
        values = tabulate([](double x, double y) { return ggxDirectionalAlbedo(x * x, y * y); });
        // The mean of what the table holds, by Simpson's rule on each linear cell of x = sqrt(cosine): what
        // is put back is then exactly what the table says is lost. 2 c dc = 4 x^3 dx.
        for (std::size_t y = 0; y < kNodes; ++y) {
            double mean = 0;
            for (std::size_t x = 0; x + 1 < kNodes; ++x) {
                const double left = values[y * kNodes + x], right = values[y * kNodes + x + 1];
                const double a = double(x) / (kNodes - 1), b = double(x + 1) / (kNodes - 1), m = (a + b) / 2;
                mean += (b - a) / 6 * 4 *
                        (a * a * a * left + 4 * m * m * m * (left + right) / 2 + b * b * b * right);
            }
            for (std::size_t x = 0; x < kNodes; ++x) means[y * kNodes + x] = mean;
        }
    } else {
        values.assign(kNodes * kNodes, 0);
    }
    append(values, texels);
    append(means, texels);
    return texels;
}

}  // namespace helio::pack
