#include "passes/renderer/scene_identity.hpp"

#include <cstring>
#include <type_traits>

namespace helio {
namespace {

/** Two independent 64-bit lanes of multiply and xor-shift over 8-byte words. */
class Fingerprint {
public:
    void word(std::uint64_t x) {
        a_ = mix((a_ ^ x) * 0x9e3779b97f4a7c15ull);
        b_ = mix((b_ + x) * 0xd6e8feb86659fd93ull);
    }
    void bytes(const void* data, std::size_t size) {
        word(size);
        const auto* at = static_cast<const unsigned char*>(data);
        for (; size >= 8; size -= 8, at += 8) {
            std::uint64_t x;
            std::memcpy(&x, at, 8);
            word(x);
        }
        std::uint64_t rest = 0;
        if (size > 0) std::memcpy(&rest, at, size);  // an empty vector has no address
        word(rest);
    }
    template <typename T>
    void value(const T& x) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes(&x, sizeof(x));
    }
    template <typename T>
    void values(const std::vector<T>& list) {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
        bytes(list.data(), list.size() * sizeof(T));
    }
    std::array<std::uint64_t, 2> words() const { return {a_, b_}; }

private:
    static std::uint64_t mix(std::uint64_t x) { return x ^ (x >> 29); }
    std::uint64_t a_ = 0x243f6a8885a308d3ull, b_ = 0x13198a2e03707344ull;
};

// Structured bindings name every member of a struct: one that gets a new member does not compile here until
// it is dealt with. Names are left out, since no picture depends on them.

void add(Fingerprint& f, const TextureUse& use) {
    const auto& [texture, texcoord, transform] = use;
    f.value(texture);
    f.value(texcoord);
    f.value(transform);
}

void add(Fingerprint& f, const std::vector<std::string>& texts) {
    f.value(texts.size());
    for (const std::string& text : texts) f.bytes(text.data(), text.size());
}

template <typename T>
void add(Fingerprint& f, const T& value) {
    f.value(value);
}

template <typename... Fields>
void addAll(Fingerprint& f, const Fields&... fields) {
    (add(f, fields), ...);
}

void add(Fingerprint& f, const std::optional<Scattering>& scattering) {
    f.value(scattering.has_value());
    if (!scattering) return;
    const auto& [model, roughness, alpha, beckmann, schlick, n, k, exponent, multipleScattering] =
        *scattering;
    addAll(f, model, roughness, alpha, beckmann, schlick, n, k, exponent, multipleScattering);
}

void add(Fingerprint& f, const std::optional<SolidTexture>& solid) {
    f.value(solid.has_value());
    if (!solid) return;
    const auto& [pattern, first, second, scale] = *solid;
    addAll(f, pattern, first, second, scale);
}

void add(Fingerprint& f, const Material& m) {
    const auto& [name, baseColor, baseColorTexture, metallic, roughness, metallicRoughnessTexture,
                 normalTexture, normalScale, heightTexture, heightScale, occlusionTexture, occlusionStrength,
                 lightmapTexture, emission, emissiveTexture, specular, specularTexture, specularColor,
                 specularColorTexture, ior, transmission, transmissionTexture, thickness, thicknessTexture,
                 attenuationDistance, attenuationColor, clearcoat, clearcoatTexture, clearcoatRoughness,
                 clearcoatRoughnessTexture, clearcoatNormalTexture, clearcoatNormalScale, sheenColor,
                 sheenColorTexture, sheenRoughness, sheenRoughnessTexture, anisotropyStrength,
                 anisotropyRotation, anisotropyTexture, iridescence, iridescenceTexture, iridescenceIor,
                 iridescenceThicknessMinimum, iridescenceThicknessMaximum, iridescenceThicknessTexture,
                 dispersion, alphaMode, alphaCutoff, doubleSided, unlit, scattering, solid, unsupported] = m;
    addAll(f, baseColor, baseColorTexture, metallic, roughness, metallicRoughnessTexture, normalTexture,
           normalScale, heightTexture, heightScale, occlusionTexture, occlusionStrength, lightmapTexture,
           emission, emissiveTexture, specular, specularTexture, specularColor, specularColorTexture, ior,
           transmission, transmissionTexture, thickness, thicknessTexture, attenuationDistance,
           attenuationColor, clearcoat, clearcoatTexture, clearcoatRoughness, clearcoatRoughnessTexture,
           clearcoatNormalTexture, clearcoatNormalScale, sheenColor, sheenColorTexture, sheenRoughness,
           sheenRoughnessTexture, anisotropyStrength, anisotropyRotation, anisotropyTexture, iridescence,
           iridescenceTexture, iridescenceIor, iridescenceThicknessMinimum, iridescenceThicknessMaximum,
           iridescenceThicknessTexture, dispersion, alphaMode, alphaCutoff, doubleSided, unlit, scattering,
           solid, unsupported);
}

/** Of a mesh as it stands: variants and deformations are chosen before. */
void add(Fingerprint& f, const Primitive& p) {
    const auto& [positions, normals, tangents, texcoords, colors, indices, material, variantMaterials,
                 targets, joints, weights, shape] = p;
    f.values(positions);
    f.values(normals);
    f.values(tangents);
    f.value(texcoords.size());
    for (const auto& set : texcoords) f.values(set);
    f.values(colors);
    f.values(indices);
    f.value(material);
    f.value(shape.has_value());
    if (!shape) return;
    const auto& [kind, radius, tubeRadius, width, height] = *shape;
    addAll(f, kind, radius, tubeRadius, width, height);
}

void add(Fingerprint& f, const PunctualLight& light) {
    const auto& [name, type, intensity, range, innerConeAngle, outerConeAngle] = light;
    addAll(f, type, intensity, range, innerConeAngle, outerConeAngle);
}

void add(Fingerprint& f, const Texture& texture) {
    const auto& [name, image, wrapU, wrapV, magFilter, minFilter, useMipmaps] = texture;
    addAll(f, image, wrapU, wrapV, magFilter, minFilter, useMipmaps);
}

void add(Fingerprint& f, const TextureImage& image) {
    const auto& [name, width, height, texels] = image;
    addAll(f, width, height, texels.index());
    std::visit([&](const auto& values) { f.values(values); }, texels);
}

void add(Fingerprint& f, const Environment& environment) {
    const auto& [radiance, image, rotation] = environment;
    addAll(f, radiance, image, rotation);
}

}  // namespace

SceneIdentity identify(const Scene& scene, const std::optional<Environment>& environment) {
    Fingerprint f;
    for (const Instance& instance : scene.instances()) {
        f.value(instance.mesh);
        f.value(instance.transform);
    }
    for (const Mesh& mesh : scene.meshes) {
        f.value(mesh.primitives.size());
        for (const Primitive& primitive : mesh.primitives) add(f, primitive);
    }
    for (const Material& material : scene.materials) add(f, material);
    for (const Texture& texture : scene.textures) add(f, texture);
    for (const TextureImage& image : scene.images) add(f, image);
    for (const PlacedLight& placed : scene.placedLights()) {
        add(f, scene.lights[std::size_t(placed.light)]);
        f.value(placed.transform);
    }
    f.value(environment.has_value());
    if (environment) add(f, *environment);
    return {f.words()};
}

}  // namespace helio
