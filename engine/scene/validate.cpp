/** @file What every scene must satisfy before anything is computed from it, an importer's or an
 * application's. */
#include "engine/scene/lens_table.hpp"
#include "engine/scene/shape.hpp"

#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace helio {
namespace {

class Validator {
public:
    explicit Validator(const Scene& scene) : scene_(scene) {}

    void run() {
        for (std::size_t i = 0; i < scene_.images.size(); ++i)
            check(scene_.images[i], fmt::format("image {}", i));
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
            index(fmt::format("texture {}", i), "image", scene_.textures[i].image, scene_.images.size(), 0);
        }
        for (std::size_t i = 0; i < scene_.materials.size(); ++i)
            check(scene_.materials[i], fmt::format("material {}", i));
        for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
            const auto& primitives = scene_.meshes[m].primitives;
            for (std::size_t p = 0; p < primitives.size(); ++p) {
                const std::string place = fmt::format("mesh {} primitive {}", m, p);
                check(primitives[p], place);
                if (primitives[p].targets.size() != primitives[0].targets.size())
                    refuse(place, "has another number of morph targets than the mesh's first primitive",
                           "give every primitive of a mesh as many");
            }
            const std::size_t targets = primitives.empty() ? 0 : primitives[0].targets.size();
            if (!scene_.meshes[m].weights.empty() && scene_.meshes[m].weights.size() != targets)
                refuse(fmt::format("mesh {}", m),
                       fmt::format("has {} weights for {} morph targets", scene_.meshes[m].weights.size(),
                                   targets),
                       "give none, or one per target");
        }
        for (std::size_t i = 0; i < scene_.cameras.size(); ++i)
            check(scene_.cameras[i], fmt::format("camera {}", i));
        for (std::size_t i = 0; i < scene_.lights.size(); ++i)
            check(scene_.lights[i], fmt::format("light {}", i));
        for (std::size_t i = 0; i < scene_.meters.size(); ++i) {
            number(fmt::format("meter {}", i), "width", scene_.meters[i].width, smallest, largest);
            number(fmt::format("meter {}", i), "height", scene_.meters[i].height, smallest, largest);
        }
        if (scene_.environment) {
            light("environment", "radiance", scene_.environment->radiance);
            index("environment", "image", scene_.environment->image, scene_.images.size(), -1);
            const glm::quat& rotation = scene_.environment->rotation;
            number("environment", "rotation's squared length", glm::dot(rotation, rotation), 0.5, 2);
        }
        checkPlacements();
        for (std::size_t i = 0; i < scene_.skins.size(); ++i)
            check(scene_.skins[i], fmt::format("skin {}", i));
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i)
            checkDeformation(scene_.nodes[i], fmt::format("node {}", i));
        for (std::size_t a = 0; a < scene_.animations.size(); ++a) {
            const auto& channels = scene_.animations[a].channels;
            for (std::size_t c = 0; c < channels.size(); ++c)
                check(channels[c], fmt::format("animation {} channel {}", a, c));
        }
    }

