#include "passes/scene/facet_losses.hpp"

#include "engine/core/shared.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace helio::pack {
namespace {

using shared64::Microfacets;

constexpr double kGoldenRatio = 0.618033988749894848L;

Microfacets facetsOf(const Scattering& s) {
    const auto width = [](float alpha) {
        return std::clamp(double(alpha), double(shared64::SMOOTH_ALPHA), double(1));
    };
    const bool isSmooth = std::max(s.alpha.x, s.alpha.y) < float(shared64::SMOOTH_ALPHA);
    return {isSmooth ? glm::dvec2(s.alpha) : glm::dvec2(width(s.alpha.x), width(s.alpha.y)), s.beckmann};
}

/** G2 / G1: of light at a visible normal, what leaves along wi without meeting another facet. */
double escaping(const Microfacets& m, const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec3& h) {
    const double visible = shared64::facetVisibleNormals(m, wo, h);
    if (!(visible > 0)) return 0;
    return 4 * shared64::facetShadowing(m, wo, wi) * glm::dot(wo, h) * shared64::facetNormals(m, h) / visible;
}

/** Integral over [0, 1] of 2 c f(c) by the trapezoids' linear cells in x = sqrt(c), 2 c dc = 4 x^3 dx, by
 * Simpson's rule, which is nearly exact for these quartics: what is put back is then what the table says is
 * lost. */
double meanOfNodes(const std::array<double, kLossNodes>& values) {
    double mean = 0;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        const double a = double(i) / (kLossNodes - 1), b = double(i + 1) / (kLossNodes - 1), m = (a + b) / 2;
        mean += (b - a) / 6 * 4 *
                (a * a * a * values[i] + 4 * m * m * m * (values[i] + values[i + 1]) / 2 +
                 b * b * b * values[i + 1]);
    }
    return mean;
}

/** Cosine-weighted mean of a reflectance. */
double meanReflectance(const std::function<double(double)>& reflectance) {
    constexpr int n = 512;
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += reflectance(std::sqrt((i + 0.5L) / n));
    return sum / n;
}

}  // namespace

double facetAlbedo(const Scattering& s, bool inside, double cosine) {
    const Microfacets m = facetsOf(s);
    const bool isDielectric = s.model == Scattering::Model::Dielectric;
    const double eta = inside ? 1 / double(s.n.x) : double(s.n.x);
    if (isDielectric ? shared64::smoothInterface(m, eta) : shared64::smoothFacets(m)) return 1;
    const double c = std::max(cosine, double(1e-5L)), sine = std::sqrt((1 - c) * (1 + c));
    // Facets wider one way: the mean over the viewer's azimuth.
    const int azimuths = m.alpha.x == m.alpha.y ? 1 : 8;
    // A lattice: total reflection and the horizon cut the square anywhere.
    constexpr int points = 8192;
    double sum = 0;
    for (int azimuth = 0; azimuth < azimuths; ++azimuth) {
        const double phi = (azimuth + 0.5L) / azimuths * std::numbers::pi / 2;
        const glm::dvec3 wo = azimuths == 1 ? glm::dvec3(sine, 0, c)
                                            : glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), c);
        for (int i = 0; i < points; ++i) {
            const double turn = i * double(kGoldenRatio);
            const glm::dvec3 h =
                shared64::facetSampleNormal(m, wo, glm::dvec2(turn - std::floor(turn), (i + 0.5L) / points));
            const double woH = std::clamp(glm::dot(wo, h), double(0), double(1));
            double beyond = 0, r = 1;
            if (isDielectric) r = shared64::dielectricReflectance(woH, eta, s.schlick, beyond);
            const glm::dvec3 up = shared64::reflectedAbout(wo, h);
            if (up.z > 0) sum += r * escaping(m, wo, up, h);
            if (!(r < 1)) continue;
            const glm::dvec3 down = glm::normalize(shared64::refractedAbout(wo, h, eta, beyond));
            if (down.z < 0) sum += (1 - r) * escaping(m, wo, down, h);
        }
    }
    return std::min(sum / (double(points) * azimuths), double(1));
}

std::array<glm::vec4, kLossTexels> facetLosses(const Scattering& s) {
    const bool isDielectric = s.model == Scattering::Model::Dielectric;
    std::array<double, kLossNodes> outside{}, inside{};
    tbb::parallel_for(std::size_t(0), std::size_t(kLossNodes), [&](std::size_t i) {
        const double root = double(i) / (kLossNodes - 1);
        outside[i] = facetAlbedo(s, false, root * root);
        inside[i] = isDielectric ? facetAlbedo(s, true, root * root) : outside[i];
    });
    // Not 0 where the surface is smooth and nothing is lost.
    const double lostOutside = std::max(1 - meanOfNodes(outside), double(1e-9L));
    const double lostInside = std::max(1 - meanOfNodes(inside), double(1e-9L));
    std::array<glm::vec4, kLossTexels> texels{};
    if (isDielectric) {
        const double n = double(s.n.x);
        const auto mean = [&](double eta) {
            return meanReflectance([&](double c) -> double {
                double beyond = 0;
                return shared64::dielectricReflectance(c, eta, s.schlick, beyond);
            });
        };
        const double scale = 1 / std::max(lostOutside, lostInside);
        // Reciprocal: throughOut lostOutside = n^2 throughIn lostInside. That holds for Fresnel's means by
        // themselves.
        const double through = 1 - mean(n);
        const double throughOut = through * lostInside * scale,
                     throughIn = through / (n * n) * lostOutside * scale;
        texels[0] = {(1 - throughOut) / lostOutside, throughOut / lostInside, (1 - throughIn) / lostInside,
                     throughIn / lostOutside};
        texels[1] = {1 - throughOut, 1 - throughIn, 0, 0};
    } else {
        for (int channel = 0; channel < 3; ++channel) {
            const double f = meanReflectance([&](double c) -> double {
                return shared64::fresnelConductor(c, double(s.n[channel]), double(s.k[channel]));
            });
            const double kept = 1 - lostOutside;
            texels[0][channel] = float(f * f * kept / (1 - f * (1 - kept)) / lostOutside);
        }
    }
    for (std::size_t i = 0; i + 1 < outside.size(); ++i)
        texels[i + 2] = {outside[i], outside[i + 1], inside[i], inside[i + 1]};
    return texels;
}

}  // namespace helio::pack
