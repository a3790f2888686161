#pragma once
/** @file
 * What of a material kernels read: its features, its textures, and where both lie among its packed texels.
 * The values are those of shaders/scene/materials.glsl and shaders/scene/surface_material.glsl.
 */
#include <heliograph/scene.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace helio::pack {

/** Bits of MATERIAL_FEATURES: kernels hold code for the bits of the scene's materials in use, and no other.
 */
enum MaterialFeature : std::uint32_t {
    kGltfFeature =
        1u << 0,  ///< some material scatters as glTF's; without any of the following bits as Lambert
    kTransmissionFeature = 1u << 1,
    kClearcoatFeature = 1u << 2,
    kSheenFeature = 1u << 3,
    kIridescenceFeature = 1u << 4,
    kAnisotropyFeature = 1u << 5,
    kVolumeFeature = 1u << 6,
    kDispersionFeature = 1u << 7,
    kNormalMapFeature = 1u << 8,
    kMetallicTextureFeature = 1u << 9,
    kSpecularTextureFeature = 1u << 10,
    kTransmissionTextureFeature = 1u << 11,
    kClearcoatTextureFeature = 1u << 12,
    kSheenTextureFeature = 1u << 13,
    kAnisotropyTextureFeature = 1u << 14,
    kIridescenceTextureFeature = 1u << 15,
    kAlphaFeature = 1u << 16,
    kUnlitFeature = 1u << 17,
    kSpecularFeature = 1u << 18,    ///< some glTF material is more than diffuse
    kMultipleFeature = 1u << 19,    ///< light between facets is made up for
    kFirstModelFeature = 1u << 20,  ///< and one bit for each Scattering::Model in order
    kBumpFeature = 1u << 27,        ///< some normal is tilted by a height map
    kDielectricFeature = 1u << 31   ///< some glTF material is no pure metal
};
inline constexpr std::uint32_t kModelFeatures = kBumpFeature - kFirstModelFeature;

/** What a material that scatters as Lambert needs beside others that are more. */
inline constexpr std::uint32_t kDiffuseFeatures = kGltfFeature | kDielectricFeature;

/** What the kernels that show this material need; 0 where it scatters as Lambert and nothing else. */
std::uint32_t materialFeatures(const Material& material);

/** Whether its microfacets, if any, have a width (SMOOTH_ALPHA); the clear coat's apart. */
bool hasRoughFacets(const Material& material);
/** Whether some of its light is scattered into a solid angle, not by mirrors and smooth glass alone. */
bool hasWideLobes(const Material& material);

/** Whether light goes on from it in a narrow cone, as from mirrors and glass, much as it came. */
bool throwsCaustics(const Material& material);

/** Whether a volume of glTF's model lies behind its surface. */
bool hasVolume(const Material& material);

/** A texture that kernels sample. */
struct SampledTexture {
    const TextureUse* use = nullptr;
    std::uint32_t row = 0;  ///< of the material's texels: its transform's rows, with texture and slot
    bool color = false;     ///< decoded from sRGB
};
/** All of a material's, base colour and emission first. `occlusion`: those of occlusion and thickness too. */
std::vector<SampledTexture> sampledTextures(const Material& material, bool occlusion = false);

/** The sets of texture coordinates that triangles of this material carry; -1 for none. */
std::array<int, 2> texcoordSets(const Material& material, bool occlusion = false);
/** Which of them a use reads; one that names a third set reads the first. */
std::uint32_t texcoordSlot(const std::array<int, 2>& sets, const TextureUse& use);
/** Whether the material's textures name more than two sets. */
bool namesTooManySets(const Material& material, bool occlusion = false);

/** Whether triangles of this material need tangents, and by which set of texture coordinates. */
bool needsTangents(const Material& material);
int tangentSet(const Material& material);

}  // namespace helio::pack
