// Height maps on the device: tilted normals against slopes, and moved surfaces against closed forms.
#include "tests/accuracy/shade_runner.hpp"

#include <heliograph/surfaces.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <tuple>

namespace helio::test {
namespace {

/** A texture of heights h(u, v) in 0..1 at the texels' centres. */
void addHeights(Scene& scene, std::uint32_t width, std::uint32_t height,
                const std::function<double(double, double)>& h) {
    std::vector<float> texels;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c)
                texels.push_back(c == 0 ? float(h((x + 0.5) / width, (y + 0.5) / height)) : 1.0f);
    scene.images.push_back({"heights", width, height, std::move(texels)});
    Texture texture;
    texture.image = int(scene.images.size()) - 1;
    texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    scene.textures.push_back(texture);
}

Material raised(double scale) {
    Material m = lambert(glm::vec3(1));
    m.heightTexture.texture = 0;
    m.heightScale = float(scale);
    return m;
}

/** The middle of the unit sphere's front: u along the longitude and v along the polar angle, 1 radian each.
 */
Primitive patch(int cuts) {
    Primitive p;
    p.texcoords.resize(1);
    for (int i = 0; i <= cuts; ++i)
        for (int j = 0; j <= cuts; ++j) {
            const double u = double(j) / cuts, v = double(i) / cuts;
            const double phi = u - 0.5, theta = std::numbers::pi / 2 - 0.5 + v;
            const glm::dvec3 n(std::sin(theta) * std::sin(phi), std::cos(theta),
                               std::sin(theta) * std::cos(phi));
            p.positions.emplace_back(n);
            p.normals.emplace_back(n);
            p.texcoords[0].emplace_back(u, v);
        }
    const auto at = [&](int i, int j) { return std::uint32_t(i * (cuts + 1) + j); };
    for (int i = 0; i < cuts; ++i)
        for (int j = 0; j < cuts; ++j)
            p.indices.insert(p.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                               at(i + 1, j + 1), at(i, j + 1)});
    return p;
}

// Three lights close to the viewer's direction, one a channel: the colours are the normal's cosines.
const std::array<glm::dvec3, 3> kLights = {glm::normalize(glm::dvec3(0.3, 0, 1)),
                                           glm::normalize(glm::dvec3(-0.15, 0.26, 1)),
                                           glm::normalize(glm::dvec3(-0.15, -0.26, 1))};
void addLights(Scene& scene) {
    for (int c = 0; c < 3; ++c) {
        PunctualLight light;
        light.type = PunctualLight::Type::Directional;
        light.intensity = glm::vec3(0);
        light.intensity[c] = 1;
        const glm::dvec3 z = kLights[std::size_t(c)], x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), z));
        addLight(scene, light,
                 glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0),
                            glm::dvec4(0, 0, 0, 1)));
    }
}
glm::dvec3 normalOf(const glm::vec4& color) {
    const glm::dmat3 rows = glm::transpose(glm::dmat3(kLights[0], kLights[1], kLights[2]));
    return glm::inverse(rows) * (std::numbers::pi * glm::dvec3(color));
}

double bumps(double u, double v) {
    return 0.5 + 0.4 * std::sin(4 * std::numbers::pi * u) * std::cos(2 * std::numbers::pi * v + 0.3);
}
glm::dvec2 bumpSlopes(double u, double v) {
    return {0.4 * 4 * std::numbers::pi * std::cos(4 * std::numbers::pi * u) *
                std::cos(2 * std::numbers::pi * v + 0.3),
            -0.4 * 2 * std::numbers::pi * std::sin(4 * std::numbers::pi * u) *
                std::sin(2 * std::numbers::pi * v + 0.3)};
}

constexpr std::uint32_t kSide = 48;

