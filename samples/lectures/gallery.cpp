#include "samples/lectures/materials.hpp"

#include <array>
#include <stdexcept>

namespace helio::lectures {
namespace {

/** Mean R G B of the middle of one of the gallery's balls, seen along -z, alone under a sky of 1. */
std::array<double, 3> ballsMiddle(Renderer& renderer, const std::string& name) {
    Scene scene = load("sample:gallery");
    Camera camera;
    camera.name = "middle";
    camera.perspective = false;
    camera.ymag = 0.01f;
    scene.cameras.push_back(camera);
    Node eye;
    eye.name = "middle";
    eye.camera = int(scene.cameras.size()) - 1;
    std::erase_if(scene.roots, [&](int root) { return scene.nodes[std::size_t(root)].name != name; });
    if (scene.roots.size() != 1) throw std::runtime_error("sample:gallery has no ball '" + name + "'");
    eye.translation = scene.nodes[std::size_t(scene.roots[0])].translation + glm::vec3(0, 0, 5);
    scene.nodes.push_back(eye);
    scene.roots.push_back(int(scene.nodes.size()) - 1);
    RenderOptions options;
    options.size = {16, 16};
    options.samples = 64;
    options.camera = "middle";
    options.auxiliary = false;
    options.environment = Environment{.radiance = glm::vec3(1)};
    const ImageF image = renderer.render(scene, options).image;
    std::array<double, 3> mean{};
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                mean[c] += double(image.at(x, y, c)) / (double(image.width) * image.height);
    return mean;
}

/** What a metal of index n + i k reflects at normal incidence. */
double metal(double n, double k) {
    return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

/** A ball through whose middle light loses the part 1 - t at each passage, between walls that reflect R. */
double tinted(double t) {
    const double r = 0.04;
    return r + (1 - r) * (1 - r) * t / (1 - r * t);
}

}  // namespace

std::vector<Figure> measureGallery(Renderer& renderer) {
    std::vector<Figure> figures;
    const auto add = [&](const std::string& name, const std::string& what, std::array<double, 3> truth,
                         double tolerance) {
        const std::array<double, 3> measured = ballsMiddle(renderer, name);
        for (std::size_t c = 0; c < 3; ++c)
            figures.push_back({name + ", " + what + ", " + "RGB"[c], measured[c], truth[c], tolerance});
    };
    add("Lambert", "its albedo", {0.6, 0.25, 0.2}, 1e-4);
    add("mirror", "all light", {1, 1, 1}, 1e-5);
    add("glass", "all light", {1, 1, 1}, 2e-3);
    add("diamond", "all light", {1, 1, 1}, 4e-3);
    // Of facets this narrow, 0.98831 of the light leaves after one reflection (GGX, width 0.1).
    add("gold", "facets' albedo times n and k's",
        {0.98831 * metal(0.18, 3.43), 0.98831 * metal(0.54, 2.32), 0.98831 * metal(1.33, 1.88)}, 3e-3);
    // Its colour is what half a unit leaves; the ball is one across.
    add("red glass", "Beer's law between two walls", {tinted(0.81), tinted(0.0225), tinted(0.01)}, 4e-3);
    return figures;
}

}  // namespace helio::lectures
