/** @file Row Z1 and the agreement with rays: what is nearest is seen, wherever the camera stands. */
#include "tests/accuracy/raster_runner.hpp"

#include <cstdio>
#include <limits>
#include <optional>

namespace helio::test {
namespace {

constexpr std::uint32_t kColumns = 320, kRows = 200;

RasterTriangle triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, std::uint32_t id) {
    RasterTriangle t;
    t.v0 = a;
    t.v1 = b;
    t.v2 = c;
    t.id = id;
    return t;
}

/** Distance along the viewing axis to a triangle's plane on the ray through pixel coordinates (x, y) of
 * pixelView, where the ray meets the triangle itself. In double, by Moeller and Trumbore's method. */
std::optional<double> rayDistance(const RasterTriangle& t, double x, double y) {
    const glm::dvec3 direction(x, -y, -1), v0(t.v0), e1 = glm::dvec3(t.v1) - v0, e2 = glm::dvec3(t.v2) - v0;
    const glm::dvec3 p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) return std::nullopt;
    const double b1 = glm::dot(-v0, p) / determinant;
    const glm::dvec3 q = glm::cross(-v0, e1);
    const double b2 = glm::dot(direction, q) / determinant, distance = glm::dot(e2, q) / determinant;
    if (b1 < 0 || b2 < 0 || b1 + b2 > 1 || !(distance > 0)) return std::nullopt;
    return distance;
}

/** Distance in pixels from (x, y) to the nearest projected edge of a triangle, cut just before the eye. */
double edgeDistance(const RasterTriangle& t, double x, double y) {
    const glm::dvec3 corners[3] = {glm::dvec3(t.v0), glm::dvec3(t.v1), glm::dvec3(t.v2)};
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 a = corners[k], b = corners[(k + 1) % 3];
        constexpr double eye = 1e-9;
        if (-a.z < eye && -b.z < eye) continue;
        if (-a.z < eye) a += (b - a) * ((-eye - a.z) / (b.z - a.z));
        if (-b.z < eye) b += (a - b) * ((-eye - b.z) / (a.z - b.z));
        const glm::dvec2 p(a.x / -a.z, -a.y / -a.z), q(b.x / -b.z, -b.y / -b.z), c(x, y);
        const double along = std::clamp(glm::dot(c - p, q - p) / glm::dot(q - p, q - p), 0.0, 1.0);
        nearest = std::min(nearest, glm::length(p + along * (q - p) - c));
    }
    return nearest;
}

/** Pixels whose id is not the ray's though the centre is more than 1/64 pixel from every edge of both
 * triangles. */
std::uint64_t disagreements(const std::vector<std::uint64_t>& keys, const std::vector<RasterTriangle>& list,
                            std::uint64_t& hits) {
    std::uint64_t wrong = 0;
    for (std::uint32_t y = 0; y < kRows; ++y)
        for (std::uint32_t x = 0; x < kColumns; ++x) {
            std::int64_t seen = -1;
            double nearest = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < list.size(); ++i)
                if (const auto d = rayDistance(list[i], x + 0.5, y + 0.5); d && *d < nearest) {
                    nearest = *d;
                    seen = std::int64_t(i);
                }
            hits += seen >= 0;
            const std::int64_t drawn = visibleTriangle(keys[y * kColumns + x]);
            if (drawn == seen) continue;
            double edge = std::numeric_limits<double>::infinity();
            for (std::int64_t i : {seen, drawn})
                if (i >= 0) edge = std::min(edge, edgeDistance(list[std::size_t(i)], x + 0.5, y + 0.5));
            wrong += edge > 1.0 / 64.0;
        }
    return wrong;
}

