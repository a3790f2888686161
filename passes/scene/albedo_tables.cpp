#include "passes/scene/albedo_tables.hpp"

#include "engine/core/shared.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>

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

std::vector<glm::vec4> sheenTable() {
    Table values(kNodes * kNodes);
    tbb::parallel_for(std::size_t(0), kNodes, [&](std::size_t row) {
        for (std::size_t column = 0; column < kNodes; ++column) {
            const double x = double(column) / (kNodes - 1);
            values[row * kNodes + column] = sheenDirectionalAlbedo(x * x, double(row) / (kNodes - 1));
        }
    });
    std::vector<glm::vec4> texels;
    for (std::size_t y = 0; y + 1 < kNodes; ++y)
        for (std::size_t x = 0; x + 1 < kNodes; ++x)
            texels.emplace_back(values[y * kNodes + x], values[y * kNodes + x + 1],
                                values[(y + 1) * kNodes + x], values[(y + 1) * kNodes + x + 1]);
    return texels;
}

}  // namespace helio::pack
