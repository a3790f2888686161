#pragma once
/** @file
 * The scene model: what importers fill and applications build in code. Right-handed, +Y up, metres unless
 * the scene says otherwise; counter-clockwise is front; cameras look along their node's -Z. Angles are
 * radians; colours are linear Rec.709; radiance is W/(sr m^2) per channel. See the project's contract.
 */
#include <heliograph/camera.hpp>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace helio {

enum class Wrap : std::uint8_t { Repeat, MirroredRepeat, ClampToEdge };
enum class Filter : std::uint8_t { Nearest, Linear };

/** Decoded pixels shared by textures. 8 or 16 bits per channel are stored as in the file (encoded); floats
 * are linear. Always 4 channels, rows from the top. */
struct TextureImage {
    std::string name;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> texels;
};

struct Texture {
    std::string name;
    int image = -1;  ///< into Scene::images
    Wrap wrapU = Wrap::Repeat;
    Wrap wrapV = Wrap::Repeat;
    Filter magFilter = Filter::Linear;
    Filter minFilter = Filter::Linear;
    bool useMipmaps = true;
};

/** A material's use of a texture. */
struct TextureUse {
    int texture = -1;           ///< into Scene::textures; -1 for none
    int texcoord = 0;           ///< which UV set
    glm::mat3 transform{1.0f};  ///< applied to (u, v, 1)
    explicit operator bool() const { return texture >= 0; }
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

/** A scattering model that glTF's parameters cannot say. It takes the place of all that a material says about
 * scattering; base colour (a tint where the model says nothing else), normal map, emission and alpha stay. */
struct Scattering {
    enum class Model : std::uint8_t {
        OrenNayar,       ///< rough diffuse: `roughness` 0..1, in Fujii's energy-conserving form
        Mirror,          ///< reflects all light, times the base colour
        Dielectric,      ///< interface to the index n.r, by Fresnel; light goes through by Snell's law
        ThinDielectric,  ///< a pane of the index n.r: light goes through in line, times the base colour
        Conductor,       ///< metal of index n + i k, times the base colour
        Phong,           ///< cos^exponent about the mirrored direction, times the base colour
        BlinnPhong       ///< cos^exponent of the half vector, times the base colour
    };
    Model model = Model::OrenNayar;
    float roughness = 0;    ///< OrenNayar
    glm::vec2 alpha{0.0f};  ///< width of microfacets along tangent and bitangent; 0: smooth
    bool beckmann = false;  ///< Beckmann's facets, else GGX
    bool schlick = false;   ///< Dielectric: Schlick's approximation of Fresnel's equations
    glm::vec3 n{1.5f};      ///< refractive index per channel
    glm::vec3 k{0.0f};      ///< extinction per channel
    float exponent = 0;     ///< Phong, BlinnPhong
    /** Conductor, Dielectric: adds the light of several scatterings between facets, which the model loses
     * otherwise. Where widths along tangent and bitangent differ, what the mean over the azimuth loses. */
    bool multipleScattering = false;
};

/** A pattern in space that a surface is cut out of, by Perlin's noise: its share between two colours, which
 * multiplies the base colour. Coordinates are those of the mesh before it is placed, skinned or morphed. */
struct SolidTexture {
    enum class Pattern : std::uint8_t {
        Noise,   ///< one feature a unit
        Clouds,  ///< noise of six sizes
        Marble,  ///< veins across x
        Wood     ///< rings about y
    };
    Pattern pattern = Pattern::Noise;
    glm::vec3 first{1.0f}, second{0.0f};  ///< linear colours, 0..1
    float scale = 1.0f;                   ///< features per unit of the mesh's own space
};

/** The glTF 2.0 metallic-roughness material. Defaults are glTF's. */
struct Material {
    std::string name;
    glm::vec4 baseColor{1.0f};
    TextureUse baseColorTexture;  ///< sRGB
    float metallic = 1.0f;
    float roughness = 1.0f;
    TextureUse metallicRoughnessTexture;  ///< G roughness, B metallic, linear
    TextureUse normalTexture;
    float normalScale = 1.0f;
    /** R, linear: the surface stands out by this times heightScale, in units of the mesh's own space. Tilts
     * normals (bump mapping) until displace() moves the surface itself. */
    TextureUse heightTexture;
    float heightScale = 0.0f;
    TextureUse occlusionTexture;
    float occlusionStrength = 1.0f;
    /** Irradiance (W/m^2) of all light on the surface, linear, as bakeIrradiance() finds it: the raster
     * pipeline shows it in place of the diffuse light that it would find, and reads no occlusionTexture then.
     */
    TextureUse lightmapTexture;
    glm::vec3 emission{0.0f};    ///< radiance: emissive factor times strength
    TextureUse emissiveTexture;  ///< sRGB
    float specular = 1.0f;       ///< KHR_materials_specular factor; 0 with metallic 0 is exactly Lambertian
    TextureUse specularTexture;
    glm::vec3 specularColor{1.0f};
    TextureUse specularColorTexture;
    float ior = 1.5f;
    float transmission = 0.0f;       ///< KHR_materials_transmission
    TextureUse transmissionTexture;  ///< R, linear
    float thickness = 0.0f;       ///< KHR_materials_volume: 0 is thin-walled; metres of the mesh's own space
    TextureUse thicknessTexture;  ///< G, linear
    float attenuationDistance = std::numeric_limits<float>::infinity();  ///< metres of the world
    glm::vec3 attenuationColor{1.0f};  ///< what of white light is left after attenuationDistance
    float clearcoat = 0.0f;            ///< KHR_materials_clearcoat
    TextureUse clearcoatTexture;       ///< R, linear
    float clearcoatRoughness = 0.0f;
    TextureUse clearcoatRoughnessTexture;  ///< G, linear
    TextureUse clearcoatNormalTexture;
    float clearcoatNormalScale = 1.0f;
    glm::vec3 sheenColor{0.0f};    ///< KHR_materials_sheen
    TextureUse sheenColorTexture;  ///< sRGB
    float sheenRoughness = 0.0f;
    TextureUse sheenRoughnessTexture;  ///< A, linear
    float anisotropyStrength = 0.0f;   ///< KHR_materials_anisotropy
    float anisotropyRotation = 0.0f;   ///< radians, counter-clockwise from the tangent
    TextureUse anisotropyTexture;      ///< RG direction in [-1, 1], B strength, linear
    float iridescence = 0.0f;          ///< KHR_materials_iridescence
    TextureUse iridescenceTexture;     ///< R, linear
    float iridescenceIor = 1.3f;
    float iridescenceThicknessMinimum = 100.0f;  ///< nanometres
    float iridescenceThicknessMaximum = 400.0f;  ///< nanometres; taken where there is no texture
    TextureUse iridescenceThicknessTexture;      ///< G, linear, from minimum to maximum
    float dispersion = 0.0f;                     ///< KHR_materials_dispersion: 20 / Abbe number
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;  ///< emits from both faces
    bool unlit = false;
    std::optional<Scattering> scattering;  ///< instead of glTF's
    std::optional<SolidTexture> solid;     ///< multiplies the base colour
    /** What the file asked for that the model cannot hold yet, e.g. "KHR_materials_sheen". */
    std::vector<std::string> unsupported;
};

/** What a morph weight of 1 adds to a primitive's attributes. Each is empty or one per position. */
struct MorphTarget {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec3> tangents;
};

/** A surface that a formula gives, in the space of its mesh. Flat ones lie in the XY plane and face +Z; a
 * sphere has its poles on Y, with u = 1/2 + atan2(x, z) / 2 pi and v = acos(y) / pi. Texture coordinates of a
 * disc or quad run from 0 to 1 over the rectangle around it, u along X and v against Y; of a plane once a
 * unit; of a torus u = 1/2 + atan2(y, x) / 2 pi, and v runs likewise round the tube, 1/2 at its outermost.
 * Nodes may place flat shapes in any way, and round ones with a scale that is the same along all axes. */
struct Shape {
    enum class Kind : std::uint8_t {
        Sphere,
        Plane,  ///< without end
        Disc,
        Quad,
        Torus  ///< a tube round Z
    };
    Kind kind = Kind::Sphere;
    float radius = 1;             ///< Sphere, Disc; of the Torus's circle through the middle of its tube
    float tubeRadius = 0.25f;     ///< Torus: below `radius`
    float width = 1, height = 1;  ///< Quad, along X and Y
    bool operator==(const Shape&) const = default;
};

/** Triangles with one material, or one shape. Attributes are empty or one per position. */
struct Primitive {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;                 ///< unit, or empty: flat-shaded
    std::vector<glm::vec4> tangents;                ///< w is the bitangent's sign
    std::vector<std::vector<glm::vec2>> texcoords;  ///< per set
    std::vector<glm::vec4> colors;                  ///< linear, multiplies the base colour
    std::vector<std::uint32_t> indices;             ///< 3 per triangle; always filled
    int material = -1;                              ///< into Scene::materials; -1 for glTF's default material
    /** The material under each of Scene::variants, as `material` counts. Empty: `material` under all. */
    std::vector<int> variantMaterials;
    std::vector<MorphTarget> targets;  ///< the same number in every primitive of a mesh
    /** Per set of 4 influences and position: indices into Skin::joints, and weights whose sum over the sets
     * is
     * 1. Both empty for a primitive that no skin moves. */
    std::vector<std::vector<glm::u16vec4>> joints;
    std::vector<std::vector<glm::vec4>> weights;
    std::optional<Shape> shape{};  ///< in place of triangles: there are no positions then
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> weights{};  ///< per morph target, for nodes without weights; empty: 0
};

struct PunctualLight {
    enum class Type : std::uint8_t { Point, Spot, Directional };
    std::string name;
    Type type = Type::Point;
    glm::vec3 intensity{1.0f};  ///< colour times intensity: W/sr, W/m^2 for directional
    float range = 0;            ///< 0: unlimited
    float innerConeAngle = 0;
    float outerConeAngle = 0.7853982f;
};

/** An instrument that reads the scene's light, placed by a node: it faces along the node's -Z as cameras do,
 * the node's scale does not count, and it hides nothing. The path pipeline reads it, see
 * RenderResult::meters. */
struct Meter {
    enum class Quantity : std::uint8_t {
        Irradiance,  ///< W/m^2 that arrive at a point from before it
        Flux,        ///< W that arrive on a rectangle from before it
        Radiance,    ///< W/(sr m^2) that arrive at a point along the axis
        /** W/sr that what lies before the rectangle gives off towards it, as seen from infinitely far: all
         * that rays through the rectangle along the axis meet. Punctual lights show in none. */
        Intensity
    };
    std::string name;
    Quantity quantity = Quantity::Irradiance;
    float width = 1, height = 1;  ///< of the rectangle, along the node's X and Y
};

/** Translation, rotation and scale, applied from right to left. */
struct Placement {
    glm::vec3 translation{0.0f};
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
    glm::vec3 scale{1.0f};
    /** The rotation is normalised; a zero one is none. */
    glm::dmat4 matrix() const;
};

/** Joints that move the vertices of meshes. A skinned mesh ignores the transform of its own node. */
struct Skin {
    std::string name;
    std::vector<int> joints;                     ///< into Scene::nodes
    std::vector<glm::mat4> inverseBindMatrices;  ///< one per joint, or empty for identity
};

enum class AnimationPath : std::uint8_t { Translation, Rotation, Scale, Weights };
enum class Interpolation : std::uint8_t { Linear, Step, CubicSpline };

/** How one property of one node changes. A value has 3 numbers, or 4 (a quaternion x, y, z, w), or one per
 * morph target. A cubic spline has three values per time: in-tangent, value, out-tangent. */
struct AnimationChannel {
    int node = -1;  ///< into Scene::nodes
    AnimationPath path = AnimationPath::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;  ///< seconds, ascending, at least one
    std::vector<float> values;
};

struct Animation {
    std::string name;
    std::vector<AnimationChannel> channels;
};

/** A node of the hierarchy. The local transform is `matrix` where given, else translation, rotation, scale.
 */
struct Node {
    std::string name;
    std::vector<int> children;
    std::optional<glm::mat4> matrix;
    glm::vec3 translation{0.0f};
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
    glm::vec3 scale{1.0f};
    int mesh = -1;
    int camera = -1;
    int light = -1;
    int skin = -1;               ///< into Scene::skins, for `mesh`
    std::vector<float> weights;  ///< per morph target of `mesh`; empty: the mesh's
    /** Where copies of `mesh` stand in this node's space. Empty: one, as the node itself. */
    std::vector<Placement> copies;
    /** Where the mesh stands in the world, whatever the hierarchy says: a point that its vertices are
     * relative to. For meshes whose vertices a skin placed. */
    std::optional<glm::dvec3> meshOrigin;
    int meter = -1;  ///< into Scene::meters
    glm::dmat4 localTransform() const;
};

/** Light from everywhere that geometry does not cover. */
struct Environment {
    glm::vec3 radiance{0.0f};  ///< constant, or multiplies the image
    /** Lat-long, into Scene::images; -1 for constant. +Y up, u = 1/2 - atan2(x, z) / 2 pi, v = acos(y) / pi
     * from the top; 8 and 16 bits are sRGB-encoded, floats linear. */
    int image = -1;
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< of the image in the world
    bool operator==(const Environment&) const = default;
};

/** A mesh placed in the world: one per node that holds a mesh (or one per Node::copies), in depth-first order
 * from Scene::roots. Its index is the instance id of outputs; triangle ids count a mesh's triangles over its
 * primitives in order, of which a shape is one. */
struct Instance {
    int node = -1;
    int mesh = -1;
    glm::dmat4 transform{1.0};  ///< object to world
};
struct PlacedCamera {
    int node = -1;
    int camera = -1;
    glm::dmat4 transform{1.0};
};
struct PlacedLight {
    int node = -1;
    int light = -1;
    glm::dmat4 transform{1.0};
};
struct PlacedMeter {
    int node = -1;
    int meter = -1;
    glm::dmat4 transform{1.0};
};

struct Scene {
    std::string name;  ///< as reported: file name or sample:NAME
    std::vector<TextureImage> images;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Camera> cameras;
    std::vector<PunctualLight> lights;
    std::vector<Node> nodes;
    std::vector<int> roots;  ///< nodes of the shown scene
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    std::vector<std::string> variants;  ///< names that Primitive::variantMaterials counts by
    std::vector<Meter> meters;
    std::optional<Environment> environment;
    /** What the importer read over, as "WHAT: WHY" pairs for the statistics. */
    std::vector<std::pair<std::string, std::string>> skipped;
    std::vector<std::string> warnings;