TEST(RasterAgreement, RaysSeeTheSameTriangles) {
    const RasterView view = pixelView(kColumns, kRows);
    RasterRunner runner(kColumns, kRows, 300);
    std::uint64_t wrong = 0, hits = 0;
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        Random random(100 + seed);
        std::vector<RasterTriangle> list;
        for (std::uint32_t i = 0; i < 300; ++i) {
            glm::vec3 v[3];
            const double size = std::pow(10.0, random.uniform(-2, 0.5)),
                         distance = std::pow(10.0, random.uniform(-1, 2));
            const glm::dvec2 centre(random.uniform(0, kColumns), random.uniform(0, kRows));
            for (auto& corner : v) {
                const double d =
                    distance * (1.0 + size * random.uniform(-1, 1));  // behind the eye where size > 1
                corner =
                    glm::vec3(glm::dvec3((centre.x + size * 100 * random.uniform(-1, 1)) * distance,
                                         -(centre.y + size * 100 * random.uniform(-1, 1)) * distance, -d));
            }
            list.push_back(triangle(v[0], v[1], v[2], i));
        }
        wrong += disagreements(runner.run(view, list).keys, list, hits);
    }
    std::printf("             %u pixels, %llu hit, %llu wrong\n", 4 * kColumns * kRows,
                (unsigned long long)hits, (unsigned long long)wrong);
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(hits, std::uint64_t(kColumns) * kRows);
}

TEST(RasterDepth, InterpenetratingTrianglesMeetOnTheExactLine) {
    const RasterView view = pixelView(kColumns, kRows);
    RasterRunner runner(kColumns, kRows, 2);
    Random random(20);
    std::uint64_t both = 0, wrong = 0, inBand = 0;
    for (int scene = 0; scene < 40; ++scene) {
        std::vector<RasterTriangle> list;
        for (std::uint32_t i = 0; i < 2; ++i) {
            const double tilt = std::pow(10.0, random.uniform(-3, 0.5));
            const auto corner = [&](double x, double y) {
                return atPixel(x, y, 5.0 * (1.0 + tilt * random.uniform(0, 1)));
            };
            list.push_back(
                triangle(corner(-50, -50), corner(2.5 * kColumns, -50), corner(-50, 2.5 * kRows), i));
        }
        // 1/distance is affine on the screen: fit both planes, in double.
        std::array<glm::dvec3, 2> plane;
        for (std::size_t i = 0; i < 2; ++i) {
            const glm::dvec3 v0(list[i].v0),
                n = glm::cross(glm::dvec3(list[i].v1) - v0, glm::dvec3(list[i].v2) - v0);
            plane[i] = glm::dvec3(n.x, -n.y, -n.z) / glm::dot(n, v0);
        }
        const glm::dvec3 difference = plane[0] - plane[1];
        const RasterResult result = runner.run(view, list);
        for (std::uint32_t y = 0; y < kRows; ++y)
            for (std::uint32_t x = 0; x < kColumns; ++x) {
                const double d = difference.x * (x + 0.5) + difference.y * (y + 0.5) + difference.z;
                ++both;
                // Far less than the 1/64 pixel that the agreement of the pipelines allows; and planes that
                // part by less than 1e-7 of the depth have the same float.
                const double depth = plane[0].x * (x + 0.5) + plane[0].y * (y + 0.5) + plane[0].z;
                if (std::abs(d) / std::hypot(difference.x, difference.y) < 1.0 / 1024.0 ||
                    std::abs(d) < 1.2e-7 * std::abs(depth)) {
                    ++inBand;
                    continue;
                }
                wrong += visibleTriangle(result.keys[y * kColumns + x]) != (d > 0 ? 0 : 1);
            }
    }
    std::printf("             %llu pixels, %llu in the band, %llu wrong\n", (unsigned long long)both,
                (unsigned long long)inBand, (unsigned long long)wrong);
    EXPECT_EQ(wrong, 0u);
    EXPECT_LT(inBand, both / 100);
}

TEST(RasterDepth, ReversedDepthTellsNeighboursApartAtEveryDistance) {
    const RasterView view = pixelView(kColumns, kRows);
    RasterRunner runner(kColumns, kRows, 2);
    // Float32 reversed with an infinite far plane resolves a step of about z 2^-24 anywhere; 2^-22 must be
    // told.
    for (double distance = 0.01; distance < 1e7; distance *= 10) {
        const double farther =
            double(std::nextafter(float(distance * (1 + 0x1p-22)), std::numeric_limits<float>::infinity()));
        const auto sheet = [&](double d, std::uint32_t id) {
            return triangle(atPixel(-10, -10, float(d)), atPixel(-10, 900, float(d)),
                            atPixel(900, -10, float(d)), id);
        };
        const RasterResult result = runner.run(view, {sheet(farther, 0), sheet(distance, 1)});
        for (std::uint64_t key : result.keys) ASSERT_EQ(visibleTriangle(key), 1) << "at " << distance;
    }
}

