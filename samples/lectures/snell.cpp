#include "samples/lectures/materials.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace helio::lectures {

std::vector<Figure> measureSnell(Renderer& renderer) {
    constexpr double pi = std::numbers::pi;
    Scene scene = load("sample:snell");
    // Only what comes through the surface shines: the sky alone, without sun, in a black pool.
    for (Material& material : scene.materials)
        if (!material.scattering) material.baseColor = glm::vec4(0, 0, 0, 1);
    scene.lights.clear();
    for (Node& node : scene.nodes) node.light = -1;
    std::erase_if(scene.roots, [&](int root) {
        const std::string& name = scene.nodes[std::size_t(root)].name;
        return name.starts_with("post") || name.starts_with("ball");
    });
    // The diver looks at the rim on two opposite sides, 2 degrees over 64 pixels.
    constexpr std::uint32_t size = 64;
    const auto diver = std::ranges::find(scene.cameras, "diver", &Camera::name);
    const auto node = std::ranges::find(scene.nodes, "diver", &Node::name);
    if (diver == scene.cameras.end() || node == scene.nodes.end())
        throw std::runtime_error("sample:snell has no diver");
    diver->projection = Projection::Plane;
    diver->yfov = float(2 * pi / 180);
    RenderOptions options;
    options.size = {size, size};
    options.samples = 256;
    options.camera = "diver";
    options.maxDepth = 2;
    options.auxiliary = false;
    double cone = 0;
    for (const double tilt : {48.6, -48.6}) {
        const double turn = (90 + tilt) * pi / 180;  // about x; -z points up after 90 degrees
        node->rotation = glm::quat(float(std::cos(turn / 2)), float(std::sin(turn / 2)), 0, 0);
        const ImageF image = renderer.render(scene, options).image;
        // Rows of the middle columns that see the sky: below the rim where the picture's top is farther from
        // the zenith, else above it.
        double rows = 0;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 28; x < 36; ++x) rows += image.at(x, y, 0) > 0 ? 0.125 : 0;
        const double edge = tilt > 0 ? size - rows : rows;
        const double angle = tilt * pi / 180 + std::atan((1 - 2 * edge / size) * std::tan(pi / 180));
        cone += std::abs(angle) * 180 / pi;
    }
    return {{"the window's cone, degrees", cone, 2 * std::asin(1 / 1.333) * 180 / pi, 0.1}};
}

}  // namespace helio::lectures