    /** Refuses what nothing can be computed from: an index out of range, attributes of the wrong number, a
     * number that is not finite or out of its range, a cyclic hierarchy. Throws InputError with the place.
     * Scenes from load() pass; those built in code are checked when they are rendered. */
    void validate() const;
    /** World placements, computed in double, depth first from the roots, parents before children. Throw
     * InputError for a node reached twice (a cycle or two parents) or an index out of range. */
    std::vector<Instance> instances() const;
    std::vector<PlacedCamera> placedCameras() const;
    std::vector<PlacedLight> placedLights() const;
    std::vector<PlacedMeter> placedMeters() const;
    /** World bounds of all instances' finite vertices (those that indices use; every index must be in range)
     * and of their shapes (of a plane its origin alone), and number of triangles with every instance counted.
     */
    struct Bounds {
        glm::dvec3 lower{std::numeric_limits<double>::infinity()};
        glm::dvec3 upper{-std::numeric_limits<double>::infinity()};
        bool empty() const { return !(lower.x <= upper.x); }
    };
    Bounds bounds() const;
    std::uint64_t triangleCount() const;
    /** Number of shapes, with every instance counted. */
    std::uint64_t shapeCount() const;
};

/** Reads a PNG, JPEG, WebP, OpenEXR, HDR, TIFF, BMP or TGA file: 8 or 16 bits as stored, all else as floats.
 * What Environment::image or a texture wants. Throws InputError naming the file. */
TextureImage loadTextureImage(const std::filesystem::path& file);

/** State of a running load. */
struct LoadProgress {
    std::string stage;    ///< what is being done, e.g. "geometry" or "images"
    double fraction = 0;  ///< 0..1 of that
};

struct LoadOptions {
    /** Called now and then, one call at a time, from any thread. Returning false stops the load. */
    std::function<bool(const LoadProgress&)> progress = {};
    /** Name of one of the file's material variants, which is then shown; "" for the materials as they are. */
    std::string variant = {};
    /** Textures are loaded for the materials of all variants, for chooseVariant(); else for shown ones. */
    bool everyVariant = false;
};

/** Loads a file by its extension (.gltf, .glb, .obj, .ply, .stl) or "sample:NAME". Throws InputError, or
 * Cancelled where LoadOptions::progress asked for it. */
Scene load(const std::string& source, const LoadOptions& options = {});
/** Gives every primitive the material that it has under one of Scene::variants. Throws InputError that lists
 * them. Load with LoadOptions::everyVariant first. */
void chooseVariant(Scene& scene, const std::string& name);
/** Names of the built-in samples. */
std::vector<std::string> sampleNames();

/**
 * The camera to render with. `nameOrIndex` is the name of a placed camera or of its node, else an index into
 * Scene::placedCameras(); "" takes the first placed one. Throws InputError that lists the cameras.
 *
 * A scene without a placed camera is framed, for "": with c the centre of Scene::bounds() and r half its
 * diagonal, the camera stands at c - d f and looks along f = (0, -1/2, -1) / |(0, -1/2, -1)| with +X to the
 * right; vertical field of view 45 degrees, near plane d / 100. d = r / sin(h), where h is half the smaller
 * of the vertical and the horizontal field of view at `aspect` (width over height): the bounding sphere
 * touches the image's nearer edges. r is at least 2^-22 |c|, what single precision resolves there, and 1 for
 * a scene that is a single point at the origin or has no triangles (c is then the origin). The camera is
 * appended to scene.cameras as "heliograph.frame" (once; later calls overwrite it) and has node -1.
 */
PlacedCamera chooseCamera(Scene& scene, const std::string& nameOrIndex, double aspect = 1.0);

}  // namespace helio
