// Paths that photons guide to caustics: whatever their tables say, the mean is that of closed forms and of
// paths without them, and the same scene gives the same bits.
#include "passes/pathtrace/guide_tables.hpp"
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/renderer.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <vector>

namespace helio::test {
namespace {

int glassOf(SceneBuilder& b) {
    const int glass = b.material(glm::vec3(1));
    Scattering dielectric;
    dielectric.model = Scattering::Model::Dielectric;
    dielectric.n = glm::vec3(1.5f);
    b.scene.materials[std::size_t(glass)].scattering = dielectric;
    return glass;
}

PathTraceOptions guidedOptions(std::uint32_t size) {
    PathTraceOptions o = independentOptions(size);
    o.photonTargets = true;
    return o;
}

double zOf(const char* what, const Traced& image, double truth, std::uint32_t samples) {
    const Estimate e = estimate(image, 0, [](std::size_t) { return true; });
    const double z = (e.mean - truth) / e.error;
    fmt::print("{}: {:.6f} +- {:.6f}, truth {:.6f}, z {:+.2f}, {} pixels of {} samples, {} tables\n", what,
               e.mean, e.error, truth, z, image.mean.size(), samples, image.guideTables);
    return z;
}

/** A room whose walls all give off E and reflect p of what comes: E / (1 - p) wherever one looks, through
 * glass too. */
TEST(Guiding, LeavesAFurnaceWithGlassAsItIs) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.6f), glm::vec3(1)), glass = glassOf(b);
    b.room({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall});
    b.sphere({0.1f, -0.3f, 0}, 0.5f, 3, false, glass);
    b.camera({0, 0, 0.95f}, {0, -0.1f, 0}, 1.2f);
    const Traced image = trace(b.scene, guidedOptions(32), 64);
    EXPECT_GT(image.guideTables, 4u);
    EXPECT_EQ(image.rejected, 0u);
    EXPECT_LT(std::abs(zOf("furnace", image, 2.5, 64)), 4);
}

/** A floor of albedo p under a pane between it and a black lamp of radiance 1 over all of the sky: the pane
 * lets through T of diffuse light and throws back 1 - T, so that the floor shows p T / (1 - p (1 - T)). */
TEST(Guiding, FloorUnderGlassIsAsBrightAsTheSeriesSays) {
    // T by Simpson's rule over x = cos^2 of Fresnel's (1 - R) / (1 + R) of an index of 1.5.
    const auto through = [](double cosine) {
        const double sine2 = (1 - cosine * cosine) / 2.25, inside = std::sqrt(1 - sine2);
        const double s = (cosine - 1.5 * inside) / (cosine + 1.5 * inside);
        const double p = (inside - 1.5 * cosine) / (inside + 1.5 * cosine);
        const double r = 0.5 * (s * s + p * p);
        return (1 - r) / (1 + r);
    };
    EXPECT_NEAR(through(1), 0.923076923, 1e-9);
    double transmitted = 0;
    const int steps = 20000;
    for (int i = 0; i <= steps; ++i) {
        const double c = double(i) / steps, weight = i == 0 || i == steps ? 1 : (i % 2 != 0 ? 4 : 2);
        transmitted += weight * 2 * c * through(c) / (3.0 * steps);
    }
    const double albedo = 0.5, truth = albedo * transmitted / (1 - albedo * (1 - transmitted));
    SceneBuilder b;
    const int floor = b.material(glm::vec3(0.5f)), glass = glassOf(b),
              lamp = b.material(glm::vec3(0), glm::vec3(1));
    const float far = 3000;
    b.quad({-far, 0, far}, {far, 0, far}, {far, 0, -far}, {-far, 0, -far}, floor);
    b.quad({-far, 2, -far}, {far, 2, -far}, {far, 2, far}, {-far, 2, far}, glass);  // its underside
    b.quad({-far, 3, far}, {far, 3, far}, {far, 3, -far}, {-far, 3, -far}, glass);
    b.quad({-far, 4, -far}, {far, 4, -far}, {far, 4, far}, {-far, 4, far}, lamp);
    b.camera({0, 1, 0}, {0, 0, 0.01f}, 0.5f);
    // Photons aim at all of the pane: cells are large here, and tables say little that is true.
    const Traced image = trace(b.scene, guidedOptions(32), 256);
    EXPECT_GT(image.guideTables, 4u);
    EXPECT_LT(std::abs(zOf("under a pane", image, truth, 256)), 4);
}

/** A lamp in the middle of a ball of glass, which lights a room: nothing but rays find it. */
Scene lampInGlass(double scale, bool moves) {
    SceneBuilder b;
    const auto at = [&](float x, float y, float z) { return glm::vec3(glm::dvec3(x, y, z) * scale); };
    const int wall = b.material(glm::vec3(0.5f)), glass = glassOf(b),
              lamp = b.material(glm::vec3(0), glm::vec3(20));
    b.room(at(-1, -1, -1), at(1, 1, 1), {wall, wall, wall, wall, wall, wall});
    b.sphere(at(0, 0, 0), float(0.4 * scale), 3, false, glass);
    const int ball = b.sphere(at(0.1f, 0, 0), float(0.15 * scale), 1, false, lamp);
    b.camera(at(0, 0.6f, 0.9f), at(0, -0.2f, 0), 1.2f);
    if (moves) {
        AnimationChannel channel;
        channel.node = b.scene.instances()[std::size_t(ball) - 1].node;  // the glass
        channel.path = AnimationPath::Translation;
        channel.times = {0, 1};
        channel.values = {-0.1f, 0, 0, 0.1f, 0.1f, 0};
        b.scene.animations.emplace_back().channels.push_back(channel);
    }
    return b.scene;
}

