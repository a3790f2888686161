#include "tests/accuracy/path_scenes.hpp"

#include <cmath>

namespace helio::test {

SceneBuilder::SceneBuilder() {
    scene.name = "test";
}

int SceneBuilder::material(const glm::vec3& albedo, const glm::vec3& emission, bool doubleSided) {
    Material m;
    m.baseColor = glm::vec4(albedo, 1.0f);
    m.metallic = 0.0f;
    m.specular = 0.0f;
    m.emission = emission;
    m.doubleSided = doubleSided;
    scene.materials.push_back(m);
    return int(scene.materials.size()) - 1;
}

int SceneBuilder::node(Node added) {
    scene.nodes.push_back(std::move(added));
    scene.roots.push_back(int(scene.nodes.size()) - 1);
    return scene.roots.back();
}

int SceneBuilder::triangles(const std::vector<glm::vec3>& corners, int material) {
    Primitive primitive;
    primitive.positions = corners;
    for (std::uint32_t i = 0; i < corners.size(); ++i) primitive.indices.push_back(i);
    primitive.material = material;
    scene.meshes.push_back({"", {primitive}});
    Node placed;
    placed.mesh = int(scene.meshes.size()) - 1;
    node(placed);
    return int(scene.meshes.size()) - 1;
}

int SceneBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d,
                       int material) {
    return triangles({a, b, c, a, c, d}, material);
}

void SceneBuilder::room(const glm::vec3& l, const glm::vec3& u, const std::array<int, 6>& m) {
    quad({l.x, l.y, l.z}, {l.x, u.y, l.z}, {l.x, u.y, u.z}, {l.x, l.y, u.z}, m[0]);
    quad({u.x, l.y, l.z}, {u.x, l.y, u.z}, {u.x, u.y, u.z}, {u.x, u.y, l.z}, m[1]);
    quad({l.x, l.y, l.z}, {l.x, l.y, u.z}, {u.x, l.y, u.z}, {u.x, l.y, l.z}, m[2]);
    quad({l.x, u.y, l.z}, {u.x, u.y, l.z}, {u.x, u.y, u.z}, {l.x, u.y, u.z}, m[3]);
    quad({l.x, l.y, l.z}, {u.x, l.y, l.z}, {u.x, u.y, l.z}, {l.x, u.y, l.z}, m[4]);
    quad({l.x, l.y, u.z}, {l.x, u.y, u.z}, {u.x, u.y, u.z}, {u.x, l.y, u.z}, m[5]);
}

std::vector<glm::vec3> unitSphere(int levels) {
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    const std::vector<glm::dvec3> v = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                       {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                       {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::vector<glm::dvec3> corners;
    for (const auto& face : faces)
        for (int k : face) corners.push_back(glm::normalize(v[std::size_t(k)]));
    for (int level = 0; level < levels; ++level) {
        std::vector<glm::dvec3> finer;
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const glm::dvec3 a = corners[i], b = corners[i + 1], c = corners[i + 2];
            const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                             ca = glm::normalize(c + a);
            for (const glm::dvec3& p : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) finer.push_back(p);
        }
        corners = std::move(finer);
    }
    return {corners.begin(), corners.end()};
}

int SceneBuilder::sphere(const glm::vec3& centre, float radius, int levels, bool inwards, int material) {
    std::vector<glm::vec3> corners = unitSphere(levels);
    for (std::size_t i = 0; i < corners.size(); i += 3)
        if (inwards) std::swap(corners[i + 1], corners[i + 2]);
    for (glm::vec3& p : corners) p = centre + radius * p;
    return triangles(corners, material);
}

void SceneBuilder::camera(const glm::vec3& eye, const glm::vec3& target, float yfov, const glm::vec3& up) {
    Camera c;
    c.yfov = yfov;
    scene.cameras.push_back(c);
    const glm::vec3 back = glm::normalize(eye - target);
    const glm::vec3 right = glm::normalize(glm::cross(up, back));
    Node placed;
    placed.matrix = glm::mat4(glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0),
                              glm::vec4(eye, 1));
    placed.camera = int(scene.cameras.size()) - 1;
    node(placed);
}

void SceneBuilder::whiteImageAround() {
    TextureImage image;
    image.width = 4;
    image.height = 2;
    image.texels = std::vector<float>(32, 1.0f);
    scene.images.push_back(std::move(image));
    scene.environment = Environment{glm::vec3(1.0f), int(scene.images.size()) - 1};
}

void SceneBuilder::pointLight(const glm::vec3& position, const glm::vec3& intensity) {
    PunctualLight light;
    light.intensity = intensity;
    scene.lights.push_back(light);
    Node placed;
    placed.translation = position;
    placed.light = int(scene.lights.size()) - 1;
    node(placed);
}

}  // namespace helio::test
