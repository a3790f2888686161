#include "bench_scenes.hpp"

#include <heliograph/verify.hpp>

#include <glm/glm.hpp>

#include <cmath>
#include <numbers>

namespace helio::cli {
namespace {

constexpr float kFurnaceAlbedo = 0.8f;
constexpr float kFloorAlbedo = 0.5f, kLampRadiance = 4.0f, kViewHalf = 1.0f;
/** Front downwards, counter-clockwise as seen from the floor. One triangle, so that a point on the lamp is
 * all that there is to choose. */
constexpr std::array<glm::vec3, 3> kLamp = {glm::vec3{-0.9f, -0.5f, 1}, glm::vec3{0.1f, 0.8f, 1},
                                            glm::vec3{0.8f, -0.6f, 1}};

int lambertian(Scene& scene, float albedo, float emission) {
    Material material;
    material.baseColor = glm::vec4(glm::vec3(albedo), 1.0f);
    material.metallic = 0;
    material.specular = 0;
    material.emission = glm::vec3(emission);
    scene.materials.push_back(material);
    return int(scene.materials.size()) - 1;
}

void addNode(Scene& scene, Node node) {
    scene.nodes.push_back(std::move(node));
    scene.roots.push_back(int(scene.nodes.size()) - 1);
}

/** A convex polygon whose corners run counter-clockwise as seen from its front. */
void addPolygon(Scene& scene, const std::vector<glm::vec3>& corners, int material) {
    Primitive primitive;
    primitive.positions = corners;
    for (std::uint32_t i = 2; i < corners.size(); ++i)
        primitive.indices.insert(primitive.indices.end(), {0, i - 1, i});
    primitive.material = material;
    scene.meshes.push_back({"", {primitive}});
    Node node;
    node.mesh = int(scene.meshes.size()) - 1;
    addNode(scene, node);
}

void addCamera(Scene& scene, const Camera& camera, const glm::vec3& eye) {
    scene.cameras.push_back(camera);
    Node node;
    node.translation = eye;
    node.camera = 0;
    addNode(scene, node);
}

Scene furnace() {
    Scene scene;
    const int wall = lambertian(scene, kFurnaceAlbedo, 1);
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            std::vector<glm::vec3> corners;
            for (const auto& [u, v] : {std::array{-1.0f, -1.0f}, std::array{1.0f, -1.0f},
                                       std::array{1.0f, 1.0f}, std::array{-1.0f, 1.0f}}) {
                glm::vec3 corner;
                corner[axis] = side;
                corner[(axis + 1) % 3] = side < 0 ? u : v;
                corner[(axis + 2) % 3] = side < 0 ? v : u;
                corners.push_back(corner);
            }
            addPolygon(scene, corners, wall);
        }
    }
    Camera camera;
    camera.yfov = 1.2f;
    addCamera(scene, camera, {0.1f, 0.2f, 0.3f});
    return scene;
}

Scene irradiance() {
    Scene scene;
    constexpr float half = 4 * kViewHalf;
    addPolygon(scene, {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}},
               lambertian(scene, kFloorAlbedo, 0));
    addPolygon(scene, {kLamp.begin(), kLamp.end()}, lambertian(scene, 0, kLampRadiance));
    Camera camera;
    camera.perspective = false;
    camera.ymag = kViewHalf;
    addCamera(scene, camera, {0, 0, 0.5f});
    return scene;
}

/** Radiance of the floor at (x, y). */
double floorRadiance(double x, double y) {
    std::vector<verify::Vector> lamp;
    for (const glm::vec3& corner : kLamp) lamp.push_back({corner.x, corner.y, corner.z});
    return std::abs(verify::irradiancePolygon({x, y, 0}, {0, 0, 1}, lamp)) * double(kLampRadiance) *
           double(kFloorAlbedo) / std::numbers::pi;
}

}  // namespace

Scene benchScene(const std::string& name) {
    const bool isFurnace = name == "furnace";
    if (!isFurnace && name != "irradiance") return load("sample:" + name);
    Scene scene = isFurnace ? furnace() : irradiance();
    scene.name = name;
    return scene;
}

std::optional<std::vector<double>> closedForm(const std::string& name,
                                              const std::array<std::uint32_t, 2>& size) {
    const auto [width, height] = size;
    if (name == "furnace") {
        return std::vector<double>(std::size_t(width) * height,
                                   verify::furnaceRadiance(1, double(kFurnaceAlbedo)));
    }
    if (name != "irradiance") return std::nullopt;
    // Gauss's two points each way: exact for cubics, so that what is left falls with the pixel's fourth
    // power.
    const double step = 2 * double(kViewHalf) / height, gauss = 0.5 * step / std::numbers::sqrt3;
    std::vector<double> picture;
    for (std::uint32_t row = 0; row < height; ++row) {
        for (std::uint32_t column = 0; column < width; ++column) {
            const double x = (column + 0.5 - 0.5 * width) * step, y = (0.5 * height - row - 0.5) * step;
            picture.push_back(0.25 *
                              (floorRadiance(x - gauss, y - gauss) + floorRadiance(x + gauss, y - gauss) +
                               floorRadiance(x - gauss, y + gauss) + floorRadiance(x + gauss, y + gauss)));
        }
    }
    return picture;
}

}  // namespace helio::cli
