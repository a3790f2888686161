#pragma once
/** @file
 * A scene flattened to the arrays kernels read: world-space triangles, their attributes, materials, textures
 * and lights. Host only, so that packing is tested without a device; DeviceScene uploads the result. Every
 * array is a whole number of 16-byte texels and is described beside its accessors in shaders/scene.
 */
#include "engine/scene/bvh.hpp"
#include "engine/scene/comparators.hpp"
#include "engine/scene/shape.hpp"

#include <heliograph/kernel.hpp>
#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace helio {

/** Texels per material in PackedScene::materials; shaders/scene/materials.glsl names them. */
inline constexpr std::uint32_t kMaterialTexels = 49;
/** Texels per light in PackedScene::lights; shaders/scene/lights.glsl names them. */
inline constexpr std::uint32_t kLightTexels = 6;
/** Texels per placement in PackedScene::placed; shaders/scene/placed.glsl names them. */
inline constexpr std::uint32_t kPlacedTexels = 9;

/** Triangles up to which a scene is written out as code, and as many of a larger one beside its tree. */
inline constexpr std::uint32_t kWrittenOutTriangles = 64, kWrittenOutBesideTree = 24;

/** Shapes up to which all are tested one by one, beside any tree. */
inline constexpr std::uint32_t kListedShapes = 16;

/** Loop turns of a torus's test (TORUS_TURNS of shaders/shared/torus.glsl), and of all listed shapes of a ray
 * at most: with those of the tree they stay below what lavapipe runs. */
inline constexpr std::size_t kTorusTurns = 192, kListedTurns = 8000;

/** How a light is sampled; the values are those of shaders/scene/lights.glsl. */
enum class LightKind : std::uint32_t {
    Triangle,
    Parallelogram,
    Point,
    Spot,
    Directional,
    Environment,
    Quad,
    Disc,
    Sphere
};
/** Texels before the image in PackedScene::environmentMap; shaders/scene/environment.glsl names them. */
inline constexpr std::uint32_t kEnvironmentHeader = 4;
/** Steps of PackedScene::diffuseEnvironment round the equator and from pole to pole;
 * shaders/raster/shading.glsl has them too. */
inline constexpr std::uint32_t kDiffuseEnvironmentWidth = 64, kDiffuseEnvironmentHeight = 32;

/** What becomes of a mesh that stands in the scene several times: each is flattened, or it is packed once and
 * placed (passes/scene/placed_meshes.hpp), all such meshes or those where that saves memory worth a slower
 * traversal. */
enum class Placing : std::uint8_t { Flatten, WhereItSaves, Always };

/** Where photons that could make caustics set out to: mirrors, glass and what is nearly as smooth. Empty
 * where a scene has none, no lamp that rays can find, or no rough surface to receive the light. */
struct PhotonTargets {
    std::vector<std::uint32_t>
        slots;         ///< each stands for an equal area; large triangles are there several times
    float area = 0;    ///< of all
    float extent = 0;  ///< longer than any way within the scene
};

struct PackOptions {
    /** Triangles are put in the order of a tree's leaves and the tree is packed; else they stay in scene
     * order and `nodes` is empty. */
    bool tree = true;
    /** Besides the tree, the largest triangles are kept out of it for kernels to hold as code
     * (PackedScene::writtenOut). Of Bvh alone. */
    bool writeOutLargest = false;
    /** What finds triangles along a ray, not Auto; only Bvh puts triangles in the order of its leaves. */
    AcceleratorKind accelerator = AcceleratorKind::Bvh;
    /** Of Bvh: spatial splits are made, and triangles may have several slots. Not where the tree holds boxes
     * of shapes, placed meshes or ways of moving triangles, which cannot be cut. Hits are the same. */
    bool spatialSplits = false;
    /** Of Bvh: the scene's tree is built on the device (passes/tree) by a DeviceScene. Hits are the same. */
    bool deviceTree = false;
    /** Emissive surfaces get into the light table. Punctual lights always do: no ray can find them. */
    bool sampleSurfaces = true;
    /** Rays that arrive at an environment by chance bring their part of its light (multiple importance
     * sampling), so that light sampling need not draw directions to its dim parts. */
    bool raysFindEnvironment = false;
    /** Adaptive and Uniform make tables (lightTables) where there are lights to choose among. */
    LightChoice lights = LightChoice::Power;
    /** Of Bvh alone, for scenes that do not move. Hits are the same. */
    Placing placing = Placing::Flatten;
    /** Triangles take the place of shapes. */
    bool shapesAsTriangles = false;
    /** What rasterization needs is packed: occlusion textures, which dim the light of surroundings that
     * nothing is traced to, lightmaps, and thicknesses of volumes. */
    bool occlusion = false;
    /** PackedScene::photonTargets is made. */
    bool photons = false;
    /** PackedScene::diffuseEnvironment is made. */
    bool diffuseEnvironment = false;
    /** The point of the world that becomes the packed scene's origin, so that floats resolve a scene that
     * stands far from the world's. */
    glm::dvec3 origin{0.0};
    bool operator==(const PackOptions&) const = default;
};

