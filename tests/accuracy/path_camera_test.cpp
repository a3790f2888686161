// Cameras in pictures: rows C5, C6 and C8 (thin lens), panoramas and fisheyes, in both pipelines.
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/device.hpp"

#include <heliograph/error.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace helio::test {
namespace {

PathTraceOptions options(std::uint32_t width, std::uint32_t height,
                         SamplerKind sampler = SamplerKind::Independent) {
    PathTraceOptions o;
    o.size = {width, height};
    o.maxDepth = 0;
    o.sampler = sampler;
    return o;
}

/** A camera at the origin along -z behind whose lens, 50 mm at f/2 focused at 1 m, lies a sensor of
 * `sensor` metres, and a square emitter of `side` metres at a distance, facing it. */
constexpr double kFocal = 0.05, kAperture = 0.025, kFocus = 1.0;
constexpr double kImage = kFocal * kFocus / (kFocus - kFocal);  ///< distance of the sensor

SceneBuilder lensScene(double sensor, double distance, double side, float aperture = float(kAperture)) {
    SceneBuilder b;
    const auto h = float(side / 2), z = float(-distance);
    b.quad({-h, -h, z}, {h, -h, z}, {h, h, z}, {-h, h, z}, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    b.camera({0, 0, 0}, {0, 0, -1}, float(2 * std::atan(sensor / 2 / kImage)));
    b.scene.cameras[0].lens = ThinLens{.apertureDiameter = aperture, .focusDistance = float(kFocus)};
    return b;
}

/** Sum of a picture's red, and moments of it about its mean in pixels, y upwards. */
struct Moments {
    double sum = 0, xx = 0, yy = 0, xy = 0, yyy = 0;
    glm::dvec2 mean{0.0};
};
Moments moments(std::uint32_t width, std::uint32_t height, const std::function<double(std::size_t)>& value) {
    Moments m;
    const auto each = [&](const std::function<void(double, glm::dvec2)>& visit) {
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x)
                visit(value(std::size_t(y) * width + x), {x + 0.5, height - y - 0.5});
    };
    each([&](double v, glm::dvec2 p) { m.sum += v, m.mean += v * p; });
    m.mean /= m.sum;
    each([&](double v, glm::dvec2 p) {
        const glm::dvec2 d = p - m.mean;
        m.xx += v * d.x * d.x / m.sum;
        m.yy += v * d.y * d.y / m.sum;
        m.xy += v * d.x * d.y / m.sum;
        m.yyy += v * d.y * d.y * d.y / m.sum;
    });
    return m;
}
Moments moments(const Traced& image) {
    return moments(image.width, image.height, [&](std::size_t i) { return image.mean[i].x; });
}

/** Second moment per axis of the image of the square emitter, in metres on the sensor: that of the circle of
 * confusion, of the square's own image and of a pixel, which add up. */
double blurredMoment(double circle, double side, double distance, double pixel) {
    const double square = side * kImage / distance;
    return circle * circle / 16 + (square * square + pixel * pixel) / 12;
}

TEST(CameraLens, ThePublishedCircleOfConfusion) {
    // Object at 2 m: 0.657895 mm.
    constexpr double sensor = 1.2e-3, side = 5e-3, distance = 2.0, circle = 0.6578947368e-3;
    constexpr std::uint32_t pixels = 96;
    const double pixel = sensor / pixels;
    const Traced blurred = trace(lensScene(sensor, distance, side).scene, options(pixels, pixels), 512);
    const Traced pinhole = trace(lensScene(sensor, distance, side, 0).scene, options(pixels, pixels), 512);
    const Moments m = moments(blurred);
    const double truth = blurredMoment(circle, side, distance, pixel) / (pixel * pixel);
    const double own = (std::pow(side * kImage / distance, 2) + pixel * pixel) / 12;
    const double measured = std::sqrt(16 * ((m.xx + m.yy) / 2 * pixel * pixel - own));
    fmt::print(
        "second moments {:.3f} {:.3f}, truth {:.3f} px^2: circle of confusion {:.6f} mm, truth {:.6f}\n",
        m.xx, m.yy, truth, measured * 1e3, circle * 1e3);
    EXPECT_NEAR(m.xx / truth, 1, 0.01);
    EXPECT_NEAR(m.yy / truth, 1, 0.01);
    EXPECT_NEAR(m.xy / truth, 0, 0.01);
    EXPECT_NEAR(m.mean.x, pixels / 2.0, 0.1);
    EXPECT_NEAR(m.mean.y, pixels / 2.0, 0.1);
    EXPECT_NEAR(measured / circle, 1, 0.01);

    // A disc of one brightness, the emitter's share of the circle that the lens sees at its distance.
    const double level =
        std::pow(side / (kAperture * (distance - kFocus) / kFocus), 2) / (std::numbers::pi / 4);
    const double inside = circle / 2 - side * kImage / distance,
                 outside = circle / 2 + side * kImage / distance;
    double sum = 0;
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < pixels; ++y)
        for (std::uint32_t x = 0; x < pixels; ++x) {
            const double r = pixel * std::hypot(x + 0.5 - pixels / 2.0, y + 0.5 - pixels / 2.0);
            const double v = blurred.mean[y * pixels + x].x;
            if (r < inside) sum += v, ++count;
            if (r > outside) {
                EXPECT_EQ(v, 0.0);
            }
        }
    const double error = std::sqrt(level * (1 - level) / 512 / double(count));
    fmt::print("within: {:.6f} +- {:.6f}, truth {:.6f}\n", sum / double(count), error, level);
    EXPECT_LT(std::abs(sum / double(count) - level), 4 * error);

