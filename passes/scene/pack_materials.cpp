#include "passes/scene/albedo_tables.hpp"
#include "passes/scene/facet_losses.hpp"
#include "passes/scene/material_layout.hpp"
#include "passes/scene/packed_scene.hpp"

#include <heliograph/error.hpp>
#include <heliograph/image.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

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
constexpr std::uint32_t kLinear = 1u << 7;
constexpr std::uint32_t kNormals = 1u << 8;

// Flags of a packed material, as shaders/scene/materials.glsl reads them.
constexpr std::uint32_t kDoubleSided = 1u << 0;
constexpr std::uint32_t kMask = 1u << 1;
constexpr std::uint32_t kBlend = 1u << 2;
constexpr std::uint32_t kUnlit = 1u << 3;
constexpr std::uint32_t kThin = 1u << 4;
constexpr std::uint32_t kTurnedFacets = 1u << 5;
constexpr std::uint32_t kBeckmann = 1u << 6;
constexpr std::uint32_t kSchlick = 1u << 7;
constexpr std::uint32_t kCompensated = 1u << 8;
constexpr std::uint32_t kLightmap = 1u << 9;
constexpr std::uint32_t kModelShift = 16;

/** Packs textures once each for every way they are read, as colour or as data, and gives their place. */
class TexturePacker {
public:
    TexturePacker(const Scene& scene, PackedScene& packed) : scene_(scene), packed_(packed) {
        float factor = 1;
        for (const Material& m : scene.materials)
            factor = std::max({factor, m.emission.x, m.emission.y, m.emission.z});
        brightest_ = 0x1p100f / factor;  // what a picture holds
    }

    /** Index into PackedScene::textures, or -1. What is not emission lies between 0 and 1. */
    int add(const TextureUse& use, bool color, bool emission, bool normals) {
        if (!use) return -1;
        if (use.texture >= int(scene_.textures.size()))
            throw InputError(scene_.name, "", fmt::format("texture {} does not exist", use.texture),
                             "name one of the scene's textures");
        const auto [place, isNew] =
            packedTexture_.try_emplace({use.texture, color, emission, normals}, int(packed_.textures.size()));
        if (!isNew) return place->second;
        const Texture& texture = scene_.textures[std::size_t(use.texture)];
        if (texture.image < 0 || texture.image >= int(scene_.images.size()))
            throw InputError(scene_.name, fmt::format("texture {}", use.texture),
                             fmt::format("image {} does not exist", texture.image),
                             "name one of the scene's images");
        const TextureImage& image = scene_.images[std::size_t(texture.image)];
        const bool eightBits = std::holds_alternative<std::vector<std::uint8_t>>(image.texels);
        const bool sixteenBits = std::holds_alternative<std::vector<std::uint16_t>>(image.texels);
        std::uint32_t flags = std::uint32_t(texture.wrapU) | std::uint32_t(texture.wrapV) << kWrapVShift;
        if (texture.magFilter == Filter::Nearest) flags |= kNearest;
        if (!eightBits) flags |= kFloat;
        if (texture.useMipmaps && (color || normals)) flags |= kMipmaps;
        if (normals) flags |= kNormals;
        packed_.normalLevels |= normals && texture.useMipmaps;
        if (!color && eightBits) flags |= kLinear;
        packed_.linearTextures |= !color && eightBits;
        packed_.textures.emplace_back(addImage(texture.image, color || !sixteenBits, emission), image.width,
                                      image.height, flags);
        return place->second;
    }

private:
    /** Offset of an image's first texel in its array. Images are stored once however many textures share
     * them; 16-bit ones once for each way they are decoded. */
    std::uint32_t addImage(int index, bool decode, bool emission) {
        const bool floats =
            std::holds_alternative<std::vector<float>>(scene_.images[std::size_t(index)].texels);
        const auto [place, isNew] = imageOffset_.try_emplace({index, decode, floats && emission}, 0u);
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
            for (std::size_t i = 0; i < texels; ++i)
                packed_.texelsFloat.push_back(linearTexel(image, i, decode));
            if (floats) clean(index, place->second, emission ? brightest_ : 1.0f);
        }
        return place->second;
    }

    /** Replaces what is no reflectance or radiance in an image of floats: NaN and negative values by 0,
     * others above `largest` by that. */
    void clean(int index, std::size_t first, float largest) {
        std::uint64_t low = 0, high = 0;
        for (std::size_t i = first; i < packed_.texelsFloat.size(); ++i)
            for (glm::length_t c = 0; c < 4; ++c) {
                float& value = packed_.texelsFloat[i][c];
                if (value >= 0.0f && value <= largest) continue;
                ++(value > largest ? high : low);
                value = value > largest ? largest : 0.0f;
            }
        if (low + high > 0)
            packed_.warnings.push_back(
                fmt::format("image {}: {} values are negative or not numbers and taken as 0, {} are above {} "
                            "and taken as that",
                            index, low, high, largest));
    }

    std::uint32_t checkedOffset(std::size_t offset, std::size_t texels, int index) const {
        // The least that Vulkan devices with large texel buffers give, and what lavapipe gives.
        constexpr std::size_t most = std::size_t(1) << 27;
        if (offset + texels > most)
            throw InputError(scene_.name, fmt::format("image {}", index),
                             fmt::format("textures need more than {} texels", most), "reduce their sizes");
        return std::uint32_t(offset);
    }

    static glm::vec4 linearTexel(const TextureImage& image, std::size_t i, bool decode) {
        if (const auto* floats = std::get_if<std::vector<float>>(&image.texels)) {
            const float* c = floats->data() + i * 4;
            return {c[0], c[1], c[2], c[3]};
        }
        const std::uint16_t* c = std::get<std::vector<std::uint16_t>>(image.texels).data() + i * 4;
        if (!decode) return glm::vec4(c[0], c[1], c[2], c[3]) / 65535.0f;
        return {float(srgbDecode(c[0] / 65535.0)), float(srgbDecode(c[1] / 65535.0)),
                float(srgbDecode(c[2] / 65535.0)), float(c[3] / 65535.0)};
    }

    const Scene& scene_;
    PackedScene& packed_;
    float brightest_ = 0x1p100f;
    std::map<std::tuple<int, bool, bool, bool>, int> packedTexture_;
    std::map<std::tuple<int, bool, bool>, std::uint32_t> imageOffset_;
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

