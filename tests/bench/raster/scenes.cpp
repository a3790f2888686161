#include "tests/bench/raster/scenes.hpp"

#include "passes/renderer/prepared_scene.hpp"
#include "passes/scene/packed_scene.hpp"

#include <bit>
#include <cmath>
#include <filesystem>
#include <random>
#include <utility>

namespace helio::bench {
namespace {

/** Pixel coordinates x/-z and -y/-z: at distance 1 a unit is a pixel. */
RasterView pixelView(std::array<std::uint32_t, 2> size) {
    RasterView view;
    view.rowX = {1, 0, 0};
    view.rowY = {0, -1, 0};
    view.rowW = {0, 0, -1};
    view.depthOffset = 0.5;
    view.width = size[0];
    view.height = size[1];
    return view;
}

class Uniform {
public:
    double operator()(double low, double high) {
        return low + (high - low) * (double(random_()) / 4294967296.0);
    }

private:
    std::mt19937 random_{7};
};

void add(BenchScene& scene, const std::array<glm::dvec3, 3>& corners) {  // x, y in pixels, distance
    const auto id = std::uint32_t(scene.triangles.size() / 3);
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3& c = corners[std::size_t(k)];
        scene.triangles.emplace_back(c.x * c.z, -c.y * c.z, -c.z, std::bit_cast<float>(k == 0 ? id : 0u));
    }
}

}  // namespace

BenchScene scattered(std::string name, std::uint32_t count, double side, std::array<std::uint32_t, 2> size) {
    BenchScene scene{std::move(name), pixelView(size), {}};
    Uniform uniform;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec2 centre(uniform(0, size[0]), uniform(0, size[1]));
        const double distance = uniform(1, 9);
        std::array<glm::dvec3, 3> corners;
        double area = 0;
        do {
            for (glm::dvec3& c : corners)
                c = {centre.x + side * uniform(-0.5, 0.5), centre.y + side * uniform(-0.5, 0.5),
                     distance + uniform(0, 0.5)};
            const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
            area = std::abs(a.x * b.y - a.y * b.x);
        } while (area < 0.1 * side * side);
        add(scene, corners);
    }
    return scene;
}

BenchScene fullScreen(std::string name, std::uint32_t count, std::array<std::uint32_t, 2> size) {
    BenchScene scene{std::move(name), pixelView(size), {}};
    Uniform uniform;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double distance = uniform(1, 9);
        add(scene, {glm::dvec3(-10, -10, distance), glm::dvec3(2.0 * size[0] + 20, -10, 0.9 * distance),
                    glm::dvec3(-10, 2.0 * size[1] + 20, 0.8 * distance)});
    }
    return scene;
}

BenchScene walls(std::string name, std::uint32_t count, std::uint32_t side,
                 std::array<std::uint32_t, 2> size) {
    BenchScene scene{std::move(name), pixelView(size), {}};
    Uniform uniform;
    for (std::uint32_t wall = 0; wall < count; ++wall) {
        const double distance = uniform(1, 9);  // in no order
        const auto corner = [&](std::uint32_t x, std::uint32_t y) {
            return glm::dvec3(double(size[0]) * x / side, double(size[1]) * y / side, distance);
        };
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x) {
                add(scene, {corner(x, y), corner(x, y + 1), corner(x + 1, y + 1)});
                add(scene, {corner(x, y), corner(x + 1, y + 1), corner(x + 1, y)});
            }
    }
    return scene;
}

BenchScene fromFile(const std::string& file, std::array<std::uint32_t, 2> size) {
    const Scene loaded = load(file);
    const View view = chooseView(loaded, "", double(size[0]) / size[1]);
    PackedScene packed = packScene(loaded, {.tree = false});
    return {std::filesystem::path(file).filename().string(),
            makeRasterView(view.transform, view.camera, size), std::move(packed.triangles)};
}

}  // namespace helio::bench