/** Arrays for the device. "Slot" is a triangle's place in `triangles`; "g" is its global index in scene
 * order: instances as Scene::instances() lists them, then the mesh's triangles over its primitives. */
struct PackedScene {
    /** 3 texels a slot: v0.xyz | bits(g), v1.xyz | bits(instance), v2.xyz | bits(material). World space
     * about PackOptions::origin, transformed in double and rounded once; counter-clockwise is front, mirrored
     * transforms included. A shape takes one slot and one g: centre, a and b of a PlacedShape, and 1 more
     * than its kind in the upper 4 bits of the material's word. A placement takes one slot and no g: 2^31 +
     * its index in place of g. Behind all slots lie the placed meshes' triangles, in their own space, without
     * an instance; their g are those after the flattened triangles'. */
    std::vector<glm::vec4> triangles;
    /** kPlacedTexels a placement, empty where all is flattened; slots of placed triangles have `placedBits`
     * for the triangle in its mesh. */
    std::vector<glm::uvec4> placed;
    std::uint32_t placedBits = 0;
    /** First g of every instance, of placed ones that of their mesh, and the number of g at the end. */
    std::vector<std::uint32_t> instanceFirst;
    /** 5 texels a node, see engine/scene/bvh.hpp; of other accelerators the words of a Comparator. Empty
     * without a tree. */
    std::vector<glm::uvec4> nodes;
    AcceleratorKind accelerator = AcceleratorKind::Bvh;  ///< of `nodes`
    bool splitTree = false;  ///< some g have several slots: SPLIT_TREE of shaders/intersection/traverse.glsl
    /** Texels of `triangles` that are in no tree, for kernels to hold as code: of the slots from
     * firstWrittenOut to the last. All of a small scene without a tree. */
    std::vector<glm::vec4> writtenOut;
    std::uint32_t firstWrittenOut = 0;
    std::vector<std::uint32_t> writtenOutEmitters;  ///< g of those that emit
    /** 3 texels a g (one per vertex): unit world-space shading normal, 0. Empty where no mesh has normals. */
    std::vector<glm::vec4> normals;
    /** 3 texels a g: u, v in the first set that the material's textures name, then in the second; 0 where the
     * primitive has no such set. Empty where no material in use samples a texture. */
    std::vector<glm::vec4> texcoords;
    /** 3 texels a g: unit world-space tangent, sign of the bitangent times the instance's scale (the cube
     * root of a unit cube's volume). Empty where no material needs them. */
    std::vector<glm::vec4> tangents;
    /** 256 texels with the permutation of Perlin's noise at i and i + 1; then 3 a g: the corner's place in
     * its mesh. Empty where no material in use has a solid texture. */
    std::vector<glm::vec4> solidPoints;
    /** 3 texels a g: linear colour. Empty where no mesh has colours. */
    std::vector<glm::vec4> colors;
    /** kMaterialTexels each; the last is glTF's default material. Then the tables of albedos, where needed.
     */
    std::vector<glm::vec4> materials;
    std::uint32_t albedoTables = 0;  ///< first of their texels
    std::vector<glm::vec4> lights;   ///< kLightTexels each
    /** Chance by power of every light that is a surface: the first rows of `lights`. Stays on the host. */
    std::vector<float> surfaceLightChances;
    std::vector<glm::uvec4> textures;    ///< offset, width, height, flags
    std::vector<std::uint32_t> texels8;  ///< RGBA8 as stored in the file, R in the low byte
    std::vector<glm::vec4> texelsFloat;  ///< linear float texels
    glm::vec3 environment{0.0f};  ///< radiance of what no geometry covers: constant, or times the image
    /** Of a scene that moves: corners at each of motionKeys times, 3 texels a slot, one time after another.
     */
    std::vector<glm::vec4> triangleKeys;
    std::vector<glm::vec4> normalKeys;  ///< `normals` likewise, where there are any
    std::uint32_t motionKeys = 0;       ///< 0 where nothing moves
    /** Image of the surroundings with the tables that draw from it, empty where they are constant. */
    std::vector<glm::vec4> environmentMap;
    std::array<std::uint32_t, 2> environmentSize{0, 0};  ///< texels
    /** Of the trees over rows, and over a row's cells. */
    std::array<std::uint32_t, 2> environmentLevels{1, 1}, environmentNodes{1, 1};
    bool environmentRotated = false;
    /** What a white Lambertian surface reflects of the image, by its normal in the image's frame: at column i
     * and row j that of u = i / width, v = j / height, both poles included. Empty unless asked for. */
    std::vector<glm::vec4> diffuseEnvironment;
    /** Radiance of the image over all directions, of what light sampling draws: W/m^2, mean over RGB. */
    double environmentPower = 0;
    std::array<double, 6> environmentIrradiance{};  ///< of it, on surfaces that face +x, -x, +y, ...
    PhotonTargets photonTargets;
    std::uint32_t triangleCount = 0;  ///< slots: with shapes and placements
    std::uint32_t shapeCount = 0;
    std::uint32_t listedShapes = 0;  ///< shapes in the last slots, which are in no tree
    bool shapesInTree = false, spheres = false, flatShapes = false, tori = false;
    bool hasShapes() const { return spheres || flatShapes || tori; }
    std::uint32_t lightCount = 0;
    std::uint32_t lightBits = 1;  ///< the light table has 2^lightBits rows, filler after the lights
    std::uint32_t nodeCount = 0;  ///< of the tree, holes of its blocks included
    std::uint32_t treeDepth = 0;  ///< levels; bounds the traversal stack
    /** Tables that choose lights, see passes/scene/light_tables.hpp; empty where they are chosen by power. */
    std::vector<glm::uvec4> lightSlots;
    std::vector<std::uint32_t> lightCells;       ///< per cell and axis: number of a table
    std::vector<std::uint32_t> lightRanges;      ///< of cuts
    std::vector<std::uint32_t> lightOfTriangle;  ///< per g: row of the light table, 0 where it is no light
    std::uint32_t lightSlotBits = 1;
    glm::ivec3 lightGridSize{0};  ///< cells; 0: one table for all places
    glm::vec3 lightGridOrigin{0.0f};
    float lightGridScale = 0;  ///< cells per metre
    bool lightCuts = false;
    bool areaLights = false;      ///< some light in the table is a surface
    bool triangleLights = false;  ///< some surface in the table is no parallelogram
    /** Lights that are sampled by the solid angle they fill (shaders/scene/solid_angle_light.glsl): 1
     * rectangles, 2 triangles. 0 where all are too small, as seen from the scene's surfaces, for that to pay.
     */
    std::uint32_t solidAngles = 0;
    bool punctualLights = false;    ///< some light in the table is punctual
    bool emission = false;          ///< some surface in use emits
    bool texturedEmission = false;  ///< emission varies over some surface in use
    bool baseColorTextures = false;
    bool occlusionTextures = false;  ///< of PackOptions::occlusion, where there are surroundings to dim
    bool lightmaps = false;  ///< of PackOptions::occlusion: some material shows the light of a texture
    /** Whether textures of light at rest are packed. */
    bool bakedTextures() const { return occlusionTextures || lightmaps || volumes; }
    bool volumes = false;  ///< of PackOptions::occlusion: some material has a thickness
    /** Of PackOptions::occlusion, where some surface lets light through: every instance's scale, the cube
     * root of a unit cube's volume. */
    std::vector<float> instanceScales;
    bool alphaMasks = false, alphaBlends = false;  ///< modes of materials in use
    bool solidTextures = false;                    ///< some base colour varies over space
    bool linearTextures = false;         ///< some 8-bit texture holds data, which is not sRGB-encoded
    bool normalLevels = false;           ///< some normal map asks for mip levels
    std::uint32_t materialFeatures = 0;  ///< passes/scene/material_layout.hpp; 0: all surfaces are Lambertian
    /** Whether light goes through some surface of a material in use. */
    bool transmits() const;
    bool roughFacets = false;  ///< some material in use has microfacets of a width
    bool tiltedLobes =
        false;  ///< some normal of vertices or of a map is that of a surface with more than mirrors
    bool doubleSidedEmission = false;
    /** "WHAT", "WHY" of everything in the scene that no kernel shows (yet). */
    std::vector<std::pair<std::string, std::string>> skipped;
    /** What the raster pipeline leaves out besides. */
    std::vector<std::pair<std::string, std::string>> rasterSkipped;
    std::vector<std::string> warnings;  ///< what of the scene is not shown as it is given
    double treeSeconds = 0;             ///< time to build the tree