namespace {

constexpr std::size_t kScatteringAlphaRow = 42;
using Rows = std::array<glm::vec4, kMaterialTexels>;

/** Absorption over 1/m: what of light is left after the distance is the colour. No channel dies out wholly.
 */
glm::vec3 absorption(const Material& m) {
    if (!(m.attenuationDistance < std::numeric_limits<float>::infinity())) return glm::vec3(0.0f);
    return -glm::log(glm::max(m.attenuationColor, glm::vec3(1e-6f))) / m.attenuationDistance;
}

void addParameters(const Material& m, Rows& rows) {
    rows[7] = {m.specularColor, m.specular};
    rows[8] = {m.ior, m.transmission, m.dispersion, m.normalScale};
    rows[9] = {absorption(m), m.heightScale};
    rows[10] = {m.clearcoat, m.clearcoatRoughness, m.clearcoatNormalScale, m.anisotropyStrength};
    rows[11] = {m.sheenColor, m.sheenRoughness};
    rows[12] = {std::cos(m.anisotropyRotation), std::sin(m.anisotropyRotation), m.iridescence,
                m.iridescenceIor};
    // Without a texture the film's thickness is the largest.
    rows[13] = {m.iridescenceThicknessTexture ? m.iridescenceThicknessMinimum : m.iridescenceThicknessMaximum,
                m.iridescenceThicknessMaximum, m.lightmapTexture ? 0.0f : m.occlusionStrength, m.thickness};
    if (m.solid) {
        rows[45] = {m.solid->first, glm::uintBitsToFloat(std::uint32_t(m.solid->pattern) + 1u)};
        rows[46] = {m.solid->second, m.solid->scale};
    }
    if (m.scattering) {
        const Scattering& s = *m.scattering;
        rows[40] = {s.n, s.roughness};
        rows[41] = {s.k, s.exponent};
        rows[kScatteringAlphaRow] = {s.alpha, 0.0f, 0.0f};  // z: first texel of facetLosses()
    }
}

std::uint32_t flagsOf(const Material& m) {
    std::uint32_t flags = 0;
    if (m.doubleSided) flags |= kDoubleSided;
    if (m.alphaMode == AlphaMode::Mask) flags |= kMask;
    if (m.alphaMode == AlphaMode::Blend) flags |= kBlend;
    if (m.unlit) flags |= kUnlit;
    if (m.thickness <= 0.0f) flags |= kThin;
    if (m.lightmapTexture && !m.unlit) flags |= kLightmap;
    if (m.scattering) {
        const Scattering& s = *m.scattering;
        flags |= (std::uint32_t(s.model) + 1u) << kModelShift;
        if (s.alpha.x != s.alpha.y) flags |= kTurnedFacets;
        if (s.beckmann) flags |= kBeckmann;
        if (s.schlick) flags |= kSchlick;
        if (s.multipleScattering) flags |= kCompensated;
    } else if (m.anisotropyStrength > 0.0f) {
        flags |= kTurnedFacets;
    }
    return flags;
}

}  // namespace

