// Points on lamps by the solid angle that they fill: solid angles against the closed form in double, the
// points against the density by chi-squared, at every scale and in every degenerate place.
#include "tests/support/shader_harness.hpp"

#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace helio::test {
namespace {

const Preamble kLibrary = {"#define SOLID_ANGLES 3", "shaders/scene/solid_angle_light.glsl"};

/** Van Oosterom and Strackee 1983, in double. */
double solidAngle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double triple = std::abs(glm::dot(a, glm::cross(b - a, c - a)));
    return 2 *
           std::atan2(triple, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

/** A lamp as seen from p: of its parallelogram, or of the half of it that is a triangle. */
struct Lamp {
    glm::vec3 p, corner, edge1, edge2;
    bool isTriangle = false;
    glm::dvec3 at(double x, double y) const {
        return glm::dvec3(corner) - glm::dvec3(p) + glm::dvec3(edge1) * x + glm::dvec3(edge2) * y;
    }
    /** Of the part between the places `from` and `to`. */
    double part(glm::dvec2 from, glm::dvec2 to, int halves) const {
        const glm::dvec3 a = at(from.x, from.y), b = at(to.x, from.y), c = at(from.x, to.y),
                         d = at(to.x, to.y);
        return ((halves & 1) != 0 ? solidAngle(a, b, c) : 0) + ((halves & 2) != 0 ? solidAngle(b, d, c) : 0);
    }
    double whole() const { return part({0, 0}, {1, 1}, isTriangle ? 1 : 3); }
    std::string text() const {
        const auto vector = [](glm::vec3 v) {
            return fmt::format("vec3({:.9e}, {:.9e}, {:.9e})", v.x, v.y, v.z);
        };
        return vector(p) + ", " + vector(corner) + ", " + vector(edge1) + ", " + vector(edge2);
    }
};

class Lamps {
public:
    explicit Lamps(unsigned seed) : random_(seed) {}
    float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
    glm::vec3 vector() {
        glm::vec3 v(2);
        while (glm::dot(v, v) > 1 || glm::dot(v, v) < 1e-3f)
            v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        return v;
    }
    /** Of a size of 10^`decades` at most either way, near enough to be large. */
    Lamp draw(bool isTriangle, float decades) {
        const float scale = std::pow(10.0f, uniform(-decades, decades));
        Lamp lamp;
        lamp.isTriangle = isTriangle;
        const glm::vec3 x = glm::normalize(vector());
        const glm::vec3 y = glm::normalize(glm::cross(x, vector()));
        lamp.edge1 = scale * x;
        lamp.edge2 = scale * (isTriangle ? vector() : std::exp(uniform(-2.0f, 0.0f)) * y);
        lamp.p = scale * 3.0f * vector();
        // Beside, below and over the lamp, from near its plane to two sizes off.
        lamp.corner = lamp.p + lamp.edge1 * uniform(-1.2f, 0.2f) + lamp.edge2 * uniform(-1.2f, 0.2f) +
                      scale * std::pow(10.0f, uniform(-2.0f, 0.3f)) *
                          glm::normalize(glm::cross(lamp.edge1, lamp.edge2));
        return lamp;
    }

private:
    std::mt19937 random_;
};

TEST(SolidAngle, IsTheClosedFormAtEveryScale) {
    for (const bool isTriangle : {false, true}) {
        Lamps lamps(isTriangle ? 2 : 1);
        std::vector<glm::vec3> p, corner, edge1, edge2;
        std::vector<double> truth;
        for (int i = 0; i < 100000; ++i) {
            const Lamp lamp = lamps.draw(isTriangle, 6);
            p.push_back(lamp.p);
            corner.push_back(lamp.corner);
            edge1.push_back(lamp.edge1);
            edge2.push_back(lamp.edge2);
            truth.push_back(lamp.whole());
        }
        const std::vector<float> found = runOnDevice<float>(
            kLibrary, fmt::format("seen{}(a, b, c, d).solidAngle", isTriangle ? "Triangle" : "Rectangle"), p,
            corner, edge1, edge2);
        double worst = 0;
        for (std::size_t i = 0; i < truth.size(); ++i)
            if (truth[i] > 0.05) worst = std::max(worst, std::abs(found[i] - truth[i]) / truth[i]);
        fmt::print("{}: worst relative error {:.2e}\n", isTriangle ? "triangles" : "rectangles", worst);
        EXPECT_LT(worst, 1e-4);
    }
}

TEST(SolidAngle, PointsAreUniformOverIt) {
    constexpr std::size_t count = 20000;
    constexpr int cells = 8, lampsOfEach = 8;
    std::mt19937 random(7);
    std::vector<glm::vec2> u;
    for (std::size_t i = 0; i < count; ++i)
        u.emplace_back(std::uniform_real_distribution<float>(0, 1)(random),
                       std::uniform_real_distribution<float>(0, 1)(random));
    double least = 1;
    for (const bool isTriangle : {false, true}) {
        Lamps lamps(isTriangle ? 12 : 11);
        for (int k = 0; k < lampsOfEach; ++k) {
            Lamp lamp = lamps.draw(isTriangle, 3);
            while (lamp.whole() < 0.06) lamp = lamps.draw(isTriangle, 3);
            const std::string call = fmt::format(
                "vec2 place; const float s = sampleSolidAngle({0}, place); return vec3(place, s);",
                fmt::format("{0}, {2}, {1}, a", lamp.text().substr(0, lamp.text().find("), ") + 1),
                            lamp.text().substr(lamp.text().find("), ") + 3), isTriangle ? "true" : "false"));
            const std::vector<glm::vec3> places = runOnDevice<glm::vec3>(kLibrary, call, u);
            std::vector<double> observed(2 * cells * cells), expected(2 * cells * cells);
            for (const glm::vec3& place : places) {
                ASSERT_NEAR(place.z / lamp.whole(), 1, 1e-4);
                const double x = std::min(double(place.x), 1 - 1e-9) * cells;
                const double y = std::min(double(place.y), 1 - 1e-9) * cells;
                const bool upper = x - std::floor(x) + y - std::floor(y) > 1;
                ++observed[std::size_t(2 * (int(y) * cells + int(x)) + upper)];
            }
            for (int y = 0; y < cells; ++y)
                for (int x = 0; x < cells; ++x)
                    for (int half = 0; half < 2; ++half) {
                        if (isTriangle && x + y + half >= cells) continue;
                        expected[std::size_t(2 * (y * cells + x) + half)] =
                            double(count) / lamp.whole() *
                            lamp.part(glm::dvec2(x, y) / double(cells),
                                      glm::dvec2(x + 1, y + 1) / double(cells), 1 << half);
                    }
            // A point on the line between two halves may be counted with either.
            for (std::size_t i = 0; i < observed.size(); ++i)
                if (expected[i] == 0 && observed[i] > 0 && observed[i] < 3) {
                    observed[i - 1] += observed[i];
                    observed[i] = 0;
                }
            const verify::ChiSquaredResult result = verify::chiSquaredTest(observed, expected);
            least = std::min(least, result.pValue);
            EXPECT_GT(result.pValue, verify::sidakLevel(0.01, 2 * lampsOfEach))
                << (isTriangle ? "triangle " : "rectangle ") << k << ", chi-squared " << result.statistic
                << " at " << result.degrees;
        }
    }
    fmt::print("least p of {}: {:.3f}\n", 2 * lampsOfEach, least);
}

TEST(SolidAngle, NoPlaceGivesWhatIsNoNumber) {
    std::mt19937 random(3);
    const std::vector<float> offsets = {0, 0, 0, 1e-30f, 1e-12f, 1e-6f, -1e-6f, 0.5f, 1, -1, 1e6f, 1e12f};
    const auto pick = [&] { return offsets[random() % offsets.size()]; };
    std::vector<glm::vec3> p, corner, edge1, edge2;
    for (int i = 0; i < 50000; ++i) {
        const float scale = std::pow(10.0f, float(int(random() % 21)) - 10.0f);
        edge1.push_back(scale * glm::vec3(1, random() % 4 == 0 ? 1e-6f : 0.0f, 0));
        edge2.push_back(scale * (random() % 3 == 0 ? glm::vec3(0.5f, 1e-4f, 0) : glm::vec3(0, 1, 0)));
        corner.push_back(glm::vec3(0));
        p.push_back(scale * glm::vec3(pick(), pick(), pick()));
    }
    for (const char* isTriangle : {"false", "true"}) {
        const std::string call = fmt::format(
            "vec2 place = vec2(0.5); const vec2 u = fract(abs(a.xy) * 7.31 + abs(c.yx) * 1e3);"
            "const float s = sampleSolidAngle(a, {}, b, c, d, u, place); return vec3(place, s);",
            isTriangle);
        for (const glm::vec3& place : runOnDevice<glm::vec3>(kLibrary, call, p, corner, edge1, edge2)) {
            ASSERT_TRUE(place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1);
            ASSERT_TRUE(place.z >= 0 && place.z < 6.3f);
        }
    }
}

}  // namespace
}  // namespace helio::test
