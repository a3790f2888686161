#include "samples/lectures/materials.hpp"

namespace helio::lectures {
namespace {

constexpr std::uint32_t kSize = 257;

/** Distance from the middle of `profile` at which it falls to half, by linear interpolation. */
double halfWidth(const std::vector<double>& profile) {
    const std::size_t middle = profile.size() / 2;
    const double half = 0.5 * profile[middle];
    std::size_t i = middle;
    while (i + 1 < profile.size() && profile[i] > half) ++i;
    return double(i - middle) - (half - profile[i]) / (profile[i - 1] - profile[i]);
}

/** Slope at which the highlight of facets of width a falls to half. Seen from the lamp: 1 / r^2 of the lamp,
 * the cosine, D and G of equal directions, over 4 cosines squared, which makes (1 + s^2)^(3/2) / ((1 + s^2 /
 * a^2)^2 sqrt(1 + a^2 s^2)) of the middle's. */
double slopeOfHalf(double a) {
    double low = 0, high = 10 * a;
    while (high - low > 1e-9) {
        const double s = 0.5 * (low + high),
                     ratio = std::pow(1 + s * s, 1.5) /
                             (std::pow(1 + s * s / (a * a), 2) * std::sqrt(1 + a * a * s * s));
        (ratio > 0.5 ? low : high) = s;
    }
    return low;
}

}  // namespace

std::vector<Figure> measureBrushed(Renderer& renderer) {
    const Scene scene = load("sample:brushed");
    const glm::dvec2 alpha(scene.materials.at(1).scattering->alpha);
    RenderOptions options;
    options.size = {kSize, kSize};
    options.samples = 16;
    options.camera = "lamp";
    options.maxDepth = 1;
    options.auxiliary = false;
    options.environment = Environment{};
    const ImageF image = renderer.render(scene, options).image;
    std::vector<double> along, across;
    for (std::uint32_t i = 0; i < kSize; ++i) {
        along.push_back(double(image.at(i, kSize / 2, 0)));
        across.push_back(double(image.at(kSize / 2, i, 0)));
    }
    const double pixel = 2 * 0.28 / kSize;
    const glm::dvec2 widths(halfWidth(along) * pixel, halfWidth(across) * pixel);
    const glm::dvec2 truths(slopeOfHalf(alpha.x), slopeOfHalf(alpha.y));
    return {{"the highlight's half width along the scratches, slopes", widths.x, truths.x, 0.003 * truths.x},
            {"across", widths.y, truths.y, 0.002 * truths.y},
            {"across over along", widths.y / widths.x, truths.y / truths.x, 0.003 * truths.y / truths.x}};
}

}  // namespace helio::lectures
