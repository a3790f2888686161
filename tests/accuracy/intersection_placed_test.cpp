// Meshes packed once and placed many times give the hits of the flattened scene, bit by bit.
#include "tests/accuracy/intersection_support.hpp"
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"
#include "tests/support/meshes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace helio::test {
namespace {

struct Random {
    std::mt19937 engine{7};
    std::uniform_real_distribution<float> uniform{-1.0f, 1.0f};
    float number() { return uniform(engine); }
    glm::vec3 point() { return {number(), number(), number()}; }
};

/** `copies` of two rough meshes under turns, uneven scales, shears and mirrors, among them two in one place
 * and one that is flat; a floor and a shape that are not placed. About `centre`, `size` large. */
Scene crowd(int copies, const glm::vec3& centre, float size, bool normals) {
    Random random;
    SceneBuilder b;
    Scene& scene = b.scene;
    const int grey = b.material(glm::vec3(0.6f)), red = b.material({0.7f, 0.2f, 0.1f});
    std::vector<glm::vec3> rough = octasphere(4), stalks = landscape(400);
    for (glm::vec3& p : rough) p *= 1.0f + 0.2f * std::sin(9.0f * p.x) * std::sin(7.0f * p.y);
    b.triangles(rough, red);
    b.triangles(stalks, grey);
    scene.nodes.clear();
    scene.roots.clear();
    if (normals)
        for (auto& mesh : scene.meshes)
            for (Primitive& p : mesh.primitives)
                for (const glm::vec3& at : p.positions)
                    p.normals.push_back(glm::normalize(at + glm::vec3(0, 0.01f, 0)));
    const auto add = [&](int mesh, const glm::mat4& matrix) {
        Node node;
        node.mesh = mesh;
        node.matrix = matrix;
        scene.nodes.push_back(node);
        scene.roots.push_back(int(scene.nodes.size()) - 1);
    };
    const glm::mat4 whole = glm::scale(glm::translate(glm::mat4(1.0f), centre), glm::vec3(size));
    for (int i = 0; i < copies; ++i) {
        glm::mat4 matrix = glm::translate(glm::mat4(1.0f), random.point());
        matrix = glm::rotate(matrix, 3.0f * random.number(), random.point() + glm::vec3(0, 0, 0.01f));
        glm::vec3 scale = glm::exp(random.point() - 2.5f);
        if (i % 3 == 1) scale.x = -scale.x;
        if (i % 50 == 7) scale.z = 0;
        matrix = glm::scale(matrix, scale * (i % 2 == 0 ? 1.0f : 0.1f));
        if (i % 4 == 2) matrix[0] += 0.5f * matrix[1];
        add(i % 2, whole * matrix);
        if (i % 40 == 11) add(i % 2, whole * matrix);
    }
    b.quad({-2, -1, -2}, {-2, -1, 2}, {2, -1, 2}, {2, -1, -2}, grey);
    scene.nodes.back().matrix = whole;
    for (int mesh : {2, 2}) add(mesh, glm::translate(whole, {0.1f, 0.05f, 0.1f * float(mesh)}));
    return scene;
}

/** What a slot is: instance and triangle of the mesh. */
std::array<std::uint32_t, 2> identity(const PackedScene& packed, std::int32_t slot) {
    if (slot < 0) return {~0u, ~0u};
    std::size_t place = std::size_t(slot);
    std::uint32_t instance = 0;
    if (std::uint32_t(slot) >= packed.triangleCount) {
        const std::size_t row =
            ((std::uint32_t(slot) - packed.triangleCount) >> packed.placedBits) * kPlacedTexels;
        place = std::size_t(std::uint32_t(slot) - packed.placed[row + 7].w);
        instance = packed.placed[row + 8].w;
    } else {
        instance = glm::floatBitsToUint(packed.triangles[place * 3 + 1].w);
    }
    return {instance, glm::floatBitsToUint(packed.triangles[place * 3].w) - packed.instanceFirst[instance]};
}

std::vector<RayHit> hitsOf(const PackedScene& packed, RayQuestion question, const std::vector<Ray>& rays) {
    RayIntersector intersector(device(), packed, question, rays.size());
    intersector.upload(rays);
    intersector.run();
    EXPECT_EQ(intersector.abandoned(), 0u);
    return intersector.hits();
}

void expectSameHits(const Scene& scene, const char* what, bool leaving = true) {
    SCOPED_TRACE(what);
    const PackedScene flat = packScene(scene), placed = packScene(scene, {.placing = Placing::Always});
    ASSERT_TRUE(flat.placed.empty());
    ASSERT_GT(placed.placed.size(), 20 * kPlacedTexels);
    ASSERT_LT(placed.triangles.size() * 3 / 2, flat.triangles.size());
    Random random;
    glm::vec3 lower(flat.triangles[0]), upper = lower;
    for (const glm::vec4& p : flat.triangles) {
        lower = glm::min(lower, glm::vec3(p));
        upper = glm::max(upper, glm::vec3(p));
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 50000; ++i) {
        const glm::vec3 origin = 0.5f * (lower + upper) + 0.7f * (upper - lower) * random.point();
        glm::vec3 direction = glm::vec3(flat.triangles[random.engine() % flat.triangles.size()]) - origin;
        if (i % 4 == 1) direction = random.point();
        if (i % 8 == 2) direction = glm::vec3(0), direction[i / 8 % 3] = i % 16 == 2 ? 1.0f : -1.0f;
        rays.push_back({.origin = origin,
                        .limit = i % 5 == 0 ? 0.9f : std::numeric_limits<float>::infinity(),
                        .direction = direction});
    }
    std::size_t found = 0, ofPlaced = 0, wrong = 0;
    const std::vector<RayHit> wanted = hitsOf(flat, RayQuestion::Closest, rays),
                              hits = hitsOf(placed, RayQuestion::Closest, rays);
    std::vector<Ray> leavingFlat, leavingPlaced;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        found += wanted[i].slot >= 0 ? 1 : 0;
        ofPlaced += hits[i].slot >= int(placed.triangleCount) ? 1 : 0;
        wrong += identity(flat, wanted[i].slot) != identity(placed, hits[i].slot) ||
                         wanted[i].distance != hits[i].distance
                     ? 1
                     : 0;
        if (wanted[i].slot < 0 || hits[i].slot < 0) continue;
        Ray next{.origin = rays[i].origin + wanted[i].distance * rays[i].direction,
                 .direction = random.point()};
        next.source = wanted[i].slot;
        leavingFlat.push_back(next);
        next.source = hits[i].slot;
        leavingPlaced.push_back(next);
    }
    fmt::print("{}: {} of {} rays meet something, {} a placed mesh; {} triangles held for {}\n", what, found,
               rays.size(), ofPlaced, placed.triangles.size() / 3, flat.triangles.size() / 3);
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(ofPlaced, 10000u);
    EXPECT_LT(found, 45000u);
    wrong = 0;
    const std::vector<RayHit> any = hitsOf(flat, RayQuestion::Any, rays),
                              placedAny = hitsOf(placed, RayQuestion::Any, rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        wrong += (any[i].slot < 0) != (placedAny[i].slot < 0) ? 1 : 0;
    EXPECT_EQ(wrong, 0u) << "any";
    if (!leaving) return;
    wrong = 0;
    const std::vector<RayHit> left = hitsOf(flat, RayQuestion::Closest, leavingFlat),
                              placedLeft = hitsOf(placed, RayQuestion::Closest, leavingPlaced);
    for (std::size_t i = 0; i < left.size(); ++i)
        wrong += identity(flat, left[i].slot) != identity(placed, placedLeft[i].slot) ||
                         left[i].distance != placedLeft[i].distance
                     ? 1
                     : 0;
    EXPECT_EQ(wrong, 0u) << "leaving";
}

TEST(Placed, HitsAreThoseOfTheFlattenedScene) {
    expectSameHits(crowd(150, glm::vec3(0), 1, false), "about the origin");
    expectSameHits(crowd(150, {300, -2000, 500}, 1, false), "2000 sizes away");
    expectSameHits(crowd(150, glm::vec3(2e-6f), 1e-6f, false), "a millionth");
    // Another mesh with the same triangles in the same places: the first instance is met.
    Scene twice = crowd(60, glm::vec3(0), 1, false);
    twice.meshes.push_back(twice.meshes[0]);
    for (std::size_t i = 0; i < 30; ++i) {
        Node node = twice.nodes[i];
        if (node.mesh == 0) node.mesh = int(twice.meshes.size()) - 1;
        twice.nodes.push_back(node);
        twice.roots.push_back(int(twice.nodes.size()) - 1);
    }
    expectSameHits(twice, "ties", false);
}

/** The pictures too, but for shading normals, which are turned in another precision. */
TEST(Placed, PicturesAreThoseOfTheFlattenedScene) {
    for (const bool normals : {false, true}) {
        SceneBuilder b;
        b.scene = crowd(normals ? 60 : 150, glm::vec3(0), 1, normals);
        if (!normals) {  // a volume, which goes by the surface that a ray left, and slots beyond 2^24
            Material& glass = b.scene.materials[1];
            glass.specular = glass.transmission = glass.thickness = 1;
            glass.roughness = 0;
            glass.attenuationDistance = 0.05f;
            glass.attenuationColor = {0.9f, 0.4f, 0.2f};
            const int ball = b.triangles(octasphere(7), 0);
            Node again = b.scene.nodes[std::size_t(b.scene.roots[std::size_t(ball)])];
            again.translation = {0, -4, 0};
            b.scene.nodes.push_back(again);
            b.scene.roots.push_back(int(b.scene.nodes.size()) - 1);
        }
        b.camera({0, 0.3f, 2.5f}, {0, 0, 0}, 0.8f);
        const int lamp = b.material(glm::vec3(0.1f), glm::vec3(9));
        for (const float x : {-0.8f, 0.0f, 0.8f})
            b.quad({x, 1.4f, 0}, {x + 0.2f, 1.4f, 0}, {x + 0.2f, 1.4f, 0.2f}, {x, 1.4f, 0.2f}, lamp);
        PathTraceOptions options = independentOptions(24, 4);
        options.lights = LightChoice::Power;  // tables go by some places in each mesh
        options.placing = Placing::Flatten;
        const Traced flat = trace(b.scene, options, 2);
        options.placing = Placing::Always;
        options.turnBudget = 200;  // paths are kept between dispatches
        const Traced placed = trace(b.scene, options, 2);
        EXPECT_EQ(flat.hits.instance, placed.hits.instance);
        EXPECT_EQ(flat.hits.triangle, placed.hits.triangle);
        EXPECT_EQ(flat.hits.depth, placed.hits.depth);
        double worst = 0;
        std::size_t differing = 0;
        for (std::size_t i = 0; i < flat.mean.size(); ++i) {
            const double difference =
                glm::length(flat.mean[i] - placed.mean[i]) / (1e-3 + glm::length(flat.mean[i]));
            worst = std::max(worst, difference);
            differing += difference > 1e-4 ? 1 : 0;
            EXPECT_LT(glm::length(flat.hits.normal[i] - placed.hits.normal[i]), normals ? 1e-5f : 1e-30f);
        }
        fmt::print("{} normals: worst difference {:.1e}, {} of {} pixels differ\n",
                   normals ? "with" : "without", worst, differing, flat.mean.size());
        if (normals)
            EXPECT_LT(differing, 30u);  // bounces may part
        else
            EXPECT_EQ(worst, 0.0);
        options.scheduler = Scheduler::Wavefront;
        if (!normals) {
            EXPECT_EQ(trace(b.scene, options, 2).mean, flat.mean);
        }
        EXPECT_EQ(flat.rejected, 0u);
    }
}

/** What is not placed, and that few savings are not worth it. */
TEST(Placed, MeshesArePlacedWhereThatSaves) {
    const auto placements = [](const Scene& scene, Placing placing) {
        return packScene(scene, {.placing = placing}).placed.size() / kPlacedTexels;
    };
    Scene scene = crowd(50, glm::vec3(0), 1, false);
    // Of 50, and 1 more in the place of another, 1 is flat; and two floors, that one in the place of the
    // other.
    EXPECT_EQ(placements(scene, Placing::Always), 48u + 1u);
    EXPECT_EQ(placements(scene, Placing::WhereItSaves), 0u);
    EXPECT_EQ(placements(scene, Placing::Flatten), 0u);
    EXPECT_EQ(placements(crowd(50, {1e6f, 2e6f, 0}, 1, false), Placing::Always), 0u);
    scene.materials[1].emission = glm::vec3(1);  // of half of the meshes
    EXPECT_EQ(placements(scene, Placing::Always), 23u + 1u);
    scene.materials[0].emission = glm::vec3(1);
    EXPECT_EQ(placements(scene, Placing::Always), 0u);

    Scene many = crowd(2, glm::vec3(0), 1, false);
    Node& node = many.nodes[0];
    for (int i = 0; i < 20000; ++i) {
        Placement at;
        at.translation = {float(i % 100), 0, float(i / 100)};
        node.copies.push_back(at);
    }
    const PackedScene packed = packScene(many, {.placing = Placing::WhereItSaves});
    EXPECT_EQ(packed.placed.size() / kPlacedTexels, 20000u);
    EXPECT_EQ(packed.instanceFirst.size(), many.instances().size() + 1);
    EXPECT_LT(packed.bytes(), 10u << 20);
    EXPECT_THROW(packScene(many), InputError);
}

}  // namespace
}  // namespace helio::test
