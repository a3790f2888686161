#include "engine/scene/mesh/mtl_material.hpp"

#include "engine/scene/mesh/attributes.hpp"
#include "engine/scene/mesh/text.hpp"
#include "engine/scene/notes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

// Compiled in here: the library loads no further object at start-up, and sanitizers see it.
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>
#include <string_view>

namespace helio::mesh {
namespace {

/** Keywords with numbers, and how many of them are read. tinyobjloader takes what is no number for 0. */
constexpr std::array<std::pair<std::string_view, std::size_t>, 16> numeric{{
    {"Ka", 3},
    {"Kd", 3},
    {"Ks", 3},
    {"Ke", 3},
    {"Tf", 3},
    {"Kt", 3},
    {"Ns", 1},
    {"Ni", 1},
    {"d", 1},
    {"Tr", 1},
    {"Pr", 1},
    {"Pm", 1},
    {"Ps", 1},
    {"Pc", 1},
    {"aniso", 1},
    {"anisor", 1},
}};

class Builder {
public:
    Builder(const std::string& file, const MtlBlock& block, TextureFiles& textures, Scene& scene)
        : file_(file), block_(block), textures_(textures), scene_(scene) {}

    Material build() {
        read();
        material_.name = block_.name;
        setColor();
        if (hasAny({"Pr", "Pm", "map_Pr", "map_Pm"})) {
            setPhysical();
        } else {
            setPhong();
        }
        setEmission();
        setAlpha();
        material_.sheenColor = glm::vec3(unit(from_.sheen, "Ps"));
        material_.sheenRoughness = 0.3f;  // of the extension's sheen, which gives none
        if (from_.sheen <= 0) material_.sheenRoughness = 0;
        material_.clearcoat = unit(from_.clearcoat_thickness, "Pc");
        material_.clearcoatRoughness = unit(from_.clearcoat_roughness, "Pcr");
        material_.anisotropyStrength = unit(from_.anisotropy, "aniso");
        material_.anisotropyRotation = float(double(from_.anisotropy_rotation) * 2 * std::numbers::pi);
        material_.normalTexture = use(from_.normal_texname, from_.normal_texopt);
        if (!from_.normal_texname.empty()) material_.normalScale = from_.normal_texopt.bump_multiplier;
        setHeight();
        noteRest();
        return std::move(material_);
    }

private:
    bool has(const char* keyword) const { return keywords_.contains(keyword); }
    bool hasAny(std::initializer_list<const char*> keywords) const {
        return std::any_of(keywords.begin(), keywords.end(), [this](const char* k) { return has(k); });
    }

    /** Checks the numbers, then lets tinyobjloader read the block. */
    void read() {
        std::string text = "newmtl m\n";
        for (const MtlBlock::Line& line : block_.lines) {
            keywords_.insert(line.keyword);
            const auto known = std::find_if(numeric.begin(), numeric.end(),
                                            [&](const auto& entry) { return entry.first == line.keyword; });
            text += line.keyword + ' ' +
                    (known == numeric.end() ? withWholeOptions(line.rest) : numbers(line, known->second)) +
                    '\n';
        }
        std::istringstream stream(text);
        std::map<std::string, int> names;
        std::vector<tinyobj::material_t> materials;
        std::string warning, error;
        tinyobj::LoadMtl(&names, &materials, &stream, &warning, &error);
        if (!materials.empty()) from_ = materials.front();
    }

    /** tinyobjloader takes three words after -o, -s and -t, even where the next is an option already; MTL
     * lets the last two be left out. */
    static std::string withWholeOptions(std::string_view rest) {
        std::string text;
        while (rest.starts_with('-')) {
            const std::string_view option = takeWord(rest);
            const bool isVector = option == "-o" || option == "-s" || option == "-t";
            text.append(option);
            for (int given = 0; isVector && given < 3; ++given) {
                std::string_view after = rest;
                const std::string_view word = takeWord(after);
                const bool isNumber = parseReal(word).has_value();
                text.append(" ").append(isNumber ? word : option == "-s" ? "1" : "0");
                if (isNumber) rest = after;
            }
            if (!isVector) {
                const std::string_view value = takeWord(rest);
                text.append(" ").append(value);
                if (option == "-mm") text.append(" ").append(takeWord(rest));
            }
            text.push_back(' ');
            rest = trimmed(rest);
        }
        return text.append(rest);
    }

