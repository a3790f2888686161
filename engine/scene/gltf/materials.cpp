#include "engine/scene/extras/extras.hpp"
#include "engine/scene/gltf/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace helio::gltf {
namespace {

using tinygltf::ExtensionMap;
using tinygltf::Value;

const Value* find(const ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double numberOr(const Value& object, const char* member, double fallback) {
    return object.Has(member) ? object.Get(member).GetNumberAsDouble() : fallback;
}

template <class Vector>
Vector vectorOr(const Value& object, const char* member, Vector fallback) {
    if (!object.Has(member)) return fallback;
    const Value& value = object.Get(member);
    for (int i = 0; i < fallback.length(); ++i) fallback[i] = float(value.Get(i).GetNumberAsDouble());
    return fallback;
}

/** A glTF 2.0 sampler's numbers (section 5.26). What it leaves open is linear with mip levels here. */
void setSampler(const tinygltf::Sampler& sampler, Texture& texture) {
    const auto wrap = [](int value) {
        if (value == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::ClampToEdge;
        return value == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::MirroredRepeat : Wrap::Repeat;
    };
    texture.wrapU = wrap(sampler.wrapS);
    texture.wrapV = wrap(sampler.wrapT);
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) texture.magFilter = Filter::Nearest;
    switch (sampler.minFilter) {
        case TINYGLTF_TEXTURE_FILTER_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
            texture.minFilter = Filter::Nearest;
            break;
        default:
            texture.minFilter = Filter::Linear;
    }
    texture.useMipmaps = sampler.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST &&
                         sampler.minFilter != TINYGLTF_TEXTURE_FILTER_LINEAR;
}

/** One material on its way, with the asset's textures it brings along. */
class MaterialBuilder {
public:
    MaterialBuilder(const Asset& asset, helio::Scene& scene) : asset_(asset), scene_(scene), images_(asset) {}

    Material build(const tinygltf::Material& from, int index, bool isUsed) {
        material_ = {};
        index_ = index;
        isUsed_ = isUsed;
        material_.name = from.name;
        const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
        for (int c = 0; c < 4; ++c) {
            material_.baseColor[c] = unit(pbr.baseColorFactor[std::size_t(c)], "baseColorFactor");
        }
        material_.metallic = unit(pbr.metallicFactor, "metallicFactor");
        material_.roughness = unit(pbr.roughnessFactor, "roughnessFactor");
        material_.baseColorTexture = use(pbr.baseColorTexture);
        material_.metallicRoughnessTexture = use(pbr.metallicRoughnessTexture);
        material_.normalTexture = use(from.normalTexture);
        material_.normalScale = float(from.normalTexture.scale);
        material_.occlusionTexture = use(from.occlusionTexture);
        material_.occlusionStrength = unit(from.occlusionTexture.strength, "strength");
        material_.emissiveTexture = use(from.emissiveTexture);
        for (std::size_t c = 0; c < from.emissiveFactor.size(); ++c) {
            material_.emission[int(c)] = float(from.emissiveFactor[c]);
        }
        if (from.alphaMode == "MASK") material_.alphaMode = AlphaMode::Mask;
        if (from.alphaMode == "BLEND") material_.alphaMode = AlphaMode::Blend;
        material_.alphaCutoff = float(from.alphaCutoff);
        material_.doubleSided = from.doubleSided;
        readExtensions(from);
        extras::readMaterial(asset_.document()["materials"][std::size_t(index)], material_);
        return std::move(material_);
    }

    void finish(LoadMonitor& monitor) { images_.decodeAll(monitor, scene_); }

private:
    /** Factors that must lie in 0..1 are brought there; files with others are about, and energy must not
     * grow. */
    float unit(double value, const char* member) {
        if (value < 0 || value > 1) {
            warn(scene_, fmt::format("materials[{}]: {} is {}, taken as {}", index_, member, value,
                                     std::clamp(value, 0.0, 1.0)));
        }
        return float(std::clamp(value, 0.0, 1.0));
    }

    glm::vec3 unit(const glm::vec3& value, const char* member) {
        return {unit(value.r, member), unit(value.g, member), unit(value.b, member)};
    }

    /** An index of refraction: 0 stands for an infinite one, else none is below the vacuum's. */
    float refraction(double value, const char* member) {
        if (value == 0 || value >= 1) return float(value);
        warn(scene_, fmt::format("materials[{}]: {} is {}, taken as 1", index_, member, value));
        return 1;
    }

    void readExtensions(const tinygltf::Material& from) {
        using Read = void (MaterialBuilder::*)(const Value&);
        constexpr std::pair<const char*, Read> readers[] = {
            {"KHR_materials_anisotropy", &MaterialBuilder::readAnisotropy},
            {"KHR_materials_clearcoat", &MaterialBuilder::readClearcoat},
            {"KHR_materials_dispersion", &MaterialBuilder::readDispersion},
            {"KHR_materials_emissive_strength", &MaterialBuilder::readEmissiveStrength},
            {"KHR_materials_ior", &MaterialBuilder::readIor},
            {"KHR_materials_iridescence", &MaterialBuilder::readIridescence},
            {"KHR_materials_sheen", &MaterialBuilder::readSheen},
            {"KHR_materials_specular", &MaterialBuilder::readSpecular},
            {"KHR_materials_transmission", &MaterialBuilder::readTransmission},
            {"KHR_materials_unlit", &MaterialBuilder::readUnlit},
            {"KHR_materials_volume", &MaterialBuilder::readVolume},
        };
        for (const auto& [name, read] : readers) {
            if (const Value* extension = find(from.extensions, name)) (this->*read)(*extension);
        }
        for (const auto& [name, value] : from.extensions) note(name);
        for (const auto& [name, value] : from.pbrMetallicRoughness.extensions) note(name);
    }

    void readAnisotropy(const Value& from) {
        material_.anisotropyStrength = unit(numberOr(from, "anisotropyStrength", 0), "anisotropyStrength");
        material_.anisotropyRotation = float(numberOr(from, "anisotropyRotation", 0));
        material_.anisotropyTexture = use(from, "anisotropyTexture");
    }

    void readClearcoat(const Value& from) {
        material_.clearcoat = unit(numberOr(from, "clearcoatFactor", 0), "clearcoatFactor");
        material_.clearcoatTexture = use(from, "clearcoatTexture");
        material_.clearcoatRoughness =
            unit(numberOr(from, "clearcoatRoughnessFactor", 0), "clearcoatRoughnessFactor");
        material_.clearcoatRoughnessTexture = use(from, "clearcoatRoughnessTexture");
        material_.clearcoatNormalTexture = use(from, "clearcoatNormalTexture");
        if (material_.clearcoatNormalTexture)
            material_.clearcoatNormalScale = float(numberOr(from.Get("clearcoatNormalTexture"), "scale", 1));
    }

    void readDispersion(const Value& from) { material_.dispersion = float(numberOr(from, "dispersion", 0)); }

    void readEmissiveStrength(const Value& from) {
        material_.emission *= float(numberOr(from, "emissiveStrength", 1));
    }

    void readIor(const Value& from) { material_.ior = refraction(numberOr(from, "ior", 1.5), "ior"); }

    void readIridescence(const Value& from) {
        material_.iridescence = unit(numberOr(from, "iridescenceFactor", 0), "iridescenceFactor");
        material_.iridescenceTexture = use(from, "iridescenceTexture");
        material_.iridescenceIor = float(numberOr(from, "iridescenceIor", 1.3));
        material_.iridescenceThicknessMinimum = float(numberOr(from, "iridescenceThicknessMinimum", 100));
        material_.iridescenceThicknessMaximum = float(numberOr(from, "iridescenceThicknessMaximum", 400));
        material_.iridescenceThicknessTexture = use(from, "iridescenceThicknessTexture");
    }

    void readSheen(const Value& from) {
        material_.sheenColor = unit(vectorOr(from, "sheenColorFactor", glm::vec3(0)), "sheenColorFactor");
        material_.sheenColorTexture = use(from, "sheenColorTexture");
        material_.sheenRoughness = unit(numberOr(from, "sheenRoughnessFactor", 0), "sheenRoughnessFactor");
        material_.sheenRoughnessTexture = use(from, "sheenRoughnessTexture");
    }

    void readSpecular(const Value& from) {
        material_.specular = unit(numberOr(from, "specularFactor", 1), "specularFactor");
        material_.specularColor = vectorOr(from, "specularColorFactor", glm::vec3(1));
        material_.specularTexture = use(from, "specularTexture");
        material_.specularColorTexture = use(from, "specularColorTexture");
    }

    void readTransmission(const Value& from) {
        material_.transmission = unit(numberOr(from, "transmissionFactor", 0), "transmissionFactor");
        material_.transmissionTexture = use(from, "transmissionTexture");
    }

    void readUnlit(const Value&) { material_.unlit = true; }

    void readVolume(const Value& from) {
        material_.thickness = float(numberOr(from, "thicknessFactor", 0));
        material_.thicknessTexture = use(from, "thicknessTexture");
        if (from.Has("attenuationDistance"))
            material_.attenuationDistance = float(numberOr(from, "attenuationDistance", 0));
        material_.attenuationColor =
            unit(vectorOr(from, "attenuationColor", glm::vec3(1)), "attenuationColor");
    }

    void note(const std::string& extension) {
        auto& list = material_.unsupported;
        if (!isSupported(extension) && std::find(list.begin(), list.end(), extension) == list.end()) {
            list.push_back(extension);
        }
    }

    template <class Info>
    TextureUse use(const Info& info) {
        if (info.index < 0) return {};
        TextureUse result = use(info.index, info.texCoord);
        for (const auto& [name, value] : info.extensions) note(name);
        if (const Value* transform = find(info.extensions, "KHR_texture_transform"))
            apply(*transform, result);
        return result;
    }

    /** A texture named inside an extension, which tinygltf does not read for us. */
    TextureUse use(const Value& extension, const char* member) {
        if (!extension.Has(member)) return {};
        const Value& info = extension.Get(member);
        TextureUse result = use(int(numberOr(info, "index", 0)), int(numberOr(info, "texCoord", 0)));
        if (!info.Has("extensions")) return result;
        const Value& extensions = info.Get("extensions");
        for (const std::string& name : extensions.Keys()) note(name);
        if (extensions.Has("KHR_texture_transform")) apply(extensions.Get("KHR_texture_transform"), result);
        return result;
    }

    TextureUse use(int texture, int texcoord) {
        if (!isUsed_) return {};
        TextureUse result;
        result.texture = sceneTexture(texture);
        result.texcoord = texcoord;
        return result;
    }

    /** KHR_texture_transform: scale, then rotate, then offset. With v down the image, turning the coordinates
     * counter-clockwise as the extension says makes u' = u cos + v sin, v' = v cos - u sin; its own example
     * (the lower left quadrant, turned clockwise) holds with these signs only. */
    static void apply(const Value& transform, TextureUse& use) {
        const glm::vec2 offset = vectorOr(transform, "offset", glm::vec2(0));
        const glm::vec2 scale = vectorOr(transform, "scale", glm::vec2(1));
        const double angle = numberOr(transform, "rotation", 0);
        const auto c = float(std::cos(angle)), s = float(std::sin(angle));
        use.transform = glm::mat3(glm::vec3(c * scale.x, -s * scale.x, 0),
                                  glm::vec3(s * scale.y, c * scale.y, 0), glm::vec3(offset, 1));
        use.texcoord = int(numberOr(transform, "texCoord", use.texcoord));
    }

    /** The scene's texture for one of the asset's; -1 where it has no image that can be read. */
    int sceneTexture(int texture) {
        if (const auto known = textures_.find(texture); known != textures_.end()) return known->second;
        const tinygltf::Texture& from = asset_.model().textures[std::size_t(texture)];
        int source = from.source;
        if (const Value* webp = find(from.extensions, "EXT_texture_webp"))
            source = webp->Get("source").GetNumberAsInt();
        if (source < 0) {
            for (const auto& [name, value] : from.extensions) note(name);
            skip(scene_, fmt::format("texture {}", texture), "it has no PNG, JPEG or WebP image");
            return textures_[texture] = -1;
        }
        Texture result;
        result.name = from.name;
        result.image = images_.use(source);
        if (from.sampler >= 0) setSampler(asset_.model().samplers[std::size_t(from.sampler)], result);
        scene_.textures.push_back(result);
        return textures_[texture] = int(scene_.textures.size()) - 1;
    }

    const Asset& asset_;
    helio::Scene& scene_;
    ImageLoader images_;
    std::map<int, int> textures_;
    Material material_;
    int index_ = 0;
    bool isUsed_ = false;
};

}  // namespace

void buildMaterials(const Asset& asset, const std::set<int>& used, LoadMonitor& monitor,
                    helio::Scene& scene) {
    MaterialBuilder builder(asset, scene);
    int index = 0;
    for (const tinygltf::Material& material : asset.model().materials) {
        scene.materials.push_back(builder.build(material, index, used.contains(index)));
        ++index;
    }
    builder.finish(monitor);
}

}  // namespace helio::gltf
