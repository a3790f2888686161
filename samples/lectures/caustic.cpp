#include "samples/lectures/materials.hpp"

namespace helio::lectures {
namespace {

/** Red of an image's columns, means over the rows. */
std::vector<double> columns(const ImageF& image) {
    std::vector<double> result(image.width);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) result[x] += double(image.at(x, y, 0)) / image.height;
    return result;
}

}  // namespace

std::vector<Figure> measureCaustic(Renderer& renderer) {
    Scene scene = load("sample:caustic");
    RenderOptions options;
    options.size = {40, 4};
    options.samples = 32768;
    options.camera = "above";
    options.maxDepth = 2;
    options.auxiliary = false;
    options.environment = Environment{};
    const std::vector<double> both = columns(renderer.render(scene, options).image);
    std::erase_if(scene.roots, [&](int root) { return scene.nodes[std::size_t(root)].name == "ring"; });
    options.samples = 256;
    const std::vector<double> direct = columns(renderer.render(scene, options).image);
    // A circular mirror brings parallel rays to 1 / |1 - 2 s / (R cos i)| of their irradiance at the distance
    // s. On the axis s = 1 - x, i = 0: between the centre and the cusp c the mirrored light is 1 / (1 - x /
    // c) of the direct light, m, so that the sum of m (1 - x / c) is the number of columns.
    double sum = 0, moment = 0, count = 0, middle = 0, truth = 0;
    for (std::size_t i = 0; i < both.size(); ++i) {
        const double x = -0.1 + (double(i) + 0.5) / 100, mirrored = both[i] / direct[i] - 1;
        if (std::abs(x) < 0.1) {
            middle += mirrored / 20;
            truth += 0.05 / (1 - 2 * x);
        }
        if (x < 0) continue;
        sum += mirrored;
        moment += mirrored * x;
        ++count;
    }
    return {{"the caustic's cusp, of the radius", moment / (sum - count), 0.5, 0.015},
            {"mirrored over direct light about the centre", middle, truth, 0.02}};
}

}  // namespace helio::lectures
