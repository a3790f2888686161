#include "tests/stability/sweep_list.hpp"

#include "tests/accuracy/path_scenes.hpp"
#include "tests/stability/measure.hpp"
#include "tests/stability/variants.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace helio::test {
namespace {

Renderer& renderer() {
    static Renderer shared;
    return shared;
}

Outcome against(const RenderResult& result, double truth) {
    const Mean mean = meanOf(result.image);
    Outcome outcome;
    outcome.error = std::abs(mean.value - truth) / truth;
    if (result.nanCount > 0) outcome.error = INFINITY;
    outcome.noise = mean.error / truth;
    outcome.warned = !result.warnings.empty();
    return outcome;
}

Outcome known(const KnownScene& scene, std::uint32_t samples = 1024) {
    return against(renderer().render(scene.scene, independentSamples(8, samples)), scene.truth);
}

/** The box sample under a change that must not show, against itself: same samples, so that noise is small;
 * or, where the change asks for other samples, beside the noise of both. */
Outcome unchanged(const Scene& changed, Pipeline pipeline, bool sameSamples = true) {
    RenderOptions options = independentSamples(24, 64, pipeline);
    static const RenderResult truths[] = {
        renderer().render(load("sample:cornell"), independentSamples(24, 64, Pipeline::Path)),
        renderer().render(load("sample:cornell"), independentSamples(24, 64, Pipeline::Raster))};
    const RenderResult result = renderer().render(changed, options);
    Outcome outcome = against(result, meanOf(truths[int(pipeline)].image).value);
    outcome.noise = sameSamples ? 0 : std::sqrt(2.0) * outcome.noise;
    return outcome;
}

std::vector<double> powers(double base, int first, int last, int step = 1) {
    std::vector<double> values;
    for (int k = first; k <= last; k += step) values.push_back(std::pow(base, k));
    return values;
}

Scene moved(double sizes, bool inVertices) {
    const float distance = float(sizes * 550);
    const Scene scene = load("sample:cornell");
    const Scene far =
        transformed(scene, glm::translate(glm::mat4(1.0f), glm::vec3(distance, -distance, 0.5f * distance)));
    return inVertices ? baked(far) : far;
}

/** A card near on the left, another far on the right, their distances 1 / sqrt(ratio) and sqrt(ratio): the
 * share of pixels that do not show their card. */
Outcome nearAndFar(double ratio, Pipeline pipeline) {
    const float near = float(1 / std::sqrt(ratio)), far = float(std::sqrt(ratio));
    SceneBuilder b;
    const int first = b.material(glm::vec3(0.0f), glm::vec3(1.0f)),
              second = b.material(glm::vec3(0.0f), glm::vec3(2.0f));
    b.quad({-near, -near, -near}, {0, -near, -near}, {0, near, -near}, {-near, near, -near}, first);
    b.quad({-far, -far, -far * 1.0001f}, {far, -far, -far * 1.0001f}, {far, far, -far * 1.0001f},
           {-far, far, -far * 1.0001f}, second);
    b.camera({0, 0, 0}, {0, 0, -1}, 1.5f);
    b.scene.cameras[0].znear = 0.1f * near;
    RenderOptions options = independentSamples(16, 4, pipeline);
    const RenderResult result = renderer().render(b.scene, options);
    Outcome outcome;
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x)
            outcome.error += result.image.at(x, y, 0) == (x < 8 ? 1.0f : 2.0f) ? 0 : 1.0 / 256;
    outcome.warned = !result.warnings.empty();
    return outcome;
}

/** What a white metal under a sky of 1 shows above 1: no roughness may make light. */
Outcome gained(double roughness) {
    Outcome outcome = known(metalBall(float(roughness)), 256);
    const KnownScene scene = metalBall(float(roughness));
    const Mean mean = meanOf(renderer().render(scene.scene, independentSamples(8, 256)).image);
    outcome.error = std::max(mean.value - 1, 0.0);
    return outcome;
}

/** A closed room of albedo 0.99 whose paths end after so many scatterings: the series ends there too. */
Outcome cutShort(double depth) {
    constexpr double albedo = 0.99f;
    RenderOptions options = independentSamples(8, 64);
    options.maxDepth = std::int64_t(depth);
    return against(renderer().render(furnace(float(albedo)).scene, options),
                   (1 - std::pow(albedo, depth + 1)) / (1 - albedo));
}

/** Many samples of one pixel: error beyond their noise is that of adding them up. */
Outcome accumulated(double samples) {
    const KnownScene scene = squareLight(1);
    return against(renderer().render(scene.scene, independentSamples(1, std::uint32_t(samples))),
                   scene.truth);
}

