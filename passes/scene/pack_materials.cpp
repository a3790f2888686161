#include "passes/scene/packed_scene.hpp"

#include <heliograph/error.hpp>
#include <heliograph/image.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace helio::pack {
namespace {

/** Exact decoding of 8-bit sRGB. */
const std::array<double, 256>& decodeTable() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> values{};
        for (int i = 0; i < 256; ++i) values[std::size_t(i)] = srgbDecode(i / 255.0);
        return values;
    }();
    return table;
}

// Flags of a packed texture, as shaders/scene/textures.glsl reads them.
constexpr std::uint32_t kWrapVShift = 2;
constexpr std::uint32_t kNearest = 1u << 4;
constexpr std::uint32_t kFloat = 1u << 5;
constexpr std::uint32_t kMipmaps = 1u << 6;

/** Packs textures used as colour once each and gives their place. */
class TexturePacker {
public:
    TexturePacker(const Scene& scene, PackedScene& packed) : scene_(scene), packed_(packed) {}

    /** Index into PackedScene::textures, or -1. */
    int add(const TextureUse& use) {
        if (!use) return -1;
        if (use.texture >= int(scene_.textures.size()))
            throw InputError(scene_.name, "", fmt::format("texture {} does not exist", use.texture),
                             "name one of the scene's textures");
        const auto [place, isNew] = packedTexture_.try_emplace(use.texture, int(packed_.textures.size()));
        if (!isNew) return place->second;
        const Texture& texture = scene_.textures[std::size_t(use.texture)];
        if (texture.image < 0 || texture.image >= int(scene_.images.size()))
            throw InputError(scene_.name, fmt::format("texture {}", use.texture),
                             fmt::format("image {} does not exist", texture.image),
                             "name one of the scene's images");
        const TextureImage& image = scene_.images[std::size_t(texture.image)];
        const bool eightBits = std::holds_alternative<std::vector<std::uint8_t>>(image.texels);
        std::uint32_t flags = std::uint32_t(texture.wrapU) | std::uint32_t(texture.wrapV) << kWrapVShift;
        if (texture.magFilter == Filter::Nearest) flags |= kNearest;
        if (!eightBits) flags |= kFloat;
        if (texture.useMipmaps) flags |= kMipmaps;
        packed_.textures.emplace_back(addImage(texture.image), image.width, image.height, flags);
        return place->second;
    }

private:
    /** Offset of an image's first texel in its array. Images are stored once however many textures share
     * them. */
    std::uint32_t addImage(int index) {
        const auto [place, isNew] = imageOffset_.try_emplace(index, 0u);
        if (!isNew) return place->second;
        const TextureImage& image = scene_.images[std::size_t(index)];
        const std::size_t texels = std::size_t(image.width) * image.height;
        const std::size_t values = std::visit([](const auto& v) { return v.size(); }, image.texels);
        if (texels == 0 || values != texels * 4)
            throw InputError(scene_.name, fmt::format("image {}", index),
                             fmt::format("{}x{} pixels but {} values", image.width, image.height, values),
                             "give 4 values per pixel");
        if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&image.texels)) {
            place->second = checkedOffset(packed_.texels8.size(), texels, index);
            for (std::size_t i = 0; i < texels; ++i) {
                const std::uint8_t* c = bytes->data() + i * 4;
                packed_.texels8.push_back(std::uint32_t(c[0]) | std::uint32_t(c[1]) << 8 |
                                          std::uint32_t(c[2]) << 16 | std::uint32_t(c[3]) << 24);
            }
        } else {
            place->second = checkedOffset(packed_.texelsFloat.size(), texels, index);
            for (std::size_t i = 0; i < texels; ++i) packed_.texelsFloat.push_back(linearTexel(image, i));
        }
        return place->second;
    }

    std::uint32_t checkedOffset(std::size_t offset, std::size_t texels, int index) const {
        // The least that Vulkan devices with large texel buffers give, and what lavapipe gives.
        constexpr std::size_t most = std::size_t(1) << 27;
        if (offset + texels > most)
            throw InputError(scene_.name, fmt::format("image {}", index),
                             fmt::format("textures need more than {} texels", most), "reduce their sizes");
        return std::uint32_t(offset);
    }

    static glm::vec4 linearTexel(const TextureImage& image, std::size_t i) {
        if (const auto* floats = std::get_if<std::vector<float>>(&image.texels)) {
            const float* c = floats->data() + i * 4;
            return {c[0], c[1], c[2], c[3]};
        }
        const std::uint16_t* c = std::get<std::vector<std::uint16_t>>(image.texels).data() + i * 4;
        return {float(srgbDecode(c[0] / 65535.0)), float(srgbDecode(c[1] / 65535.0)),
                float(srgbDecode(c[2] / 65535.0)), float(c[3] / 65535.0)};
    }

    const Scene& scene_;
    PackedScene& packed_;
    std::map<int, int> packedTexture_;
    std::map<int, std::uint32_t> imageOffset_;
};

