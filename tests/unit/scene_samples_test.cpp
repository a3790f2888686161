#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace helio
