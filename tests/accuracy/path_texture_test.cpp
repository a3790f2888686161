// Textures of the path tracer: filtering and wrapping against double precision, textured emission.
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"

#include <heliograph/image.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace helio::test {
namespace {

constexpr std::uint32_t kSize = 64;

/** A square from (0, 0) to (1, 1), texture coordinates from `from` to `to`, seen whole from straight above.
 */
SceneBuilder square(const glm::vec2& from, const glm::vec2& to) {
    SceneBuilder b;
    b.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, b.material(glm::vec3(1.0f)));
    auto& primitive = b.scene.meshes[0].primitives[0];
    primitive.texcoords.resize(1);
    for (const glm::vec3& p : primitive.positions)
        primitive.texcoords[0].push_back(from + (to - from) * glm::vec2(p));
    b.camera({0.5f, 0.5f, 1}, {0.5f, 0.5f, 0}, 1);
    b.scene.cameras[0].perspective = false;
    b.scene.cameras[0].ymag = 0.5f;
    return b;
}

TextureImage noise(std::uint32_t width, std::uint32_t height, bool bytes) {
    std::mt19937 random(width * 31 + height);
    TextureImage image;
    image.width = width;
    image.height = height;
    if (bytes) {
        std::vector<std::uint8_t> texels(width * height * 4);
        for (auto& t : texels) t = std::uint8_t(random() & 255u);
        image.texels = texels;
    } else {
        std::vector<float> texels(width * height * 4);
        for (auto& t : texels) t = float(random() & 0xffffu) / 65536.0f;
        image.texels = texels;
    }
    return image;
}

int wrapped(int i, int size, Wrap mode) {
    if (mode == Wrap::ClampToEdge) return std::clamp(i, 0, size - 1);
    const int period = mode == Wrap::MirroredRepeat ? 2 * size : size;
    const int r = ((i % period) + period) % period;
    return r < size ? r : period - 1 - r;
}

double texelAt(const TextureImage& image, int x, int y, int c) {
    const std::size_t at = (std::size_t(y) * image.width + std::size_t(x)) * 4 + std::size_t(c);
    if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&image.texels))
        return srgbDecode((*bytes)[at] / 255.0);
    return std::get<std::vector<float>>(image.texels)[at];
}

double filtered(const TextureImage& image, const Texture& texture, double u, double v, int c) {
    const int w = int(image.width), h = int(image.height);
    if (texture.magFilter == Filter::Nearest)
        return texelAt(image, wrapped(int(std::floor(u * w)), w, texture.wrapU),
                       wrapped(int(std::floor(v * h)), h, texture.wrapV), c);
    const double x = u * w - 0.5, y = v * h - 0.5;
    const int i = int(std::floor(x)), k = int(std::floor(y));
    double sum = 0;
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx)
            sum += (dx == 1 ? x - i : 1 - x + i) * (dy == 1 ? y - k : 1 - y + k) *
                   texelAt(image, wrapped(i + dx, w, texture.wrapU), wrapped(k + dy, h, texture.wrapV), c);
    return sum;
}

TEST(PathTexture, FiltersAndWrapsAsInDouble) {
    const glm::vec2 from(-1.37f, 2.61f), to(2.29f, -1.83f);
    for (bool bytes : {true, false})
        for (Filter filter : {Filter::Nearest, Filter::Linear})
            for (Wrap wrap : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge}) {
                SceneBuilder b = square(from, to);
                b.scene.images = {noise(7, 5, bytes)};
                Texture texture;
                texture.image = 0;
                texture.wrapU = wrap;
                texture.wrapV = wrap == Wrap::Repeat ? Wrap::MirroredRepeat : Wrap::Repeat;
                texture.magFilter = filter;
                b.scene.textures = {texture};
                b.scene.materials[0].baseColorTexture = {.texture = 0};
                b.scene.materials[0].baseColor = {0.5f, 1.0f, 0.25f, 1.0f};
                PathTraceOptions o;
                o.size = {kSize, kSize};
                const Traced image = trace(b.scene, o, 1);
                double worst = 0;
                int beyond = 0;
                for (std::uint32_t y = 0; y < kSize; ++y)
                    for (std::uint32_t x = 0; x < kSize; ++x) {
                        const glm::dvec2 p((x + 0.5) / kSize, 1 - (y + 0.5) / kSize);
                        const glm::dvec2 uv = glm::dvec2(from) + glm::dvec2(to - from) * p;
                        for (int c = 0; c < 3; ++c) {
                            const double truth = double(b.scene.materials[0].baseColor[c]) *
                                                 filtered(b.scene.images[0], texture, uv.x, uv.y, c);
                            const double error = std::abs(image.hits.albedo[y * kSize + x][c] - truth);
                            // A nearest texel may change within rounding of its edge.
                            if (filter == Filter::Nearest && error > 1e-3)
                                ++beyond;
                            else
                                worst = std::max(worst, error);
                        }
                    }
                EXPECT_LT(worst, 2e-5)
                    << "bytes " << bytes << " filter " << int(filter) << " wrap " << int(wrap);
                EXPECT_LE(beyond, 3);
            }
}

