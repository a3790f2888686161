/** @file
 * What surfaces are cut out of and how they stand out: balls of marble, wood and clouds (solid textures of
 * Perlin's noise), and one of clay whose map of heights tilts its normals, or moves it with --displace 24.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <cmath>

namespace helio::samples::carved {
namespace {

constexpr float pi = 3.14159265f;

int solid(Scene& scene, const char* name, SolidTexture::Pattern pattern, glm::vec3 first, glm::vec3 second,
          float scale) {
    Material material = diffuse(name, glm::vec3(1));
    material.solid = SolidTexture{pattern, first, second, scale};
    return addMaterial(scene, material);
}

/** Knobs in rows: smooth heights over longitude and latitude. */
int clay(Scene& scene) {
    constexpr std::uint32_t width = 512, height = 256;
    std::vector<std::uint16_t> texels;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const float wave =
                std::sin(16 * pi * (float(x) + 0.5f) / width) * std::sin(9 * pi * (float(y) + 0.5f) / height);
            const auto h = std::uint16_t(std::lround(65535 * wave * wave));
            texels.insert(texels.end(), {h, h, h, 65535});
        }
    scene.images.push_back({"knobs", width, height, std::move(texels)});
    Texture texture;
    texture.image = int(scene.images.size()) - 1;
    scene.textures.push_back(texture);
    Material material = diffuse("clay", {0.62f, 0.3f, 0.2f});
    material.heightTexture.texture = int(scene.textures.size()) - 1;
    material.heightScale = 0.16f;
    return addMaterial(scene, material);
}

/** The unit sphere over longitude and latitude, with texture coordinates. */
Primitive globe(int material) {
    constexpr int columns = 48, rows = 24;
    Primitive p;
    p.material = material;
    p.texcoords.resize(1);
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j <= columns; ++j) {
            // The seam's two columns and the poles are each at one place, to the bit.
            const bool isPole = i == 0 || i == rows;
            const double theta = double(pi) * i / rows, phi = 2 * double(pi) * (j % columns) / columns;
            const glm::vec3 n =
                isPole ? glm::vec3(0, i == 0 ? 1 : -1, 0)
                       : glm::vec3(glm::normalize(glm::dvec3(std::sin(theta) * std::sin(phi), std::cos(theta),
                                                             std::sin(theta) * std::cos(phi))));
            p.positions.push_back(n);
            p.normals.push_back(n);
            p.texcoords[0].emplace_back(float(j) / columns, float(i) / rows);
        }
    const auto at = [](int i, int j) { return std::uint32_t(i * (columns + 1) + j); };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            if (i + 1 < rows) p.indices.insert(p.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            if (i > 0) p.indices.insert(p.indices.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return p;
}

Scene makeCarved() {
    using Pattern = SolidTexture::Pattern;
    Scene scene;
    const int materials[4] = {
        solid(scene, "marble", Pattern::Marble, {0.85f, 0.83f, 0.8f}, {0.12f, 0.16f, 0.22f}, 1.6f),
        solid(scene, "wood", Pattern::Wood, {0.62f, 0.36f, 0.16f}, {0.3f, 0.13f, 0.05f}, 7),
        solid(scene, "clouds", Pattern::Clouds, {0.15f, 0.35f, 0.7f}, {0.9f, 0.9f, 0.92f}, 3), clay(scene)};
    for (int i = 0; i < 4; ++i) {
        Node node;
        node.name = scene.materials[std::size_t(materials[i])].name;
        node.mesh = addMesh(scene, node.name, i == 3 ? globe(materials[i]) : sphereShape(24, materials[i]));
        node.translation = {2.4f * float(i) - 3.6f, 1.05f, 0};
        // Wood and marble show a section that is not along their axes.
        node.rotation = glm::angleAxis(0.5f, glm::vec3(1, 0, 0));
        addRoot(scene, node);
    }
    addRoot(scene, "floor",
            addMesh(scene, "floor",
                    quadShape({-12, 0, 8}, {24, 0, 0}, {0, 0, -16},
                              solid(scene, "tiles", Pattern::Noise, glm::vec3(0.5f), glm::vec3(0.3f), 1))));
    addSun(scene, glm::vec3(2.4f, 2.3f, 2.1f), {-0.6f, 1, 0.7f});
    scene.environment = Environment{glm::vec3(0.3f, 0.34f, 0.4f), -1};
    addCamera(scene, {0, 3.2f, 9.5f}, {0, 0.8f, 0}, 30);
    return scene;
}

const RegisterSample sample{"carved", makeCarved};

}  // namespace
}  // namespace helio::samples::carved