TEST(RasterDepth, FarFromTheOriginNothingChanges) {
    // Eye and corners moved by a million; corners are on a grid that floats hold there too. The camera is
    // turned, so that a transform that adds large products loses digits.
    const glm::dvec3 forward = glm::normalize(glm::dvec3(0.3, -0.2, -1)),
                     across = glm::normalize(glm::cross(forward, glm::dvec3(0.1, 1, 0)));
    RasterView view;
    view.width = kColumns;
    view.height = kRows;
    view.rowW = forward;
    view.rowX = 211.0 * across + 0.5 * kColumns * forward;
    view.rowY = -211.0 * glm::cross(across, forward) + 0.5 * kRows * forward;
    view.depthOffset = 1e-3;
    RasterRunner runner(kColumns, kRows, 400);
    Random random(21);
    std::vector<RasterTriangle> list, moved;
    const glm::vec3 shift(1048576.0f, -1048576.0f, 524288.0f);
    for (std::uint32_t i = 0; i < 400; ++i) {
        glm::vec3 v[3];
        const glm::dvec3 centre(random.uniform(-60, 60), random.uniform(-40, 40), random.uniform(-60, -5));
        for (auto& corner : v)
            corner = glm::vec3(glm::round((centre + glm::dvec3(random.uniform(-8, 8), random.uniform(-8, 8),
                                                               random.uniform(-8, 8))) *
                                          8.0) /
                               8.0);
        list.push_back(triangle(v[0], v[1], v[2], i));
        moved.push_back(triangle(v[0] + shift, v[1] + shift, v[2] + shift, i));
    }
    const RasterResult here = runner.run(view, list);
    view.eye = glm::dvec3(shift);
    EXPECT_EQ(runner.run(view, moved).keys, here.keys);
}

TEST(RasterDepth, OrthographicViews) {
    Camera camera;
    camera.perspective = false;
    camera.ymag = 10;
    camera.znear = 0.5f;
    camera.zfar = 100;
    const RasterView view = makeRasterView(glm::dmat4(1.0), camera, {kColumns, kRows}, 0.5, 0.0);
    RasterRunner runner(kColumns, kRows, 300, {}, {}, true);
    Random random(22);
    std::vector<RasterTriangle> list;
    for (std::uint32_t i = 0; i < 300; ++i) {
        glm::vec3 v[3];
        const double size = std::pow(10.0, random.uniform(-1, 1.5));
        const glm::dvec3 centre(random.uniform(-16, 16), random.uniform(-10, 10), random.uniform(-90, 1));
        for (auto& corner : v)
            corner = glm::vec3(centre + size * glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1),
                                                          random.uniform(-0.5, 0.5)));
        list.push_back(triangle(v[0], v[1], v[2], i));
    }
    const RasterResult result = runner.run(view, list);
    const Mismatch m = compare(result, view, list, 4e-7);
    EXPECT_EQ(m.different, 0u) << m.first;
    EXPECT_GT(m.covered, m.pixels / 2);
    // Depth falls evenly from 1 at the near plane to 0 at zfar.
    const RasterResult one =
        runner.run(view, {triangle({-99, -99, -50.25f}, {99, -99, -50.25f}, {0, 99, -50.25f}, 0)});
    EXPECT_FLOAT_EQ(std::bit_cast<float>(std::uint32_t(one.keys[kColumns * kRows / 2] >> 32)), 0.5f);
}

TEST(RasterCapabilities, ADeviceWithoutThemIsNamedWithWhatItLacks) {
    EXPECT_NO_THROW(requireRasterCapabilities(device().info()));
    for (const char* needed : kRasterCapabilities) {
        DeviceInfo info = device().info();
        for (Capability& capability : info.capabilities)
            if (capability.name == needed) capability.present = false;
        try {
            requireRasterCapabilities(info);
            ADD_FAILURE() << needed;
        } catch (const DeviceError& error) {
            EXPECT_NE(std::string(error.what()).find(needed), std::string::npos);
            EXPECT_NE(std::string(error.what()).find(info.name), std::string::npos);
        }
    }
}

