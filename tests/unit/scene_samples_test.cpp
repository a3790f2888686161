#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace helio {
namespace {

TEST(Samples, UnknownNamesListTheKnown) {
    try {
        load("sample:teapot");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("cornell"), std::string::npos) << error.what();
    }
}

/** World-space triangles of the objects, by their nodes' names. */
std::map<std::string, std::vector<std::array<glm::dvec3, 3>>> trianglesByName(const Scene& scene) {
    std::map<std::string, std::vector<std::array<glm::dvec3, 3>>> result;
    for (const Instance& instance : scene.instances()) {
        auto& triangles = result[scene.nodes[std::size_t(instance.node)].name];
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives) {
            for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
                std::array<glm::dvec3, 3> corners;
                for (std::size_t k = 0; k < 3; ++k) {
                    corners[k] =
                        instance.transform * glm::dvec4(primitive.positions[primitive.indices[i + k]], 1.0);
                }
                triangles.push_back(corners);
            }
        }
    }
    return result;
}

glm::dvec3 areaVector(const std::array<glm::dvec3, 3>& t) {
    return 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
}

TEST(Cornell, HasThePublishedAreasAndFacesTheRoom) {
    const Scene scene = load("sample:cornell");
    const auto objects = trianglesByName(scene);
    ASSERT_EQ(objects.size(), 8u);
    std::map<std::string, double> area;
    for (const auto& [name, triangles] : objects) {
        const bool isBlock = name.find("block") != std::string::npos;
        glm::dvec3 inside(278, 274, 280);
        if (isBlock) {
            inside = glm::dvec3(0);
            for (const auto& t : triangles) inside += (t[0] + t[1] + t[2]) / (3.0 * double(triangles.size()));
        }
        for (const auto& t : triangles) {
            area[name] += glm::length(areaVector(t));
            const double facing = glm::dot(areaVector(t), inside - t[0]);
            EXPECT_TRUE(isBlock ? facing < 0 : facing > 0) << name;
        }
    }
    EXPECT_NEAR(area["light"], 130.0 * 105, 1e-6);
    EXPECT_NEAR(area["ceiling"] + area["light"], 556 * 559.2, 0.1);
    EXPECT_NEAR(area["floor"], (552.8 + 549.6) / 2 * 559.2, 0.1);
    EXPECT_NEAR(area["right wall"], 548.8 * 559.2, 0.1);
    EXPECT_EQ(scene.triangleCount(), 2u + 8 + 2 + 2 + 2 + 2 + 10 + 10);
}

TEST(Cornell, IsClosedExceptForItsFront) {
    // The boundary of the room's surface is the loop of the open front: every edge inside it is shared. Edges
    // of walls meet pairwise though the room is not quite a box.
    const auto objects = trianglesByName(load("sample:cornell"));
    std::map<std::pair<std::array<double, 3>, std::array<double, 3>>, int> edges;
    for (const auto& [name, triangles] : objects) {
        if (name.find("block") != std::string::npos) continue;
        for (const auto& t : triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec3 a = t[k], b = t[(k + 1) % 3];
                ++edges[{{a.x, a.y, a.z}, {b.x, b.y, b.z}}];
            }
        }
    }
    int open = 0;
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        if (edges.contains({edge.second, edge.first})) continue;
        EXPECT_EQ(edge.first[2], 0);
        EXPECT_EQ(edge.second[2], 0);
        ++open;
    }
    EXPECT_EQ(open, 4);
}

TEST(Cornell, IsSeenByThePublishedCamera) {
    Scene scene = load("sample:cornell");
    const PlacedCamera placed = chooseCamera(scene, "");
    EXPECT_EQ(glm::dvec3(placed.transform[3]), glm::dvec3(278, 273, -800));
    EXPECT_EQ(glm::dvec3(placed.transform[2]), glm::dvec3(0, 0, -1));  // looks along +Z
    EXPECT_EQ(glm::dvec3(placed.transform[1]), glm::dvec3(0, 1, 0));
    EXPECT_NEAR(scene.cameras[0].yfov, 2 * std::atan(0.0125 / 0.035), 1e-6);
}

TEST(Cornell, IsLambertian) {
    for (const Material& material : load("sample:cornell").materials) {
        EXPECT_EQ(material.metallic, 0);
        EXPECT_EQ(material.specular, 0);
        EXPECT_FALSE(material.doubleSided);
    }
}

TEST(Samples, AreFifteen) {
    EXPECT_EQ(sampleNames(),
              (std::vector<std::string>{"brushed", "carved", "caustic", "cornell", "gallery", "glass",
                                        "instances", "lenses", "lights500", "materials", "plates", "shading",
                                        "snell", "terrain", "wheel"}));
}

class EverySample : public testing::TestWithParam<std::string> {};

