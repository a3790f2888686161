#include "passes/scene/device_scene.hpp"

#include "passes/tree/tree_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace helio {
namespace {

/** Placed corners are brought to the world in double. */
PackOptions supported(const Device& device, PackOptions options) {
    if (!device.info().has("shaderFloat64")) options.placing = Placing::Flatten;
    return options;
}

BuildTree builderOf(Device& device, const PackOptions& options) {
    if (!options.deviceTree) return {};
    return [&device](std::span<const glm::vec3> positions) {
        return TreeBuilder(device, positions.size() / 3).build(positions);
    };
}

}  // namespace

DeviceScene::DeviceScene(Device& device, const Scene& scene, std::span<const Scene> later,
                         const PackOptions& options)
    : info_(packScene(scene, later, supported(device, options), builderOf(device, options))) {
    hostBytes_ = info_.bytes();
    const auto& environment = info_.environment;
    hasLightTables_ = !info_.lightSlots.empty();
    constants_ = {{"HAS_NORMALS", !info_.normals.empty()},
                  {"HAS_COLORS", !info_.colors.empty()},
                  {"HAS_BASE_TEXTURES", info_.baseColorTextures},
                  {"HAS_EMISSION", info_.emission},
                  {"HAS_EMISSION_TEXTURES", info_.texturedEmission},
                  {"HAS_FLOAT_TEXTURES", !info_.texelsFloat.empty()},
                  {"HAS_AREA_LIGHTS", info_.areaLights},
                  {"HAS_PUNCTUAL_LIGHTS", info_.punctualLights},
                  {"HAS_ENVIRONMENT", environment != glm::vec3(0.0f)},
                  {"HAS_TRIANGLE_LIGHTS", info_.triangleLights},
                  {"LIGHT_COUNT", std::int32_t(info_.lightCount)},
                  {"LIGHT_BITS", std::int32_t(info_.lightBits)},
                  {"LIGHT_SLOT_BITS", std::int32_t(info_.lightSlotBits)},
                  {"LIGHT_CUTS", info_.lightCuts},
                  {"LIGHT_GRID_X", info_.lightGridSize.x},
                  {"LIGHT_GRID_Y", info_.lightGridSize.y},
                  {"LIGHT_GRID_Z", info_.lightGridSize.z},
                  {"LIGHT_ORIGIN_X", info_.lightGridOrigin.x},
                  {"LIGHT_ORIGIN_Y", info_.lightGridOrigin.y},
                  {"LIGHT_ORIGIN_Z", info_.lightGridOrigin.z},
                  {"LIGHT_GRID_SCALE", info_.lightGridScale},
                  {"ENVIRONMENT_WIDTH", std::int32_t(info_.environmentSize[0])},
                  {"ENVIRONMENT_HEIGHT", std::int32_t(info_.environmentSize[1])},
                  {"ENVIRONMENT_ROW_LEVELS", std::int32_t(info_.environmentLevels[0])},
                  {"ENVIRONMENT_COLUMN_LEVELS", std::int32_t(info_.environmentLevels[1])},
                  {"ENVIRONMENT_ROW_NODES", std::int32_t(info_.environmentNodes[0])},
                  {"ENVIRONMENT_COLUMN_NODES", std::int32_t(info_.environmentNodes[1])},
                  {"ENVIRONMENT_ROTATED", info_.environmentRotated},
                  {"HAS_LINEAR_TEXTURES", info_.linearTextures},
                  {"ALBEDO_TABLES", std::int32_t(info_.albedoTables)},
                  {"HAS_ROUGH_FACETS", info_.roughFacets},
                  {"HAS_TILTED_LOBES", info_.tiltedLobes},
                  {"LISTED_SHAPES", std::int32_t(info_.listedShapes)},
                  {"SHAPES_IN_TREE", info_.shapesInTree},
                  {"HAS_SPHERES", info_.spheres},
                  {"HAS_TORI", info_.tori},
                  {"HAS_FLAT_SHAPES", info_.flatShapes},
                  {"PLACED_BITS", std::int32_t(info_.placedBits)},
                  {"TRIANGLE_COUNT", std::int32_t(info_.triangleCount)}};
    hasPlacedMeshes_ = !info_.placed.empty();
    const auto upload = [&](std::string_view name, auto& values, Format view) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        if (values.empty()) values.assign(std::max<std::size_t>(1, 16 / sizeof(T)), T{});
        buffers_.push_back({name, view, makeBuffer(device, fmt::format("scene.{}", name), values)});
        // The host's copy is not needed any more, but where few triangles are written out as code.
        constexpr std::size_t kept = std::size_t(64) << 10;
        if (values.size() * sizeof(T) > kept) std::decay_t<decltype(values)>().swap(values);
    };
    upload("uTriangles", info_.triangles, Format::Undefined);
    upload("uNodes", info_.nodes, Format::Undefined);
    if (hasPlacedMeshes()) upload("uPlaced", info_.placed, Format::Undefined);
    upload("uNormals", info_.normals, Format::Undefined);
    upload("uTexcoords", info_.texcoords, Format::Undefined);
    upload("uTangents", info_.tangents, Format::Undefined);
    upload("uColors", info_.colors, Format::Undefined);
    upload("uMaterials", info_.materials, Format::Undefined);
    upload("uLights", info_.lights, Format::Undefined);
    std::vector<glm::uvec4> textures = info_.textures;  // the headers stay: mip levels are laid out from them
    upload("uTextures", textures, Format::Undefined);
    upload("uTexels8", info_.texels8, Format::R32UI);
    upload("uTexelsFloat", info_.texelsFloat, Format::Undefined);
    if (info_.solidTextures) upload("uSolidPoints", info_.solidPoints, Format::Undefined);
    if (!info_.instanceScales.empty()) upload("uInstanceScales", info_.instanceScales, Format::R32F);
    if (info_.motionKeys > 0) {
        upload("uTriangleKeys", info_.triangleKeys, Format::Undefined);
        upload("uNormalKeys", info_.normalKeys, Format::Undefined);
    }
    if (hasLightTables()) {
        upload("uLightSlots", info_.lightSlots, Format::Undefined);
        upload("uLightCells", info_.lightCells, Format::R32UI);
        upload("uLightRanges", info_.lightRanges, Format::R32UI);
        upload("uLightOfTriangle", info_.lightOfTriangle, Format::R32UI);
    }
    if (hasEnvironmentImage()) upload("uEnvironmentMap", info_.environmentMap, Format::Undefined);
    upload("uInstanceFirst", info_.instanceFirst, Format::R32UI);
}

