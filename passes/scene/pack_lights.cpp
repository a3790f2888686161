#include "passes/scene/alias_table.hpp"
#include "passes/scene/light_tables.hpp"
#include "passes/scene/packed_scene.hpp"
#include "passes/scene/solid_angle_gain.hpp"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace helio::pack {
namespace {

struct Candidate {
    LightKind kind = LightKind::Triangle;
    double weight = 0;  ///< chance to be chosen, before normalisation: power, mean over RGB
    glm::dvec3 origin{0.0}, edge1{0.0}, edge2{0.0}, normal{0.0};
    glm::vec3 radiance{0.0f};
    double weightPerArea = 0, area = 0;
    bool doubleSided = false;
    std::uint32_t g = 0, material = 0;
    double environmentPower = 0;
    bool isSurface() const {
        return kind == LightKind::Triangle || kind == LightKind::Parallelogram || kind >= LightKind::Quad;
    }
};

/** Most lights that Adaptive chooses among by power. */
constexpr std::size_t kFewLights = 2;
/** Of SolidAngleGain, for which the cost of sampling by solid angle is paid. */
constexpr double kLeastGain = 0.1;

double mean(const glm::dvec3& rgb) {
    return (rgb.x + rgb.y + rgb.z) / 3.0;
}

double square(double x) {
    return x * x;
}

/** Of a sphere around all that light falls on; 1 for a scene without surfaces or extent. */
double boundingRadius(const Scene& scene) {
    const Scene::Bounds bounds = scene.bounds();
    const double radius = bounds.empty() ? 0.0 : 0.5 * glm::length(bounds.upper - bounds.lower);
    return radius > 0.0 ? radius : 1.0;
}

/** Whether two triangles are the halves of one parallelogram: they share an edge, and the corners across it
 * mirror each other through its middle exactly as far as float can say. Gives the corner and edges of it. */
bool makesParallelogram(const glm::vec3* a, const glm::vec3* b, Candidate& light) {
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            // The shared edge runs forwards in one triangle and backwards in the other.
            if (a[(i + 1) % 3] != b[(k + 2) % 3] || a[(i + 2) % 3] != b[(k + 1) % 3]) continue;
            const glm::dvec3 corner(a[i]), left(a[(i + 1) % 3]), right(a[(i + 2) % 3]), across(b[k]);
            const glm::dvec3 size = glm::max(glm::max(glm::abs(corner), glm::abs(across)),
                                             glm::max(glm::abs(left), glm::abs(right)));
            const glm::dvec3 gap = glm::abs(left + right - corner - across);
            const double unit = std::numeric_limits<float>::epsilon();
            if (gap.x > 2 * unit * size.x || gap.y > 2 * unit * size.y || gap.z > 2 * unit * size.z) continue;
            light.origin = corner;
            light.edge1 = left - corner;
            light.edge2 = right - corner;
            return true;
        }
    return false;
}

/** Place and area of a shape as a light; false for one without end and for a torus, which rays alone find. */
bool makesLight(const PlacedShape& shape, Candidate& light, double& area) {
    light.normal = glm::cross(shape.a, shape.b);
    area = 4.0 * glm::length(light.normal);
    light.origin = shape.centre - shape.a - shape.b;
    light.edge1 = 2.0 * shape.a;
    light.edge2 = 2.0 * shape.b;
    switch (shape.kind) {
        case Shape::Kind::Plane:
        case Shape::Kind::Torus:
            return false;
        case Shape::Kind::Quad:
            light.kind = LightKind::Quad;
            break;
        case Shape::Kind::Disc:
            light.kind = LightKind::Disc;
            area *= 0.25 * glm::pi<double>();
            break;
        case Shape::Kind::Sphere:
            light.kind = LightKind::Sphere;
            light.origin = shape.centre;
            light.edge1 = shape.a;
            light.edge2 = shape.b;
            area = 4.0 * glm::pi<double>() * glm::dot(shape.a, shape.a);
            break;
    }
    return true;
}