/** The mean of paths with tables beside that of paths without. */
void expectMeanOfUnguidedPaths(const Scene& scene, const std::string& what, std::uint32_t samples) {
    PathTraceOptions o = guidedOptions(24);
    const Traced guided = trace(scene, o, samples);
    o.photonTargets = false;
    o.seed = 7;
    const Traced plain = trace(scene, o, 2 * samples);
    EXPECT_GT(guided.guideTables, 4u) << what;
    EXPECT_EQ(guided.rejected, 0u);
    EXPECT_EQ(plain.guideTables, 0u);
    const auto all = [](std::size_t) { return true; };
    const Estimate a = estimate(guided, 0, all), b = estimate(plain, 0, all);
    const double z = (a.mean - b.mean) / std::hypot(a.error, b.error);
    fmt::print("{}: guided {:.5f} +- {:.5f} ({} samples), else {:.5f} +- {:.5f} ({} samples), z {:+.2f}\n",
               what, a.mean, a.error, samples, b.mean, b.error, 2 * samples, z);
    EXPECT_LT(std::abs(z), 4) << what;
}

/** Of scenes as small and as large as floats hold well. */
TEST(Guiding, MeansAreThoseOfUnguidedPaths) {
    for (const double scale : {1e-6, 1e6})
        expectMeanOfUnguidedPaths(lampInGlass(scale, false), fmt::format("scale {}", scale), 128);
}

/** Where guided surfaces mirror too: half of the light off some, that of coats, and glossy metal. */
TEST(Guiding, SurfacesThatMirrorKeepTheirMeans) {
    Scene scene = lampInGlass(1, false);
    const Material wall = scene.materials.front();
    Material half = wall, coated = wall, glossy = wall;
    half.metallic = glossy.metallic = 0.6f;
    half.baseColor = glossy.baseColor = glm::vec4(0.8f, 0.8f, 0.8f, 1);
    half.roughness = 0;
    glossy.roughness = 0.4f;
    coated.clearcoat = 1;
    coated.specular = 1;
    coated.roughness = 0.5f;
    scene.materials.insert(scene.materials.end(), {half, coated, glossy});
    const int first = int(scene.materials.size()) - 3;
    scene.meshes[2].primitives[0].material = first;  // floor
    scene.meshes[4].primitives[0].material = first + 1;
    scene.meshes[0].primitives[0].material = first + 2;
    expectMeanOfUnguidedPaths(scene, "mirrors, coats and gloss", 64);
}

RenderOptions pictureOf(Guiding guiding) {
    RenderOptions o;
    o.size = {37, 21};  // no multiple of a tile
    o.samples = 12;
    o.seed = 3;
    o.guiding = guiding;
    return o;
}

void expectEqual(const RenderResult& a, const RenderResult& b) {
    ASSERT_EQ(a.image.data.size(), b.image.data.size());
    EXPECT_EQ(std::memcmp(a.image.data.data(), b.image.data.data(), a.image.data.size() * sizeof(float)), 0);
    EXPECT_EQ(a.rays.bounce, b.rays.bounce);
}

TEST(Guiding, GivesTheSameBitsAgain) {
    for (const bool moves : {false, true}) {
        const Scene scene = lampInGlass(1, moves);
        RenderOptions o = pictureOf(Guiding::On);
        o.samples = 40;
        if (moves) o.shutter = {0.0, 1.0};
        o.checkpointSeconds = 0;
        const RenderResult whole = renderer().render(scene, o);
        ASSERT_TRUE(whole.caustics && whole.caustics->guided);
        EXPECT_GT(whole.caustics->kept, 1000u);
        EXPECT_EQ(whole.nanCount, 0u);
        o.scheduler = Scheduler::Wavefront;
        expectEqual(renderer().render(scene, o), whole);
        // Interrupted, and taken up again by the other scheduler.
        o.checkpoint = std::filesystem::temp_directory_path() /
                       fmt::format("heliograph_guiding_{}.checkpoint", getpid());
        std::filesystem::remove(o.checkpoint);
        o.progress = [](const Progress& p) { return p.stage != "render" || p.fraction < 0.05; };
        EXPECT_LT(renderer().render(scene, o).rays.camera, whole.rays.camera);
        o.progress = {};
        o.resume = true;
        o.scheduler = Scheduler::Megakernel;
        expectEqual(renderer().render(scene, o), whole);
        std::filesystem::remove(o.checkpoint);
    }
    // However many turns a dispatch takes.
    PathTraceOptions o = guidedOptions(21);
    const Traced whole = trace(lampInGlass(1, false), o, 4);
    o.turnBudget = 7;
    const Traced parts = trace(lampInGlass(1, false), o, 4);
    EXPECT_TRUE(parts.mean == whole.mean);
}

