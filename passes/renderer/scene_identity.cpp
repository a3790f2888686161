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

void add(Fingerprint& f, const TextureUse& use) {
    f.value(use.texture);
    f.value(use.texcoord);
    f.value(use.transform);
}

void add(Fingerprint& f, const Material& m) {
    f.value(m.baseColor);
    f.value(m.metallic);
    f.value(m.roughness);
    f.value(m.normalScale);
    f.value(m.occlusionStrength);
    f.value(m.emission);
    f.value(m.specular);
    f.value(m.specularColor);
    f.value(m.ior);
    f.value(m.alphaMode);
    f.value(m.alphaCutoff);
    f.value(m.doubleSided);
    f.value(m.unlit);
    for (const TextureUse* use :
         {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.occlusionTexture,
          &m.emissiveTexture, &m.specularTexture, &m.specularColorTexture}) {
        add(f, *use);
    }
}

void add(Fingerprint& f, const Primitive& p) {
    f.values(p.positions);
    f.values(p.normals);
    f.values(p.tangents);
    f.value(p.texcoords.size());
    for (const auto& set : p.texcoords) f.values(set);
    f.values(p.colors);
    f.values(p.indices);
    f.value(p.material);
}

void add(Fingerprint& f, const PunctualLight& light) {
    f.value(light.type);
    f.value(light.intensity);
    f.value(light.range);
    f.value(light.innerConeAngle);
    f.value(light.outerConeAngle);
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
    for (const Texture& texture : scene.textures) {
        f.value(texture.image);
        f.value(texture.wrapU);
        f.value(texture.wrapV);
        f.value(texture.magFilter);
        f.value(texture.minFilter);
        f.value(texture.useMipmaps);
    }
    for (const TextureImage& image : scene.images) {
        f.value(image.width);
        f.value(image.height);
        f.value(image.texels.index());
        std::visit([&](const auto& texels) { f.values(texels); }, image.texels);
    }
    for (const PlacedLight& placed : scene.placedLights()) {
        add(f, scene.lights[std::size_t(placed.light)]);
        f.value(placed.transform);
    }
    f.value(environment.has_value());
    if (environment) {
        f.value(environment->radiance);
        f.value(environment->image);
    }
    return {f.words()};
}

}  // namespace helio
