/** @file
 * Both pipelines agree on what each pixel's centre meets, wherever it is more than 1/64 pixel from every
 * projected edge of either triangle; on built-in samples and on real assets.
 */
#include "passes/film/film.hpp"
#include "passes/pathtrace/path_tracer.hpp"
#include "tests/accuracy/shade_runner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>

namespace helio::test {
namespace {

constexpr std::array<std::uint32_t, 2> kSize = {280, 210};

FirstHits firstHits(const Scene& scene, const PlacedCamera& camera) {
    const PathTraceOptions options{.size = kSize, .maxDepth = 0};
    DeviceScene uploaded(device(), scene, PathTracer::packOptions(scene, options));
    Film film(device(), kSize[0], kSize[1]);
    return PathTracer(device(), uploaded, scene.cameras[std::size_t(camera.camera)], camera.transform,
                      options, film)
        .firstHits();
}

/** Distance in pixels from a centre to the nearest projected edge of a triangle (3 texels of PackedScene). */
double edgeDistance(const RasterView& view, const glm::vec4* corners, glm::dvec2 centre) {
    glm::dvec3 p[3];
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 d = glm::dvec3(corners[k]) - view.eye;
        p[k] = {glm::dot(view.rowX, d), glm::dot(view.rowY, d), glm::dot(view.rowW, d)};
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 a = p[k], b = p[(k + 1) % 3];
        const double eye = view.depthOffset;
        if (a.z < eye && b.z < eye) continue;
        if (a.z < eye) a += (b - a) * ((eye - a.z) / (b.z - a.z));
        if (b.z < eye) b += (a - b) * ((eye - b.z) / (a.z - b.z));
        const glm::dvec2 from = glm::dvec2(a) / a.z, to = glm::dvec2(b) / b.z;
        const double squared = glm::dot(to - from, to - from);
        const double along =
            squared > 0 ? std::clamp(glm::dot(centre - from, to - from) / squared, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(from + along * (to - from) - centre));
    }
    return nearest;
}

void expectAgreement(Scene scene) {
    const PlacedCamera placed = chooseCamera(scene, "", double(kSize[0]) / kSize[1]);
    const RasterView view =
        makeRasterView(placed.transform, scene.cameras[std::size_t(placed.camera)], kSize);
    const ShadedImage raster = shade(scene, view);
    const FirstHits rays = firstHits(scene, placed);
    const PackedScene packed = packScene(scene, {.tree = false});

    std::uint64_t hits = 0, different = 0, wrong = 0, normals = 0;
    double depthError = 0, albedoError = 0;
    std::string first;
    for (std::size_t i = 0; i < raster.ids.size(); ++i) {
        const glm::ivec2 drawn = raster.ids[i], seen(rays.instance[i], rays.triangle[i]);
        hits += seen.x >= 0;
        if (drawn == seen) {
            if (seen.x < 0) continue;
            depthError =
                std::max(depthError, std::abs(double(raster.albedoDepth[i].w) / rays.depth[i] - 1.0));
            for (int c = 0; c < 3 && !packed.baseColorTextures && !packed.solidTextures; ++c)
                albedoError =
                    std::max(albedoError, double(std::abs(raster.albedoDepth[i][c] - rays.albedo[i][c])));
            normals += glm::dot(glm::vec3(raster.normal[i]), rays.normal[i]) < 0.9999f;
            continue;
        }
        ++different;
        const glm::dvec2 centre(double(i % kSize[0]) + 0.5, double(i / kSize[0]) + 0.5);
        double edge = std::numeric_limits<double>::infinity();
        for (const glm::ivec2& id : {drawn, seen})
            if (id.x >= 0)
                edge = std::min(
                    edge,
                    edgeDistance(
                        view,
                        &packed.triangles[3 * (packed.instanceFirst[std::size_t(id.x)] + std::size_t(id.y))],
                        centre));
        if (edge > 1.0 / 64.0) {
            ++wrong;
            if (first.empty())
                first = "pixel " + std::to_string(i % kSize[0]) + ", " + std::to_string(i / kSize[0]) +
                        ": drawn " + std::to_string(drawn.x) + "/" + std::to_string(drawn.y) + ", ray " +
                        std::to_string(seen.x) + "/" + std::to_string(seen.y) + ", " + std::to_string(edge) +
                        " pixels from an edge";
        }
    }
    std::printf(
        "             %u triangles, %zu pixels, %llu hit, %llu differ at edges, %llu elsewhere; depth off by "
        "%.1e, albedo by %.1e, %llu normals\n",
        packed.triangleCount, raster.ids.size(), (unsigned long long)hits,
        (unsigned long long)(different - wrong), (unsigned long long)wrong, depthError, albedoError,
        (unsigned long long)normals);
    EXPECT_EQ(wrong, 0u) << first;
    EXPECT_GT(hits, raster.ids.size() / 50);
    EXPECT_LT(depthError, 1e-4);
    EXPECT_LT(albedoError, 1e-5);
    EXPECT_LT(normals, raster.ids.size() / 1000);
}

TEST(PipelineAgreement, Samples) {
    for (const std::string& name : sampleNames()) {
        SCOPED_TRACE(name);
        std::printf("             %s\n", name.c_str());
        expectAgreement(load("sample:" + name));
    }
}

TEST(PipelineAgreement, CornellBoxAtOtherScales) {
    for (const double scale : {1e-3, 1e3}) {
        SCOPED_TRACE(scale);
        Scene scene = load("sample:cornell");
        for (const int root : std::vector<int>(scene.roots)) {
            Node& node = scene.nodes[std::size_t(root)];
            node.matrix = glm::mat4(glm::dmat4(glm::dvec4(scale, 0, 0, 0), glm::dvec4(0, scale, 0, 0),
                                               glm::dvec4(0, 0, scale, 0), glm::dvec4(0, 0, 0, 1)) *
                                    node.localTransform());
        }
        expectAgreement(scene);
    }
}

void expectAssetAgreement(const char* name) {
    const std::filesystem::path file =
        std::filesystem::path(HELIOGRAPH_SHARED_DIR) / "assets" / "gltf" / name;
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "left out: " << name << " is not in " HELIOGRAPH_SHARED_DIR;
    expectAgreement(load(file.string()));
}

TEST(PipelineAgreement, FlightHelmet) {
    expectAssetAgreement("FlightHelmet/FlightHelmet.gltf");
}
TEST(PipelineAgreement, Fox) {
    expectAssetAgreement("Fox.glb");
}

}  // namespace
}  // namespace helio::test