std::vector<Binding> DeviceScene::bindings(Graph& graph, const std::vector<std::string_view>& names) {
    std::vector<Binding> result;
    for (std::string_view name : names) {
        const auto found = std::ranges::find(buffers_, name, &Named::name);
        assert(found != buffers_.end() && "DeviceScene has no buffer of that name");
        result.emplace_back(std::string(name), graph.import(found->buffer), found->view);
    }
    return result;
}

SpecConstants DeviceScene::constants(const std::vector<std::string_view>& names) const {
    SpecConstants result;
    for (std::string_view name : names) {
        const auto found = constants_.find(std::string(name));
        assert(found != constants_.end() && "DeviceScene has no constant of that name");
        result.insert(*found);
    }
    return result;
}

SpecConstants DeviceScene::environmentConstants() const {
    if (!hasEnvironmentImage()) return {};
    return constants({"ENVIRONMENT_WIDTH", "ENVIRONMENT_HEIGHT", "ENVIRONMENT_ROW_LEVELS",
                      "ENVIRONMENT_COLUMN_LEVELS", "ENVIRONMENT_ROW_NODES", "ENVIRONMENT_COLUMN_NODES",
                      "ENVIRONMENT_ROTATED"});
}

SpecConstants DeviceScene::lightTableConstants() const {
    if (!hasLightTables()) return {};
    return constants({"LIGHT_SLOT_BITS", "LIGHT_CUTS", "LIGHT_GRID_X", "LIGHT_GRID_Y", "LIGHT_GRID_Z",
                      "LIGHT_ORIGIN_X", "LIGHT_ORIGIN_Y", "LIGHT_ORIGIN_Z", "LIGHT_GRID_SCALE"});
}

std::uint64_t DeviceScene::deviceBytes() const {
    std::uint64_t bytes = 0;
    for (const Named& named : buffers_) bytes += named.buffer.bytes();
    return bytes;
}

}  // namespace helio
