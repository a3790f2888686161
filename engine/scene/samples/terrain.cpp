/** @file
 * A mountain island in a lake, in metres: a ridged multifractal heightfield (Musgrave 1993) on a 320 x 320
 * grid, one texture over all of it with detail down to the texel, a low sun and a sky of one colour.
 */
#include "engine/scene/samples/sample.hpp"
#include "engine/scene/samples/shapes.hpp"

#include <heliograph/image.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace helio::samples::terrain {
namespace {

constexpr int cells = 320;
constexpr int textureSize = 1024;
constexpr double side = 1200;
constexpr double peak = 215;

double mix(double a, double b, double t) {
    return a + t * (b - a);
}

/** Gradient of the lattice point, one of 8 directions, from a hash of its coordinates (lowbias32, C. Wellons
 * 2018). */
double gradientDot(int ix, int iy, double dx, double dy) {
    std::uint32_t h = std::uint32_t(ix) * 0x9e3779b1u ^ std::uint32_t(iy) * 0x85ebca77u;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    h ^= h >> 16;
    constexpr double c = 0.41421356;
    constexpr std::array<std::array<double, 2>, 8> gradients{
        {{1, c}, {-1, c}, {1, -c}, {-1, -c}, {c, 1}, {-c, 1}, {c, -1}, {-c, -1}}};
    const auto& gradient = gradients[h & 7];
    return gradient[0] * dx + gradient[1] * dy;
}

/** Gradient noise (Perlin 2002's fade) in about -1..1, period none. */
double noise(double x, double y) {
    // std::floor and std::lerp are calls with branches of their own, which five million evaluations would
    // feel.
    const auto floorOf = [](double value) { return int(value) - (value < int(value)); };
    const int ix = floorOf(x), iy = floorOf(y);
    const double dx = x - ix, dy = y - iy;
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const double u = fade(dx), v = fade(dy);
    const double low = mix(gradientDot(ix, iy, dx, dy), gradientDot(ix + 1, iy, dx - 1, dy), u);
    const double high =
        mix(gradientDot(ix, iy + 1, dx, dy - 1), gradientDot(ix + 1, iy + 1, dx - 1, dy - 1), u);
    return 1.5 * mix(low, high, v);
}

double fractal(double x, double y, int octaves) {
    double sum = 0, amplitude = 0.5;
    for (int i = 0; i < octaves; ++i) {
        sum += amplitude * noise(x, y);
        amplitude *= 0.5;
        x = 2.03 * x + 17.1;
        y = 2.03 * y - 5.7;
    }
    return sum;
}

/** Ridged multifractal: octaves weigh more where the one before is high, so that ridges are rough and valleys
 * smooth. */
double ridged(double x, double y) {
    double sum = 0, amplitude = 0.55, weight = 1;
    double rounding = 0.02;  // of |noise| at 0, over about a cell of the grid: a crease would have no normal
    for (int i = 0; i < 6; ++i) {
        const double n = noise(x, y);
        const double ridge = 1 + rounding - std::sqrt(n * n + rounding * rounding);
        const double signal = ridge * ridge * weight;
        sum += amplitude * signal;
        weight = std::clamp(signal * 1.5, 0.0, 1.0);
        amplitude *= 0.44;
        rounding *= 1.7;
        x = 2.07 * x + 3.3;
        y = 2.07 * y + 9.2;
    }
    return sum;
}

/** Height in metres over the lake at (u, v) in 0..1. */
double height(double u, double v) {
    const double x = 2 * u - 1, y = 2 * v - 1;
    const double bend = 0.35 * fractal(2.2 * x + 7.7, 2.2 * y + 1.3, 3);
    const double distance = std::sqrt(x * x + y * y) + 0.55 * fractal(1.4 * x - 3.1, 1.4 * y + 8.8, 4);
    const double island = 1 - std::clamp((distance - 0.15) / 0.75, 0.0, 1.0);
    const double shape = island * island * (3 - 2 * island);
    const double ridges = ridged(1.9 * x + bend + 11.5, 1.9 * y - bend + 4.1);
    return peak * (shape * ridges * (0.45 + 0.75 * ridges) - 0.045);
}

struct Heightfield {
    std::vector<double> heights, flatness;  ///< flatness is the normal's upward part
    double at(int i, int j) const {
        i = std::clamp(i, 0, cells);
        j = std::clamp(j, 0, cells);
        return heights[std::size_t(j) * (cells + 1) + std::size_t(i)];
    }
    /** Unit normal by central differences. */
    glm::dvec3 normal(int i, int j) const {
        const double step = 2 * side / cells;
        return glm::normalize(
            glm::dvec3((at(i - 1, j) - at(i + 1, j)) / step, 1, (at(i, j - 1) - at(i, j + 1)) / step));
    }
};

/** Lowers what is steeper than rock stands (about 60 degrees): each point to at most its neighbours' height
 * and the slope between, by sweeps from two opposite corners. */
void slump(Heightfield& field) {
    constexpr double rise = 1.7 * side / cells, diagonal = 1.41421356 * rise;
    const auto sweep = [&](int i, int j, int back) {
        double& h = field.heights[std::size_t(j) * (cells + 1) + std::size_t(i)];
        h = std::min({h, field.at(i - back, j) + rise, field.at(i, j - back) + rise,
                      field.at(i - back, j - back) + diagonal, field.at(i + back, j - back) + diagonal});
    };
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) sweep(i, j, 1);
    }
    for (int j = cells; j >= 0; --j) {
        for (int i = cells; i >= 0; --i) sweep(i, j, -1);
    }
}