/** A closed room seen so near a wall by a camera that looks along the wall. */
Outcome nearWall(double distance) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.5f), glm::vec3(1.0f));
    b.room({-1, 0, -1}, {1, 2, 1}, {wall, wall, wall, wall, wall, wall});
    b.camera({0, float(distance), 0}, {0.5f, float(distance), -1}, 1.0f);
    return known({b.scene, 2}, 64);
}

Outcome copies(double count, Pipeline pipeline) {
    Scene scene = load("sample:cornell");
    for (double there = 1; there < count; there *= 2) scene = doubled(scene);
    return unchanged(scene, pipeline, pipeline == Pipeline::Raster);
}

/** A wall that emits what a texture of floats says. */
Outcome texture(double value, Pipeline pipeline) {
    SceneBuilder b;
    const int wall = b.material(glm::vec3(0.0f), glm::vec3(1.0f));
    const float x = float(value);
    b.scene.images = {{"values", 1, 1, std::vector<float>{x, x, x, 1}}};
    b.scene.textures = {Texture{"values", 0}};
    b.scene.materials[std::size_t(wall)].emissiveTexture.texture = 0;
    b.quad({-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, wall);
    b.scene.meshes[0].primitives[0].texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}};
    b.camera({0, 0, 0}, {0, 0, -1}, 1.0f);
    return against(renderer().render(b.scene, independentSamples(4, 4, pipeline)), value);
}

/** One row of a closed room. */
Outcome row(double pixels, bool high) {
    const KnownScene scene = furnace(0.5f);
    RenderOptions options = independentSamples(1, 16);
    options.size = {high ? 1 : std::uint32_t(pixels), high ? std::uint32_t(pixels) : 1};
    return against(renderer().render(scene.scene, options), scene.truth);
}

}  // namespace

std::vector<Sweep> sweeps() {
    const Scene cornell = load("sample:cornell");
    std::vector<Sweep> all;
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        const std::string where = pipeline == Pipeline::Path ? ", path" : ", raster";
        all.push_back({"scale of the scene" + where, 1e-6, powers(2, -60, 60, 10), [=](double factor) {
                           return unchanged(
                               transformed(cornell, glm::scale(glm::mat4(1.0f), glm::vec3(float(factor)))),
                               pipeline);
                       }});
        all.push_back({"distance from the origin by a node, in sizes" + where, 1e-3, powers(10, 0, 9),
                       [=](double sizes) { return unchanged(moved(sizes, false), pipeline); }});
        all.push_back({"distance from the origin in the vertices, in sizes" + where, 1e-2, powers(10, 0, 7),
                       [=](double sizes) { return unchanged(moved(sizes, true), pipeline); }});
        all.push_back({"ratio of far and near in one picture" + where, 1e-6, powers(10, 2, 20, 2),
                       [=](double ratio) { return nearAndFar(ratio, pipeline); }});
        all.push_back({"copies of everything in one place" + where, 1e-2, powers(2, 0, 6),
                       [=](double count) { return copies(count, pipeline); }});
        std::vector<double> emissions = powers(10, 0, 36, 4);
        emissions.push_back(1e38);
        emissions.push_back(std::numeric_limits<double>::infinity());
        all.push_back({"emission in a texture of floats" + where, 1e-5, emissions,
                       [=](double value) { return texture(value, pipeline); }});
    }
    all.push_back({"aspect of triangles", 1e-3, powers(10, 1, 7),
                   [](double aspect) { return known(slivers(aspect), 64); }});
    all.push_back({"side of a lamp at distance 1", 1e-2, powers(2, -40, 40, 5),
                   [](double side) { return known(squareLight(float(side))); }});
    all.push_back({"albedo of a closed room, 1 - x", 2e-2, powers(10, -4, -1),
                   [](double x) { return known(furnace(float(1 - x)), 256); }});
    all.push_back({"index of glass, 1 + x", 1e-2, powers(10, -8, 2),
                   [](double x) { return known(glassBall(float(1 + x))); }});
    all.push_back({"light that a rough white metal gains",
                   1e-4,
                   {0, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 1},
                   gained});
    all.push_back({"scatterings of a path at most",
                   5e-3,
                   {0, 1, 4, 16, 64, 256, 1024, 4096, 16384, 65535, 65536, 1e6, 2147483647},
                   cutShort});
    all.push_back({"samples of a pixel", 1e-5, powers(10, 1, 6), accumulated});
    all.push_back({"distance of the camera from a wall", 1e-3, powers(10, -12, 0), nearWall});
    all.push_back({"pixels of a picture of one row", 1e-3, powers(2, 0, 16, 2),
                   [](double n) { return row(n, false); }});
    all.push_back({"pixels of a picture of one column", 1e-3, powers(2, 0, 16, 2),
                   [](double n) { return row(n, true); }});
    return all;
}

}  // namespace helio::test