    // Energy: what the lens spreads is what the pinhole shows, the square's image in pixels.
    const auto everywhere = [](std::size_t) { return true; };
    const double whole = std::pow(side * kImage / distance / pixel, 2);
    for (const Traced* image : {&blurred, &pinhole}) {
        const Estimate e = estimate(*image, 0, everywhere);
        const double total = e.mean * double(e.pixels), sigma = e.error * double(e.pixels);
        fmt::print("energy {:.4f} +- {:.4f}, truth {:.4f}\n", total, sigma, whole);
        EXPECT_LT(std::abs(total - whole), 3.5 * sigma);
        EXPECT_LT(sigma, 0.01 * whole);
    }
}

TEST(CameraLens, RasterSpreadsTheSameDisc) {
    constexpr double sensor = 1.2e-3, side = 5e-3, distance = 2.0, circle = 0.6578947368e-3;
    constexpr std::uint32_t pixels = 96;
    const double pixel = sensor / pixels;
    Renderer renderer;
    RenderOptions raster;
    raster.pipeline = Pipeline::Raster;
    raster.size = {pixels, pixels};
    raster.auxiliary = false;
    raster.environment = Environment{};
    raster.antialiasing = antialiasing("ssaa1024");
    const Scene scene = lensScene(sensor, distance, side).scene;
    const RenderResult result = renderer.render(scene, raster);
    const Moments m =
        moments(pixels, pixels, [&](std::size_t i) { return double(result.image.data[i * 3]); });
    const double truth = blurredMoment(circle, side, distance, pixel) / (pixel * pixel);
    const double whole = std::pow(side * kImage / distance / pixel, 2);
    fmt::print("second moments {:.3f} {:.3f}, truth {:.3f} px^2; energy {:.4f}, truth {:.4f}\n", m.xx, m.yy,
               truth, m.sum, whole);
    EXPECT_NEAR(m.xx / truth, 1, 0.01);
    EXPECT_NEAR(m.yy / truth, 1, 0.01);
    EXPECT_NEAR(m.sum / whole, 1, 0.01);
    const auto names = [](const RenderResult& r) {
        return std::ranges::any_of(r.skipped, [](const auto& s) { return s.first == "thin lens"; });
    };
    EXPECT_FALSE(names(result));
    raster.antialiasing = {};
    EXPECT_TRUE(names(renderer.render(scene, raster)));
}