/** One step of (1 2 1) / 4 along each axis: takes off edges that the grid has no room for. */
Heightfield smoothed(const Heightfield& field) {
    Heightfield result;
    result.heights.reserve(field.heights.size());
    const auto row = [&](int i, int j) {
        return field.at(i - 1, j) + 2 * field.at(i, j) + field.at(i + 1, j);
    };
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) {
            result.heights.push_back((row(i, j - 1) + 2 * row(i, j) + row(i, j + 1)) / 16);
        }
    }
    return result;
}

Heightfield makeHeights() {
    Heightfield field;
    field.heights.reserve(std::size_t(cells + 1) * (cells + 1));
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i)
            field.heights.push_back(height(double(i) / cells, double(j) / cells));
    }
    slump(field);
    field = smoothed(field);
    field.flatness.reserve(field.heights.size());
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) field.flatness.push_back(field.normal(i, j).y);
    }
    return field;
}

Primitive makeGround(const Heightfield& field, int material) {
    Primitive ground;
    ground.material = material;
    ground.texcoords.resize(1);
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) {
            const double u = double(i) / cells, v = double(j) / cells;
            ground.positions.emplace_back((u - 0.5) * side, field.at(i, j), (v - 0.5) * side);
            ground.normals.emplace_back(field.normal(i, j));
            ground.texcoords[0].emplace_back(u, v);
        }
    }
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            const auto a = std::uint32_t(j * (cells + 1) + i), b = a + 1, c = a + cells + 1, d = c + 1;
            // Cells are split along alternating diagonals: one direction would show as a grain.
            const bool isOdd = (i + j) % 2 != 0;
            const std::array<std::uint32_t, 6> corners = isOdd
                                                             ? std::array<std::uint32_t, 6>{a, c, b, b, c, d}
                                                             : std::array<std::uint32_t, 6>{a, c, d, a, d, b};
            ground.indices.insert(ground.indices.end(), corners.begin(), corners.end());
        }
    }
    return ground;
}

/** What grows or lies there, as linear reflectance: sand at the shore, grass, wood, rock where it is steep,
 * snow. */