void addSurfaces(const Scene& scene, std::span<const glm::vec3> positions, std::span<const Surface> surfaces,
                 const std::vector<bool>& isMoving, std::vector<Candidate>& lights) {
    // Radiance that decides how often a surface is chosen: constant over a material's surfaces, so that the
    // density per area is too, and a ray that finds the surface knows it from the material alone.
    std::vector<glm::dvec3> meanRadiance(scene.materials.size() + 1, glm::dvec3(0.0));
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        meanRadiance[i] = glm::dvec3(material.emission);
        if (material.emission != glm::vec3(0.0f) && material.emissiveTexture) {
            const Texture& texture = scene.textures[std::size_t(material.emissiveTexture.texture)];
            // A texture may show only its dark part on these surfaces; the floor keeps every surface that
            // could emit in the table.
            meanRadiance[i] *=
                glm::max(meanColor(scene.images[std::size_t(texture.image)]), glm::dvec3(1e-3));
        }
    }
    for (std::size_t g = 0; g < surfaces.size(); ++g) {
        const std::uint32_t index = surfaces[g].material;
        if (!(mean(meanRadiance[index]) > 0.0) || isMoving[index]) continue;
        const Material& material = scene.materials[index];
        const glm::vec3* corners = positions.data() + g * 3;
        Candidate light;
        light.kind = LightKind::Triangle;
        light.origin = glm::dvec3(corners[0]);
        light.edge1 = glm::dvec3(corners[1]) - light.origin;
        light.edge2 = glm::dvec3(corners[2]) - light.origin;
        glm::dvec3 normal = glm::cross(light.edge1, light.edge2);
        double area = 0.5 * glm::length(normal);
        if (surfaces[g].shape > 0) {
            if (!makesLight(shapeOf(corners, surfaces[g].shape), light, area)) continue;
            normal = light.normal;
        }
        if (!(area > 0.0)) continue;
        if (surfaces[g].shape == 0 && surfaces[std::min(g + 1, surfaces.size() - 1)].shape == 0 &&
            !material.emissiveTexture && material.alphaMode == AlphaMode::Opaque && g + 1 < surfaces.size() &&
            surfaces[g + 1].material == index && surfaces[g + 1].instance == surfaces[g].instance &&
            makesParallelogram(corners, corners + 3, light)) {
            light.kind = LightKind::Parallelogram;
            area = glm::length(glm::cross(light.edge1, light.edge2));
        }
        light.normal = light.kind == LightKind::Sphere ? glm::dvec3(0.0) : glm::normalize(normal);
        light.radiance = material.emission;
        light.doubleSided = material.doubleSided;
        light.weightPerArea =
            glm::pi<double>() * mean(meanRadiance[index]) * (material.doubleSided ? 2.0 : 1.0);
        light.weight = light.weightPerArea * area;
        light.area = area;
        light.g = std::uint32_t(g);
        light.material = index;
        lights.push_back(light);
        if (light.kind == LightKind::Parallelogram) ++g;
    }
}

void addPunctual(const Scene& scene, const glm::dvec3& origin, std::vector<Candidate>& lights) {
    const double radius = boundingRadius(scene);
    for (const PlacedLight& placed : scene.placedLights()) {
        const PunctualLight& source = scene.lights[std::size_t(placed.light)];
        const double strength = mean(glm::dvec3(source.intensity));
        if (!(strength > 0.0)) continue;
        Candidate light;
        light.origin = glm::dvec3(placed.transform[3]) - origin;
        light.radiance = source.intensity;
        const glm::dvec3 forward = -glm::dvec3(placed.transform[2]);
        light.normal = glm::length(forward) > 0.0 ? glm::normalize(forward) : glm::dvec3(0, 0, -1);
        switch (source.type) {
            case PunctualLight::Type::Point:
                light.kind = LightKind::Point;
                light.weight = 4.0 * glm::pi<double>() * strength;
                break;
            case PunctualLight::Type::Spot: {
                light.kind = LightKind::Spot;
                const double outer = std::cos(double(source.outerConeAngle));
                const double inner = std::cos(double(source.innerConeAngle));
                light.weight = 2.0 * glm::pi<double>() * strength * std::max(1.0 - outer, 1e-6);
                // KHR_lights_punctual: attenuation = clamp(cos * scale + offset, 0, 1)^2.
                const double scale = 1.0 / std::max(0.001, inner - outer);
                light.edge2 = {scale, -outer * scale, 0.0};
                break;
            }
            case PunctualLight::Type::Directional:
                light.kind = LightKind::Directional;
                light.weight = glm::pi<double>() * square(radius) * strength;
                break;
        }
        light.edge2.z = source.type == PunctualLight::Type::Directional ? 0.0 : double(source.range);
        lights.push_back(light);
    }
}

/** The image of the surroundings: what of its light falls on the scene's bounding sphere. */
void addEnvironment(const Scene& scene, const PackedScene& packed, std::vector<Candidate>& lights) {
    Candidate light;
    light.kind = LightKind::Environment;
    light.environmentPower = packed.environmentPower;
    light.weight = glm::pi<double>() * square(boundingRadius(scene)) * packed.environmentPower;
    lights.push_back(light);
}