/** Mean angle between the normals shown and those of the sphere with the heights on it, n - grad h. */
double bumpError(std::uint32_t texels, double size) {
    constexpr double scale = 0.08;
    Scene scene;
    addHeights(scene, texels, texels, bumps);
    glm::dmat4 grown(size);
    grown[3][3] = 1;
    addPrimitive(scene, patch(192), raised(scale), grown);
    addLights(scene);
    const ShadedImage image = shade(scene, frontView(kSide, 0.4 * size, 5 * size));
    double sum = 0;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const double px = 0.4 * ((x + 0.5) * 2 / kSide - 1), py = 0.4 * (1 - (y + 0.5) * 2 / kSide);
            const glm::dvec3 n(px, py, std::sqrt(1 - px * px - py * py));
            const double theta = std::acos(n.y), phi = std::atan2(n.x, n.z);
            const glm::dvec2 slope = scale * bumpSlopes(phi + 0.5, theta - std::numbers::pi / 2 + 0.5);
            const glm::dvec3 east(std::cos(phi), 0, -std::sin(phi)), south = glm::cross(n, east) * -1.0;
            const glm::dvec3 expected =
                glm::normalize(n - east * (slope.x / std::sin(theta)) - south * slope.y);
            const glm::dvec3 shown = normalOf(image.color[image.at(x, y)]);
            EXPECT_NEAR(glm::length(shown), 1, 1e-5);
            sum += glm::length(glm::normalize(shown) - expected);
        }
    return sum / (kSide * kSide);
}

TEST(Bump, NormalsTendToTheSlopesWithTheSquareOfATexel) {
    const double coarse = bumpError(20, 1), fine = bumpError(40, 1);
    const double slope = std::log2(coarse / fine);
    std::printf("             mean angle %.2e of 20 texels, %.2e of 40: order %.3f\n", coarse, fine, slope);
    EXPECT_NEAR(slope, 2, 0.1);
    // Heights are those of the mesh: a placement that scales it scales them too.
    EXPECT_NEAR(bumpError(40, 1000) / fine, 1, 0.01);
}

TEST(Bump, AFlatMapLeavesEveryBit) {
    // The same kernel: another surface, out of sight, has the map instead.
    Scene with, without;
    for (Scene* scene : {&with, &without}) {
        addHeights(*scene, 8, 8, [](double, double) { return 0.3; });
        Material plain = lambert(glm::vec3(1));
        addPrimitive(*scene, patch(16), scene == &with ? raised(2) : plain);
        glm::dmat4 aside(1.0);
        aside[3] = {0, 0, 100, 1};
        addPrimitive(*scene, patch(1), scene == &with ? plain : raised(2), aside);
        addLights(*scene);
    }
    const ShadedImage a = shade(with, frontView(kSide, 0.4)), b = shade(without, frontView(kSide, 0.4));
    EXPECT_EQ(a.color, b.color);
    EXPECT_GT(a.color[0].r, 0.1f);
}

/** A square of side 1 in the plane z = 0 with waves of height `a` along x. */
Scene waves(double a) {
    Scene scene;
    addHeights(scene, 1024, 1,
               [](double u, double) { return 0.5 + 0.5 * std::sin(2 * std::numbers::pi * u); });
    scene.textures[0].wrapU = Wrap::Repeat;
    Primitive p = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    p.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    addPrimitive(scene, p, raised(a));
    return scene;
}

double area(const Scene& scene) {
    double sum = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives)
            for (std::size_t t = 0; t + 2 < p.indices.size(); t += 3) {
                const glm::dvec3 v = p.positions[p.indices[t]],
                                 e1 = glm::dvec3(p.positions[p.indices[t + 1]]) - v,
                                 e2 = glm::dvec3(p.positions[p.indices[t + 2]]) - v;
                sum += 0.5 * glm::length(glm::cross(e1, e2));
            }
    return sum;
}

TEST(Displacement, AreaIsTheEllipticIntegral) {
    // z = a/2 sin(2 pi x): the arc's length is 2/pi sqrt(1 + k^2) E(k / sqrt(1 + k^2)), k = pi a.
    const double a = 0.3, k = std::numbers::pi * a;
    const double exact =
        2 / std::numbers::pi * std::sqrt(1 + k * k) * std::comp_ellint_2(k / std::sqrt(1 + k * k));
    double last = 0;
    for (std::uint32_t cuts : {8u, 16u, 32u}) {
        Scene scene = waves(a);
        displace(scene, cuts);
        EXPECT_EQ(scene.triangleCount(), 2 * cuts * cuts);
        const double error = exact - area(scene);
        if (last > 0) {
            EXPECT_NEAR(std::log2(last / error), 2, 0.1) << cuts << " cuts";
        }
        last = error;
    }
    std::printf("             area within %.1e of %.6f at 32 cuts\n", last, exact);
    EXPECT_LT(std::abs(last), 2e-3 * exact);
}

