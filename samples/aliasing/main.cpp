// Aliasing, seen and measured: stripes too fine for the pixels come out as coarse ones, at the frequency that
// sampling theory says; filtering over the pixel takes them away. A wheel that turns nearly once a frame is
// seen to turn back slowly. `aliasing [FOLDER]` prints the frequencies and writes two pictures of a zone
// plate, with its ghosts and without.
#include <heliograph/fourier.hpp>
#include <heliograph/heliograph.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <functional>

namespace {

constexpr std::uint32_t kPixels = 256, kTexels = 4096;

/** A glowing square that fills the picture; its texture is value(u, v), u to the right and v down, both 0
 * to 1. */
helio::Scene poster(std::array<std::uint32_t, 2> texels, const std::function<double(double, double)>& value) {
    helio::Scene scene;
    scene.name = "poster";
    std::vector<float> image;
    for (std::uint32_t y = 0; y < texels[1]; ++y)
        for (std::uint32_t x = 0; x < texels[0]; ++x) {
            const auto shade = float(value((x + 0.5) / texels[0], (y + 0.5) / texels[1]));
            image.insert(image.end(), {shade, shade, shade, 1.0f});
        }
    scene.images = {{"poster", texels[0], texels[1], std::move(image)}};
    scene.textures.resize(1);
    scene.textures[0].image = 0;
    helio::Material material;
    material.baseColor = {0, 0, 0, 1};
    material.emission = {1, 1, 1};
    material.emissiveTexture.texture = 0;
    scene.materials = {material};
    helio::Primitive square;
    square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    square.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    square.indices = {0, 1, 2, 0, 2, 3};
    square.material = 0;
    scene.meshes = {{"poster", {square}}};
    helio::Camera camera;
    camera.perspective = false;
    camera.ymag = 1;
    scene.cameras = {camera};
    helio::Node object, eye;
    object.mesh = 0;
    eye.camera = 0;
    eye.translation = {0, 0, 1};
    scene.nodes = {object, eye};
    scene.roots = {0, 1};
    return scene;
}

helio::ImageF picture(helio::Renderer& renderer, const helio::Scene& scene, helio::TextureFilter filter) {
    helio::RenderOptions options;
    options.size = {kPixels, kPixels};
    options.pipeline = helio::Pipeline::Raster;
    options.samples = 1;
    options.auxiliary = false;
    options.textureFilter = filter;
    return renderer.render(scene, options).image;
}

/** The strongest frequency of a row, in cycles over the picture, and its amplitude. */
std::pair<std::uint32_t, double> strongest(helio::Device& device, const helio::ImageF& image) {
    std::vector<std::complex<float>> row;
    for (std::uint32_t x = 0; x < kPixels; ++x) row.emplace_back(image.at(x, kPixels / 2, 0), 0.0f);
    const auto spectrum = helio::fourierTransform(device, row, {kPixels, 1});
    std::uint32_t best = 1;
    for (std::uint32_t k = 1; k <= kPixels / 2; ++k)
        if (std::abs(spectrum[k]) > std::abs(spectrum[best])) best = k;
    return {best, 2.0 * double(std::abs(spectrum[best])) / kPixels};
}

constexpr std::uint32_t kFrames = 32;
constexpr double kPi = 3.14159265358979323846;

/** A hand on a black dial that turns `speed` times a second counter-clockwise. */
helio::Scene wheel(double speed) {
    helio::Scene scene = poster({1, 1}, [](double, double) { return 1.0; });
    scene.name = "wheel";
    scene.meshes[0].primitives[0].positions = {
        {0, -0.06f, 0}, {0.9f, -0.06f, 0}, {0.9f, 0.06f, 0}, {0, 0.06f, 0}};
    helio::AnimationChannel turn;
    turn.node = 0;
    turn.path = helio::AnimationPath::Rotation;
    // Rotations between two keys go the shorter way: eight keys a turn.
    const int keys = int(std::ceil(8 * speed * kFrames)) + 1;
    for (int k = 0; k < keys; ++k) {
        const double half = 0.5 * 2 * kPi * k / 8;
        turn.times.push_back(float(k / (8 * speed)));
        turn.values.insert(turn.values.end(), {0, 0, float(std::sin(half)), float(std::cos(half))});
    }
    scene.animations = {{"turn", {turn}}};
    return scene;
}

/** Where the light's mean is, x to the right and y up from the middle, in each of kFrames frames one second
 * apart. */
std::vector<std::complex<float>> positions(helio::Renderer& renderer, const helio::Scene& scene) {
    constexpr std::uint32_t size = 48;
    std::vector<std::complex<float>> result;
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
        helio::RenderOptions options;
        options.size = {size, size};
        options.pipeline = helio::Pipeline::Raster;
        options.antialiasing = helio::antialiasing("ssaa8");
        options.samples = 1;
        options.auxiliary = false;
        options.frameTime = frame;
        const helio::ImageF image = renderer.render(scene, options).image;
        std::complex<float> sum = 0;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x)
                sum += image.at(x, y, 0) *
                       std::complex<float>(float(x) + 0.5f - 0.5f * size, 0.5f * size - float(y) - 0.5f);
        result.push_back(sum / float(size * size));
    }
    return result;
}