private:
    [[noreturn]] void refuse(const std::string& place, std::string fault, std::string remedy) const {
        throw InputError(scene_.name, place, std::move(fault), std::move(remedy));
    }

    void index(const std::string& place, const char* what, int value, std::size_t size, int lowest) const {
        if (value >= lowest && (value < 0 || std::size_t(value) < size)) return;
        refuse(place, fmt::format("its {} {} does not exist", what, value),
               fmt::format("the scene has {}", size));
    }

    void number(const std::string& place, const char* what, double value, double low, double high) const {
        if (value >= low && value <= high) return;  // false for NaN
        refuse(place, fmt::format("its {} is {}", what, value),
               fmt::format("give a number from {} to {}", low, high));
    }

    void unit(const std::string& place, const char* what, double value) const {
        number(place, what, value, 0, 1);
    }

    void color(const std::string& place, const char* what, glm::vec3 value) const {
        for (int c = 0; c < 3; ++c) number(place, what, value[c], 0, largest);
    }

    /** What light a picture can hold. */
    void light(const std::string& place, const char* what, glm::vec3 value) const {
        color(place, what, value);
        for (int c = 0; c < 3; ++c) {
            if (value[c] > brightest)
                refuse(place, fmt::format("its {} is {}", what, value[c]),
                       "the film takes at most 2^100 (1.27e30): give the scene another unit of power");
        }
    }

    template <class Vector>
    void finite(const std::string& place, const char* what, const std::vector<Vector>& values) const {
        for (std::size_t i = 0; i < values.size(); ++i) {
            for (int c = 0; c < Vector::length(); ++c) {
                if (!std::isfinite(values[i][c])) {
                    refuse(place, fmt::format("{} {} is not finite", what, i), "give finite numbers");
                }
            }
        }
    }

    void check(const TextureImage& image, const std::string& place) const {
        const std::size_t values = std::visit([](const auto& texels) { return texels.size(); }, image.texels);
        if (image.width > 0 && image.height > 0 && values == std::size_t(image.width) * image.height * 4)
            return;
        refuse(place, fmt::format("has {} values for {} x {} texels", values, image.width, image.height),
               "give 4 values a texel, and at least one texel");
    }

    void use(const std::string& place, const char* what, const TextureUse& use) const {
        index(place, what, use.texture, scene_.textures.size(), -1);
        number(place, "texture coordinate set", use.texcoord, 0, 255);
        for (int c = 0; c < 3; ++c) {
            for (int r = 0; r < 3; ++r)
                number(place, "texture transform", use.transform[c][r], -largest, largest);
        }
    }

    void check(const Material& material, const std::string& place) const {
        for (int c = 0; c < 4; ++c) unit(place, "baseColor", material.baseColor[c]);
        unit(place, "metallic", material.metallic);
        unit(place, "roughness", material.roughness);
        unit(place, "specular", material.specular);
        number(place, "normalScale", material.normalScale, -largest, largest);
        unit(place, "occlusionStrength", material.occlusionStrength);
        number(place, "ior", material.ior, 0, largest);
        number(place, "alphaCutoff", material.alphaCutoff, 0, largest);
        light(place, "emission", material.emission);
        color(place, "specularColor", material.specularColor);
        use(place, "baseColorTexture", material.baseColorTexture);
        use(place, "metallicRoughnessTexture", material.metallicRoughnessTexture);
        use(place, "normalTexture", material.normalTexture);
        number(place, "heightScale", material.heightScale, -largest, largest);
        use(place, "heightTexture", material.heightTexture);
        use(place, "occlusionTexture", material.occlusionTexture);
        use(place, "lightmapTexture", material.lightmapTexture);
        use(place, "emissiveTexture", material.emissiveTexture);
        use(place, "specularTexture", material.specularTexture);
        use(place, "specularColorTexture", material.specularColorTexture);
        checkVolume(material, place);
        checkCoats(material, place);
        if (material.solid) {
            for (int c = 0; c < 3; ++c) {
                unit(place, "solid.first", material.solid->first[c]);
                unit(place, "solid.second", material.solid->second[c]);
            }
            number(place, "solid.scale", material.solid->scale, -largest, largest);
        }
        if (material.scattering) checkScattering(*material.scattering, place);
    }

    void checkScattering(const Scattering& scattering, const std::string& place) const {
        unit(place, "scattering.roughness", scattering.roughness);
        for (int c = 0; c < 2; ++c) unit(place, "scattering.alpha", scattering.alpha[c]);
        for (int c = 0; c < 3; ++c) {
            number(place, "scattering.n", scattering.n[c], 0.01f, 100);
            number(place, "scattering.k", scattering.k[c], 0, 100);
        }
        number(place, "scattering.exponent", scattering.exponent, 0, 1e6f);
        using Model = Scattering::Model;
        if (scattering.multipleScattering && scattering.model != Model::Conductor &&
            scattering.model != Model::Dielectric)
            refuse(place, "asks for multiple scattering between facets that its model has not",
                   "take the model conductor or dielectric");
    }

    void checkVolume(const Material& material, const std::string& place) const {
        unit(place, "transmission", material.transmission);
        number(place, "thickness", material.thickness, 0, largest);
        if (!(material.attenuationDistance > 0))
            refuse(place, fmt::format("its attenuationDistance is {}", material.attenuationDistance),
                   "give a number above 0; infinity for a clear medium");
        for (int c = 0; c < 3; ++c) unit(place, "attenuationColor", material.attenuationColor[c]);
        number(place, "dispersion", material.dispersion, 0, largest);
        use(place, "transmissionTexture", material.transmissionTexture);
        use(place, "thicknessTexture", material.thicknessTexture);
    }

    void checkCoats(const Material& material, const std::string& place) const {
        unit(place, "clearcoat", material.clearcoat);
        unit(place, "clearcoatRoughness", material.clearcoatRoughness);
        number(place, "clearcoatNormalScale", material.clearcoatNormalScale, -largest, largest);
        for (int c = 0; c < 3; ++c) unit(place, "sheenColor", material.sheenColor[c]);
        unit(place, "sheenRoughness", material.sheenRoughness);
        unit(place, "anisotropyStrength", material.anisotropyStrength);
        number(place, "anisotropyRotation", material.anisotropyRotation, -largest, largest);
        unit(place, "iridescence", material.iridescence);
        number(place, "iridescenceIor", material.iridescenceIor, 1, largest);
        number(place, "iridescenceThicknessMinimum", material.iridescenceThicknessMinimum, 0, largest);
        number(place, "iridescenceThicknessMaximum", material.iridescenceThicknessMaximum, 0, largest);
        use(place, "clearcoatTexture", material.clearcoatTexture);
        use(place, "clearcoatRoughnessTexture", material.clearcoatRoughnessTexture);
        use(place, "clearcoatNormalTexture", material.clearcoatNormalTexture);
        use(place, "sheenColorTexture", material.sheenColorTexture);
        use(place, "sheenRoughnessTexture", material.sheenRoughnessTexture);
        use(place, "anisotropyTexture", material.anisotropyTexture);
        use(place, "iridescenceTexture", material.iridescenceTexture);
        use(place, "iridescenceThicknessTexture", material.iridescenceThicknessTexture);
    }

    void perVertex(const std::string& place, const char* what, std::size_t size, std::size_t vertices) const {
        if (size == 0 || size == vertices) return;
        refuse(place, fmt::format("has {} {} for {} positions", size, what, vertices),
               "give none, or one per position");
    }

    void check(const Shape& shape, std::size_t vertices, const std::string& place) const {
        if (vertices > 0)
            refuse(place, fmt::format("has a shape and {} positions", vertices),
                   "give each a primitive of its own");
        number(place, "shape's radius", shape.radius, smallestShape, largestShape);
        if (shape.kind == Shape::Kind::Torus)
            number(place, "torus's tubeRadius", shape.tubeRadius, 0.01 * double(shape.radius),
                   0.99 * double(shape.radius));
        number(place, "shape's width", shape.width, smallestShape, largestShape);
        number(place, "shape's height", shape.height, smallestShape, largestShape);
    }

    void check(const Primitive& primitive, const std::string& place) const {
        const std::size_t vertices = primitive.positions.size();
        if (primitive.shape) check(*primitive.shape, vertices, place);
        index(place, "material", primitive.material, scene_.materials.size(), -1);
        perVertex(place, "normals", primitive.normals.size(), vertices);
        perVertex(place, "tangents", primitive.tangents.size(), vertices);
        perVertex(place, "colors", primitive.colors.size(), vertices);
        for (const auto& set : primitive.texcoords)
            perVertex(place, "texture coordinates", set.size(), vertices);
        if (primitive.indices.size() % 3 != 0) {
            refuse(place, fmt::format("has {} indices", primitive.indices.size()),
                   "give 3 indices a triangle");
        }
        const auto wrong = std::find_if(primitive.indices.begin(), primitive.indices.end(),
                                        [&](std::uint32_t vertex) { return vertex >= vertices; });
        if (wrong != primitive.indices.end()) {
            refuse(place, fmt::format("index {} is {}", wrong - primitive.indices.begin(), *wrong),
                   fmt::format("it has {} positions", vertices));
        }
        finite(place, "position", primitive.positions);
        finite(place, "normal", primitive.normals);
        finite(place, "tangent", primitive.tangents);
        finite(place, "color", primitive.colors);
        for (const auto& set : primitive.texcoords) finite(place, "texture coordinate", set);
        if (!primitive.variantMaterials.empty() &&
            primitive.variantMaterials.size() != scene_.variants.size()) {
            refuse(place, fmt::format("has {} variant materials", primitive.variantMaterials.size()),
                   fmt::format("give none, or one for each of the {} variants", scene_.variants.size()));
        }
        for (int material : primitive.variantMaterials)
            index(place, "variant material", material, scene_.materials.size(), -1);
        checkDeformation(primitive, place);
    }

    void checkDeformation(const Primitive& primitive, const std::string& place) const {
        const std::size_t vertices = primitive.positions.size();
        for (const MorphTarget& target : primitive.targets) {
            perVertex(place, "morph positions", target.positions.size(), vertices);
            perVertex(place, "morph normals", target.normals.size(), vertices);
            perVertex(place, "morph tangents", target.tangents.size(), vertices);
            finite(place, "morph position", target.positions);
            finite(place, "morph normal", target.normals);
            finite(place, "morph tangent", target.tangents);
        }
        if (primitive.joints.size() != primitive.weights.size()) {
            refuse(place,
                   fmt::format("has {} sets of joints and {} of weights", primitive.joints.size(),
                               primitive.weights.size()),
                   "give as many of both");
        }
        for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
            const auto& joints = primitive.joints[set];
            const auto& weights = primitive.weights[set];
            if (joints.size() != vertices || weights.size() != vertices)
                refuse(place, "has joints or weights that are not one per position", "give one per position");
            finite(place, "joint weight", weights);
        }
    }

    /** What a node's mesh asks of the node: as many weights as targets, and joints that its skin has. */
    void checkDeformation(const Node& node, const std::string& place) const {
        index(place, "skin", node.skin, scene_.skins.size(), -1);
        if (node.mesh < 0 || std::size_t(node.mesh) >= scene_.meshes.size()) return;
        const auto& primitives = scene_.meshes[std::size_t(node.mesh)].primitives;
        for (const Primitive& primitive : primitives) {
            if (!node.weights.empty() && node.weights.size() != primitive.targets.size())
                refuse(place,
                       fmt::format("has {} morph weights, its mesh {} targets", node.weights.size(),
                                   primitive.targets.size()),
                       "give one weight per target");
            if (node.skin < 0) continue;
            const std::size_t joints = scene_.skins[std::size_t(node.skin)].joints.size();
            for (const auto& set : primitive.joints) {
                for (const glm::u16vec4& four : set) {
                    const std::size_t most = std::max({four.x, four.y, four.z, four.w});
                    if (most >= joints)
                        refuse(place, fmt::format("its mesh names joint {}", most),
                               fmt::format("its skin {} has {}", node.skin, joints));
                }
            }
        }
    }

    void check(const Skin& skin, const std::string& place) const {
        if (skin.joints.empty()) refuse(place, "has no joints", "give at least one");
        for (int joint : skin.joints) index(place, "joint", joint, scene_.nodes.size(), 0);
        if (!skin.inverseBindMatrices.empty() && skin.inverseBindMatrices.size() != skin.joints.size()) {
            refuse(place,
                   fmt::format("has {} inverse bind matrices for {} joints", skin.inverseBindMatrices.size(),
                               skin.joints.size()),
                   "give none, or one per joint");
        }
        for (const glm::mat4& matrix : skin.inverseBindMatrices) {
            for (int c = 0; c < 4; ++c) {
                for (int r = 0; r < 4; ++r)
                    number(place, "inverse bind matrix", matrix[c][r], -largest, largest);
            }
        }
    }

    void check(const AnimationChannel& channel, const std::string& place) const {
        index(place, "node", channel.node, scene_.nodes.size(), 0);
        const Node& node = scene_.nodes[std::size_t(channel.node)];
        std::size_t width = channel.path == AnimationPath::Rotation ? 4 : 3;
        if (channel.path == AnimationPath::Weights) {
            width = 0;
            if (node.mesh >= 0 && std::size_t(node.mesh) < scene_.meshes.size() &&
                !scene_.meshes[std::size_t(node.mesh)].primitives.empty())
                width = scene_.meshes[std::size_t(node.mesh)].primitives[0].targets.size();
        } else if (node.matrix) {
            refuse(place, fmt::format("moves node {}, which has a matrix", channel.node),
                   "give the node translation, rotation and scale");
        }
        if (channel.times.empty()) refuse(place, "has no times", "give at least one");
        for (std::size_t i = 0; i < channel.times.size(); ++i) {
            if (std::isfinite(channel.times[i]) && (i == 0 || channel.times[i] >= channel.times[i - 1]))
                continue;
            refuse(place, fmt::format("time {} is {}", i, channel.times[i]), "give finite times that ascend");
        }
        const std::size_t values =
            channel.times.size() * width * (channel.interpolation == Interpolation::CubicSpline ? 3 : 1);
        if (channel.values.size() != values) {
            refuse(place,
                   fmt::format("has {} values for {} times", channel.values.size(), channel.times.size()),
                   fmt::format("give {}", values));
        }
        for (float value : channel.values) number(place, "value", value, -largest, largest);
    }

    void check(const Camera& camera, const std::string& place) const {
        if (camera.perspective) {
            number(place, "yfov", camera.yfov, 1e-6, 3.14159);
        } else {
            number(place, "ymag", camera.ymag, smallest, largest);
        }
        number(place, "aspectRatio", camera.aspectRatio, 0, largest);
        number(place, "znear", camera.znear, camera.perspective ? smallest : 0, largest);
        if (!(camera.zfar > camera.znear))
            refuse(place, "its zfar is not beyond its znear", "give zfar > znear");
        if (camera.projection > Projection::Equisolid)
            refuse(place, "its projection is none of the known", "give one of Projection's values");
        number(place, "fieldOfView", camera.fieldOfView, 1e-6, 6.2831855);
        if (camera.lens) check(camera, *camera.lens, place);
        if (camera.lensTable) check(camera, *camera.lensTable, place);
        if (camera.shutter) {
            number(place, "shutter.open", camera.shutter->open, -1e6, 1e6);
            number(place, "shutter.close", camera.shutter->close, camera.shutter->open, 1e6);
            number(place, "shutter.rolling", camera.shutter->rolling, 0, 1e6);
        }
        if (!camera.exposure) return;
        number(place, "exposure.fNumber", camera.exposure->fNumber, 1e-3, 1e6);
        number(place, "exposure.shutterSeconds", camera.exposure->shutterSeconds, 1e-9, 1e9);
        number(place, "exposure.iso", camera.exposure->iso, 1e-3, 1e9);
    }

    void check(const Camera& camera, const LensTable& lens, const std::string& place) const {
        if (!camera.perspective || camera.projection != Projection::Plane || camera.lens)
            refuse(place, "has a lens table but no perspective, or a thin lens too", "leave one out");
        if (lens.surfaces.empty() || lens.surfaces.size() > 32)
            refuse(place, fmt::format("its lens has {} surfaces", lens.surfaces.size()), "give 1 to 32");
        number(place, "lensTable.scale", lens.scale, 1e-12, 1e12);
        number(place, "lensTable.filmHeight", lens.filmHeight, 1e-6, 1e6);
        number(place, "lensTable.stop", lens.stop, 1e-3, 1);
        for (const LensSurface& surface : lens.surfaces) {
            number(place, "lensTable radius", surface.radius, -1e6, 1e6);
            number(place, "lensTable thickness", surface.thickness, 0, 1e6);
            number(place, "lensTable ior", surface.ior, 1, 4);
            number(place, "lensTable diameter", surface.diameter, 1e-6, 1e6);
        }
        const ParaxialLens near = paraxial(lens);
        if (!(near.focalLength > 0 && std::isfinite(near.focalLength)))
            refuse(place, fmt::format("its lens has the focal length {:.3g}", near.focalLength),
                   "give a lens that gathers light");
        if (!(near.filmDistance > 0 && std::isfinite(near.filmDistance)))
            refuse(place, "its lens is not sharp anywhere behind the last surface",
                   "give a farther focusDistance");
    }

    void check(const Camera& camera, const ThinLens& lens, const std::string& place) const {
        if (!camera.perspective || camera.projection != Projection::Plane)
            refuse(place, "has a thin lens but no perspective", "leave the lens out");
        number(place, "lens.apertureDiameter", lens.apertureDiameter, 0, largest);
        if (!(lens.focusDistance >= 1e-18f))  // infinity is well
            refuse(place, fmt::format("lens.focusDistance is {}", lens.focusDistance), "give 1e-18 or more");
        if (lens.blades != 0 && (lens.blades < 3 || lens.blades > 64))
            refuse(place, fmt::format("its lens has {} blades", lens.blades), "give 3 to 64, or 0");
        number(place, "lens.bladeRotation", lens.bladeRotation, -1e6, 1e6);
    }

    void check(const PunctualLight& light, const std::string& place) const {
        this->light(place, "intensity", light.intensity);
        number(place, "range", light.range, 0, largest);
        if (light.type != PunctualLight::Type::Spot) return;
        number(place, "innerConeAngle", light.innerConeAngle, 0, light.outerConeAngle);
        number(place, "outerConeAngle", light.outerConeAngle, smallest, 1.5708);
    }

    void checkPlacements() const {
        const auto transform = [this](int node, const glm::dmat4& matrix) {
            for (int c = 0; c < 4; ++c) {
                for (int r = 0; r < 4; ++r) {
                    if (std::isfinite(matrix[c][r])) continue;
                    refuse(fmt::format("node {}", node), "its place in the world is not finite",
                           "give finite transforms");
                }
            }
        };
        for (const Instance& instance : scene_.instances()) {
            transform(instance.node, instance.transform);
            if (instance.mesh >= int(scene_.meshes.size())) continue;
            for (const Primitive& primitive : scene_.meshes[std::size_t(instance.mesh)].primitives)
                if (primitive.shape) placeShape(scene_, instance, *primitive.shape);
        }
        for (const PlacedCamera& camera : scene_.placedCameras()) transform(camera.node, camera.transform);
        for (const PlacedLight& light : scene_.placedLights()) transform(light.node, light.transform);
        for (const PlacedMeter& meter : scene_.placedMeters()) transform(meter.node, meter.transform);
    }

    static constexpr double largest = std::numeric_limits<float>::max();
    /** FILM_LARGEST of shaders/film/accumulate.glsl: a sample above it is left out of the picture. */
    static constexpr float brightest = 0x1p100f;
    static constexpr double smallest = std::numeric_limits<float>::min();
    /** Squares of a shape's sizes are normal floats. */
    static constexpr double smallestShape = 1e-12, largestShape = 1e12;
    const Scene& scene_;
};

}  // namespace

void Scene::validate() const {
    Validator(*this).run();
}

}  // namespace helio