/** Largest difference of the depths shown from those of the waves, seen from above. */
double depthError(std::uint32_t cuts) {
    Scene scene = waves(0.3);
    displace(scene, cuts);
    glm::dmat4 back(1.0);
    back[3] = {-0.5, -0.5, 0, 1};
    for (Node& node : scene.nodes) node.matrix = glm::mat4(back);
    const ShadedImage image = shade(scene, frontView(64, 0.5));
    double worst = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            const double z = 0.3 * (0.5 + 0.5 * std::sin(2 * std::numbers::pi * (x + 0.5) / 64));
            worst = std::max(worst, std::abs(double(image.albedoDepth[image.at(x, y)].w) - (5 - z)));
        }
    return worst;
}

TEST(Displacement, DepthIsTheWavesWithTheSquareOfTheCut) {
    const double coarse = depthError(8), fine = depthError(32);
    std::printf("             depth within %.2e at 8 cuts, %.2e at 32: order %.3f\n", coarse, fine,
                std::log2(coarse / fine) / 2);
    EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.15);
}

TEST(Displacement, ChangesTheOutlineAndBumpsDoNot) {
    // Nearly along the waves' crests: a column of the picture has one height of wave, from the near to the
    // far edge.
    const glm::dvec3 back = glm::normalize(glm::dvec3(0, -1, 0.2)),
                     up(0, 0.2 / std::sqrt(1.04), 1 / std::sqrt(1.04));
    Camera camera;
    camera.perspective = false;
    camera.ymag = 0.5;
    const glm::dmat4 place(glm::dvec4(1, 0, 0, 0), glm::dvec4(up, 0), glm::dvec4(back, 0),
                           glm::dvec4(glm::dvec3(0.5, 0.5, 0) + 5.0 * back, 1));
    constexpr std::uint32_t side = 64;
    const RasterView view = makeRasterView(place, camera, {side, side}, 0.5, 10);
    Scene flat = waves(0.3), moved = waves(0.3);
    displace(moved, 64);
    EXPECT_EQ(moved.materials[0].heightScale, 0.0f);
    for (const bool isMoved : {false, true}) {
        const ShadedImage image = shade(isMoved ? moved : flat, view);
        int covered = 0;
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x) {
                const double row = 0.5 - (y + 0.5) / side;
                const double z =
                    isMoved ? 0.3 * (0.5 + 0.5 * std::sin(2 * std::numbers::pi * (x + 0.5) / side)) : 0;
                const double middle = z * up.z, half = 0.5 * up.y;
                const bool wanted = std::abs(row - middle) < half;
                if (std::abs(std::abs(row - middle) - half) < 0.1 / side) continue;  // at the very edge
                EXPECT_EQ(image.ids[image.at(x, y)].x >= 0, wanted) << isMoved << " " << x << " " << y;
                covered += wanted;
            }
        EXPECT_GT(covered, 500);
    }
}

TEST(Displacement, SharedCornersStayShared) {
    // A bent strip whose triangles' corners come in every order: each inner edge is met twice, to the bit.
    Scene scene;
    addHeights(scene, 16, 16, bumps);
    Primitive p = patch(3);
    for (std::size_t t = 0; t < p.indices.size(); t += 3)
        std::rotate(p.indices.begin() + long(t), p.indices.begin() + long(t + t / 3 % 3),
                    p.indices.begin() + long(t) + 3);
    addPrimitive(scene, p, raised(0.2));
    displace(scene, 5);
    const Primitive& q = scene.meshes[0].primitives[0];
    std::vector<std::array<float, 6>> edges;
    for (std::size_t t = 0; t < q.indices.size(); t += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            glm::vec3 a = q.positions[q.indices[t + k]], b = q.positions[q.indices[t + (k + 1) % 3]];
            if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::swap(a, b);
            edges.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
        }
    std::ranges::sort(edges);
    std::size_t single = 0;
    for (std::size_t i = 0; i < edges.size();) {
        const auto end = std::upper_bound(edges.begin() + long(i), edges.end(), edges[i]);
        const auto count = end - (edges.begin() + long(i));
        single += count == 1;
        ASSERT_LE(count, 2);
        i += std::size_t(count);
    }
    EXPECT_EQ(single, 4u * 3 * 5);  // the rim
}

