/** @file
 * Light scattered several times between facets: with the table of passes/scene/facet_losses.hpp the albedo of
 * what absorbs nothing is 1, at every angle, from both sides of an interface.
 */
#include "tests/accuracy/scattering_lobes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace helio::test {
namespace {

/** Means over a lattice of numbers of the compensating part's weight, by its own density, and of the single
 * scattering: of both its branches, each by its chance. Returns the largest difference from 1. */
double checkAlbedo(const Lobe& model, double& mostMade) {
    constexpr std::size_t each = 25600;
    const std::vector<float> cosines = {1.0f, 0.83f, 0.5f, 0.21f, 0.052f, 2e-3f};
    std::vector<glm::mat4> p;
    std::vector<glm::vec3> wo;
    std::vector<glm::vec2> u;
    for (const LobeCase& c : model.cases)
        for (float cosine : cosines)
            for (std::size_t i = 0; i < each; ++i) {
                const double turn = double(i) * std::numbers::phi;
                p.push_back(c.p);
                wo.push_back(directionAt(cosine, 0.4f));
                u.emplace_back(turn - std::floor(turn), (double(i) + 0.5) / each);
            }
    const std::string body =
        "ModelSurface m = SURFACE(a); float sum = 0.0;"
        "vec3 h = facetSampleNormal(m.facets, b, c); float beyond; float woH = clamp(dot(b, h), 0.0, 1.0);"
        "float r = METAL ? 1.0 : dielectricReflectance(woH, m.eta, false, beyond);"
        "vec3 up = reflectedAbout(b, h), across;"
        "if (up.z > 0.0) { ScatterValue v = facetReflection(m.facets, b, up, across); sum += r * v.value.x / "
        "v.density; }"
        "if (r < 1.0) { vec3 down = normalize(refractedAbout(b, h, m.eta, beyond));"
        "if (down.z < 0.0) { ScatterValue v = facetTransmission(m.facets, b, down, m.eta, across);"
        "if (v.density > 0.0) sum += (1.0 - r) * v.value.x / v.density * m.eta * m.eta; } }"
        "vec3 wi = cosineHemisphere(c); float cosine = wi.z * INV_PI;"
        "if (METAL) return vec2(sum, compensatedConductor(noScattering(), m.losses, b, "
        "wi).value.x / cosine);"
        "float made = compensatedDielectric(noScattering(), m.losses, m.inside, m.eta, b, wi).value.x;"
        "made += compensatedDielectric(noScattering(), m.losses, m.inside, m.eta, b, vec3(wi.xy, "
        "-wi.z)).value.x * m.eta * m.eta;"
        "return vec2(sum, made / cosine);";
    Preamble lines = model.lines();
    lines.lines.push_back(fmt::format("#define METAL {}", !model.below));
    const auto parts = runOnDevice<glm::vec2>(lines, body, p, wo, u);
    double worst = 0;
    for (std::size_t run = 0; run < parts.size() / each; ++run) {
        double single = 0, made = 0;
        for (std::size_t i = run * each; i < (run + 1) * each; ++i) {
            single += double(parts[i].x) / double(each);
            made += double(parts[i].y) / double(each);
        }
        const std::string where = model.cases[run / cosines.size()].name + " cosine " +
                                  std::to_string(cosines[run % cosines.size()]);
        EXPECT_NEAR(single + made, 1.0, 1e-3) << where << ": " << single << " and " << made;
        worst = std::max(worst, std::abs(single + made - 1.0));
        mostMade = std::max(mostMade, made);
    }
    return worst;
}

TEST(Compensation, LosslessFacetsReflectAllLight) {
    struct Facets {
        float n, alpha;
        bool beckmann;
    };
    const std::vector<Facets> all = {{0, 0.1f, false}, {0, 0.4f, false},    {0, 1, false},
                                     {0, 0.7f, true},  {1.5f, 0.1f, false}, {1.5f, 0.4f, false},
                                     {1.5f, 1, false}, {3, 0.7f, true},     {1.1f, 0.6f, false}};
    double worst = 0, mostMade = 0;
    for (const Facets& f : all) {
        const double most = checkAlbedo(compensatedFacets("facets", f.n, f.alpha, f.beckmann), mostMade);
        worst = std::max(worst, most);
    }
    EXPECT_GT(mostMade, 0.3);
    std::printf("largest difference of an albedo from 1: %.2e\n", worst);
}
/** GGX facets of width 1 seen from above: 1 - ln 2 by themselves. */
TEST(Compensation, WidestFacetsLoseLnTwo) {
    Scattering s;
    s.model = Scattering::Model::Conductor;
    s.alpha = glm::vec2(1);
    EXPECT_NEAR(pack::facetAlbedo(s, false, 1.0), 1 - std::numbers::ln2, 1e-4);
    s.alpha = glm::vec2(0);
    EXPECT_EQ(pack::facetAlbedo(s, false, 0.3), 1.0);
}

}  // namespace
}  // namespace helio::test