void materials(const Scene& scene, const std::vector<bool>& materialUsed, PackedScene& packed) {
    TexturePacker textures(scene, packed);
    for (std::size_t i = 0; i <= scene.materials.size(); ++i) {
        const Material material = i < scene.materials.size() ? scene.materials[i] : Material{};
        Rows rows{};
        rows[0] = material.baseColor;
        rows[1] = {material.emission, glm::uintBitsToFloat(flagsOf(material))};
        // The light sampling density of this material's surfaces, filled in by lights().
        rows[2] = {0.0f, material.metallic, material.roughness, material.alphaCutoff};
        addParameters(material, rows);
        for (std::size_t row = 3; row < 40; row = row == 5 ? 14 : row + 2)
            rows[row].w = glm::uintBitsToFloat(std::uint32_t(-1));
        if (!material.scattering) rows[40].w = glm::uintBitsToFloat(std::uint32_t(-1));
        rows[43].w = rows[47].w = glm::uintBitsToFloat(std::uint32_t(-1));
        if (materialUsed[i]) {
            const std::uint32_t features = materialFeatures(material);
            packed.roughFacets |= hasRoughFacets(material);
            packed.tiltedLobes |=
                (features & (kNormalMapFeature | kBumpFeature)) != 0 && hasWideLobes(material);
            packed.materialFeatures |= features == 0 ? kDiffuseFeatures : features;
            const std::array<int, 2> sets = texcoordSets(material, packed.bakedTextures());
            for (const SampledTexture& texture : sampledTextures(material, packed.bakedTextures())) {
                const int index = textures.add(
                    *texture.use, texture.color,
                    texture.use == &material.emissiveTexture || texture.use == &material.lightmapTexture,
                    texture.use == &material.normalTexture ||
                        texture.use == &material.clearcoatNormalTexture);
                rows[texture.row] = transformRow(*texture.use, 0, std::uint32_t(index));
                rows[texture.row + 1] = transformRow(*texture.use, 1, texcoordSlot(sets, *texture.use));
            }
            const bool emits = material.emission != glm::vec3(0.0f);
            packed.emission |= emits;
            packed.texturedEmission |= emits && material.emissiveTexture;
            packed.baseColorTextures |= bool(material.baseColorTexture);
            packed.alphaMasks |= material.alphaMode == AlphaMode::Mask;
            packed.alphaBlends |= material.alphaMode == AlphaMode::Blend;
            packed.doubleSidedEmission |= emits && material.doubleSided;
        }
        packed.materials.insert(packed.materials.end(), rows.begin(), rows.end());
    }
    packed.albedoTables = std::uint32_t(packed.materials.size());
    if ((packed.materialFeatures & kSheenFeature) != 0) {
        const std::vector<glm::vec4> table = sheenTable();
        packed.materials.insert(packed.materials.end(), table.begin(), table.end());
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const auto& scattering = scene.materials[i].scattering;
        if (!materialUsed[i] || !scattering || !scattering->multipleScattering) continue;
        packed.materials[i * kMaterialTexels + kScatteringAlphaRow].z =
            glm::uintBitsToFloat(std::uint32_t(packed.materials.size()));
        const auto table = facetLosses(*scattering);
        packed.materials.insert(packed.materials.end(), table.begin(), table.end());
    }
    // Diffuse surfaces alone need none of the code that tells materials apart.
    if (packed.materialFeatures == kDiffuseFeatures) packed.materialFeatures = 0;
}

}  // namespace helio::pack