TEST(CameraLens, WhatIsInFocusIsSharp) {
    // A square in the sharp plane whose edges fall between pixels: seen without any blur, at magnification zi
    // / zo.
    constexpr std::uint32_t pixels = 64, wide = 24;
    constexpr double sensor = 6.4e-3;
    const double side = wide * (sensor / pixels) * kFocus / kImage;
    for (const float aperture : {0.0f, float(kAperture), 0.2f}) {
        const Traced image =
            trace(lensScene(sensor, kFocus, side * (1 + 1e-5), aperture).scene, options(pixels, pixels), 256);
        for (std::uint32_t y = 0; y < pixels; ++y)
            for (std::uint32_t x = 0; x < pixels; ++x) {
                const auto lies = [](std::uint32_t i) {
                    return i >= (pixels - wide) / 2 && i < (pixels + wide) / 2;
                };
                const double wanted = lies(x) && lies(y) ? 1.0 : 0.0;
                // The square is 1e-5 larger, so that rounding cannot open its edges: 2e-4 pixels.
                EXPECT_NEAR(image.mean[y * pixels + x].x, wanted, wanted > 0 ? 0.0 : 0.01) << x << " " << y;
            }
    }
}

TEST(CameraLens, WithoutApertureItIsThePinhole) {
    Scene scene = load("sample:cornell");
    PathTraceOptions o = options(48, 48, SamplerKind::Sobol);
    o.maxDepth = 4;
    const Traced pinhole = trace(scene, o, 8);
    for (Camera& camera : scene.cameras) camera.lens = ThinLens{.apertureDiameter = 0, .focusDistance = 3};
    const Traced none = trace(scene, o, 8);
    for (Camera& camera : scene.cameras) camera.lens->apertureDiameter = 1e-7f;
    const Traced tiny = trace(scene, o, 8);
    double worst = 0;
    for (std::size_t i = 0; i < pinhole.mean.size(); ++i) {
        EXPECT_EQ(pinhole.mean[i], none.mean[i]);  // the same kernel
        worst = std::max(worst,
                         glm::length(pinhole.mean[i] - tiny.mean[i]) / (glm::length(pinhole.mean[i]) + 0.1));
    }
    // A ray that starts 1e-7 aside may meet another side of an edge: single pixels, and few.
    std::size_t differ = 0;
    for (std::size_t i = 0; i < pinhole.mean.size(); ++i)
        differ +=
            glm::length(pinhole.mean[i] - tiny.mean[i]) > 1e-3 * (glm::length(pinhole.mean[i]) + 0.1) ? 1 : 0;
    fmt::print("A = 1e-7: {} of {} pixels differ by more than 0.001, worst {:.2g}\n", differ,
               pinhole.mean.size(), worst);
    EXPECT_LE(differ, 12u);
}

TEST(CameraLens, BladesShapeTheBlur) {
    constexpr double sensor = 1.2e-3, side = 2e-3;
    constexpr std::uint32_t pixels = 64;
    const double pixel = sensor / pixels;
    for (const bool far : {true, false}) {
        const double distance = far ? 2.0 : 0.7;
        const double circle = kAperture * std::abs(distance - kFocus) / distance * kImage / kFocus;
        SceneBuilder b = lensScene(sensor, distance, side);
        b.scene.cameras[0].lens->blades = 3;
        b.scene.cameras[0].lens->bladeRotation = float(std::numbers::pi / 2);  // a corner upwards
        const Moments m = moments(trace(b.scene, options(pixels, pixels, SamplerKind::Sobol), 1024));
        // Of a triangle in a circle of radius R: R^2 / 8 per axis, third moment R^3 / 40 towards the corner.
        const double radius = circle / 2 / pixel, square = side * kImage / distance / pixel;
        const double truth = radius * radius / 8 + (square * square + 1) / 12;
        const double third = (far ? 1 : -1) * std::pow(radius, 3) / 40;
        fmt::print("{}: second moments {:.3f} {:.3f}, truth {:.3f}; third {:.1f}, truth {:.1f}\n",
                   far ? "far" : "near", m.xx, m.yy, truth, m.yyy, third);
        EXPECT_NEAR(m.xx / truth, 1, 0.02);
        EXPECT_NEAR(m.yy / truth, 1, 0.02);
        // Behind the focus the picture shows the aperture as it is, before it upside down.
        EXPECT_NEAR(m.yyy / third, 1, 0.08);
    }
}

