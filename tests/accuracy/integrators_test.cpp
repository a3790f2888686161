// The integrators beside path tracing: what each follows of light's ways, by closed forms.
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/renderer.hpp"

#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace helio::test {
namespace {

struct Estimate {
    double value = 0, error = 0;
};
Estimate render(const Scene& scene, Integrator integrator, std::uint32_t samples) {
    RenderOptions o;
    o.size = {16, 16};
    o.samples = samples;
    o.integrator = integrator;
    o.sampler = SamplerKind::Independent;
    const RenderResult result = renderer().render(scene, o);
    EXPECT_TRUE(renderer().device().validationMessages().empty());
    EXPECT_EQ(result.nanCount, 0u);
    Estimate mean;
    const auto variance = std::size_t(result.image.channel("variance.R"));
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            mean.value += double(result.image.at(x, y, 0)) / 256;
            mean.error += double(result.image.at(x, y, variance));
        }
    mean.error = std::sqrt(mean.error) / 256;
    return mean;
}

void expectMean(const Estimate& mean, double truth, double tolerance, const std::string& what) {
    const double z = mean.error > 0 ? (mean.value - truth) / mean.error : 0.0;
    fmt::print("{}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}\n", what, mean.value, mean.error, truth, z);
    EXPECT_LT(std::abs(z), 4.0) << what;
    EXPECT_LT(mean.error, tolerance * truth) << what;
    if (mean.error == 0) {
        EXPECT_NEAR(mean.value, truth, 2e-6 * truth) << what;
    }
}

/** A white patch at the origin under a square light at height 1: 0.752274688454 / pi. */
Scene patch(const glm::vec3& eye) {
    SceneBuilder b;
    constexpr float half = 1e-3f;
    b.quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0},
           b.material(glm::vec3(1.0f)));
    b.camera(eye, {0, 0, 0}, 2e-5f, {0, 0, 1});
    b.quad({-0.5f, -0.5f, 1}, {-0.5f, 0.5f, 1}, {0.5f, 0.5f, 1}, {0.5f, -0.5f, 1},
           b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    return b.scene;
}

TEST(Integrators, HemisphereHasTheMeanOfLightSamplingAndItsPredictedVariance) {
    const Scene scene = patch({3, 0.5f, 0.4f});
    const double truth = 0.752274688454 / std::numbers::pi;
    const Estimate direct = render(scene, Integrator::Direct, 256),
                   naive = render(scene, Integrator::Hemisphere, 1024);
    expectMean(direct, truth, 0.005, "direct");
    expectMean(naive, truth, 0.01, "hemisphere");
    // x = 2 cos over the light's solid angle, else 0: E[x^2] = 1/(2 pi) times the integral of 4 cos^2 over
    // it.
    double squares = 0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const double x = (i + 0.5) / n - 0.5, y = (k + 0.5) / n - 0.5, d2 = x * x + y * y + 1;
            squares += 4 / d2 / (d2 * std::sqrt(d2)) / (n * n);
        }
    const double sigma = std::sqrt((squares / (2 * std::numbers::pi) - truth * truth) / (256.0 * 1024));
    fmt::print("standard error {:.6f}, predicted {:.6f}\n", naive.error, sigma);
    EXPECT_NEAR(naive.error / sigma, 1.0, 0.03);
    EXPECT_GT(naive.error * 2, 3 * direct.error);  // at four times the samples
}

/** A closed room that emits 1 and reflects half: each scattering adds its power of 1/2. */
TEST(Integrators, DirectAndWhittedEndAfterOneScattering) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.5f), glm::vec3(1.0f));
    b.room({-1, -1, -1}, {1, 1.5f, 2}, {wall, wall, wall, wall, wall, wall});
    b.camera({0.125f, 0.25f, 0.25f}, {0.375f, 0.125f, -1}, 0.9f);
    expectMean(render(b.scene, Integrator::Path, 64), 2.0, 0.01, "path");
    expectMean(render(b.scene, Integrator::Direct, 64), 1.5, 0.01, "direct");
    expectMean(render(b.scene, Integrator::Hemisphere, 64), 1.5, 0.01, "hemisphere");
    expectMean(render(b.scene, Integrator::Whitted, 256), 1.5, 0.03, "whitted");
}

/** A perfect mirror shows what the eye behind it would see. */
TEST(Integrators, WhittedFollowsMirrors) {
    const Scene scene = patch({3, 0.5f, 0.4f});
    // The mirror x = 4 shows the patch's image at x = 8.
    SceneBuilder b;
    Material mirror;
    mirror.metallic = 1.0f;
    mirror.roughness = 0.0f;
    mirror.baseColor = glm::vec4(1.0f);
    b.scene.materials.push_back(mirror);
    constexpr float half = 1e-3f;
    b.quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0},
           b.material(glm::vec3(1.0f)));
    b.quad({-0.5f, -0.5f, 1}, {-0.5f, 0.5f, 1}, {0.5f, 0.5f, 1}, {0.5f, -0.5f, 1},
           b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    b.quad({4, -3, -3}, {4, -3, 3}, {4, 3, 3}, {4, 3, -3}, 0);
    b.camera({3, 0.25f, 0.4f}, {8, 0, 0}, 1e-5f, {0, 0, 1});
    // Direct light ends at the mirror; Whitted's goes on. The mirror's own light on the patch is a second
    // scattering, which neither has.
    const double truth = 0.752274688454 / std::numbers::pi;
    expectMean(render(scene, Integrator::Whitted, 256), truth, 0.005, "seen directly");
    expectMean(render(b.scene, Integrator::Whitted, 256), truth, 0.005, "seen in the mirror");
    EXPECT_EQ(render(b.scene, Integrator::Direct, 64).value, 0.0);
}

