#include "engine/scene/samples/shapes.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace helio {
namespace {

constexpr double pi = 3.14159265358979323846;

glm::vec3 onCircle(int i, int sides, float y) {
    const double angle = 2 * pi * i / sides;
    return {float(std::sin(angle)), y, float(std::cos(angle))};
}

void addTriangle(Primitive& primitive, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    for (const glm::vec3& corner : {a, b, c}) {
        primitive.indices.push_back(std::uint32_t(primitive.positions.size()));
        primitive.positions.push_back(corner);
    }
}

}  // namespace

Primitive sphereShape(int frequency, int material) {
    const double t = (1 + std::sqrt(5.0)) / 2;
    const std::array<glm::dvec3, 12> corners{{{-1, t, 0},
                                              {1, t, 0},
                                              {-1, -t, 0},
                                              {1, -t, 0},
                                              {0, -1, t},
                                              {0, 1, t},
                                              {0, -1, -t},
                                              {0, 1, -t},
                                              {t, 0, -1},
                                              {t, 0, 1},
                                              {-t, 0, -1},
                                              {-t, 0, 1}}};
    constexpr std::array<std::array<int, 3>, 20> faces{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    Primitive primitive;
    primitive.material = material;
    for (const auto& face : faces) {
        const auto first = std::uint32_t(primitive.positions.size());
        // Row i has i + 1 points, from face[0] down to the side opposite. A side's points are the same to the
        // bit from both its faces: the weights are summed in the order of the corners' numbers.
        for (int i = 0; i <= frequency; ++i) {
            for (int j = 0; j <= i; ++j) {
                std::array<std::pair<int, int>, 3> weighted{
                    {{face[0], frequency - i}, {face[1], i - j}, {face[2], j}}};
                std::sort(weighted.begin(), weighted.end());
                glm::dvec3 point(0);
                for (const auto& [corner, weight] : weighted)
                    point += double(weight) * corners[std::size_t(corner)];
                const glm::vec3 unit(glm::normalize(point));
                primitive.positions.push_back(unit);
                primitive.normals.push_back(unit);
            }
        }
        const auto at = [&](int i, int j) { return first + std::uint32_t(i * (i + 1) / 2 + j); };
        for (int i = 0; i < frequency; ++i) {
            for (int j = 0; j <= i; ++j) {
                for (std::uint32_t index : {at(i, j), at(i + 1, j), at(i + 1, j + 1)})
                    primitive.indices.push_back(index);
                if (j == i) continue;
                for (std::uint32_t index : {at(i, j), at(i + 1, j + 1), at(i, j + 1)})
                    primitive.indices.push_back(index);
            }
        }
    }
    return primitive;
}

Primitive prismShape(int sides, int material) {
    Primitive primitive;
    primitive.material = material;
    for (int i = 0; i < sides; ++i) {
        const glm::vec3 a = onCircle(i, sides, 0), b = onCircle(i + 1, sides, 0);
        const glm::vec3 up(0, 1, 0);
        addTriangle(primitive, a, b, b + up);
        addTriangle(primitive, a, b + up, a + up);
        addTriangle(primitive, up, a + up, b + up);
    }
    return primitive;
}

Primitive gemShape(int sides, int material) {
    Primitive primitive;
    primitive.material = material;
    for (int i = 0; i < sides; ++i) {
        const glm::vec3 a = onCircle(i, sides, 0), b = onCircle(i + 1, sides, 0);
        addTriangle(primitive, glm::vec3(0, 1, 0), a, b);
        addTriangle(primitive, glm::vec3(0, -1, 0), b, a);
    }
    return primitive;
}

Primitive quadShape(glm::vec3 corner, glm::vec3 u, glm::vec3 v, int material) {
    Primitive primitive;
    primitive.material = material;
    primitive.positions = {corner, corner + u, corner + u + v, corner + v};
    primitive.normals.assign(4, glm::normalize(glm::cross(u, v)));
    primitive.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    primitive.indices = {0, 1, 2, 0, 2, 3};
    return primitive;
}

int addMaterial(Scene& scene, Material material) {
    scene.materials.push_back(std::move(material));
    return int(scene.materials.size()) - 1;
}

Material diffuse(std::string name, glm::vec3 reflectance) {
    Material material;
    material.name = std::move(name);
    material.baseColor = glm::vec4(reflectance, 1.0f);
    material.metallic = 0;
    material.specular = 0;
    return material;
}

int addMesh(Scene& scene, std::string name, Primitive primitive) {
    scene.meshes.push_back({std::move(name), {}});
    scene.meshes.back().primitives.push_back(std::move(primitive));
    return int(scene.meshes.size()) - 1;
}

int addRoot(Scene& scene, Node node) {
    scene.nodes.push_back(std::move(node));
    scene.roots.push_back(int(scene.nodes.size()) - 1);
    return scene.roots.back();
}

int addRoot(Scene& scene, std::string name, int mesh) {
    Node node;
    node.name = std::move(name);
    node.mesh = mesh;
    return addRoot(scene, std::move(node));
}

Node lookAtNode(std::string name, glm::vec3 eye, glm::vec3 target) {
    Node node;
    node.name = std::move(name);
    node.translation = eye;
    const glm::dvec3 back = glm::normalize(glm::dvec3(eye) - glm::dvec3(target));
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back));
    node.rotation = glm::quat(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
    return node;
}

void addSun(Scene& scene, glm::vec3 irradiance, glm::vec3 towards) {
    PunctualLight sun;
    sun.name = "sun";
    sun.type = PunctualLight::Type::Directional;
    sun.intensity = irradiance;
    scene.lights.push_back(sun);
    Node node = lookAtNode("sun", towards, {0, 0, 0});
    node.light = int(scene.lights.size()) - 1;
    addRoot(scene, std::move(node));
}

void addCamera(Scene& scene, glm::vec3 eye, glm::vec3 target, double yfovDegrees) {
    Camera camera;
    camera.name = "camera";
    camera.yfov = float(yfovDegrees * pi / 180);
    scene.cameras.push_back(camera);
    Node node = lookAtNode("camera", eye, target);
    node.camera = int(scene.cameras.size()) - 1;
    addRoot(scene, std::move(node));
}

}  // namespace helio
