// Both pipelines see the same triangle at the centre of every pixel that is more than 1/64 pixel from every
// projected edge of either triangle (the contract's rule), on the samples and on assets where they are
// present.
#include "passes/raster/view.hpp"
#include "tests/support/device.hpp"

#include <heliograph/pose.hpp>
#include <heliograph/renderer.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace helio {
namespace {

/** A scene's triangles in the plane of the image. */
class Projection {
public:
    Projection(const Scene& scene, const RenderOptions& options)
        : scene_(scene), instances_(scene.instances()) {
        Scene framed = scene;
        const auto [width, height] = options.size;
        const PlacedCamera placed = chooseCamera(framed, options.camera, double(width) / height);
        view_ = makeRasterView(placed.transform, framed.cameras[std::size_t(placed.camera)], options.size);
    }

    /** Distance in pixels from a point to the nearest edge of a triangle, cut just before the eye. Infinite
     * for a miss. */
    double edgeDistance(int instance, int triangle, glm::dvec2 point) const {
        if (instance < 0) return std::numeric_limits<double>::infinity();
        glm::dvec3 corners[3];
        for (int k = 0; k < 3; ++k) corners[k] = homogeneous(instances_[std::size_t(instance)], triangle, k);
        double nearest = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 a = corners[k], b = corners[(k + 1) % 3];
            const double eye = 1e-9 * std::max({std::abs(a.z), std::abs(b.z), 1e-30});
            if (a.z < eye && b.z < eye) continue;
            if (a.z < eye) a += (b - a) * ((eye - a.z) / (b.z - a.z));
            if (b.z < eye) b += (a - b) * ((eye - b.z) / (a.z - b.z));
            const glm::dvec2 p = glm::dvec2(a) / a.z, q = glm::dvec2(b) / b.z;
            const double length2 = glm::dot(q - p, q - p);
            const double along = length2 > 0 ? std::clamp(glm::dot(point - p, q - p) / length2, 0.0, 1.0) : 0;
            nearest = std::min(nearest, glm::length(p + along * (q - p) - point));
        }
        return nearest;
    }

private:
    glm::dvec3 homogeneous(const Instance& instance, int triangle, int corner) const {
        std::size_t at = std::size_t(triangle) * 3 + std::size_t(corner);
        for (const Primitive& primitive : scene_.meshes[std::size_t(instance.mesh)].primitives) {
            if (at >= primitive.indices.size()) {
                at -= primitive.indices.size();
                continue;
            }
            // Kernels see positions rounded to float.
            const glm::vec3 world(instance.transform *
                                  glm::dvec4(primitive.positions[primitive.indices[at]], 1));
            const glm::dvec3 d = glm::dvec3(world) - view_.eye;
            return {glm::dot(view_.rowX, d), glm::dot(view_.rowY, d), glm::dot(view_.rowW, d)};
        }
        ADD_FAILURE() << "no triangle " << triangle << " in mesh " << instance.mesh;
        return {};
    }

    const Scene& scene_;
    std::vector<Instance> instances_;
    RasterView view_;
};

void expectAgreement(Renderer& renderer, const Scene& scene, std::array<std::uint32_t, 2> size) {
    RenderOptions options;
    options.size = size;
    options.samples = 1;
    const ImageF path = renderer.render(scene, options).image;
    options.pipeline = Pipeline::Raster;
    const ImageF raster = renderer.render(scene, options).image;
    const Projection projection(scene, options);
    const auto id = [](const ImageF& image, std::uint32_t x, std::uint32_t y, const char* channel) {
        return int(image.at(x, y, std::size_t(image.channel(channel))));
    };
    int hits = 0, wrong = 0, nearEdges = 0;
    for (std::uint32_t y = 0; y < size[1]; ++y) {
        for (std::uint32_t x = 0; x < size[0]; ++x) {
            const int instances[2] = {id(path, x, y, "id.instance"), id(raster, x, y, "id.instance")};
            const int triangles[2] = {id(path, x, y, "id.triangle"), id(raster, x, y, "id.triangle")};
            hits += instances[0] >= 0;
            if (instances[0] == instances[1] && triangles[0] == triangles[1]) {
                const float depths[2] = {path.at(x, y, std::size_t(path.channel("depth.Z"))),
                                         raster.at(x, y, std::size_t(raster.channel("depth.Z")))};
                EXPECT_NEAR(depths[0], depths[1], 1e-4f * std::abs(depths[0])) << x << ", " << y;
                continue;
            }
            double nearest = std::numeric_limits<double>::infinity();
            for (int k = 0; k < 2; ++k) {
                nearest = std::min(nearest,
                                   projection.edgeDistance(instances[k], triangles[k], {x + 0.5, y + 0.5}));
            }
            if (nearest <= 1.0 / 64) {
                ++nearEdges;
                continue;
            }
            if (++wrong <= 5) {
                ADD_FAILURE() << scene.name << ": pixel " << x << ", " << y << ": path " << instances[0]
                              << "/" << triangles[0] << ", raster " << instances[1] << "/" << triangles[1]
                              << ", nearest edge " << nearest << " pixels";
            }
        }
    }
    EXPECT_EQ(wrong, 0) << scene.name;
    EXPECT_GT(hits, 100) << scene.name << " shows next to nothing";
    EXPECT_LT(nearEdges, hits / 20) << scene.name;
    std::printf("%s: %d pixels with a hit, %d differ within 1/64 pixel of an edge\n", scene.name.c_str(),
                hits, nearEdges);
}

TEST(PipelineAgreement, OfIdsOnTheSamples) {
    Renderer renderer(test::deviceOptions());
    for (const char* name :
         {"cornell", "gallery", "instances", "lenses", "plates", "shading", "terrain", "wheel"})
        expectAgreement(renderer, load(std::string("sample:") + name), {160, 120});
}

void expectAgreementOnAsset(const char* name) {
    const std::filesystem::path file =
        std::filesystem::path(HELIOGRAPH_SHARED_DIR) / "assets" / "gltf" / name;
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "left out: " << name << " is not in " HELIOGRAPH_SHARED_DIR;
    Renderer renderer(test::deviceOptions());
    expectAgreement(renderer, posed(load(file.string()), 0.5), {240, 180});
}

TEST(PipelineAgreement, OfIdsOnFlightHelmet) {
    expectAgreementOnAsset("FlightHelmet/FlightHelmet.gltf");
}
TEST(PipelineAgreement, OfIdsOnFox) {
    expectAgreementOnAsset("Fox.glb");
}
TEST(PipelineAgreement, OfIdsOnMorphStressTest) {
    expectAgreementOnAsset("MorphStressTest.gltf");
}

}  // namespace
}  // namespace helio
