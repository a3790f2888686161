// Perlin's noise on the device: published values, its smoothness, its sums' filtering, and solid textures of
// it.
#include "tests/accuracy/shade_runner.hpp"
#include "tests/support/shader_harness.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>

namespace helio::test {
namespace {

const Preamble kNoise = {"#extension GL_EXT_control_flow_attributes : require", "shaders/texture/noise.glsl"};

/** Perlin's published program, in double. */
class Reference {
public:
    Reference() {
        constexpr std::array<int, 256> permutation = {
            151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
            30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
            197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
            20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
            83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
            54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
            135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
            123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
            182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
            155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
            112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
            51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
            115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
            141, 128, 195, 78,  66,  215, 61,  156, 180};
        for (std::size_t i = 0; i < 512; ++i) p_[i] = permutation[i % 256];
    }
    double operator()(glm::dvec3 q) const {
        const auto x = std::size_t(int(std::floor(q.x)) & 255), y = std::size_t(int(std::floor(q.y)) & 255),
                   z = std::size_t(int(std::floor(q.z)) & 255);
        q -= glm::floor(q);
        const glm::dvec3 f = q * q * q * (q * (q * 6.0 - 15.0) + 10.0);
        const std::size_t a = at(x) + y, aa = at(a) + z, ab = at(a + 1) + z, b = at(x + 1) + y,
                          ba = at(b) + z, bb = at(b + 1) + z;
        const auto g = [&](std::size_t i, double dx, double dy, double dz) {
            return gradient(int(at(i)), q - glm::dvec3(dx, dy, dz));
        };
        const double low = glm::mix(glm::mix(g(aa, 0, 0, 0), g(ba, 1, 0, 0), f.x),
                                    glm::mix(g(ab, 0, 1, 0), g(bb, 1, 1, 0), f.x), f.y);
        const double high = glm::mix(glm::mix(g(aa + 1, 0, 0, 1), g(ba + 1, 1, 0, 1), f.x),
                                     glm::mix(g(ab + 1, 0, 1, 1), g(bb + 1, 1, 1, 1), f.x), f.y);
        return glm::mix(low, high, f.z);
    }

private:
    std::size_t at(std::size_t i) const { return std::size_t(p_[i]); }
    static double gradient(int hash, const glm::dvec3& d) {
        const int h = hash & 15;
        const double u = h < 8 ? d.x : d.y, v = h < 4 ? d.y : (h == 12 || h == 14 ? d.x : d.z);
        return ((h & 1) == 0 ? u : -u) + ((h & 2) == 0 ? v : -v);
    }
    std::array<int, 512> p_{};
};

std::vector<glm::vec3> points(std::size_t count, double range, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-range, range);
    std::vector<glm::vec3> list;
    for (std::size_t i = 0; i < count; ++i)
        list.emplace_back(uniform(random), uniform(random), uniform(random));
    return list;
}

TEST(Noise, HasThePublishedValues) {
    const Reference reference;
    EXPECT_EQ(reference({3.14, 42, 7}), 0.13691995878400012);
    EXPECT_NEAR(reference({-4.2, 10, 6}), 0.14208, 1e-14);
    const std::vector<float> got = runOnDevice<float>(
        kNoise, "perlinNoise(a)",
        std::vector<glm::vec3>{{3.14f, 42, 7}, {-4.2f, 10, 6}, {0.5f, 0.5f, 0.5f}, {3, -7, 250}, {0, 0, 0}});
    EXPECT_NEAR(got[0], 0.13691995878400012, 1e-6);
    EXPECT_NEAR(got[1], 0.14208, 1e-6);
    EXPECT_EQ(got[2], -0.25f);
    EXPECT_EQ(got[3], 0.0f);
    EXPECT_EQ(got[4], 0.0f);
}

TEST(Noise, IsTheReferenceEverywhere) {
    const Reference reference;
    for (double range : {2.0, 300.0, 20000.0}) {
        const std::vector<glm::vec3> at = points(60000, range, 3);
        const std::vector<float> got = runOnDevice<float>(kNoise, "perlinNoise(a)", at);
        double worst = 0;
        for (std::size_t i = 0; i < at.size(); ++i)
            worst = std::max(worst, std::abs(double(got[i]) - reference(at[i])));
        EXPECT_LT(worst, 1e-6) << range;
    }
    // Where floats have no fraction left it is 0, and infinity and NaN end no loop.
    for (float value : runOnDevice<float>(kNoise, "perlinNoise(a)",
                                          std::vector<glm::vec3>{{1e8f, 3, 5}, {-3e7f, 1e9f, 2e10f}}))
        EXPECT_EQ(value, 0.0f);
}

TEST(Noise, HasTwoContinuousDerivatives) {
    // Second differences on both sides of a lattice plane: their jump falls with the step, as it does where
    // the second derivative is continuous; that of Perlin's first noise (cubic weights) would stay.
    const auto jump = [](double h) {
        std::vector<glm::vec3> at = points(3000, 20, 9);
        std::vector<float> sum(at.size(), 0);
        const auto add = [&](double offset, double weight) {
            std::vector<glm::vec3> moved = at;
            for (glm::vec3& p : moved) p.x = std::round(p.x) + float(offset * h);
            const std::vector<float> value = runOnDevice<float>(kNoise, "perlinNoise(a)", moved);
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += float(weight / (h * h)) * value[i];
        };
        for (const auto& [offset, weight] :
             {std::pair{2.0, 1.0}, {1.0, -2.0}, {0.0, 1.0}, {0.0, -1.0}, {-1.0, 2.0}, {-2.0, -1.0}})
            add(offset, weight);
        double total = 0;
        for (float s : sum) total += std::abs(double(s));
        return total / double(sum.size());
    };
    const double ratio = jump(1.0 / 16) / jump(1.0 / 32);
    std::printf("             jump of the second difference falls by %.2f where the step halves\n", ratio);
    EXPECT_GT(ratio, 1.5);
    EXPECT_LT(ratio, 2.5);
}

TEST(Noise, SumsAreFilteredOverASamplesWidth) {
    // Means over squares of that width, against one filtered and one plain sample in their middle.
    constexpr int cells = 16, count = 300;
    const std::vector<glm::vec3> at = points(count, 30, 5);
    const std::array<float, 3> widths = {0.1f, 0.4f, 1.5f};
    std::vector<glm::vec3> places;
    std::vector<float> sizes;
    for (float width : widths)
        for (const glm::vec3& p : at) {
            for (int i = 0; i < cells * cells; ++i) {
                const glm::vec3 cell((float(i % cells) + 0.5f) / cells - 0.5f,
                                     (float(i / cells) + 0.5f) / cells - 0.5f, 0);
                places.push_back(p + width * cell);
                sizes.push_back(0);
            }
            places.insert(places.end(), {p, p});
            sizes.insert(sizes.end(), {width, 0});
        }
    const std::vector<glm::vec2> got = runOnDevice<glm::vec2>(
        kNoise, "NoiseSums s = noiseSums(a, b, NOISE_OCTAVES); return vec2(s.fractal, s.turbulent);", places,
        sizes);
    auto next = got.begin();
    for (float width : widths) {
        glm::dvec2 filtered(0), plain(0);
        for (int i = 0; i < count; ++i) {
            const glm::dvec2 mean = std::accumulate(next, next + cells * cells, glm::dvec2(0),
                                                    [](const glm::dvec2& sum, const glm::vec2& v) {
                                                        return sum + glm::dvec2(v);
                                                    }) /
                                    double(cells * cells);
            next += cells * cells;
            const glm::dvec2 a = glm::dvec2(*next++) - mean, b = glm::dvec2(*next++) - mean;
            filtered += a * a;
            plain += b * b;
        }
        for (int k = 0; k < 2; ++k) {
            const double gain = std::sqrt(plain[k] / filtered[k]);
            std::printf("             %s over %.1f units: RMS error %.4f, unfiltered %.4f\n",
                        k == 0 ? "noise" : "turbulence", double(width), std::sqrt(filtered[k] / count),
                        std::sqrt(plain[k] / count));
            EXPECT_GT(gain, 1.15);
        }
    }
}

TEST(SolidTexture, ShowsThePatternAtThePlaceInTheMesh) {
    const Reference reference;
    Scene scene;
    Material material = lambert(glm::vec3(1));
    material.solid = SolidTexture{SolidTexture::Pattern::Noise, {0.9f, 0.5f, 0.1f}, {0.1f, 0.2f, 0.7f}, 3};
    // A tilted square, moved and turned as a whole: the pattern is the mesh's.
    const glm::dmat4 place(glm::dvec4(0, 1, 0, 0), glm::dvec4(-1, 0, 0, 0), glm::dvec4(0, 0, 1, 0),
                           glm::dvec4(4, -3, 0.25, 1));
    addPrimitive(scene, quad({-1, -1, 0.1f}, {1, -1, 0.4f}, {1, 1, 0.7f}, {-1, 1, 0.4f}), material, place);
    scene.environment = Environment{glm::vec3(1), -1};
    Camera camera;
    camera.perspective = false;
    camera.ymag = 0.5f;
    glm::dmat4 eye(1.0);
    eye[3] = {4, -3, 5, 1};
    constexpr std::uint32_t side = 40;
    const ShadedImage image = shade(scene, makeRasterView(eye, camera, {side, side}, 0.5, 10));
    double worst = 0;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const double wx = (x + 0.5) / side - 0.5, wy = 0.5 - (y + 0.5) / side;
            // World (-y', x') of the mesh's (x', y').
            const glm::dvec3 mesh(wy, -wx, 0.4 + 0.15 * wy - 0.15 * wx);
            // A pixel is so many features wide, which the noise is filtered for.
            const double width = 3.0 / side * std::sqrt(1 + 0.15 * 0.15);
            const double share = 0.5 + 0.5 * std::exp(-0.56 * width * width) * reference(3.0 * mesh);
            for (int c = 0; c < 3; ++c) {
                const double wanted =
                    glm::mix(double(material.solid->first[c]), double(material.solid->second[c]), share);
                worst = std::max(worst, std::abs(double(image.color[image.at(x, y)][c]) - wanted));
            }
        }
    std::printf("             worst difference %.1e\n", worst);
    EXPECT_LT(worst, 2e-6);
}

}  // namespace
}  // namespace helio::test