/** Prints how fast wheels are seen to turn: from one frame to the next, and by the strongest of the
 * frequencies over all frames. */
void turnWheels(helio::Renderer& renderer) {
    std::printf("turns a frame  predicted     seen  predicted bin of %u  seen\n", kFrames);
    for (const double speed : {0.25, 0.75, 0.9, 1.1}) {
        const std::vector<std::complex<float>> hand = positions(renderer, wheel(speed));
        double angle = 0;
        for (std::uint32_t k = 1; k < kFrames; ++k) angle += double(std::arg(hand[k] / hand[k - 1]));
        const auto spectrum = helio::fourierTransform(renderer.device(), hand, {kFrames, 1});
        int best = 0;
        for (int k = 0; k < int(kFrames); ++k)
            if (std::abs(spectrum[std::size_t(k)]) > std::abs(spectrum[std::size_t(best)])) best = k;
        if (best > int(kFrames) / 2) best -= int(kFrames);
        const double predicted = speed - std::round(speed);
        std::printf("%13.2f  %9.4f  %7.4f  %19d  %4d\n", speed, predicted, angle / (2 * kPi * (kFrames - 1)),
                    int(std::round(predicted * kFrames)), best);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    helio::Renderer renderer;
    std::printf("%u pixels; amplitude of the stripes: 0.5\n", kPixels);
    std::printf("cycles  predicted  seen  amplitude  with mip levels\n");
    for (const std::uint32_t cycles : {40u, 100u, 200u, 300u, 500u}) {
        const helio::Scene stripes = poster({kTexels, 1}, [&](double u, double) {
            return 0.5 + 0.5 * std::cos(2.0 * 3.14159265358979323846 * cycles * u);
        });
        const auto [seen, amplitude] =
            strongest(renderer.device(), picture(renderer, stripes, helio::TextureFilter::Nearest));
        const double filtered =
            strongest(renderer.device(), picture(renderer, stripes, helio::TextureFilter::Trilinear)).second;
        // The nearest multiple of the sampling frequency is taken away.
        const auto predicted =
            std::uint32_t(std::abs(double(cycles) - std::round(double(cycles) / kPixels) * kPixels));
        std::printf("%6u  %9u  %4u  %9.4f  %15.4f\n", cycles, predicted, seen, amplitude, filtered);
    }
    turnWheels(renderer);
    const helio::Scene plate = poster({2048, 2048}, [](double u, double v) {
        const double x = u - 0.5, y = v - 0.5;
        return 0.5 + 0.5 * std::cos(1400.0 * (x * x + y * y));  // at the edge 223 cycles over the width
    });
    helio::saveImage(folder / "zone-plate-nearest.png",
                     picture(renderer, plate, helio::TextureFilter::Nearest));
    helio::saveImage(folder / "zone-plate-ewa.png", picture(renderer, plate, helio::TextureFilter::Ewa));
} catch (const helio::Error& error) {
    std::fprintf(stderr, "aliasing: error: %s\n", error.what());
    return 1;
}