/** Where nothing could be guided there are no photons, and the bits are those of paths without. */
TEST(Guiding, IsAbsentWhereItCannotHelp) {
    SceneBuilder mirrorless;
    const int wall = mirrorless.material(glm::vec3(0.5f)),
              lamp = mirrorless.material(glm::vec3(0), glm::vec3(1));
    mirrorless.room({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, lamp, wall, wall});
    mirrorless.camera({0, 0, 0.9f}, {0, 0, 0}, 1);
    Scene spot = lampInGlass(1, false);  // only a light that no ray finds
    for (Material& m : spot.materials) m.emission = glm::vec3(0);
    SceneBuilder lit;
    lit.scene = spot;
    lit.pointLight({0, 0.8f, 0}, glm::vec3(1));
    for (const Scene& scene : {mirrorless.scene, lit.scene}) {
        const RenderResult on = renderer().render(scene, pictureOf(Guiding::On));
        EXPECT_FALSE(on.caustics);
        expectEqual(renderer().render(scene, pictureOf(Guiding::Off)), on);
    }
    // Small pictures are done before photons would pay.
    EXPECT_FALSE(renderer().render(lampInGlass(1, false), pictureOf(Guiding::Auto)).caustics);
    RenderOptions direct = pictureOf(Guiding::On);
    direct.maxDepth = 1;
    EXPECT_FALSE(renderer().render(lampInGlass(1, false), direct).caustics);
}

PhotonRecord photonAt(const glm::vec3& position, const glm::vec3& direction) {
    return {position, 1, glm::normalize(direction), 2, {0, 1, 0}, 1, 1};
}

TEST(GuideTables, HoldWhatPhotonsSay) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(guideTables({}, 0.2f).empty());
    // Photons of no use: too few, of no flux, or of numbers that are none.
    std::vector<PhotonRecord> photons(7, photonAt({1, 2, 3}, {0, 1, 0}));
    photons.resize(20, {});
    for (const float bad : {nan, infinite}) {
        photons.push_back(photonAt({bad, 0, 0}, {0, 1, 0}));
        photons.push_back(photonAt({0, 0, 0}, {0, 1, 0}));
        photons.back().flux = bad;
    }
    EXPECT_TRUE(guideTables(photons, 0.2f).empty());

    // All in one place, along one direction: one table, whose chances lie in the bins around.
    photons.assign(100, photonAt({1e6f, -2, 3}, {0.1f, 1, 0.2f}));
    const GuideTables one = guideTables(photons, 0.25f);
    ASSERT_EQ(one.tables, 1u);
    ASSERT_EQ(one.texels.size(), std::size_t(1) << kGuideBits);
    double sum = 0;
    int bins = 0;
    for (const glm::uvec4& texel : one.texels) {
        sum += double(glm::uintBitsToFloat(texel.z));
        bins += glm::uintBitsToFloat(texel.z) > 0 ? 1 : 0;
        EXPECT_EQ(texel.w, one.texels[texel.y].z);
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_LE(bins, 4);
    int guided = 0;
    for (const glm::uvec4& cell : one.cells) guided += glm::uintBitsToFloat(cell.z) == 0.25f ? 1 : 0;
    EXPECT_EQ(guided, 1);

    // Over a floor, all from one point above it: the depth of that point is found, and cells are bounded.
    photons.clear();
    for (int i = 0; i < 100; ++i)
        for (int k = 0; k < 100; ++k) {
            const glm::vec3 p(0.1f * float(i), 0, 0.1f * float(k));
            photons.push_back(photonAt(p, glm::vec3(5, 2, 5) - p));
            photons.back().distance = glm::length(glm::vec3(5, 2, 5) - p);
        }
    const GuideTables many = guideTables(photons, 0.2f);
    EXPECT_GE(many.tables, 16u);
    EXPECT_LE(many.tables, kMostGuideTables);
    EXPECT_EQ(many.size, glm::ivec3(64, 1, 64));
    for (const glm::uvec4& cell : many.cells) EXPECT_LE(cell.x + (1u << kGuideBits), many.texels.size());
    // The same photons give the same tables.
    EXPECT_EQ(guideTables(photons, 0.2f).texels, many.texels);
}

/** What is seen from a cell's centre, and the other way: w' - offset is along w. */
TEST(GuideTables, DirectionsAndBack) {
    for (const double length : {0.0, 0.3, 0.7})
        for (int i = 0; i < 50; ++i) {
            const double a = 0.7 * i, z = std::cos(1.3 * i), r = std::sqrt(1 - z * z);
            const glm::dvec3 w(r * std::cos(a), r * std::sin(a), z), offset(0, length * 0.6, -length * 0.8);
            const glm::dvec3 seen = seenFromCentre(w, offset);
            EXPECT_NEAR(glm::length(seen), 1, 1e-12);
            EXPECT_NEAR(glm::length(glm::normalize(seen - offset) - w), 0, 1e-12);
        }
}

}  // namespace
}  // namespace helio::test
