#pragma once
/** @file Small scenes built in code, rasterized and shaded on the device. */
#include "passes/raster/raster_pipeline.hpp"
#include "passes/scene/device_scene.hpp"
#include "passes/shade/shade.hpp"
#include "tests/support/device.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace helio::test {

struct ShadedImage {
    std::uint32_t width = 0;
    std::vector<glm::vec4> color, albedoDepth, normal;
    std::vector<glm::ivec2> ids;
    std::vector<std::uint64_t> keys;
    std::size_t at(std::uint32_t x, std::uint32_t y) const { return std::size_t(y) * width + x; }
};

inline ShadedImage shade(const Scene& scene, const RasterView& view, bool tree = false,
                         Shading shading = Shading::Material) {
    DeviceScene deviceScene(device(), scene, {.tree = tree});
    ShadePipeline pipeline(device(), deviceScene, {}, {.kind = Shadows::Kind::None}, TextureFilter::Trilinear,
                           0, shading);
    if (pipeline.mips().needed()) {
        Graph graph(device());
        pipeline.declareMips(graph);
        Plan plan = graph.compile();
        plan.wait(plan.execute());
    }
    Graph graph(device());
    auto shared = std::make_shared<const RasterView>(view);
    const RasterOutput raster = RasterPipeline(device()).declare(graph, pipeline.triangles(graph), shared);
    const ShadeOutput output = pipeline.declare(graph, raster, shared);
    const auto color = graph.readback<glm::vec4>(output.color),
               albedo = graph.readback<glm::vec4>(output.albedoDepth),
               normal = graph.readback<glm::vec4>(output.normal);
    const auto ids = graph.readback<glm::ivec2>(output.ids);
    const auto keys = graph.readback<std::uint64_t>(raster.visibility);
    Plan plan = graph.compile({.poison = true});
    const Execution done = plan.execute();
    return {view.width,        color.wait(done), albedo.wait(done),
            normal.wait(done), ids.wait(done),   keys.wait(done)};
}

/** The square of `half` about the origin along -z, +x right and +y up, without perspective. */
inline RasterView frontView(std::uint32_t side, double half, double distance = 5) {
    Camera camera;
    camera.perspective = false;
    camera.ymag = float(half);
    glm::dmat4 place(1.0);
    place[3] = {0, 0, distance, 1};
    return makeRasterView(place, camera, {side, side}, 0.1 * distance, 2 * distance);
}

/** A material that is exactly Lambertian. */
inline Material lambert(const glm::vec3& color, const glm::vec3& emission = glm::vec3(0.0f)) {
    Material material;
    material.baseColor = glm::vec4(color, 1.0f);
    material.metallic = 0;
    material.specular = 0;
    material.emission = emission;
    return material;
}

/** Adds a mesh of one primitive in a node of its own. */
inline void addPrimitive(Scene& scene, Primitive primitive, const Material& material,
                         const glm::dmat4& transform = glm::dmat4(1.0)) {
    scene.materials.push_back(material);
    primitive.material = int(scene.materials.size()) - 1;
    scene.meshes.push_back({"", {std::move(primitive)}});
    Node node;
    node.mesh = int(scene.meshes.size()) - 1;
    node.matrix = glm::mat4(transform);
    scene.nodes.push_back(node);
    scene.roots.push_back(int(scene.nodes.size()) - 1);
}

/** A quadrilateral a, b, c, d, counter-clockwise seen from its front, as two triangles. */
inline Primitive quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    Primitive primitive;
    primitive.positions = {a, b, c, d};
    primitive.indices = {0, 1, 2, 0, 2, 3};
    return primitive;
}

inline void addLight(Scene& scene, const PunctualLight& light, const glm::dmat4& transform) {
    scene.lights.push_back(light);
    Node node;
    node.light = int(scene.lights.size()) - 1;
    node.matrix = glm::mat4(transform);
    scene.nodes.push_back(node);
    scene.roots.push_back(int(scene.nodes.size()) - 1);
}

/** The view from `eye` along -y, +x to the right and -z up; one unit of the plane y = 0 is `pixelsPerUnit`.
 */
inline RasterView downView(const glm::dvec3& eye, std::uint32_t width, std::uint32_t height,
                           double pixelsPerUnit) {
    RasterView view;
    view.eye = eye;
    view.width = width;
    view.height = height;
    view.rowW = {0, -1, 0};
    const double focal = pixelsPerUnit * eye.y;
    view.rowX = focal * glm::dvec3(1, 0, 0) + 0.5 * width * view.rowW;
    view.rowY = focal * glm::dvec3(0, 0, 1) + 0.5 * height * view.rowW;
    view.depthOffset = 1e-4;
    return view;
}

}  // namespace helio::test