TEST_P(EverySample, IsSound) {
    Scene scene = load("sample:" + GetParam());
    EXPECT_EQ(scene.name, "sample:" + GetParam());
    EXPECT_NO_THROW(scene.validate());
    EXPECT_TRUE(scene.skipped.empty());
    EXPECT_TRUE(scene.warnings.empty());
    for (const Mesh& mesh : scene.meshes) {
        for (const Primitive& primitive : mesh.primitives) {
            const std::size_t size = primitive.positions.size();
            EXPECT_EQ(primitive.indices.size() % 3, 0u);
            for (std::uint32_t index : primitive.indices) ASSERT_LT(index, size) << mesh.name;
            EXPECT_TRUE(primitive.normals.empty() || primitive.normals.size() == size);
            for (const auto& set : primitive.texcoords) EXPECT_EQ(set.size(), size);
            ASSERT_GE(primitive.material, 0);
            ASSERT_LT(std::size_t(primitive.material), scene.materials.size());
            for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
                const std::uint32_t* const corner = &primitive.indices[i];
                const std::array<glm::dvec3, 3> t{primitive.positions[corner[0]],
                                                  primitive.positions[corner[1]],
                                                  primitive.positions[corner[2]]};
                ASSERT_GT(glm::length(areaVector(t)), 0) << mesh.name << " triangle " << i / 3;
                if (primitive.normals.empty()) continue;
                for (int k = 0; k < 3; ++k) {
                    const glm::dvec3 normal = primitive.normals[corner[k]];
                    ASSERT_NEAR(glm::length(normal), 1, 1e-6);
                    ASSERT_GT(glm::dot(normal, areaVector(t)), 0) << mesh.name;
                }
            }
        }
    }
    for (const Material& material : scene.materials) {
        EXPECT_TRUE(material.unsupported.empty());
        EXPECT_LE(std::max({material.baseColor.r, material.baseColor.g, material.baseColor.b}), 1);
    }
}

TEST_P(EverySample, IsInViewAndLit) {
    Scene scene = load("sample:" + GetParam());
    ASSERT_GE(scene.placedCameras().size(), 1u);
    const PlacedCamera placed = chooseCamera(scene, "");
    const glm::dmat4 toCamera = glm::inverse(placed.transform);
    const double limit = std::tan(scene.cameras[std::size_t(placed.camera)].yfov / 2.0);
    int inside = 0;
    for (const Instance& instance : scene.instances()) {
        const glm::dvec3 p(
            toCamera * instance.transform *
            glm::dvec4(scene.meshes[std::size_t(instance.mesh)].primitives[0].positions[0], 1));
        inside += p.z < 0 && std::abs(p.x) < -p.z * limit * 16 / 9 && std::abs(p.y) < -p.z * limit;
    }
    EXPECT_GT(inside, 0);
    bool isLit = scene.environment.has_value() || !scene.placedLights().empty();
    for (const Material& material : scene.materials) isLit |= material.emission != glm::vec3(0);
    EXPECT_TRUE(isLit);
}

INSTANTIATE_TEST_SUITE_P(Samples, EverySample, testing::ValuesIn(sampleNames()),
                         [](const auto& sample) { return sample.param; });

TEST(Samples, ManyInstancesShareFewMeshes) {
    const Scene scene = load("sample:instances");
    EXPECT_EQ(scene.instances().size(), 4181u + 1);
    EXPECT_LE(scene.meshes.size(), 6u);
}

TEST(Samples, TheMaterialRowSpansItsRanges) {
    const Scene scene = load("sample:materials");
    float lowRoughness = 1, highRoughness = 0;
    int metals = 0, dielectrics = 0, lamps = 0;
    for (const Material& material : scene.materials) {
        if (material.emission != glm::vec3(0)) {
            ++lamps;
        } else if (material.specular > 0) {
            ++(material.metallic > 0 ? metals : dielectrics);
            lowRoughness = std::min(lowRoughness, material.roughness);
            highRoughness = std::max(highRoughness, material.roughness);
        }
    }
    EXPECT_EQ(metals, 7);
    EXPECT_EQ(dielectrics, 7);
    EXPECT_EQ(lamps, 6 + 2);
    EXPECT_EQ(lowRoughness, 0);
    EXPECT_EQ(highRoughness, 1);
}

TEST(Samples, TheTerrainIsTexturedWithDetailToTheTexel) {
    const Scene scene = load("sample:terrain");
    ASSERT_EQ(scene.images.size(), 1u);
    const TextureImage& image = scene.images[0];
    const auto& texels = std::get<std::vector<std::uint8_t>>(image.texels);
    ASSERT_EQ(texels.size(), std::size_t(image.width) * image.height * 4);
    std::size_t differing = 0;
    for (std::size_t i = 4; i < texels.size(); i += 4) differing += texels[i] != texels[i - 4];
    EXPECT_GT(differing, texels.size() / 4 / 3);
    const Scene again = load("sample:terrain");
    EXPECT_EQ(texels, std::get<std::vector<std::uint8_t>>(again.images[0].texels));
    const Scene::Bounds bounds = scene.bounds();
    EXPECT_GT(bounds.upper.y, 100);
}

TEST(Samples, SpheresAreWatertight) {
    const Scene scene = load("sample:materials");
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.name.find("gold") == std::string::npos) continue;
        const Primitive& primitive = mesh.primitives[0];
        std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> edges;
        const auto key = [&](std::uint32_t i) {
            const glm::vec3 p = primitive.positions[i];
            return std::array<float, 3>{p.x, p.y, p.z};
        };
        for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
            const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
            ++edges[{key(primitive.indices[i]), key(primitive.indices[next])}];
        }
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1);
            ASSERT_TRUE(edges.contains({edge.second, edge.first}));
        }
    }
}

}  // namespace
}  // namespace helio