    std::string numbers(const MtlBlock::Line& line, std::size_t count) {
        const auto refuse = [&](std::string fault) {
            throw InputError(file_, fmt::format("line {}", line.number), std::move(fault),
                             count == 1 ? "give a finite number" : "give one or three finite numbers");
        };
        std::string_view rest = line.rest;
        if (line.keyword == "d" && rest.starts_with("-halo")) {
            skip(scene_, "MTL d -halo", "opacity does not depend on the angle");
            takeWord(rest);
        }
        std::string text;
        std::size_t given = 0;
        float first = 0;
        for (; given < count; ++given) {
            const std::string_view word = takeWord(rest);
            if (word.empty() || word[0] == '#') break;
            if (given == 0 && (word == "spectral" || word == "xyz")) {
                skip(scene_, "MTL " + line.keyword + " " + std::string(word), "only RGB is read");
                keywords_.erase(line.keyword);
                return {};
            }
            const std::optional<float> value = parseReal(word);
            if (!value) refuse(fmt::format("{} has {} for a number", line.keyword, shown(word)));
            if (*value < 0 && line.keyword != "anisor")
                refuse(fmt::format("{} is {}, below 0", line.keyword, *value));
            if (given == 0) first = *value;
            text += fmt::format("{:e} ", *value);
        }
        if (given == 0) refuse(line.keyword + " has no number");
        for (; given < count; ++given) text += fmt::format("{:e} ", first);  // one number is grey
        return text;
    }

    /** A factor of 0..1. */
    float unit(float value, const char* what) {
        if (value > 1)
            warn(scene_, fmt::format("material {}: {} is {}, taken as 1", shown(block_.name), what, value));
        return std::clamp(value, 0.0f, 1.0f);
    }
    glm::vec3 unitColor(const tinyobj::real_t* color, const char* what) {
        return {unit(color[0], what), unit(color[1], what), unit(color[2], what)};
    }

    TextureUse use(const std::string& name, const tinyobj::texture_option_t& options) {
        if (name.empty()) return {};
        TextureUse result;
        result.texture = textures_.texture(name, options.clamp);
        if (result.texture < 0) return {};
        const float su = options.scale[0], sv = options.scale[1];
        const float ou = options.origin_offset[0], ov = options.origin_offset[1];
        // (su u + ou, sv v + ov) with v up, in coordinates with v down.
        result.transform = glm::mat3(glm::vec3(su, 0, 0), glm::vec3(0, sv, 0), glm::vec3(ou, 1 - sv - ov, 1));
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(result.transform[c].x) || !std::isfinite(result.transform[c].y))
                result.transform = glm::mat3(1);
        }
        if (options.turbulence[0] != 0 || options.turbulence[1] != 0)
            skip(scene_, "MTL texture option -t", "turbulence is not evaluated");
        if (options.brightness != 0 || options.contrast != 1)
            skip(scene_, "MTL texture option -mm", "textures are taken as they are");
        return result;
    }

    void setColor() {
        const bool hasMap = !from_.diffuse_texname.empty();
        const glm::vec3 color = has("Kd") ? unitColor(from_.diffuse, "Kd") : glm::vec3(hasMap ? 1.0f : 0.8f);
        material_.baseColor = glm::vec4(color, 1);
        material_.baseColorTexture = use(from_.diffuse_texname, from_.diffuse_texopt);
    }

    void setPhysical() {
        material_.metallic = unit(from_.metallic, "Pm");
        material_.roughness = has("Pr") ? unit(from_.roughness, "Pr") : 1.0f;
        if (has("Ni")) material_.ior = std::max(from_.ior, 1.0f);
        const bool hasRoughness = !from_.roughness_texname.empty(),
                   hasMetallic = !from_.metallic_texname.empty();
        if (hasMetallic && !has("Pm")) material_.metallic = 1;
        // One texture holds both here, and a grey one has the same in both channels.
        if (hasRoughness && (from_.roughness_texname == from_.metallic_texname || material_.metallic == 0)) {
            material_.metallicRoughnessTexture = use(from_.roughness_texname, from_.roughness_texopt);
        } else if (hasRoughness || hasMetallic) {
            if (hasMetallic && !has("Pm")) material_.metallic = 0;
            skip(scene_, "MTL map_Pr and map_Pm",
                 "one image must hold both: roughness in green, metallic in blue");
        }
    }

    /** alpha^2 = 2 / (Ns + 2); the scene's roughness is the root of alpha. */
    static float roughnessOf(float exponent) { return float(std::pow(2.0 / (double(exponent) + 2.0), 0.25)); }

