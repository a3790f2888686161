// Row X10: mappings of the sphere of directions, their solid angles, lookups and conversions.
#include <heliograph/environment.hpp>
#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

namespace helio::test {
namespace {

constexpr double kPi = std::numbers::pi;
using Mapping = EnvironmentMapping;
constexpr Mapping kAll[] = {Mapping::LatLong, Mapping::Cube, Mapping::Sphere};
constexpr const char* kNames[] = {"latlong", "cube", "sphere"};

glm::uvec2 shape(Mapping mapping, std::uint32_t size) {
    return mapping == Mapping::LatLong ? glm::uvec2(2 * size, size)
           : mapping == Mapping::Cube  ? glm::uvec2(size, 6 * size)
                                       : glm::uvec2(size);
}

glm::dvec3 randomDirection(std::mt19937& random) {
    const auto uniform = [&] { return (random() + 0.5) / 4294967296.0; };
    const double z = 2 * uniform() - 1, turn = 2 * kPi * uniform(), r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
}

/** An image whose texels hold a function at their middles. */
TextureImage imageOf(Mapping mapping, std::uint32_t size, const std::function<double(const glm::dvec3&)>& f) {
    const glm::uvec2 s = shape(mapping, size);
    TextureImage image{"", s.x, s.y, std::vector<float>()};
    auto& texels = std::get<std::vector<float>>(image.texels);
    for (std::uint32_t y = 0; y < s.y; ++y)
        for (std::uint32_t x = 0; x < s.x; ++x) {
            const auto d = environmentDirection(mapping, s.x, s.y, {x + 0.5, y + 0.5});
            const auto v = float(d ? f(*d) : f({0, 0, -1}));
            texels.insert(texels.end(), {v, 2 * v, 3 * v, 1.0f});
        }
    return image;
}

TEST(EnvironmentMap, AxesLieWhereTheConventionsSay) {
    const auto at = [](Mapping mapping, glm::dvec3 d) {
        const glm::uvec2 s = shape(mapping, 64);
        return environmentPosition(mapping, s.x, s.y, d);
    };
    const auto near = [](glm::dvec2 a, glm::dvec2 b) {
        return glm::length(a - b) < 1e-9 ? testing::AssertionSuccess()
                                         : testing::AssertionFailure() << a.x << ", " << a.y;
    };
    EXPECT_TRUE(near(at(Mapping::LatLong, {0, 0, 1}), {64, 32}));
    EXPECT_TRUE(near(at(Mapping::LatLong, {1, 0, 0}), {32, 32}));
    EXPECT_TRUE(near(at(Mapping::LatLong, {-1, 0, 0}), {96, 32}));
    EXPECT_DOUBLE_EQ(at(Mapping::LatLong, {0, 1, 0}).y, 0);
    for (int face = 0; face < 6; ++face) {
        glm::dvec3 d(0.0);
        d[face / 2] = face % 2 == 0 ? 1 : -1;
        EXPECT_TRUE(near(at(Mapping::Cube, d), {32, 64 * face + 32}));
    }
    EXPECT_TRUE(near(at(Mapping::Cube, {1, 0, 0.5}), {48, 32}));           // +z to the right of +X
    EXPECT_TRUE(near(at(Mapping::Cube, {-0.5, 0.5, 1}), {48, 256 + 16}));  // -x to the right of +Z, +y up
    EXPECT_TRUE(near(at(Mapping::Cube, {0.5, 1, 0.5}), {48, 128 + 16}));   // +z up on +Y
    EXPECT_TRUE(near(at(Mapping::Sphere, {0, 0, 1}), {32, 32}));
    EXPECT_TRUE(near(at(Mapping::Sphere, {1, 0, 0}), {32 + 32 * std::sqrt(0.5), 32}));
    EXPECT_TRUE(near(at(Mapping::Sphere, {0, 1, 0}), {32, 32 - 32 * std::sqrt(0.5)}));
}

TEST(EnvironmentMap, DirectionsComeBack) {
    std::mt19937 random(1);
    for (const Mapping mapping : kAll) {
        const glm::uvec2 s = shape(mapping, 100);
        double worst = 0;
        for (int i = 0; i < 100000; ++i) {
            glm::dvec3 d = randomDirection(random);
            if (i % 3 == 0) d = glm::normalize(d * glm::dvec3(1e-7, 1e-7, 1));  // near the poles of the ball
            if (i % 3 == 1) d = glm::normalize(d * glm::dvec3(1e-7, 1, 1e-7));
            const glm::dvec2 p = environmentPosition(mapping, s.x, s.y, d * 1e3);
            const auto back = environmentDirection(mapping, s.x, s.y, p);
            // The rim of the disc is one direction.
            worst = std::max(worst, back ? glm::length(*back - d) : glm::length(d - glm::dvec3(0, 0, -1)));
        }
        fmt::print("{}: worst {:.1e}\n", kNames[int(mapping)], worst);
        // The ball's rim has few digits: the distance from it goes with the square of the angle.
        EXPECT_LT(worst, mapping == Mapping::Sphere ? 1e-7 : 1e-13) << kNames[int(mapping)];
    }
}

TEST(EnvironmentMap, SolidAnglesSumToFourPi) {
    for (const Mapping mapping : kAll)
        for (const std::uint32_t size : {1u, 2u, 7u, 64u, 1000u}) {
            const glm::uvec2 s = shape(mapping, size);
            double sum = 0;
            for (std::uint32_t y = 0; y < s.y; ++y)
                for (std::uint32_t x = 0; x < s.x; ++x) {
                    const double angle = texelSolidAngle(mapping, s.x, s.y, x, y);
                    ASSERT_GE(angle, -1e-13);
                    sum += angle;
                }
            EXPECT_NEAR(sum / (4 * kPi), 1, 1e-10) << kNames[int(mapping)] << " " << size;
        }
}

TEST(EnvironmentMap, SolidAngleIsTheShareOfDirectionsThatMeetTheTexel) {
    std::mt19937 random(2);
    constexpr int count = 400000;
    for (const Mapping mapping : kAll) {
        const glm::uvec2 s = shape(mapping, 3);
        std::vector<int> met(std::size_t(s.x) * s.y);
        for (int i = 0; i < count; ++i) {
            const glm::dvec2 p = environmentPosition(mapping, s.x, s.y, randomDirection(random));
            ++met[std::min<std::size_t>(std::size_t(p.y), s.y - 1) * s.x +
                  std::min<std::size_t>(std::size_t(p.x), s.x - 1)];
        }
        for (std::size_t i = 0; i < met.size(); ++i) {
            const double p =
                texelSolidAngle(mapping, s.x, s.y, std::uint32_t(i % s.x), std::uint32_t(i / s.x)) /
                (4 * kPi);
            EXPECT_LT(std::abs(met[i] - p * count), 5 * std::sqrt(p * count) + 1)
                << kNames[int(mapping)] << " " << i;
        }
    }
}

TEST(EnvironmentMap, LookupsAreContinuousAcrossEdges) {
    // Random texels: a step between neighbours is up to 1, over a thousandth of a texel up to 0.002.
    std::mt19937 random(3);
    for (const Mapping mapping : {Mapping::LatLong, Mapping::Cube}) {
        const EnvironmentImage image(
            imageOf(mapping, 8, [&](const glm::dvec3&) { return random() / 4294967296.0; }), mapping);
        double worst = 0;
        for (int i = 0; i < 200000; ++i) {
            glm::dvec3 d = randomDirection(random);
            if (i % 2 == 0)
                d[i / 2 % 3] = d[(i / 2 + 1) % 3] * (i % 4 == 0 ? 1 : -1);  // on an edge of the cube
            // The pole of a lat-long image is not one value.
            if (mapping == Mapping::LatLong && std::abs(d.y) > 0.9 * glm::length(d)) continue;
            const glm::dvec3 step = randomDirection(random) * 1e-5 * glm::length(d);
            worst = std::max(worst, double(std::abs(image.along(d).x - image.along(d + step).x)));
        }
        fmt::print("{}: largest step over 1e-5 rad {:.1e}\n", kNames[int(mapping)], worst);
        EXPECT_LT(worst, 5e-4) << kNames[int(mapping)];
    }
}

TEST(EnvironmentMap, RoundTripsKeepASmoothSky) {
    // Second-order harmonics: bilinear lookups err by about the square of a texel.
    const auto sky = [](const glm::dvec3& d) {
        return 1 + 0.5 * d.x - 0.3 * d.y + 0.4 * d.x * d.z + 0.2 * d.z * d.z;
    };
    for (const Mapping from : kAll)
        for (const Mapping to : kAll) {
            double errors[2];
            for (int k = 0; k < 2; ++k) {
                const std::uint32_t size = 32u << k;
                const TextureImage there = EnvironmentImage(imageOf(from, size, sky), from).convert(to);
                const EnvironmentImage back(EnvironmentImage(there, to).convert(from, shape(from, size).x),
                                            from);
                std::mt19937 random(4);
                double sum = 0;
                constexpr int count = 5000;
                for (int i = 0; i < count; ++i) {
                    const glm::dvec3 d = randomDirection(random);
                    sum += std::pow(back.along(d).x - sky(d), 2) + std::pow(back.along(d).z / 3 - sky(d), 2);
                }
                errors[k] = std::sqrt(sum / (2 * count));
                // Mean radiance: 1 + 0.2/3.
                EXPECT_NEAR(back.mean().x, 1 + 0.2 / 3, 5e-3);
            }
            fmt::print("{} - {} - {}: RMS error {:.1e}, {:.1e} with twice the texels\n", kNames[int(from)],
                       kNames[int(to)], kNames[int(from)], errors[0], errors[1]);
            // A ball's texels at the rim are coarse: about the square root of a texel behind it.
            const bool ball = from == Mapping::Sphere || to == Mapping::Sphere;
            EXPECT_LT(errors[1], ball ? 0.05 : 1e-3);
            EXPECT_LT(errors[1], (ball ? 0.95 : 0.35) * errors[0]);
        }
}

TEST(EnvironmentMap, QuadratureOfSolidAngles) {
    // The integral of (a.d)^2 is 4 pi / 3 whatever the unit vector a; at 1024 x 512 and its like.
    for (const Mapping mapping : kAll) {
        const std::uint32_t size = mapping == Mapping::Cube ? 256 : 512;
        const glm::uvec2 s = shape(mapping, size);
        const glm::dvec3 a = glm::normalize(glm::dvec3(1, 2, -3));
        double sum = 0;
        for (std::uint32_t y = 0; y < s.y; y += 1)
            for (std::uint32_t x = 0; x < s.x; ++x)
                if (const auto d = environmentDirection(mapping, s.x, s.y, {x + 0.5, y + 0.5}))
                    sum += texelSolidAngle(mapping, s.x, s.y, x, y) * std::pow(glm::dot(a, *d), 2);
        EXPECT_NEAR(sum / (4 * kPi / 3), 1, mapping == Mapping::Sphere ? 3e-3 : 1e-4) << kNames[int(mapping)];
    }
}

TEST(EnvironmentMap, WrongShapesAreRefused) {
    const TextureImage image{"sky", 8, 4, std::vector<float>(8 * 4 * 4)};
    EXPECT_NO_THROW(EnvironmentImage(image, Mapping::LatLong));
    EXPECT_THROW(EnvironmentImage(image, Mapping::Cube), InputError);
    EXPECT_THROW(EnvironmentImage(image, Mapping::Sphere), InputError);
    EXPECT_EQ(likelyEnvironmentMapping(8, 4), Mapping::LatLong);
    EXPECT_EQ(likelyEnvironmentMapping(8, 48), Mapping::Cube);
    EXPECT_EQ(likelyEnvironmentMapping(8, 8), Mapping::Sphere);
    EXPECT_FALSE(environmentMapping("cubic"));
}

TEST(EnvironmentMap, ARealPairOfCubeAndLatLong) {
    const std::filesystem::path folder = std::filesystem::path(HELIOGRAPH_SHARED_DIR) / "assets/openexr";
    if (!std::filesystem::exists(folder / "KernerEnvCube.exr"))
        GTEST_SKIP() << "no " << folder << ": the pair of photographs is left out";
    const TextureImage cubeImage = loadTextureImage(folder / "KernerEnvCube.exr"),
                       latLongImage = loadTextureImage(folder / "KernerEnvLatLong.exr");
    const EnvironmentImage cube(cubeImage, Mapping::Cube), latLong(latLongImage, Mapping::LatLong);
    const glm::dvec3 a = cube.mean(), b = latLong.mean();
    fmt::print("{}x{} and {}x{}: mean radiance {:.5f} {:.5f}\n", cubeImage.width, cubeImage.height,
               latLongImage.width, latLongImage.height, a.x, b.x);
    EXPECT_NEAR(a.x / b.x, 1, 0.01);
    // Correlation over directions: 1 but for resampling. A face that is turned or swapped gives far less.
    std::mt19937 random(5);
    constexpr int count = 50000;
    double sums[5] = {};
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 d = randomDirection(random);
        const double p = std::log(1e-3 + cube.along(d).y), q = std::log(1e-3 + latLong.along(d).y);
        const double add[5] = {p, q, p * p, q * q, p * q};
        for (int k = 0; k < 5; ++k) sums[k] += add[k] / count;
    }
    const double correlation = (sums[4] - sums[0] * sums[1]) /
                               std::sqrt((sums[2] - sums[0] * sums[0]) * (sums[3] - sums[1] * sums[1]));
    fmt::print("correlation of logarithms {:.5f}\n", correlation);
    EXPECT_GT(correlation, 0.99);
}

}  // namespace
}  // namespace helio::test
