#include "samples/lectures/materials.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace helio::lectures {

std::vector<Figure> measureLenses(Renderer& renderer) {
    Scene scene = load("sample:lenses");
    const auto lens =
        std::ranges::find_if(scene.cameras, [](const Camera& camera) { return camera.lens.has_value(); });
    if (lens == scene.cameras.end()) throw std::runtime_error("sample:lenses has no thin lens");
    // Only the lamp, 8 m away.
    std::erase_if(scene.roots, [&](int root) {
        const Node& node = scene.nodes[std::size_t(root)];
        return node.camera < 0 && node.name != "lamp 5";
    });
    RenderOptions options;
    options.size = {320, 180};
    options.samples = 512;
    options.camera = lens->name;
    options.maxDepth = 0;
    options.auxiliary = false;
    options.environment = Environment{};
    const ImageF image = renderer.render(scene, options).image;
    double sum = 0, xx = 0, yy = 0;
    glm::dvec2 mean(0.0);
    const auto each = [&](auto visit) {
        for (std::uint32_t y = 0; y < 180; ++y)
            for (std::uint32_t x = 0; x < 320; ++x) visit(double(image.at(x, y, 0)), glm::dvec2(x, y));
    };
    each([&](double v, glm::dvec2 p) { sum += v, mean += v * p; });
    mean /= sum;
    each([&](double v, glm::dvec2 p) {
        xx += v * (p.x - mean.x) * (p.x - mean.x) / sum;
        yy += v * (p.y - mean.y) * (p.y - mean.y) / sum;
    });
    // Along the axis, in the sharp plane: blur A |z - s| / z, as pixels s tan(yfov / 2) 2 / 180 each.
    const PlacedCamera placed = chooseCamera(scene, lens->name);
    const glm::dvec3 seen = glm::inverse(placed.transform) * scene.instances().at(0).transform[3];
    const double z = -seen.z, s = double(lens->lens->focusDistance);
    const double pixel = 2 * s * std::tan(double(lens->yfov) / 2) / 180;
    const double circle = double(lens->lens->apertureDiameter) * (z - s) / z / pixel;
    const double own = 0.003 * 8 * s / z / pixel;  // the lamp's radius
    const double blades = 2 * std::numbers::pi / lens->lens->blades;
    const double truth = circle * circle / 4 * (2 + std::cos(blades)) / 12 + own * own / 4 + 1.0 / 12;
    return {{"second moment across of a lamp out of focus, square pixels", xx, truth, 0.05 * truth},
            {"upwards", yy, truth, 0.05 * truth}};
}

}  // namespace helio::lectures