TEST(RasterView, PixelsOfACamera) {
    // 36 x 24 mm film behind 50 mm: 26.99146656 degrees, 50/24 image heights of focal length.
    Camera camera;
    camera.yfov = float(26.99146656 * 3.14159265358979 / 180);
    glm::dmat4 placed(1.0);
    placed[3] = {1, 2, 3, 1};
    const RasterView view = makeRasterView(placed, camera, {600, 400});
    const auto project = [&](const glm::dvec3& p) {
        const glm::dvec3 d = p - view.eye;
        return glm::dvec2(glm::dot(view.rowX, d), glm::dot(view.rowY, d)) / glm::dot(view.rowW, d);
    };
    EXPECT_NEAR(project({1, 2, 0}).x, 300, 1e-9);
    EXPECT_NEAR(project({1, 2, 0}).y, 200, 1e-9);
    EXPECT_NEAR(project({2, 2, 2}).x, 300 + 400 * 50.0 / 24, 1e-3);
    EXPECT_NEAR(project({1, 3, 2}).y, 200 - 400 * 50.0 / 24, 1e-3) << "y runs down";
    EXPECT_THROW(makeRasterView(placed, camera, {0, 4}), InputError);
    EXPECT_THROW(makeRasterView(placed, camera, {20000, 4}), InputError);
    EXPECT_THROW(makeRasterView(glm::dmat4(0.0), camera, {4, 4}), InputError);
}

/** Row Z2: share of pixels on which, of two parallel planes `apart`, the farther is seen; the view leans, so
 * that the pixels' depths lie anywhere between two steps. */
double fighting(RasterRunner& runner, RasterView view, double z, double apart) {
    // The planes are at the world's origin and the eye is away: floats keep the small difference.
    view.eye = {0, 0, z};
    std::vector<RasterTriangle> list;
    const float w = float(z);
    for (std::uint32_t id : {0u, 1u}) {  // of equal depths the smaller id is seen: the farther plane's
        const float at = id == 0 ? -float(apart) : 0.0f;
        list.push_back(triangle({-4 * w, -4 * w, at}, {8 * w, -4 * w, at}, {-4 * w, 8 * w, at}, id));
    }
    const RasterResult result = runner.run(view, list);
    std::uint64_t wrong = 0;
    for (const std::uint64_t key : result.keys) wrong += visibleTriangle(key) == 0;
    return double(wrong) / double(result.keys.size());
}

TEST(RasterPrecision, PlanesFightUpToThePredictedDifference) {
    constexpr std::uint32_t size = 64;
    for (const DepthFormat format :
         {DepthFormat::Reversed, DepthFormat::Float, DepthFormat::Unorm24, DepthFormat::Unorm16}) {
        RasterRunner runner(size, size, 2, {.depth = format});
        for (const double z : {1.0, 10.0, 100.0}) {
            RasterView view;
            view.rowW = {std::sin(0.1), 0, -std::cos(0.1)};
            view.rowX = double(size) * glm::dvec3(std::cos(0.1), 0, std::sin(0.1)) + 0.5 * size * view.rowW;
            view.rowY = glm::dvec3(0, -double(size), 0) + 0.5 * size * view.rowW;
            view.width = view.height = size;
            view.depthOffset = 0.1;
            conventionalDepth(view, 1000);
            const double predicted = resolvableDepth(view, format, z);
            // Two depths fall into one step with the chance 1 - difference / step: half of the pixels are
            // wrong where the planes are half a step apart. (The lean changes the step by a tenth of z: 2 *
            // 10 %.)
            double low = 0, high = 64 * predicted;
            for (int k = 0; k < 24; ++k) {
                const double middle = 0.5 * (low + high);
                (fighting(runner, view, z, middle) > 0.5 ? low : high) = middle;
            }
            const double measured = 2 * high;
            std::printf("depth format %d, z %g: predicted step %.3g, measured %.3g\n", int(format), z,
                        predicted, measured);
            EXPECT_GT(measured, 0.5 * predicted);
            EXPECT_LT(measured, 2 * predicted);
            EXPECT_EQ(fighting(runner, view, z, 4 * predicted), 0.0);
        }
    }
}

}  // namespace
}  // namespace helio::test