/** A light as lightTables() wants it. */
LightSource sourceOf(const Candidate& light) {
    using Shape = LightSource::Shape;
    LightSource source;
    source.power = light.weight;
    source.normal = light.normal;
    source.bothFaces = light.doubleSided;
    source.centre = light.origin;
    const double pi = glm::pi<double>();
    switch (light.kind) {
        case LightKind::Triangle:
            source.centre += (light.edge1 + light.edge2) / 3.0;
            source.radius = 0.4 * std::max(glm::length(light.edge1), glm::length(light.edge2));
            source.strength = light.weight / pi;
            break;
        case LightKind::Sphere:
            source.radius = glm::length(light.edge1);
            source.bothFaces = false;  // without a normal it is one that faces all ways
            source.strength = light.weight / pi;
            break;
        case LightKind::Quad:
        case LightKind::Disc:
        case LightKind::Parallelogram:
            source.centre += 0.5 * (light.edge1 + light.edge2);
            source.radius = 0.4 * std::max(glm::length(light.edge1), glm::length(light.edge2));
            source.strength = light.weight / pi;
            break;
        case LightKind::Point:
            source.shape = Shape::Point;
            source.strength = mean(glm::dvec3(light.radiance));
            break;
        case LightKind::Spot:
            source.shape = Shape::Spot;
            source.strength = mean(glm::dvec3(light.radiance));
            source.coneScale = light.edge2.x;
            source.coneOffset = light.edge2.y;
            break;
        case LightKind::Directional:
            source.shape = Shape::Directional;
            source.strength = mean(glm::dvec3(light.radiance));
            break;
        case LightKind::Environment:
            source.shape = Shape::Environment;
            source.strength = light.environmentPower;
            break;
    }
    return source;
}

/** Builds the tables that choose among the lights, and puts these in the tables' order. */
void makeTables(std::vector<Candidate>& lights, std::span<const glm::vec3> positions, std::size_t surfaces,
                bool adaptive, PackedScene& packed) {
    std::vector<LightSource> sources;
    for (const Candidate& light : lights) sources.push_back(sourceOf(light));
    LightTables tables = lightTables(sources, positions, packed.environmentIrradiance, adaptive);
    std::vector<Candidate> ordered;
    for (std::uint32_t i : tables.order) ordered.push_back(lights[i]);
    lights = std::move(ordered);
    packed.lightSlots = std::move(tables.slots);
    packed.lightCells = std::move(tables.cells);
    packed.lightRanges = std::move(tables.ranges);
    packed.lightSlotBits = tables.bits;
    packed.lightGridSize = tables.size;
    packed.lightGridOrigin = tables.origin;
    packed.lightGridScale = tables.scale;
    packed.lightCuts = tables.cuts;
    packed.lightOfTriangle.assign(surfaces, 0);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].isSurface()) continue;
        packed.lightOfTriangle[lights[i].g] = std::uint32_t(i);
        if (lights[i].kind == LightKind::Parallelogram)
            packed.lightOfTriangle[lights[i].g + 1] = std::uint32_t(i);
    }
}

/** PackedScene::solidAngles for these lights. */
std::uint32_t solidAnglesOf(const std::vector<Candidate>& lights, std::span<const glm::vec3> places,
                            const std::function<bool(std::size_t)>& receives) {
    std::vector<FlatLight> flat;
    for (const Candidate& light : lights) {
        if (light.kind != LightKind::Triangle && light.kind != LightKind::Parallelogram &&
            light.kind != LightKind::Quad)
            continue;
        flat.push_back({light.origin, light.edge1, light.edge2, mean(glm::dvec3(light.radiance)),
                        light.kind == LightKind::Triangle, light.doubleSided});
    }
    const SolidAngleGain gain = solidAngleGain(flat, places, receives);
    return (gain.rectangles > kLeastGain ? 1u : 0u) | (gain.triangles > kLeastGain ? 2u : 0u);
}

glm::vec4 texel(const glm::dvec3& v, float w) {
    return {glm::vec3(v), w};
}
glm::vec4 texel(const glm::dvec3& v, std::uint32_t bits) {
    return {glm::vec3(v), glm::uintBitsToFloat(bits)};
}

}  // namespace