/** The direction of a point of the image in the camera's frame, by the definitions in camera.hpp; false
 * outside of a fisheye's circle. */
bool directionOf(const Camera& camera, glm::dvec2 point, glm::dvec2 size, glm::dvec3& d) {
    if (camera.projection == Projection::LatLong) {
        const double longitude = (point.x / size.x - 0.5) * 2 * std::numbers::pi,
                     polar = point.y / size.y * std::numbers::pi;
        d = {std::sin(polar) * std::sin(longitude), std::cos(polar), -std::sin(polar) * std::cos(longitude)};
        return true;
    }
    const glm::dvec2 p = (2.0 * point - size) / std::min(size.x, size.y);
    const double r = glm::length(p), half = double(camera.fieldOfView) / 2;
    const double angle = camera.projection == Projection::Equidistant
                             ? r * half
                             : 2 * std::asin(std::min(1.0, r * std::sin(half / 2)));
    const double azimuth = std::atan2(-p.y, p.x);
    d = {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), -std::cos(angle)};
    return r <= 1;
}

struct Wide {
    const char* name;
    Projection projection;
    float fieldOfView;
    std::uint32_t width, height;
};
const Wide kWide[] = {{"panorama", Projection::LatLong, 3, 128, 64},
                      {"equidistant 180", Projection::Equidistant, float(std::numbers::pi), 96, 80},
                      {"equidistant 360", Projection::Equidistant, float(2 * std::numbers::pi), 80, 80},
                      {"equisolid 180", Projection::Equisolid, float(std::numbers::pi), 80, 96},
                      {"equisolid 300", Projection::Equisolid, 5.2f, 80, 80}};

TEST(CameraWide, PixelsSeeTheDirectionsTheyStandFor) {
    for (const Wide& wide : kWide) {
        SceneBuilder b;
        const int wall = b.material(glm::vec3(0.5f));
        b.room({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall});
        b.camera({0, 0, 0}, {0.6f, -0.3f, -0.5f}, 1, {0.1f, 1, 0.2f});
        b.scene.cameras[0].projection = wide.projection;
        b.scene.cameras[0].fieldOfView = wide.fieldOfView;
        const glm::dmat3 toWorld(b.scene.placedCameras()[0].transform);
        const Traced image = trace(b.scene, options(wide.width, wide.height), 1);
        std::size_t compared = 0, outside = 0;
        for (std::uint32_t y = 0; y < wide.height; ++y)
            for (std::uint32_t x = 0; x < wide.width; ++x) {
                glm::dvec3 d;
                const bool seen =
                    directionOf(b.scene.cameras[0], {x + 0.5, y + 0.5}, {wide.width, wide.height}, d);
                const std::size_t i = std::size_t(y) * wide.width + x;
                if (!seen) {
                    EXPECT_EQ(image.hits.instance[i], -1);
                    ++outside;
                    continue;
                }
                const glm::dvec3 w = toWorld * d, size = glm::abs(w);
                const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
                const double largest = size[axis];
                const double second = std::max(size[(axis + 1) % 3], size[(axis + 2) % 3]);
                if (largest - second < 1e-5) continue;
                EXPECT_EQ(image.hits.instance[i], axis * 2 + (w[axis] > 0 ? 1 : 0))
                    << wide.name << x << " " << y;
                EXPECT_NEAR(image.hits.depth[i] / (-d.z / largest), 1, 1e-4 / std::abs(d.z));
                ++compared;
            }
        fmt::print("{}: {} pixels agree, {} lie outside of the circle\n", wide.name, compared, outside);
        EXPECT_GT(compared, wide.width * wide.height / 2);
    }
}