    std::uint64_t bytes() const;
};

/** What a kernel that intersects through scene_hit.glsl or comparators.glsl is compiled with for another
 * accelerator than Bvh. */
KernelVariant acceleratorVariant(AcceleratorKind kind);

/** Flattens a scene. Throws InputError where an index is out of range, a position is not finite in float, or
 * the scene has more triangles or texels than a 32-bit index reaches. */
PackedScene packScene(const Scene& scene, const PackOptions& options = {});
/** Flattens a scene that moves: `later` is the same scene at further times, evenly spaced; every vertex goes
 * in straight lines from one to the next. Boxes of the tree hold a triangle's whole way. Surfaces that emit
 * and move, and those of their materials, are left out of the light table. Takes Bvh alone. */
PackedScene packScene(const Scene& scene, std::span<const Scene> later, const PackOptions& options);
/** With another builder of the scene's tree than buildBvh(). */
using BuildTree = std::function<Bvh(std::span<const glm::vec3> positions)>;
PackedScene packScene(const Scene& scene, std::span<const Scene> later, const PackOptions& options,
                      const BuildTree& build);

namespace pack {
// The steps of packScene, each in its own file. All append to `packed`.

/** One triangle of the flattened scene with what the later steps need. */
struct Surface {
    std::uint32_t instance = 0;
    std::uint32_t material = 0;  ///< into the packed materials
    bool moves = false;
    std::uint32_t shape = 0;  ///< 1 more than its kind; 0: a triangle
};

/** What a shape's three vectors among the positions (centre, a, b) say. */
PlacedShape shapeOf(const glm::vec3* vectors, std::uint32_t shape);

struct PlacedMeshes;
/** World-space positions (3 per g) and attributes; fills everything that is indexed by g. `placed`: meshes
 * that follow in their own space, while their instances are left out. PackedScene::triangleCount becomes that
 * of the flattened triangles. */
std::vector<glm::vec3> geometry(const Scene& scene, const glm::dvec3& origin, PackedScene& packed,
                                std::vector<Surface>& surfaces, PlacedMeshes* placed = nullptr);
/** Corners of triangles with the same boxes as the shapes, and the triangles themselves: what a tree is built
 * of. */
std::vector<glm::vec3> treeCorners(std::span<const glm::vec3> positions, std::span<const Surface> surfaces);
/** Triangles, and in place of shapes ones on them: where surfaces are, for estimates. */
std::vector<glm::vec3> surfaceTriangles(std::span<const glm::vec3> positions,
                                        std::span<const Surface> surfaces);
/** Triangles that lie exactly on an opaque one of lower g and face as it does become points, which nothing
 * meets: the lower index wins a tie. Else rounding would let the one shadow the other, and its light would
 * count twice. `fromBothSides`: also those that face the other way, where neither emits; for rays, which meet
 * back faces. Returns how many. */
std::size_t collapseTwins(const Scene& scene, std::span<const Surface> surfaces, bool fromBothSides,
                          std::span<glm::vec3> positions);
/** Positions at every time, the first included; fills PackedScene::normalKeys and motionKeys and says which
 * surfaces move. */
std::vector<std::vector<glm::vec3>> motion(const std::vector<glm::vec3>& positions,
                                           std::span<const Scene> later, const PackOptions& options,
                                           PackedScene& packed, std::vector<Surface>& surfaces);
/** Triangles with the boxes of the moving ones' whole ways: what a tree is built of. */
std::vector<glm::vec3> waysBoxes(const std::vector<std::vector<glm::vec3>>& keys);
/** Materials and textures that some instance uses. */
void materials(const Scene& scene, const std::vector<bool>& materialUsed, PackedScene& packed);
/** The light table: emissive triangles (pairs that make a parallelogram as one) and punctual lights, chosen
 * in proportion to power by an alias table; also each material's sampling density per area. Positions beyond
 * the surfaces' are further triangles that light falls on. */
void lights(const Scene& scene, std::span<const glm::vec3> positions, std::span<const Surface> surfaces,
            const PackOptions& options, PackedScene& packed);

/** The environment, and where it is an image its texels and tables. Before the lights, of which it is one. */
void environment(const Scene& scene, const PackOptions& options, PackedScene& packed);
/** PackedScene::diffuseEnvironment of a latitude-longitude image of finite radiances. Ramamoorthi and
 * Hanrahan, "An efficient representation for irradiance environment maps", 2001, show how smooth it is: the
 * table's own steps leave about 0.1 % of its range. */
std::vector<glm::vec4> diffuseEnvironment(std::span<const glm::vec3> texels, std::uint32_t width,
                                          std::uint32_t height);

/** PackedScene::photonTargets; `order`: the g of every slot. */
PhotonTargets photonTargets(const Scene& scene, std::span<const glm::vec3> positions,
                            std::span<const Surface> surfaces, std::span<const std::uint32_t> order,
                            const PackedScene& packed);

/** "WHAT", "WHY" of what materials ask for and kernels do not show, once each; of the materials in use alone.
 */
std::vector<std::pair<std::string, std::string>> notShown(const Scene& scene,
                                                          const std::vector<bool>& materialUsed);

/** Unit tangents of a primitive's corners in its own space, 3 a triangle, with the bitangent's sign: those it
 * has, else by its texture coordinates (see pack_tangents.cpp). */
std::vector<glm::vec4> tangents(const Primitive& primitive, int texcoordSet);

/** Mean linear RGB of a texture used as colour. */
glm::dvec3 meanColor(const TextureImage& image);
}  // namespace pack

}  // namespace helio