/** Reflections of a ray in the plane between two half-planes from the origin, at angles 0 and `wedge`: what
 * remains to be turned until it leads away, in double precision. */
int reflections(glm::dvec2 p, glm::dvec2 d, double wedge) {
    const glm::dvec2 sides[] = {{1, 0}, {std::cos(wedge), std::sin(wedge)}};
    for (int count = 0;; ++count) {
        double nearest = 1e300;
        int met = -1;
        for (int i = 0; i < 2; ++i) {
            const glm::dvec2 normal(-sides[i].y, sides[i].x);
            const double t = -glm::dot(p, normal) / glm::dot(d, normal);
            if (t > 1e-9 && t < nearest && glm::dot(p + t * d, sides[i]) > 0) {
                nearest = t;
                met = i;
            }
        }
        if (met < 0) return count;
        const glm::dvec2 normal(-sides[met].y, sides[met].x);
        p += nearest * d;
        d -= 2 * glm::dot(d, normal) * normal;
    }
}

/** Two mirrors that halve light make a wedge of 60 degrees under a sky of 1: a ray that is turned n times
 * shows 2^-n, and nothing where paths are cut before that. */
TEST(Integrators, TwoMirrorsTurnARayAsOftenAsGeometrySays) {
    constexpr double wedge = std::numbers::pi / 3;
    SceneBuilder b;
    Material mirror;
    mirror.scattering = Scattering{.model = Scattering::Model::Mirror};
    mirror.baseColor = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    b.scene.materials.push_back(mirror);
    const int half = int(b.scene.materials.size()) - 1;
    const glm::vec3 far(1000 * float(std::cos(wedge)), 1000 * float(std::sin(wedge)), 0), z(0, 0, 1000);
    b.quad(-z, glm::vec3(1000, 0, 0) - z, glm::vec3(1000, 0, 0) + z, z, half);
    b.quad(-z, far - z, far + z, z, half);
    const glm::vec3 eye(3, 1.2f, 0);
    b.camera(eye, {0.6f, 0.3f, 0}, 0.9f, {0, 0, 1});
    b.scene.environment = Environment{glm::vec3(1.0f), -1};
    for (const Integrator integrator : {Integrator::Whitted, Integrator::Path}) {
        for (const std::int64_t depth : {-1, 2}) {
            RenderOptions o;
            o.size = {64, 4};
            o.samples = 4;
            o.integrator = integrator;
            o.maxDepth = depth;
            o.roulette = 1e9;  // no noise
            const RenderResult result = renderer().render(b.scene, o);
            const glm::dvec3 forward = glm::normalize(glm::dvec3(glm::vec3(0.6f, 0.3f, 0) - eye)),
                             right = glm::cross(forward, glm::dvec3(0, 0, 1));
            const double width = 16 * std::tan(0.45);
            int seen[4] = {};
            for (std::uint32_t x = 0; x < 64; ++x) {
                const auto countAt = [&](double place) {
                    const glm::dvec3 d = forward + (place / 32 - 1) * width * right;
                    return reflections(glm::dvec2(glm::dvec3(eye)), glm::dvec2(d), wedge);
                };
                const int count = countAt(x);
                if (count != countAt(x + 1) || count != countAt(x + 0.5)) continue;  // an edge
                ++seen[std::min(count, 3)];
                const double truth = depth >= 0 && count > depth ? 0.0 : std::pow(0.5, count);
                for (std::uint32_t y = 0; y < 4; ++y)
                    EXPECT_NEAR(double(result.image.at(x, y, 0)), truth, 1e-6) << x << ", " << count;
            }
            fmt::print("pixels turned 0 to 3 times: {} {} {} {}\n", seen[0], seen[1], seen[2], seen[3]);
            EXPECT_GT(seen[2], 0);
            EXPECT_GT(seen[3], 0);
        }
    }
}

/** A floor beside a long wall of height h sees 1 - F of the sky; an open one all; a closed room none. */
TEST(Integrators, AmbientOcclusion) {
    const auto floorBeside = [](float height) {
        SceneBuilder b;
        const int glow =
            b.material(glm::vec3(0.1f, 0.7f, 0.2f), glm::vec3(5.0f));  // colours and light do not count
        b.quad({-1e-3f, 0, 1e-3f}, {1e-3f, 0, 1e-3f}, {1e-3f, 0, -1e-3f}, {-1e-3f, 0, -1e-3f}, glow);
        if (height > 0) b.quad({1, 0, -5000}, {1, 0, 5000}, {1, height, 5000}, {1, height, -5000}, glow);
        b.pointLight({-1, 2, 0}, glm::vec3(9.0f));
        b.camera({-2, 1.5f, 0.3f}, {0, 0, 0}, 2e-5f);
        return b.scene;
    };
    expectMean(render(floorBeside(0), Integrator::AmbientOcclusion, 16), 1.0, 1e-9, "open floor");
    for (double height : {0.5, 2.0})
        expectMean(render(floorBeside(float(height)), Integrator::AmbientOcclusion, 512),
                   1.0 - verify::formFactorInfiniteWall(1.0, height), 0.005,
                   fmt::format("wall of {}", height));
    SceneBuilder room;
    const int wall = room.material(glm::vec3(0.5f), glm::vec3(1.0f));
    room.room({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall});
    room.camera({0, 0, 0}, {0, 0, -1}, 0.9f);
    EXPECT_EQ(render(room.scene, Integrator::AmbientOcclusion, 16).value, 0.0);
}

}  // namespace
}  // namespace helio::test
