#include "engine/scene/extras/extras.hpp"
#include "engine/scene/gltf/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace helio::gltf {
namespace {

using nlohmann::json;

/** A glTF 2.0 sampler's numbers (section 5.26). What it leaves open is linear with mip levels here. */
void setSampler(const json& sampler, Texture& texture) {
    constexpr int nearest = 9728, linear = 9729, nearestMipmapNearest = 9984, nearestMipmapLinear = 9986,
                  clampToEdge = 33071, mirroredRepeat = 33648, repeat = 10497;
    const auto wrap = [](int value) {
        if (value == clampToEdge) return Wrap::ClampToEdge;
        return value == mirroredRepeat ? Wrap::MirroredRepeat : Wrap::Repeat;
    };
    texture.wrapU = wrap(integerOr(sampler, "wrapS", repeat));
    texture.wrapV = wrap(integerOr(sampler, "wrapT", repeat));
    if (integerOr(sampler, "magFilter", linear) == nearest) texture.magFilter = Filter::Nearest;
    const int filter = integerOr(sampler, "minFilter", -1);
    const bool isNearest =
        filter == nearest || filter == nearestMipmapNearest || filter == nearestMipmapLinear;
    texture.minFilter = isNearest ? Filter::Nearest : Filter::Linear;
    texture.useMipmaps = filter != nearest && filter != linear;
}

/** One material on its way, with the asset's textures it brings along. */
class MaterialBuilder {
public:
    MaterialBuilder(const Asset& asset, MemoryBudget& memory, helio::Scene& scene)
        : asset_(asset), scene_(scene), images_(asset, memory) {}

    Material build(const json& from, int index, bool isUsed) {
        material_ = {};
        index_ = index;
        isUsed_ = isUsed;
        material_.name = from.value("name", "");
        static const json none = json::object();
        const auto partOf = [&](const char* name) -> const json& {
            const auto found = from.find(name);
            return found == from.end() ? none : *found;
        };
        const json& pbr = partOf("pbrMetallicRoughness");
        const glm::dvec4 color = vectorOr(pbr, "baseColorFactor", glm::dvec4(1));
        for (int c = 0; c < 4; ++c) material_.baseColor[c] = unit(color[c], "baseColorFactor");
        material_.metallic = unit(numberOr(pbr, "metallicFactor", 1), "metallicFactor");
        material_.roughness = unit(numberOr(pbr, "roughnessFactor", 1), "roughnessFactor");
        material_.baseColorTexture = use(pbr, "baseColorTexture");
        material_.metallicRoughnessTexture = use(pbr, "metallicRoughnessTexture");
        material_.normalTexture = use(from, "normalTexture");
        material_.normalScale = float(numberOr(partOf("normalTexture"), "scale", 1));
        material_.occlusionTexture = use(from, "occlusionTexture");
        material_.occlusionStrength = unit(numberOr(partOf("occlusionTexture"), "strength", 1), "strength");
        material_.emissiveTexture = use(from, "emissiveTexture");
        material_.emission = vectorOr(from, "emissiveFactor", glm::vec3(0));
        const std::string alphaMode = from.value("alphaMode", "OPAQUE");
        if (alphaMode == "MASK") material_.alphaMode = AlphaMode::Mask;
        if (alphaMode == "BLEND") material_.alphaMode = AlphaMode::Blend;
        material_.alphaCutoff = float(numberOr(from, "alphaCutoff", 0.5));
        material_.doubleSided = from.value("doubleSided", false);
        readExtensions(from);
        extras::readMaterial(from, material_);
        readOwnTextures(from);
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

    void readExtensions(const json& from) {
        using Read = void (MaterialBuilder::*)(const json&);
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
            if (const json* const extension = extensionOf(from, name)) (this->*read)(*extension);
        }
        noteExtensions(from);
        if (from.contains("pbrMetallicRoughness")) noteExtensions(from["pbrMetallicRoughness"]);
    }

    void readAnisotropy(const json& from) {
        material_.anisotropyStrength = unit(numberOr(from, "anisotropyStrength", 0), "anisotropyStrength");
        material_.anisotropyRotation = float(numberOr(from, "anisotropyRotation", 0));
        material_.anisotropyTexture = use(from, "anisotropyTexture");
    }

    void readClearcoat(const json& from) {
        material_.clearcoat = unit(numberOr(from, "clearcoatFactor", 0), "clearcoatFactor");
        material_.clearcoatTexture = use(from, "clearcoatTexture");
        material_.clearcoatRoughness =
            unit(numberOr(from, "clearcoatRoughnessFactor", 0), "clearcoatRoughnessFactor");
        material_.clearcoatRoughnessTexture = use(from, "clearcoatRoughnessTexture");
        material_.clearcoatNormalTexture = use(from, "clearcoatNormalTexture");
        if (material_.clearcoatNormalTexture)
            material_.clearcoatNormalScale = float(numberOr(from["clearcoatNormalTexture"], "scale", 1));
    }

    void readDispersion(const json& from) { material_.dispersion = float(numberOr(from, "dispersion", 0)); }

    void readEmissiveStrength(const json& from) {
        material_.emission *= float(numberOr(from, "emissiveStrength", 1));
    }

    void readIor(const json& from) { material_.ior = refraction(numberOr(from, "ior", 1.5), "ior"); }

    void readIridescence(const json& from) {
        material_.iridescence = unit(numberOr(from, "iridescenceFactor", 0), "iridescenceFactor");
        material_.iridescenceTexture = use(from, "iridescenceTexture");
        material_.iridescenceIor = float(numberOr(from, "iridescenceIor", 1.3));
        material_.iridescenceThicknessMinimum = float(numberOr(from, "iridescenceThicknessMinimum", 100));
        material_.iridescenceThicknessMaximum = float(numberOr(from, "iridescenceThicknessMaximum", 400));
        material_.iridescenceThicknessTexture = use(from, "iridescenceThicknessTexture");
    }