glm::vec4 transformRow(const TextureUse& use, int row, std::uint32_t bits) {
    const glm::mat3& m = use.transform;
    return {m[0][row], m[1][row], m[2][row], glm::uintBitsToFloat(bits)};
}

}  // namespace

glm::dvec3 meanColor(const TextureImage& image) {
    glm::dvec3 sum(0.0);
    const std::size_t texels = std::size_t(image.width) * image.height;
    std::visit(
        [&](const auto& values) {
            using T = typename std::decay_t<decltype(values)>::value_type;
            for (std::size_t i = 0; i < texels; ++i)
                for (int c = 0; c < 3; ++c) {
                    const auto v = values[i * 4 + std::size_t(c)];
                    if constexpr (std::is_same_v<T, std::uint8_t>)
                        sum[c] += decodeTable()[v];
                    else if constexpr (std::is_same_v<T, std::uint16_t>)
                        sum[c] += srgbDecode(v / 65535.0);
                    else
                        sum[c] += std::isfinite(v) ? double(v) : 0.0;
                }
        },
        image.texels);
    return texels > 0 ? sum / double(texels) : sum;
}

void materials(const Scene& scene, const std::vector<bool>& materialUsed, PackedScene& packed) {
    TexturePacker textures(scene, packed);
    for (std::size_t i = 0; i <= scene.materials.size(); ++i) {
        const Material material = i < scene.materials.size() ? scene.materials[i] : Material{};
        const bool used = materialUsed[i];
        const bool emits = material.emission != glm::vec3(0.0f);
        const int baseTexture = used ? textures.add(material.baseColorTexture) : -1;
        const int emissiveTexture = used && emits ? textures.add(material.emissiveTexture) : -1;
        packed.emission |= used && emits;
        packed.texturedEmission |= emissiveTexture >= 0;
        packed.baseColorTextures |= baseTexture >= 0;
        packed.doubleSidedEmission |= used && emits && material.doubleSided;
        const std::uint32_t flags = material.doubleSided ? 1u : 0u;
        packed.materials.push_back(material.baseColor);
        packed.materials.push_back({material.emission, glm::uintBitsToFloat(flags)});
        // The light sampling density of this material's surfaces, filled in by lights().
        packed.materials.push_back({0.0f, material.metallic, material.roughness, material.alphaCutoff});
        packed.materials.push_back(transformRow(material.baseColorTexture, 0, std::uint32_t(baseTexture)));
        packed.materials.push_back(transformRow(material.baseColorTexture, 1, kBaseColorSlot));
        packed.materials.push_back(transformRow(material.emissiveTexture, 0, std::uint32_t(emissiveTexture)));
        packed.materials.push_back(transformRow(material.emissiveTexture, 1, kEmissiveSlot));
    }
}

}  // namespace helio::pack