/** Radians squared that an image point stands for, per pixel. */
double solidAngle(const Camera& camera, glm::dvec2 point, glm::dvec2 size) {
    if (camera.projection == Projection::LatLong)
        return 2 * std::numbers::pi * std::numbers::pi / (size.x * size.y) *
               std::sin(point.y / size.y * std::numbers::pi);
    const double radius = std::min(size.x, size.y) / 2, half = double(camera.fieldOfView) / 2;
    const double r = glm::length(2.0 * point - size) / 2 / radius;
    if (camera.projection == Projection::Equisolid) return std::pow(2 * std::sin(half / 2) / radius, 2);
    const double angle = r * half;
    return half * half / (radius * radius) * (angle > 1e-9 ? std::sin(angle) / angle : 1.0);
}

TEST(CameraWide, SolidAnglesAndFurnaces) {
    // A sphere of radius 1 at distance 3 fills 2 pi (1 - sqrt(8) / 3). Filters move light between pixels and
    // lose none, at the panorama's seam and poles neither: the sphere lies there in turn.
    const double truth = 2 * std::numbers::pi * (1 - std::sqrt(8.0) / 3);
    for (const Wide& wide : kWide)
        for (const PixelFilter filter : {PixelFilter::Box, PixelFilter::Tent}) {
            const bool panorama = wide.projection == Projection::LatLong;
            if (!panorama && (filter != PixelFilter::Box || wide.fieldOfView < 4)) continue;
            for (const glm::vec3 at : panorama ? std::vector<glm::vec3>{{0, 0, 3}, {0, 3, 0}}
                                               : std::vector<glm::vec3>{{0.4f, 0.3f, -2.9580399f}}) {
                SceneBuilder b;
                b.sphere(at, 1.0f, 3, false, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
                b.camera({0, 0, 0}, {0, 0, -1}, 1);
                b.scene.cameras[0].projection = wide.projection;
                b.scene.cameras[0].fieldOfView = wide.fieldOfView;
                PathTraceOptions o = options(wide.width, wide.height, SamplerKind::Sobol);
                o.filter = filter;
                const Traced image = trace(b.scene, o, 16);
                double sum = 0;
                for (std::uint32_t y = 0; y < wide.height; ++y)
                    for (std::uint32_t x = 0; x < wide.width; ++x)
                        sum += image.mean[std::size_t(y) * wide.width + x].x *
                               solidAngle(b.scene.cameras[0], {x + 0.5, y + 0.5}, {wide.width, wide.height});
                fmt::print("{}{}: {:.5f} sr, truth {:.5f}\n", wide.name,
                           filter == PixelFilter::Box ? "" : ", tent", sum, truth);
                // The sphere of 1280 triangles is 0.5 % smaller than a round one.
                EXPECT_NEAR(sum / truth, 0.995,
                            panorama && at.y > 2 && filter != PixelFilter::Box ? 0.02 : 0.01);
            }
        }
    SceneBuilder b;
    b.sphere({0, 0, 0}, 1.0f, 2, true, b.material(glm::vec3(0.0f), glm::vec3(1.0f)));
    b.camera({0, 0, 0}, {0, 0, -1}, 1);
    b.scene.cameras[0].projection = Projection::LatLong;
    for (const glm::dvec3& value : trace(b.scene, options(32, 16), 4).mean) EXPECT_EQ(value.x, 1.0);
}

TEST(CameraWide, RasterRefusesThem) {
    SceneBuilder b = lensScene(0.024, 2, 0.1, 0);
    b.scene.cameras[0].lens.reset();
    b.scene.cameras[0].projection = Projection::Equidistant;
    Renderer renderer;
    RenderOptions raster;
    raster.pipeline = Pipeline::Raster;
    raster.size = {8, 8};
    EXPECT_THROW(renderer.render(b.scene, raster), InputError);
    b.scene.cameras[0].lens = ThinLens{.apertureDiameter = 0.1f};
    EXPECT_THROW(b.scene.validate(), InputError);
}

}  // namespace
}  // namespace helio::test
