#include "tests/stability/measure.hpp"

#include "tests/accuracy/path_scenes.hpp"

#include <heliograph/verify.hpp>

#include <array>
#include <cmath>

namespace helio::test {

RenderOptions independentSamples(std::uint32_t size, std::uint32_t samples, Pipeline pipeline) {
    RenderOptions options;
    options.pipeline = pipeline;
    options.size = {size, size};
    options.samples = samples;
    options.sampler = SamplerKind::Independent;
    return options;
}

Mean meanOf(const ImageF& image) {
    const std::size_t pixels = std::size_t(image.width) * image.height, stride = image.channels.size();
    Mean mean;
    for (const auto& [color, variance] :
         {std::array{"R", "variance.R"}, std::array{"G", "variance.G"}, std::array{"B", "variance.B"}}) {
        const auto x = std::size_t(image.channel(color));
        const int v = image.channel(variance);
        for (std::size_t i = 0; i < pixels; ++i) {
            mean.value += image.data[i * stride + x] / (3.0 * double(pixels));
            if (v < 0) continue;
            // A pixel's channels share their paths: their errors add up at worst.
            const double deviation = std::sqrt(double(image.data[i * stride + std::size_t(v)]));
            mean.error += deviation * deviation / (3.0 * double(pixels) * double(pixels));
        }
    }
    mean.error = std::sqrt(mean.error);
    return mean;
}

KnownScene squareLight(float side) {
    SceneBuilder b;
    constexpr float half = 1e-3f;
    b.quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0},
           b.material(glm::vec3(1.0f)));
    b.camera({3 * half, 0.5f * half, 0.4f * half}, {0, 0, 0}, 2e-3f, {0, 0, 1});
    const float h = side / 2, radiance = side < 1 ? 1 / (side * side) : 1;
    b.quad({-h, -h, 1}, {-h, h, 1}, {h, h, 1}, {h, -h, 1}, b.material(glm::vec3(0.0f), glm::vec3(radiance)));
    constexpr double pi = 3.14159265358979323846;
    return {b.scene, verify::irradianceCentredRectangle(side, side, 1) * radiance / pi};
}

KnownScene furnace(float albedo) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(albedo), glm::vec3(1.0f));
    b.room({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall});
    b.camera({0.1f, 0.2f, 0.3f}, {0.5f, 0.1f, -1}, 1.0f);
    return {b.scene, 1 / (1 - double(albedo))};
}

namespace {

SceneBuilder ball(const Material& look, float yfov) {
    SceneBuilder b;
    const int material = b.material(glm::vec3(1.0f));
    b.scene.materials[std::size_t(material)] = look;
    b.sphere({0, 0, 0}, 1, 4, false, material);
    b.camera({0, 0, 5}, {0, 0, 0}, yfov);
    b.scene.environment = Environment{glm::vec3(1.0f), -1};
    return b;
}

}  // namespace

KnownScene glassBall(float index) {
    Material glass;
    glass.scattering = Scattering{};
    glass.scattering->model = Scattering::Model::Dielectric;
    glass.scattering->n = glm::vec3(index);
    return {ball(glass, 0.7f).scene, 1};
}

KnownScene metalBall(float roughness) {
    Material metal;
    metal.metallic = 1;
    metal.roughness = roughness;
    return {ball(metal, 0.35f).scene, 1};
}

KnownScene slivers(double aspect) {
    SceneBuilder b;
    std::vector<glm::vec3> corners;
    constexpr double length = 10;
    const double width = length / aspect;
    // Enough of them for what the camera sees, and a few whole ones where they are wide.
    const int count = int(std::ceil(2e-3 / width)) + 2;
    for (int i = -count; i < count; ++i) {
        const float x = float(i * width), y = float((i + 1) * width), end = float(length / 2);
        for (const glm::vec3& p : {glm::vec3(x, -end, 0), glm::vec3(y, -end, 0), glm::vec3(y, end, 0),
                                   glm::vec3(x, -end, 0), glm::vec3(y, end, 0), glm::vec3(x, end, 0)})
            corners.push_back(p);
    }
    b.triangles(corners, b.material(glm::vec3(0.5f)));
    b.camera({0, 0, 1e-3f}, {0, 0, 0}, 1.0f);
    b.scene.environment = Environment{glm::vec3(1.0f), -1};
    return {b.scene, 0.5};
}

}  // namespace helio::test