glm::dvec3 cover(double h, double flatness, double patch, double grain) {
    const auto step = [](double low, double high, double x) {
        const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
        return t * t * (3 - 2 * t);
    };
    const glm::dvec3 sand(0.44, 0.36, 0.23), grass(0.10, 0.16, 0.035), wood(0.030, 0.065, 0.022);
    const glm::dvec3 rock(0.20, 0.175, 0.155), snow(0.82, 0.84, 0.88);
    glm::dvec3 color = glm::mix(sand, grass, step(2, 7, h + 4 * patch));
    color = glm::mix(color, wood, step(-0.12, 0.08, patch) * step(9, 18, h) * (1 - step(70, 95, h)));
    color = glm::mix(color, rock * (1 + 0.4 * patch), step(0.72, 0.57, flatness + 0.08 * patch));
    color = glm::mix(color, rock, step(78, 110, h + 30 * patch));
    color = glm::mix(color, snow, step(98, 122, h + 40 * patch) * step(0.52, 0.70, flatness + 0.1 * patch));
    if (h < 0) color = glm::mix(color, glm::dvec3(0.05, 0.08, 0.07), step(0, -8, h));
    return color * (1 + 0.55 * grain);
}

/** sRGB of linear values in 0..1, to a step of 8 bits. */
std::uint8_t srgb8(double linear) {
    static const std::array<std::uint8_t, 8193> table = [] {
        std::array<std::uint8_t, 8193> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = std::uint8_t(srgbEncode(double(i) / double(values.size() - 1)) * 255 + 0.5);
        }
        return values;
    }();
    return table[std::size_t(std::clamp(linear, 0.0, 1.0) * 8192 + 0.5)];
}

TextureImage makeTexture(const Heightfield& field) {
    TextureImage image;
    image.name = "terrain";
    image.width = image.height = textureSize;
    std::vector<std::uint8_t> texels;
    texels.reserve(std::size_t(textureSize) * textureSize * 4);
    for (int y = 0; y < textureSize; ++y) {
        for (int x = 0; x < textureSize; ++x) {
            // Height and slope are smooth at a texel's size: the grid's are interpolated, only the patterns
            // are new.
            const double u = (x + 0.5) / textureSize * cells, v = (y + 0.5) / textureSize * cells;
            const int i = int(u), j = int(v);
            const double a = u - i, b = v - j;
            const std::size_t corner = std::size_t(j) * (cells + 1) + std::size_t(i);
            const auto between = [&](const std::vector<double>& values) {
                return mix(mix(values[corner], values[corner + 1], a),
                           mix(values[corner + cells + 1], values[corner + cells + 2], a), b);
            };
            const double h = between(field.heights);
            const double flatness = between(field.flatness);
            const double patch = fractal(x * 0.021, y * 0.021, 3);
            const double grain = fractal(x * 0.31, y * 0.31, 2);
            const glm::dvec3 color = cover(h, flatness, patch, grain);
            texels.insert(texels.end(), {srgb8(color.x), srgb8(color.y), srgb8(color.z), 255});
        }
    }
    image.texels = std::move(texels);
    return image;
}

Scene makeTerrain() {
    Scene scene;
    const Heightfield field = makeHeights();
    scene.images.push_back(makeTexture(field));
    Texture texture;
    texture.name = "terrain";
    texture.image = 0;
    texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    scene.textures.push_back(texture);

    Material ground = diffuse("ground", glm::vec3(1));
    ground.baseColorTexture.texture = 0;
    addRoot(scene, "ground", addMesh(scene, "ground", makeGround(field, addMaterial(scene, ground))));
    Material water = diffuse("water", {0.012f, 0.045f, 0.070f});
    water.specular = 1;
    water.roughness = 0.12f;
    water.ior = 1.333f;
    constexpr float lake = 12000;
    addRoot(
        scene, "lake",
        addMesh(scene, "lake",
                quadShape({-lake, 0, lake}, {2 * lake, 0, 0}, {0, 0, -2 * lake}, addMaterial(scene, water))));

    addSun(scene, {4.2f, 3.5f, 2.6f}, {-0.85f, 0.5f, 0.35f});
    scene.environment = Environment{glm::vec3(0.33f, 0.45f, 0.68f), -1};
    addCamera(scene, {-190, 170, 830}, {10, 34, 0}, 36);
    return scene;
}

const RegisterSample registered{"terrain", makeTerrain};

}  // namespace
}  // namespace helio::samples::terrain
