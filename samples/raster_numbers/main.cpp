// What the rasterizer draws, measured in its pictures: the area of a triangle by its antialiased pixels, all
// the light that a lit ball gives off, how wide a shadow is, what a texture too fine for the pixels comes out
// as, and what glass lets through. `raster_numbers [FOLDER]` prints each beside its closed form, writes the
// pictures, and fails where one is off.
#include <heliograph/heliograph.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr std::uint32_t kSize = 128;

/** Looked at from straight above, 4 by 4 metres over the picture, from `height` on. */
helio::Scene seenFromAbove(float height) {
    helio::Scene scene;
    helio::Camera camera;
    camera.perspective = false;
    camera.ymag = 2;
    scene.cameras = {camera};
    helio::Node eye;
    eye.camera = 0;
    eye.translation = {0, 0, height};
    scene.nodes = {eye};
    scene.roots = {0};
    return scene;
}

void add(helio::Scene& scene, const helio::Primitive& primitive, const helio::Material& material) {
    scene.materials.push_back(material);
    helio::Mesh mesh;
    mesh.primitives = {primitive};
    mesh.primitives[0].material = int(scene.materials.size()) - 1;
    scene.meshes.push_back(mesh);
    helio::Node node;
    node.mesh = int(scene.meshes.size()) - 1;
    scene.nodes.push_back(node);
    scene.roots.push_back(int(scene.nodes.size()) - 1);
}

helio::Primitive square(float half, float height) {
    helio::Primitive p;
    p.positions = {
        {-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}};
    p.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    p.indices = {0, 1, 2, 0, 2, 3};
    return p;
}

helio::Material diffuse(float albedo) {
    helio::Material m;
    m.baseColor = {albedo, albedo, albedo, 1};
    m.metallic = 0;
    m.specular = 0;
    return m;
}

helio::Material lamp() {
    helio::Material m = diffuse(0);
    m.emission = {1, 1, 1};
    return m;
}

/** Lights shine along -z, from `height`. */
void addLight(helio::Scene& scene, helio::PunctualLight::Type type, float intensity, float height) {
    helio::PunctualLight light;
    light.type = type;
    light.intensity = glm::vec3(intensity);
    scene.lights = {light};
    helio::Node node;
    node.light = 0;
    node.translation = {0, 0, height};
    scene.nodes.push_back(node);
    scene.roots.push_back(int(scene.nodes.size()) - 1);
}

class Numbers {
public:
    explicit Numbers(std::string folder) : folder_(std::move(folder)) {}

    helio::ImageF draw(const char* name, helio::Scene& scene, const char* antialiasing) {
        scene.name = name;
        helio::RenderOptions options;
        options.size = {kSize, kSize};
        options.pipeline = helio::Pipeline::Raster;
        options.antialiasing = helio::antialiasing(antialiasing);
        options.samples = 1;
        options.auxiliary = false;
        options.shadows.kind = helio::Shadows::Kind::Hard;
        const helio::ImageF image = renderer_.render(scene, options).image;
        if (!folder_.empty()) helio::saveImage(folder_ + "/" + name + ".png", image);
        return image;
    }
    void compare(const char* what, double measured, double truth, double within) {
        const bool holds = std::abs(measured - truth) <= within;
        std::printf("%-46s %.5f  closed form %.5f%s\n", what, measured, truth, holds ? "" : "  OFF");
        holds_ = holds_ && holds;
    }
    bool hold() const { return holds_; }

private:
    std::string folder_;
    helio::Renderer renderer_;
    bool holds_ = true;
};

/** The picture's integral over its 4 by 4 metres. */
double integral(const helio::ImageF& image) {
    double sum = 0;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) sum += double(image.at(x, y, 0));
    return sum * 16 / (double(image.width) * image.height);
}

void coverage(Numbers& numbers) {
    helio::Scene scene = seenFromAbove(3);
    helio::Primitive triangle;
    triangle.positions = {{-1.7f, -1.1f, 0}, {1.5f, -1.6f, 0}, {0.3f, 1.8f, 0}};
    triangle.indices = {0, 1, 2};
    add(scene, triangle, lamp());
    const double area = 0.5 * ((1.5 + 1.7) * (1.8 + 1.1) - (0.3 + 1.7) * (-1.6 + 1.1));
    numbers.compare("area of a triangle by its pixels (m^2)",
                    integral(numbers.draw("triangle", scene, "msaa16")), area, 2e-3);
}