    void readSheen(const json& from) {
        material_.sheenColor = unit(vectorOr(from, "sheenColorFactor", glm::vec3(0)), "sheenColorFactor");
        material_.sheenColorTexture = use(from, "sheenColorTexture");
        material_.sheenRoughness = unit(numberOr(from, "sheenRoughnessFactor", 0), "sheenRoughnessFactor");
        material_.sheenRoughnessTexture = use(from, "sheenRoughnessTexture");
    }

    void readSpecular(const json& from) {
        material_.specular = unit(numberOr(from, "specularFactor", 1), "specularFactor");
        material_.specularColor = vectorOr(from, "specularColorFactor", glm::vec3(1));
        material_.specularTexture = use(from, "specularTexture");
        material_.specularColorTexture = use(from, "specularColorTexture");
    }

    void readTransmission(const json& from) {
        material_.transmission = unit(numberOr(from, "transmissionFactor", 0), "transmissionFactor");
        material_.transmissionTexture = use(from, "transmissionTexture");
    }

    void readUnlit(const json&) { material_.unlit = true; }

    void readVolume(const json& from) {
        material_.thickness = float(numberOr(from, "thicknessFactor", 0));
        material_.thicknessTexture = use(from, "thicknessTexture");
        if (from.contains("attenuationDistance"))
            material_.attenuationDistance = float(numberOr(from, "attenuationDistance", 0));
        material_.attenuationColor =
            unit(vectorOr(from, "attenuationColor", glm::vec3(1)), "attenuationColor");
    }

    /** Textures that extras.heliograph names. */
    void readOwnTextures(const json& from) {
        const auto own = [&](const char* member) -> const json* {
            const auto extras = from.find("extras");
            if (extras == from.end() || !extras->is_object() || !extras->contains("heliograph"))
                return nullptr;
            const json& mine = (*extras)["heliograph"];
            if (!mine.is_object() || !mine.contains(member)) return nullptr;
            if (mine[member]["index"].get<std::size_t>() >= asset_.document().size("textures"))
                throw InputError(asset_.file(),
                                 fmt::format("/materials/{}/extras/heliograph/{}/index", index_, member),
                                 fmt::format("texture {} does not exist", mine[member]["index"].dump()),
                                 "name one of the file's textures");
            return &mine;
        };
        if (const json* const mine = own("height")) {
            material_.heightTexture = use(*mine, "height");
            material_.heightScale = float(numberOr((*mine)["height"], "scale", 1));
        }
        if (const json* const mine = own("lightmap")) material_.lightmapTexture = use(*mine, "lightmap");
    }

    void note(const std::string& extension) {
        auto& list = material_.unsupported;
        if (!isSupported(extension) && std::find(list.begin(), list.end(), extension) == list.end()) {
            list.push_back(extension);
        }
    }

    void noteExtensions(const json& object) {
        for (const auto& [name, value] : extensionsOf(object).items()) note(name);
    }

    TextureUse use(const json& object, const char* member) {
        const auto info = object.find(member);
        if (info == object.end()) return {};
        TextureUse result = use(integerOr(*info, "index", 0), integerOr(*info, "texCoord", 0));
        noteExtensions(*info);
        if (const json* const transform = extensionOf(*info, "KHR_texture_transform"))
            apply(*transform, result);
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
    static void apply(const json& transform, TextureUse& use) {
        const glm::vec2 offset = vectorOr(transform, "offset", glm::vec2(0));
        const glm::vec2 scale = vectorOr(transform, "scale", glm::vec2(1));
        const double angle = numberOr(transform, "rotation", 0);
        const auto c = float(std::cos(angle)), s = float(std::sin(angle));
        use.transform = glm::mat3(glm::vec3(c * scale.x, -s * scale.x, 0),
                                  glm::vec3(s * scale.y, c * scale.y, 0), glm::vec3(offset, 1));
        use.texcoord = integerOr(transform, "texCoord", use.texcoord);
    }

    /** The scene's texture for one of the asset's; -1 where it has no image that can be read. */
    int sceneTexture(int texture) {
        if (const auto known = textures_.find(texture); known != textures_.end()) return known->second;
        const json from = asset_.document().element("textures", std::size_t(texture));
        int source = integerOr(from, "source", -1);
        if (const json* const webp = extensionOf(from, "EXT_texture_webp"))
            source = integerOr(*webp, "source", -1);
        if (source < 0) {
            noteExtensions(from);
            skip(scene_, fmt::format("texture {}", texture), "it has no PNG, JPEG or WebP image");
            return textures_[texture] = -1;
        }
        Texture result;
        result.name = from.value("name", "");
        result.image = images_.use(source);
        const int sampler = integerOr(from, "sampler", -1);
        if (sampler >= 0) setSampler(asset_.document().element("samplers", std::size_t(sampler)), result);
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

void buildMaterials(const Asset& asset, const std::set<int>& used, MemoryBudget& memory, LoadMonitor& monitor,
                    helio::Scene& scene) {
    MaterialBuilder builder(asset, memory, scene);
    const std::size_t count = asset.document().size("materials");
    memory.take("materials", count * sizeof(Material), 0);
    scene.materials.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const json material = asset.document().element("materials", i);
        scene.materials.push_back(builder.build(material, int(i), used.contains(int(i))));
    }
    builder.finish(monitor);
}

}  // namespace helio::gltf