    void setPhong() {
        material_.metallic = 0;
        material_.roughness = has("Ns") ? roughnessOf(from_.shininess) : 1.0f;
        material_.ior = has("Ni") ? std::max(from_.ior, 1.0f) : 1.5f;
        const int illumination = has("illum") ? from_.illum : 2;
        const bool isDull = illumination == 0 || illumination == 1;
        const glm::vec3 highlight = has("Ks") && !isDull ? unitColor(from_.specular, "Ks") : glm::vec3(0);
        const auto largest = [](const glm::vec3& c) { return std::max({c.x, c.y, c.z}); };
        if (illumination == 4 || illumination == 6 || illumination == 7 || illumination == 9) {
            material_.transmission = 1;
            material_.thickness = 1;  // meshes in OBJ files are solids: light is refracted
            material_.roughness = 0;
            const glm::vec3 filter =
                has("Tf") || has("Kt") ? unitColor(from_.transmittance, "Tf") : glm::vec3(1);
            if (largest(glm::vec3(material_.baseColor)) > 0.05f)
                skip(scene_, "Kd of transparent MTL materials", "glass has no diffuse part");
            material_.baseColor = glm::vec4(filter, 1);
            material_.baseColorTexture = {};
        } else if ((illumination == 3 || illumination == 5 || illumination == 8) &&
                   largest(highlight) > largest(glm::vec3(material_.baseColor))) {
            material_.metallic = 1;
            if (illumination != 8) material_.roughness = 0;
            if (largest(glm::vec3(material_.baseColor)) > 0.05f)
                skip(scene_, "Kd of mirroring MTL materials", "a metal has no diffuse part");
            material_.baseColor = glm::vec4(highlight, 1);
            material_.baseColorTexture = use(from_.specular_texname, from_.specular_texopt);
        } else if (largest(highlight) > 0) {
            const double root = (double(material_.ior) - 1) / (double(material_.ior) + 1);
            if (root * root < 1e-3) material_.ior = 1.5f;  // an index of 1 cannot reflect what Ks asks for
            const double reflectance = root * root < 1e-3 ? 0.04 : root * root;
            material_.specularColor = highlight / float(reflectance);
            material_.specularColorTexture = use(from_.specular_texname, from_.specular_texopt);
        } else {
            material_.specular = 0;
        }
    }

    void setEmission() {
        const bool hasMap = !from_.emissive_texname.empty();
        material_.emission = has("Ke") ? glm::vec3(from_.emission[0], from_.emission[1], from_.emission[2])
                                       : glm::vec3(hasMap ? 1.0f : 0.0f);
        material_.emissiveTexture = use(from_.emissive_texname, from_.emissive_texopt);
    }

    void setAlpha() {
        if (material_.transmission > 0) return;
        const float alpha = unit(from_.dissolve, "d");
        material_.baseColor.a = alpha;
        const bool hasMap = !from_.alpha_texname.empty();
        const bool isColorMap = hasMap && from_.alpha_texname == from_.diffuse_texname;
        if (alpha < 1 || isColorMap) material_.alphaMode = AlphaMode::Blend;
        if (hasMap && !isColorMap)
            skip(scene_, "MTL map_d", "only the alpha channel of the image that is map_Kd is read");
    }

    /** Heights are known where -bm says how high white stands, in units of the scene: many files name normal
     * maps as bump. */
    void setHeight() {
        if (from_.bump_texname.empty()) return;
        const bool saysHeight =
            std::any_of(block_.lines.begin(), block_.lines.end(), [](const MtlBlock::Line& line) {
                return (line.keyword == "bump" || line.keyword == "map_bump" || line.keyword == "map_Bump") &&
                       std::string_view(line.rest).find("-bm ") != std::string_view::npos;
            });
        if (saysHeight && std::isfinite(from_.bump_texopt.bump_multiplier)) {
            material_.heightTexture = use(from_.bump_texname, from_.bump_texopt);
            if (material_.heightTexture) material_.heightScale = from_.bump_texopt.bump_multiplier;
        } else {
            skip(scene_, "MTL bump",
                 "it does not say how high it stands; give -bm HEIGHT, or a normal map as norm");
        }
    }

    void noteRest() {
        const auto note = [&](bool isThere, const char* what, const char* why) {
            if (isThere) skip(scene_, what, why);
        };
        note(from_.ambient[0] > 0 || from_.ambient[1] > 0 || from_.ambient[2] > 0, "MTL Ka",
             "light that comes from nowhere is not shown");
        note(!from_.reflection_texname.empty(), "MTL refl", "reflections are traced");
        note(!from_.specular_highlight_texname.empty(), "MTL map_Ns", "the exponent is the same everywhere");
        note(!from_.sheen_texname.empty(), "MTL map_Ps", "sheen is the same everywhere");
        note(!from_.displacement_texname.empty(), "MTL disp", "heights are those of bump with -bm");
        note(has("decal"), "MTL decal", "decals are not shown");
    }

    const std::string& file_;
    const MtlBlock& block_;
    TextureFiles& textures_;
    Scene& scene_;
    tinyobj::material_t from_{};
    std::set<std::string> keywords_;
    Material material_;
};

}  // namespace

Material materialOf(const std::string& file, const MtlBlock& block, TextureFiles& textures, Scene& scene) {
    return Builder(file, block, textures, scene).build();
}

}  // namespace helio::mesh