void lights(const Scene& scene, std::span<const glm::vec3> positions, std::span<const Surface> surfaces,
            const PackOptions& options, PackedScene& packed) {
    std::vector<Candidate> candidates;
    // Where a light stands depends on the time: materials of moving surfaces are found by rays alone.
    std::vector<bool> isMoving(scene.materials.size() + 1, false);
    for (const Surface& surface : surfaces)
        if (surface.moves) isMoving[surface.material] = true;
    if (options.sampleSurfaces) addSurfaces(scene, positions, surfaces, isMoving, candidates);
    packed.areaLights = !candidates.empty();
    const std::size_t areaCount = candidates.size();
    const std::vector<glm::vec3> onShapes =
        packed.hasShapes() ? surfaceTriangles(positions, surfaces) : std::vector<glm::vec3>();
    for (const Candidate& light : candidates) packed.triangleLights |= light.kind == LightKind::Triangle;
    addPunctual(scene, options.origin, candidates);
    packed.punctualLights = candidates.size() > areaCount;
    if (options.sampleSurfaces && !packed.environmentMap.empty()) addEnvironment(scene, packed, candidates);
    packed.lightCount = std::uint32_t(candidates.size());
    if (candidates.empty()) return;

    const std::span<const glm::vec3> places =
        onShapes.empty() ? positions : std::span<const glm::vec3>(onShapes);
    // Which light a triangle belongs to is told by the tables alone.
    if (candidates.size() == 1 || options.lights != LightChoice::Power)
        packed.solidAngles = solidAnglesOf(candidates, places, [&](std::size_t triangle) {
            // Lamps are mostly black. Triangles on shapes and of placed meshes are not told apart.
            if (!onShapes.empty() || triangle >= surfaces.size()) return true;
            const std::uint32_t material = surfaces[triangle].material;
            return material >= scene.materials.size() ||
                   !(mean(glm::dvec3(scene.materials[material].emission)) > 0.0);
        });
    // With few lights the tables gain nothing that pays for reading them.
    const std::size_t few =
        options.lights == LightChoice::Adaptive && packed.solidAngles == 0 ? kFewLights : 1;
    if (options.lights != LightChoice::Power && candidates.size() > few)
        makeTables(candidates, places, surfaces.size(), options.lights == LightChoice::Adaptive, packed);
    for (std::size_t g = 0; g < packed.lightOfTriangle.size(); ++g)
        if (isMoving[surfaces[g].material]) packed.lightOfTriangle[g] = ~0u;

    std::vector<double> weights;
    for (const Candidate& light : candidates) weights.push_back(light.weight);
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const AliasTable table = aliasTable(weights);
    packed.lightBits = table.bits;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Candidate& light = candidates[i];
        const bool surface = light.isSurface();
        const double chance = table.chance[i];
        const double density = surface ? light.weightPerArea / total : chance;
        // Error of a point on the surface from rounding its corners and the sum, along the normal; see
        // shaders/intersection/offset.glsl, which does the same for points that rays find.
        const glm::dvec3 far =
            glm::max(glm::max(glm::abs(light.origin), glm::abs(light.origin + light.edge1)),
                     glm::max(glm::abs(light.origin + light.edge2),
                              glm::abs(light.origin + light.edge1 + light.edge2)));
        const double unit = 0.5 * std::numeric_limits<float>::epsilon();
        double offset = surface ? 10.0 * unit * glm::dot(glm::abs(light.normal), far) : 0.0;
        if (light.kind == LightKind::Sphere) offset = 10.0 * unit;  // times what depends on the point
        packed.lights.push_back(texel(light.origin, table.slots[i].threshold));
        packed.lights.push_back(texel(light.edge1, table.slots[i].alias));
        packed.lights.push_back(texel(light.edge2, std::uint32_t(light.kind)));
        packed.lights.push_back({light.radiance, float(light.doubleSided ? -density : density)});
        packed.lights.push_back(texel(light.normal, float(offset)));
        packed.lights.push_back({glm::uintBitsToFloat(light.g), glm::uintBitsToFloat(light.material),
                                 float(chance), float(surface ? 1.0 / light.area : 0.0)});
        if (surface) packed.surfaceLightChances.push_back(float(chance));
        if (light.kind == LightKind::Environment)
            packed.environmentMap[0] = {float(chance), glm::uintBitsToFloat(std::uint32_t(i)), 0.0f, 0.0f};
        if (surface) packed.materials[std::size_t(light.material) * kMaterialTexels + 2].x = float(density);
    }
    // Slots of the alias table without a light of their own. A single light is taken without a table.
    for (std::size_t i = candidates.size(); candidates.size() > 1 && i < table.slots.size(); ++i) {
        packed.lights.push_back(texel(glm::dvec3(0.0), table.slots[i].threshold));
        packed.lights.push_back(texel(glm::dvec3(0.0), table.slots[i].alias));
        packed.lights.push_back(texel(glm::dvec3(0.0), std::uint32_t(LightKind::Point)));
        packed.lights.resize(packed.lights.size() + kLightTexels - 3, glm::vec4(0.0f));
    }
}

}  // namespace helio::pack
