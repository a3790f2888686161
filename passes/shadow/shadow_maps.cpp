#include "passes/shadow/shadow_maps.hpp"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>

namespace helio {
namespace {

/** Keys of all maps together: 512 MiB. */
constexpr std::uint64_t kMostTexels = 1u << 26;
/** A spot up to this half angle has one map. */
constexpr double kWidestSpot = 1.3;
/** Texels beyond a face's own quarter of the sphere, for filters. */
constexpr double kMargin = 4;

struct Face {
    glm::dvec3 axis, right, down;
};

/** Axes of a map that looks along `axis`. */
Face faceAlong(const glm::dvec3& axis) {
    const glm::dvec3 other = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(axis, other));
    return {axis, right, glm::cross(axis, right)};
}

RasterView perspectiveView(const glm::dvec3& eye, const Face& face, double tangent, std::uint32_t size,
                           double near) {
    RasterView view;
    view.eye = eye;
    view.width = view.height = size;
    const double half = 0.5 * size, focal = (half - kMargin) / tangent;
    view.rowW = face.axis;
    view.rowX = focal * face.right + half * face.axis;
    view.rowY = focal * face.down + half * face.axis;
    view.depthOffset = near;
    return view;
}

RasterView directionalView(const glm::dvec3& direction, const glm::dvec3& centre, double radius,
                           std::uint32_t size) {
    RasterView view;
    const Face face = faceAlong(direction);
    view.eye = centre - radius * direction;
    view.width = view.height = size;
    view.orthographic = true;
    const double scale = (0.5 * size - kMargin) / radius;
    view.rowW = face.axis;
    view.rowX = scale * face.right;
    view.rowY = scale * face.down;
    view.depthSlope = -0.5 / radius;
    view.depthOffset = 1.0;
    return view;
}

void addTexels(std::vector<glm::uvec4>& table, const RasterView& view, std::uint64_t firstTexel) {
    const auto row = [&](const glm::dvec3& v, std::uint32_t w) {
        const glm::vec3 f(v);
        table.emplace_back(std::bit_cast<std::uint32_t>(f.x), std::bit_cast<std::uint32_t>(f.y),
                           std::bit_cast<std::uint32_t>(f.z), w);
    };
    row(view.rowX, std::bit_cast<std::uint32_t>(float(view.depthOffset)));
    row(view.rowY, std::bit_cast<std::uint32_t>(float(view.depthSlope)));
    row(view.rowW, view.width);
    table.emplace_back(std::uint32_t(firstTexel), view.orthographic ? 1u : 0u, 0u, 0u);
    const auto words = [](double v) { return std::bit_cast<std::array<std::uint32_t, 2>>(v); };
    const auto x = words(view.eye.x), y = words(view.eye.y), z = words(view.eye.z);
    table.emplace_back(x[0], x[1], y[0], y[1]);
    table.emplace_back(z[0], z[1], 0u, 0u);
}

std::vector<RasterView> facesOf(std::span<const glm::vec4> row, const Scene::Bounds& bounds,
                                const Shadows& options) {
    const auto kind = LightKind(std::bit_cast<std::uint32_t>(row[2].w));
    const glm::dvec3 origin(row[0]), direction(row[4]);
    const glm::dvec3 centre = 0.5 * (bounds.lower + bounds.upper);
    const double radius = std::max(0.5 * glm::length(bounds.upper - bounds.lower), 1e-30);
    // Whatever is nearer than this to the light casts no shadow.
    const double near = 1e-5 * (radius + glm::length(origin - centre));
    const std::uint32_t wide = options.resolution ? options.resolution : 2048,
                        narrow = options.resolution ? options.resolution : 1024;
    if (kind == LightKind::Directional) return {directionalView(direction, centre, 1.001 * radius, wide)};
    if (kind == LightKind::Spot) {
        // scale = 1 / (cos inner - cos outer), offset = -scale cos outer.
        const double outer = std::acos(std::clamp(double(-row[2].y) / double(row[2].x), -1.0, 1.0));
        if (outer < kWidestSpot)
            return {perspectiveView(origin, faceAlong(direction), std::tan(outer), wide, near)};
    }
    if (kind == LightKind::Point || kind == LightKind::Spot) {
        std::vector<RasterView> faces;
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {1.0, -1.0}) {
                glm::dvec3 along(0.0);
                along[axis] = sign;
                faces.push_back(perspectiveView(origin, faceAlong(along), 1.0, narrow, near));
            }
        return faces;
    }
    return {};
}

}  // namespace

ShadowLayout::ShadowLayout(std::span<const glm::vec4> lights, std::uint32_t lightCount,
                           const Scene::Bounds& bounds, const Shadows& options) {
    table.resize(lightCount, glm::uvec4(0));
    std::uint64_t texels = 0;
    if (options.kind == Shadows::Kind::None || bounds.empty()) {
        offsets.push_back(0);
        return;
    }
    for (std::uint32_t light = 0; light < lightCount; ++light) {
        const std::vector<RasterView> views =
            facesOf(lights.subspan(std::size_t(light) * kLightTexels, kLightTexels), bounds, options);
        if (views.empty()) continue;
        const std::uint64_t each = rasterStride(views[0].width, views[0].height) / 8;
        if (texels + each * views.size() > kMostTexels) {
            ++lightsWithout;
            continue;
        }
        table[light] = {std::uint32_t(faces.size()), std::uint32_t(views.size()), 0, 0};
        for (const RasterView& view : views) {
            addTexels(table, view, texels);
            offsets.push_back(texels * 8);
            faces.push_back(view);
            texels += each;
        }
    }
    offsets.push_back(texels * 8);
}

ShadowMaps::ShadowMaps(Device& device, std::span<const glm::vec4> lights, std::uint32_t lightCount,
                       const Scene::Bounds& bounds, const Shadows& options)
    : layout_(lights, lightCount, bounds, options),
      table_(makeBuffer(device, "shadow.faces",
                        layout_.table.empty() ? std::vector<glm::uvec4>(1, glm::uvec4(0)) : layout_.table)),
      filter_(makeBuffer(
          device, "shadow.filter",
          std::array{glm::vec4(options.filterRadius, options.lightSize, float(lightCount), 0.0f)})),
      maps_(device, "shadow.maps", std::max<std::uint64_t>(layout_.offsets.back(), 16)) {}

void ShadowMaps::declare(Graph& graph, const RasterPipeline& raster, const RasterTriangles& triangles) {
    if (!needed()) return;
    const Buffer maps = graph.import(maps_),
                 counters = graph.buffer("shadow.counters", {sizeof(RasterCounters)});
    graph.fill("shadow.clear", maps, 0);
    graph.fill("shadow.clearCounters", counters, 0);
    for (std::size_t face = 0; face < layout_.faces.size(); ++face)
        raster.declare(graph, triangles, std::make_shared<const RasterView>(layout_.faces[face]),
                       {maps, layout_.offsets[face], counters});
}

std::vector<Binding> ShadowMaps::bindings(Graph& graph) {
    return {{"uShadowFaces", graph.import(table_), Format::RGBA32UI},
            {"uShadowMaps", graph.import(maps_), Format::RG32UI},
            {"uShadowFilter", graph.import(filter_), Format::RGBA32F}};
}

}  // namespace helio