/** Mean radiance of a glossy square under one light whose normal map's slopes vary by `sigma` each way, seen
 * with so many texels a pixel. */
double glossUnderLight(std::uint32_t side, double sigma, bool beckmann, double alpha, double lightAngle) {
    constexpr std::uint32_t texels = 256;
    std::mt19937 random(5);
    std::normal_distribution<double> slope(0.0, 1.0);
    std::vector<float> map;
    for (std::uint32_t i = 0; i < texels * texels; ++i) {
        const double u = slope(random), v = slope(random);
        const glm::dvec3 n = 0.5 * glm::normalize(glm::dvec3(-sigma * u, -sigma * v, 1)) + 0.5;
        map.insert(map.end(), {float(n.x), float(n.y), float(n.z), 1.0f});
    }
    Scene scene;
    scene.images.push_back({"normals", texels, texels, std::move(map)});
    Texture texture;
    texture.image = 0;
    scene.textures.push_back(texture);
    Material metal;
    metal.scattering = Scattering{};
    metal.scattering->model = Scattering::Model::Conductor;
    metal.scattering->n = glm::vec3(0.2f);
    metal.scattering->k = glm::vec3(3.9f);
    metal.scattering->alpha = glm::vec2(float(alpha));
    metal.scattering->beckmann = beckmann;
    metal.normalTexture.texture = 0;
    Primitive square;
    square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    square.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    square.indices = {0, 1, 2, 0, 2, 3};
    addPrimitive(scene, square, metal);
    PunctualLight light;
    light.type = PunctualLight::Type::Directional;
    const glm::dvec3 z(std::sin(lightAngle), 0, std::cos(lightAngle)), x(z.z, 0, -z.x);
    addLight(scene, light,
             glm::dmat4(glm::dvec4(x, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(z, 0), glm::dvec4(0, 0, 0, 1)));
    const ShadedImage image = shade(scene, frontView(side, 1));
    double sum = 0;
    for (const glm::vec4& color : image.color) sum += double(color.r);
    return sum / double(image.color.size());
}

TEST(NormalMips, FarSurfacesReflectTheMeanOfWhatTheirNormalsReflect) {
    // Beckmann's slopes are Gaussian, and so are the map's: their sum's are too, of the variance that the
    // levels find. GGX's are not, and what Toksvig's widening makes of them is a fit.
    std::printf(
        "             | facets | width | slopes | light at | of the mean over texels | of a flat map's |\n");
    for (const bool beckmann : {true, false})
        for (const double alpha : {0.1, 0.25})
            for (const double sigma : {0.1, 0.2}) {
                double errors = 0, flatErrors = 0;
                for (const double angle : {0.0, 0.3, 0.6}) {
                    const double near = glossUnderLight(256, sigma, beckmann, alpha, angle),
                                 far = glossUnderLight(8, sigma, beckmann, alpha, angle),
                                 flat = glossUnderLight(8, 0, beckmann, alpha, angle);
                    errors += (far - near) * (far - near);
                    flatErrors += (flat - near) * (flat - near);
                    std::printf("             | %s | %.2f | %.1f | %.1f | %.3f | %.3f |\n",
                                beckmann ? "Beckmann" : "GGX", alpha, sigma, angle, far / near, flat / near);
                    if (beckmann) {
                        EXPECT_NEAR(far / near, 1, 0.1);
                    }
                }
                EXPECT_LT(errors, 0.1 * flatErrors);
            }
}

TEST(Displacement, RefusesWhatItCannotMove) {
    Scene scene = waves(0.3);
    EXPECT_ANY_THROW(displace(scene, 0));
    EXPECT_ANY_THROW(displace(scene, 2000));
    scene.meshes[0].primitives[0].targets.resize(1);
    EXPECT_ANY_THROW(displace(scene, 4));
}

}  // namespace
}  // namespace helio::test
