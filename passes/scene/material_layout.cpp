#include "passes/scene/material_layout.hpp"

#include <algorithm>

namespace helio::pack {
namespace {

/** Rows of the texture uses, two each. */
enum Row : std::uint32_t {
    kBaseColorRow = 3,
    kEmissiveRow = 5,
    kMetallicRoughnessRow = 14,
    kNormalRow = 16,
    kSpecularRow = 18,
    kSpecularColorRow = 20,
    kTransmissionRow = 22,
    kClearcoatRow = 24,
    kClearcoatRoughnessRow = 26,
    kClearcoatNormalRow = 28,
    kSheenColorRow = 30,
    kSheenRoughnessRow = 32,
    kAnisotropyRow = 34,
    kIridescenceRow = 36,
    kIridescenceThicknessRow = 38,
    kThicknessRow = 40,  // of materials that are glTF's; the others have their model there
    kHeightRow = 43,
    kOcclusionRow = 47
};

/** SMOOTH_ALPHA of shaders/scattering/scatter.glsl: a narrower lobe is a mirror's. */
constexpr float kSmoothAlpha = 1e-4f;

bool hasSheen(const Material& m) {
    return m.sheenColor != glm::vec3(0.0f);
}

/** Whether some of what is not diffuse is left in glTF's model. */
bool isMoreThanDiffuse(const Material& m) {
    return m.metallic > 0.0f || m.specular > 0.0f || m.transmission > 0.0f || m.clearcoat > 0.0f ||
           hasSheen(m);
}

}  // namespace

bool hasVolume(const Material& m) {
    return m.transmission > 0.0f && m.thickness > 0.0f && !m.unlit && !m.scattering;
}

namespace {

std::uint32_t gltfFeatures(const Material& m) {
    std::uint32_t bits =
        m.metallic < 1.0f || m.metallicRoughnessTexture ? kDiffuseFeatures : std::uint32_t(kGltfFeature);
    const auto add = [&](std::uint32_t bit, bool present) { bits |= present ? bit : 0u; };
    if (!isMoreThanDiffuse(m)) return bits;
    const bool dielectric = m.specular > 0.0f && m.metallic < 1.0f;
    add(kSpecularFeature, true);
    add(kTransmissionFeature, m.transmission > 0.0f);
    add(kClearcoatFeature, m.clearcoat > 0.0f);
    add(kSheenFeature, hasSheen(m));
    add(kIridescenceFeature, m.iridescence > 0.0f);
    add(kAnisotropyFeature, m.anisotropyStrength > 0.0f);
    add(kVolumeFeature, m.transmission > 0.0f && m.thickness > 0.0f &&
                            m.attenuationDistance < std::numeric_limits<float>::infinity() &&
                            m.attenuationColor != glm::vec3(1.0f));
    add(kDispersionFeature, m.transmission > 0.0f && m.thickness > 0.0f && m.dispersion > 0.0f);
    add(kMetallicTextureFeature, bool(m.metallicRoughnessTexture));
    add(kSpecularTextureFeature, dielectric && (m.specularTexture || m.specularColorTexture));
    add(kTransmissionTextureFeature, m.transmission > 0.0f && m.transmissionTexture);
    add(kClearcoatTextureFeature, m.clearcoat > 0.0f && (m.clearcoatTexture || m.clearcoatRoughnessTexture ||
                                                         m.clearcoatNormalTexture));
    add(kSheenTextureFeature, hasSheen(m) && (m.sheenColorTexture || m.sheenRoughnessTexture));
    add(kAnisotropyTextureFeature, m.anisotropyStrength > 0.0f && m.anisotropyTexture);
    add(kIridescenceTextureFeature,
        m.iridescence > 0.0f && (m.iridescenceTexture || m.iridescenceThicknessTexture));
    return bits;
}

}  // namespace

std::uint32_t materialFeatures(const Material& m) {
    std::uint32_t bits = 0;
    if (m.unlit)
        bits |= kUnlitFeature;
    else if (m.scattering)
        bits |= (kFirstModelFeature << std::uint32_t(m.scattering->model)) |
                (m.scattering->multipleScattering ? kMultipleFeature : 0u);
    else
        bits |= gltfFeatures(m);
    if (m.normalTexture && !m.unlit) bits |= kNormalMapFeature;
    if (m.heightTexture && m.heightScale != 0.0f && !m.unlit) bits |= kBumpFeature;
    if (m.alphaMode != AlphaMode::Opaque) bits |= kAlphaFeature;
    return bits == kDiffuseFeatures ? 0u : bits;
}

bool hasRoughFacets(const Material& m) {
    if (m.unlit) return false;
    if (m.scattering) return !(std::max(m.scattering->alpha.x, m.scattering->alpha.y) < kSmoothAlpha);
    return isMoreThanDiffuse(m) &&
           (!(m.roughness * m.roughness < kSmoothAlpha) || m.anisotropyStrength > 0.0f);
}

bool hasWideLobes(const Material& m) {
    if (m.unlit) return false;
    if (m.scattering) {
        switch (m.scattering->model) {
            case Scattering::Model::Mirror:
            case Scattering::Model::ThinDielectric:
                return false;
            case Scattering::Model::Dielectric:
            case Scattering::Model::Conductor:
                return hasRoughFacets(m) || m.scattering->multipleScattering;
            default:
                return true;
        }
    }
    if (materialFeatures(m) == 0 && glm::vec3(m.baseColor) == glm::vec3(0.0f))
        return false;  // scatters nothing
    const bool metal = m.metallic >= 1.0f && !m.metallicRoughnessTexture;
    const bool glass = m.transmission >= 1.0f && !m.transmissionTexture;
    const bool smoothCoat =
        m.clearcoatRoughness * m.clearcoatRoughness < kSmoothAlpha && !m.clearcoatRoughnessTexture;
    return hasRoughFacets(m) || !(metal || glass) || hasSheen(m) || (m.clearcoat > 0.0f && !smoothCoat);
}

bool throwsCaustics(const Material& m) {
    constexpr float kNarrow = 0.09f;  // the alpha of a roughness of 0.3
    if (m.unlit || m.alphaMode == AlphaMode::Blend) return false;
    if (m.scattering) {
        switch (m.scattering->model) {
            case Scattering::Model::Mirror:
            case Scattering::Model::ThinDielectric:
                return true;
            case Scattering::Model::Dielectric:
            case Scattering::Model::Conductor:
                return std::max(m.scattering->alpha.x, m.scattering->alpha.y) <= kNarrow;
            default:
                return false;
        }
    }
    return (m.metallic >= 0.5f || m.transmission >= 0.25f) && m.roughness * m.roughness <= kNarrow;
}

std::vector<SampledTexture> sampledTextures(const Material& m, bool occlusion) {
    std::vector<SampledTexture> result;
    const auto add = [&](const TextureUse& use, std::uint32_t row, bool color, bool needed) {
        if (use && needed) result.push_back({&use, row, color});
    };
    const std::uint32_t bits = materialFeatures(m);
    add(m.baseColorTexture, kBaseColorRow, true, true);
    add(m.emissiveTexture, kEmissiveRow, true, m.emission != glm::vec3(0.0f));
    add(m.metallicRoughnessTexture, kMetallicRoughnessRow, false, bits & kMetallicTextureFeature);
    add(m.normalTexture, kNormalRow, false, bits & kNormalMapFeature);
    add(m.heightTexture, kHeightRow, false, bits & kBumpFeature);
    add(m.specularTexture, kSpecularRow, false, bits & kSpecularTextureFeature);
    add(m.specularColorTexture, kSpecularColorRow, true, bits & kSpecularTextureFeature);
    add(m.transmissionTexture, kTransmissionRow, false, bits & kTransmissionTextureFeature);
    add(m.clearcoatTexture, kClearcoatRow, false, bits & kClearcoatTextureFeature);
    add(m.clearcoatRoughnessTexture, kClearcoatRoughnessRow, false, bits & kClearcoatTextureFeature);
    add(m.clearcoatNormalTexture, kClearcoatNormalRow, false, bits & kClearcoatTextureFeature);
    add(m.sheenColorTexture, kSheenColorRow, true, bits & kSheenTextureFeature);
    add(m.sheenRoughnessTexture, kSheenRoughnessRow, false, bits & kSheenTextureFeature);
    add(m.anisotropyTexture, kAnisotropyRow, false, bits & kAnisotropyTextureFeature);
    add(m.iridescenceTexture, kIridescenceRow, false, bits & kIridescenceTextureFeature);
    add(m.iridescenceThicknessTexture, kIridescenceThicknessRow, false, bits & kIridescenceTextureFeature);
    add(m.thicknessTexture, kThicknessRow, false, occlusion && hasVolume(m));
    // A lightmap has what hides its surface in it.
    add(m.lightmapTexture, kOcclusionRow, false, occlusion && !m.unlit);
    add(m.occlusionTexture, kOcclusionRow, false,
        occlusion && m.occlusionStrength > 0.0f && !m.unlit && !m.lightmapTexture);
    return result;
}

std::array<int, 2> texcoordSets(const Material& material, bool occlusion) {
    std::array<int, 2> sets{-1, -1};
    for (const SampledTexture& texture : sampledTextures(material, occlusion)) {
        const int set = texture.use->texcoord;
        if (sets[0] < 0) sets[0] = set;
        if (set != sets[0] && sets[1] < 0) sets[1] = set;
    }
    return sets;
}

std::uint32_t texcoordSlot(const std::array<int, 2>& sets, const TextureUse& use) {
    return use.texcoord == sets[1] ? 1u : 0u;
}

bool namesTooManySets(const Material& material, bool occlusion) {
    const std::array<int, 2> sets = texcoordSets(material, occlusion);
    return std::ranges::any_of(sampledTextures(material, occlusion), [&](const SampledTexture& texture) {
        return texture.use->texcoord != sets[0] && texture.use->texcoord != sets[1];
    });
}

bool needsTangents(const Material& material) {
    const std::uint32_t bits = materialFeatures(material);
    const bool turned = material.scattering && material.scattering->alpha.x != material.scattering->alpha.y;
    return (bits & (kNormalMapFeature | kBumpFeature | kAnisotropyFeature)) != 0 || turned ||
           ((bits & kClearcoatTextureFeature) != 0 && material.clearcoatNormalTexture);
}

int tangentSet(const Material& material) {
    for (const TextureUse* use : {&material.normalTexture, &material.anisotropyTexture,
                                  &material.clearcoatNormalTexture, &material.heightTexture})
        if (*use) return use->texcoord;
    return 0;
}

}  // namespace helio::pack