void shading(Numbers& numbers) {
    helio::Scene scene = seenFromAbove(3);
    helio::Primitive ball;
    ball.shape = helio::Shape{};
    ball.shape->radius = 1.5f;
    add(scene, ball, diffuse(1));
    addLight(scene, helio::PunctualLight::Type::Directional, 2, 3);
    // Radiance E cos / pi over the disc: 2/3 E r^2.
    numbers.compare("light of a ball lit from the eye (W/sr)", integral(numbers.draw("ball", scene, "ssaa4")),
                    2.0 / 3 * 2 * 1.5 * 1.5, 0.015);
}

void shadow(Numbers& numbers) {
    // The eye is between the plate and the floor.
    helio::Scene scene = seenFromAbove(0.5f);
    add(scene, square(2, 0), diffuse(1));
    add(scene, square(0.5f, 1), diffuse(1));
    addLight(scene, helio::PunctualLight::Type::Point, 9, 3);
    const helio::ImageF image = numbers.draw("shadow", scene, "none");
    int dark = 0;
    for (std::uint32_t x = 0; x < kSize; ++x) dark += image.at(x, kSize / 2, 0) == 0.0f ? 1 : 0;
    numbers.compare("a plate's shadow, under a lamp (m)", dark * 4.0 / kSize, 1.0 * 3 / (3 - 1), 4.0 / kSize);
}

void texture(Numbers& numbers) {
    helio::Scene scene = seenFromAbove(3);
    constexpr std::uint32_t texels = 1024;
    std::vector<float> board;
    for (std::uint32_t i = 0; i < texels * texels; ++i) {
        const float c = (i % texels + i / texels) % 2 == 0 ? 1.0f : 0.0f;
        board.insert(board.end(), {c, c, c, 1});
    }
    scene.images = {{"board", texels, texels, std::move(board)}};
    scene.textures.resize(1);
    scene.textures[0].image = 0;
    helio::Material material = lamp();
    material.emissiveTexture.texture = 0;
    add(scene, square(2, 0), material);
    const helio::ImageF image = numbers.draw("board", scene, "none");
    double worst = 0;
    for (std::uint32_t y = 0; y < kSize; ++y)
        for (std::uint32_t x = 0; x < kSize; ++x)
            worst = std::max(worst, std::abs(double(image.at(x, y, 0)) - 0.5));
    numbers.compare("a board of 8 squares a pixel, farthest from 1/2", worst, 0, 1e-6);
}

void glass(Numbers& numbers) {
    helio::Scene scene = seenFromAbove(3);
    add(scene, square(2, 0), lamp());
    helio::Material pane = diffuse(1);
    pane.specular = 1;
    pane.roughness = 0;
    pane.transmission = 1;
    pane.thickness = 0.3f;
    pane.attenuationDistance = 0.5f;
    pane.attenuationColor = {0.25f, 0.5f, 0.9f};
    add(scene, square(1, 1), pane);
    const helio::ImageF image = numbers.draw("glass", scene, "none");
    for (std::uint32_t c = 0; c < 3; ++c) {
        const double left = std::pow(double(pane.attenuationColor[int(c)]), 0.3 / 0.5), f = 0.04;
        numbers.compare("what 0.3 m of coloured glass lets through",
                        double(image.at(kSize / 2, kSize / 2, c)),
                        left * (1 - f) * (1 - f) / (1 - f * f * left * left), 1e-5);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const std::string folder = argc > 1 ? argv[1] : "";
    if (!folder.empty()) std::filesystem::create_directories(folder);
    Numbers numbers(folder);
    coverage(numbers);
    shading(numbers);
    shadow(numbers);
    texture(numbers);
    glass(numbers);
    return numbers.hold() ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "raster_numbers: %s\n", error.what());
    return 1;
}