/** A transform of texture coordinates and the second set. */
TEST(PathTexture, TransformAndSecondSet) {
    SceneBuilder b = square({0, 0}, {1, 1});
    b.scene.images = {noise(8, 8, true)};
    b.scene.textures = {Texture{.name = "", .image = 0}};
    auto& primitive = b.scene.meshes[0].primitives[0];
    primitive.texcoords.push_back(primitive.texcoords[0]);
    for (glm::vec2& uv : primitive.texcoords[0]) uv = glm::vec2(0.0f);
    TextureUse use{.texture = 0, .texcoord = 1};
    use.transform = glm::mat3(0.6f, 0.8f, 0, -0.8f, 0.6f, 0, 0.3f, 0.1f, 1);
    b.scene.materials[0].baseColorTexture = use;
    PathTraceOptions o;
    o.size = {kSize, kSize};
    const Traced image = trace(b.scene, o, 1);
    for (std::uint32_t i = 0; i < kSize * kSize; i += 17) {
        const glm::dvec3 p((i % kSize + 0.5) / kSize, 1 - (i / kSize + 0.5) / kSize, 1);
        const glm::dvec3 uv = glm::dmat3(use.transform) * p;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.hits.albedo[i][c],
                        filtered(b.scene.images[0], b.scene.textures[0], uv.x, uv.y, c), 2e-5);
    }
}

/** A textured lamp over a floor: sampling it and finding it by chance give the same, and the mean of its
 * radiance seen directly is that of the texture. */
TEST(PathTexture, TexturedEmission) {
    SceneBuilder b = square({0, 0}, {1, 1});
    b.scene.images = {noise(6, 6, true)};
    Texture texture;
    texture.image = 0;
    b.scene.textures = {texture};
    b.scene.materials[0].emission = glm::vec3(1.0f);
    b.scene.materials[0].emissiveTexture = {.texture = 0};
    b.scene.materials[0].baseColor = glm::vec4(0, 0, 0, 1);
    const int floor = b.material(glm::vec3(0.8f));
    b.quad({-1, -1, 0.5f}, {-1, 2, 0.5f}, {2, 2, 0.5f}, {2, -1, 0.5f}, floor);  // over it, facing down
    b.scene.cameras[0].ymag = 1.4f;
    b.scene.nodes[1].matrix = std::nullopt;  // keep the square's camera where it is, but look up from below
    b.scene.nodes[1].rotation = glm::quat(0, 1, 0, 0);
    b.scene.nodes[1].translation = {0.5f, 0.5f, -1};
    PathTraceOptions o;
    o.size = {32, 32};
    o.sampler = SamplerKind::Independent;
    const Traced with = trace(b.scene, o, 4096, 512);
    o.nextEventEstimation = false;
    const Traced without = trace(b.scene, o, 16384, 512);
    for (int c = 0; c < 3; ++c) {
        const auto seesFloor = [&](std::size_t i) { return with.hits.instance[i] == 1; };
        const Estimate a = estimate(with, c, seesFloor), e = estimate(without, c, seesFloor);
        const double error = std::hypot(a.error, e.error);
        fmt::print("channel {}: sampled {:.6f}, found {:.6f}, z {:+.2f}, {} pixels\n", c, a.mean, e.mean,
                   (a.mean - e.mean) / error, a.pixels);
        EXPECT_GT(a.mean, 0.0);
        EXPECT_LT(std::abs(a.mean - e.mean), 4 * error);
        EXPECT_LT(error, 0.002 * a.mean);
    }
}

}  // namespace
}  // namespace helio::test
