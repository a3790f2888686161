/** @file What every scene must satisfy before anything is computed from it, an importer's or an
 * application's. */
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
                check(primitives[p], fmt::format("mesh {} primitive {}", m, p));
            }
        }
        for (std::size_t i = 0; i < scene_.cameras.size(); ++i)
            check(scene_.cameras[i], fmt::format("camera {}", i));
        for (std::size_t i = 0; i < scene_.lights.size(); ++i)
            check(scene_.lights[i], fmt::format("light {}", i));
        if (scene_.environment) {
            light("environment", "radiance", scene_.environment->radiance);
            index("environment", "image", scene_.environment->image, scene_.images.size(), -1);
        }
        checkPlacements();
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
        for (int c = 0; c < 4; ++c) number(place, "baseColor", material.baseColor[c], 0, 1);
        number(place, "metallic", material.metallic, 0, 1);
        number(place, "roughness", material.roughness, 0, 1);
        number(place, "specular", material.specular, 0, 1);
        number(place, "normalScale", material.normalScale, -largest, largest);
        number(place, "occlusionStrength", material.occlusionStrength, 0, 1);
        number(place, "ior", material.ior, 0, largest);
        number(place, "alphaCutoff", material.alphaCutoff, 0, largest);
        light(place, "emission", material.emission);
        color(place, "specularColor", material.specularColor);
        use(place, "baseColorTexture", material.baseColorTexture);
        use(place, "metallicRoughnessTexture", material.metallicRoughnessTexture);
        use(place, "normalTexture", material.normalTexture);
        use(place, "occlusionTexture", material.occlusionTexture);
        use(place, "emissiveTexture", material.emissiveTexture);
        use(place, "specularTexture", material.specularTexture);
        use(place, "specularColorTexture", material.specularColorTexture);
    }

    void perVertex(const std::string& place, const char* what, std::size_t size, std::size_t vertices) const {
        if (size == 0 || size == vertices) return;
        refuse(place, fmt::format("has {} {} for {} positions", size, what, vertices),
               "give none, or one per position");
    }

    void check(const Primitive& primitive, const std::string& place) const {
        const std::size_t vertices = primitive.positions.size();
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
        for (const Instance& instance : scene_.instances()) transform(instance.node, instance.transform);
        for (const PlacedCamera& camera : scene_.placedCameras()) transform(camera.node, camera.transform);
        for (const PlacedLight& light : scene_.placedLights()) transform(light.node, light.transform);
    }

    static constexpr double largest = std::numeric_limits<float>::max();
    /** FILM_LARGEST of shaders/film/accumulate.glsl: a sample above it is left out of the picture. */
    static constexpr float brightest = 0x1p100f;
    static constexpr double smallest = std::numeric_limits<float>::min();
    const Scene& scene_;
};

}  // namespace

void Scene::validate() const {
    Validator(*this).run();
}

}  // namespace helio
