#include "engine/scene/gltf/schema.hpp"

#include "engine/scene/extras/extras.hpp"
#include "engine/scene/gltf/schema_check.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <string_view>

namespace helio::gltf {
namespace {

constexpr bool required = true;
constexpr double maximumInt = std::numeric_limits<int>::max();
constexpr double maximumDouble = std::numeric_limits<double>::max();
/** Sizes and offsets stay so far below 2^64 that no sum or product of them with a stride overflows. */
constexpr double maximumSize = double(std::uint64_t(1) << 48);

Check size() {
    return integer(0, maximumSize);
}
Check anyNumber() {
    return number();
}
Check numbers(std::size_t count) {
    return arrayOf(anyNumber(), count, count);
}

Check asset() {
    return object({{"version", string(), required}, {"minVersion", string()}});
}

Check accessor() {
    const Check indices = object({{"bufferView", indexInto("bufferViews"), required},
                                  {"byteOffset", size()},
                                  {"componentType", oneOf({5121, 5123, 5125}), required}});
    const Check values = object({{"bufferView", indexInto("bufferViews"), required}, {"byteOffset", size()}});
    return object({
        {"bufferView", indexInto("bufferViews")},
        {"byteOffset", size()},
        {"componentType", oneOf({5120, 5121, 5122, 5123, 5125, 5126}), required},
        {"count", integer(1, maximumInt), required},
        {"type", oneOf(std::vector<std::string>{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}),
         required},
        {"normalized", boolean()},
        {"min", arrayOf(number(-maximumDouble, maximumDouble))},
        {"max", arrayOf(number(-maximumDouble, maximumDouble))},
        {"sparse", object({{"count", integer(1, maximumInt), required},
                           {"indices", indices, required},
                           {"values", values, required}})},
    });
}

Check textureInfo(std::vector<Property> more = {}) {
    const Check transform = object({{"offset", numbers(2)},
                                    {"rotation", anyNumber()},
                                    {"scale", numbers(2)},
                                    {"texCoord", integer(0, 255)}});
    more.push_back({"index", indexInto("textures"), required});
    more.push_back({"texCoord", integer(0, 255)});
    more.push_back({"extensions", object({{"KHR_texture_transform", transform}})});
    return object(std::move(more));
}

Check materialExtensions() {
    const Check color = arrayOf(number(0), 3, 3);
    const Check texture = textureInfo();
    const Check anything = anyNumber();
    return object({
        {"KHR_materials_anisotropy", object({{"anisotropyStrength", anything},
                                             {"anisotropyRotation", anything},
                                             {"anisotropyTexture", texture}})},
        {"KHR_materials_clearcoat", object({{"clearcoatFactor", anything},
                                            {"clearcoatTexture", texture},
                                            {"clearcoatRoughnessFactor", anything},
                                            {"clearcoatRoughnessTexture", texture},
                                            {"clearcoatNormalTexture", textureInfo({{"scale", anything}})}})},
        {"KHR_materials_dispersion", object({{"dispersion", number(0)}})},
        {"KHR_materials_emissive_strength", object({{"emissiveStrength", number(0)}})},
        {"KHR_materials_ior", object({{"ior", number(0)}})},
        {"KHR_materials_iridescence", object({{"iridescenceFactor", anything},
                                              {"iridescenceTexture", texture},
                                              {"iridescenceIor", number(1)},
                                              {"iridescenceThicknessMinimum", number(0)},
                                              {"iridescenceThicknessMaximum", number(0)},
                                              {"iridescenceThicknessTexture", texture}})},
        {"KHR_materials_sheen", object({{"sheenColorFactor", color},
                                        {"sheenColorTexture", texture},
                                        {"sheenRoughnessFactor", anything},
                                        {"sheenRoughnessTexture", texture}})},
        {"KHR_materials_specular", object({{"specularFactor", number(0)},
                                           {"specularTexture", texture},
                                           {"specularColorFactor", color},
                                           {"specularColorTexture", texture}})},
        {"KHR_materials_transmission",
         object({{"transmissionFactor", anything}, {"transmissionTexture", texture}})},
        {"KHR_materials_unlit", object({})},
        {"KHR_materials_volume", object({{"thicknessFactor", number(0)},
                                         {"thicknessTexture", texture},
                                         {"attenuationDistance", positive()},
                                         {"attenuationColor", color}})},
    });
}

Check material() {
    const Check metallicRoughness = object({{"baseColorFactor", numbers(4)},
                                            {"baseColorTexture", textureInfo()},
                                            {"metallicFactor", anyNumber()},
                                            {"roughnessFactor", anyNumber()},
                                            {"metallicRoughnessTexture", textureInfo()},
                                            {"extensions", object({})}});
    return object({
        {"name", string()},
        {"pbrMetallicRoughness", metallicRoughness},
        {"normalTexture", textureInfo({{"scale", anyNumber()}})},
        {"occlusionTexture", textureInfo({{"strength", anyNumber()}})},
        {"emissiveTexture", textureInfo()},
        {"emissiveFactor", arrayOf(number(0), 3, 3)},
        {"alphaMode", oneOf(std::vector<std::string>{"OPAQUE", "MASK", "BLEND"})},
        {"alphaCutoff", number(0)},
        {"doubleSided", boolean()},
        {"extensions", materialExtensions()},
    });
}

Check variants() {
    const Check index = indexInto("extensions.KHR_materials_variants.variants");
    const Check mapping =
        object({{"material", indexInto("materials"), required}, {"variants", arrayOf(index, 1), required}});
    return object({{"mappings", arrayOf(mapping), required}});
}

Check mesh() {
    const Check attributes = mapOf(indexInto("accessors"));
    const Check primitive = object({{"attributes", attributes, required},
                                    {"indices", indexInto("accessors")},
                                    {"material", indexInto("materials")},
                                    {"mode", integer(0, 6)},
                                    {"targets", arrayOf(attributes)},
                                    {"extensions", object({{"KHR_materials_variants", variants()}})}});
    return object({{"name", string()},
                   {"primitives", arrayOf(primitive, 1), required},
                   {"weights", arrayOf(anyNumber())},
                   {"extensions", object({})}});
}

Check node() {
    const Check light = object({{"light", indexInto("extensions.KHR_lights_punctual.lights"), required}});
    const Check copies = object({{"attributes", mapOf(indexInto("accessors")), required}});
    const Check members = object({
        {"name", string()},
        {"children", arrayOf(indexInto("nodes"))},
        {"matrix", numbers(16)},
        {"translation", numbers(3)},
        {"rotation", numbers(4)},
        {"scale", numbers(3)},
        {"mesh", indexInto("meshes")},
        {"camera", indexInto("cameras")},
        {"skin", indexInto("skins")},
        {"weights", arrayOf(anyNumber())},
        {"extensions", object({{"KHR_lights_punctual", light}, {"EXT_mesh_gpu_instancing", copies}})},
    });
    return [members](const Context& context, const Place& place, const nlohmann::json& value) {
        members(context, place, value);
        if (!value.contains("matrix")) return;
        for (const char* other : {"translation", "rotation", "scale"}) {
            if (value.contains(other)) {
                refuse(context, place, fmt::format("has a matrix and a {}", other),
                       "give a matrix, or translation, rotation and scale");
            }
        }
    };
}

Check skin() {
    return object({{"name", string()},
                   {"inverseBindMatrices", indexInto("accessors")},
                   {"skeleton", indexInto("nodes")},
                   {"joints", arrayOf(indexInto("nodes"), 1), required}});
}

Check animation() {
    // Samplers are an animation's own: indices into them are checked as they are read.
    const Check target = object({{"node", indexInto("nodes")}, {"path", string(), required}});
    const Check channel =
        object({{"sampler", integer(0, maximumInt), required}, {"target", target, required}});
    const Check sampler =
        object({{"input", indexInto("accessors"), required},
                {"output", indexInto("accessors"), required},
                {"interpolation", oneOf(std::vector<std::string>{"LINEAR", "STEP", "CUBICSPLINE"})}});
    return object({{"name", string()},
                   {"channels", arrayOf(channel), required},
                   {"samplers", arrayOf(sampler), required}});
}

Check camera() {
    const Check members = object({
        {"name", string()},
        {"type", oneOf(std::vector<std::string>{"perspective", "orthographic"}), required},
        {"perspective", object({{"yfov", number(1e-6, 3.1415), required},
                                {"znear", positive(), required},
                                {"zfar", positive()},
                                {"aspectRatio", positive()}})},
        {"orthographic", object({{"xmag", anyNumber(), required},
                                 {"ymag", positive(), required},
                                 {"znear", number(0), required},
                                 {"zfar", positive(), required}})},
        {"extensions", object({})},
    });
    return [members](const Context& context, const Place& place, const nlohmann::json& value) {
        members(context, place, value);
        const auto& type = value["type"].get_ref<const std::string&>();
        if (!value.contains(type))
            refuse(context, place, "has no " + type, "describe the camera as its type says");
    };
}

Check light() {
    return object({
        {"name", string()},
        {"type", oneOf(std::vector<std::string>{"point", "spot", "directional"}), required},
        {"color", arrayOf(number(0), 3, 3)},
        {"intensity", number(0)},
        {"range", positive()},
        {"spot", object({{"innerConeAngle", number(0, 1.5708)}, {"outerConeAngle", number(0, 1.5708)}})},
    });
}

Check imageBasedLight() {
    return object({{"name", string()},
                   {"intensity", number(0)},
                   {"rotation", numbers(4)},
                   {"specularImages", arrayOf(arrayOf(indexInto("images"), 6, 6), 1), required}});
}

/** Whether a version, "MAJOR.MINOR", is no later than 2.0, which is what is read here. */
bool isAtMostTwo(std::string_view version) {
    const auto point = version.find('.');
    const auto isNumber = [](std::string_view digits) {
        return !digits.empty() && digits.find_first_not_of("0123456789") == digits.npos;
    };
    if (point == version.npos) return false;
    std::string_view major = version.substr(0, point), minor = version.substr(point + 1);
    if (!isNumber(major) || !isNumber(minor)) return false;
    major.remove_prefix(std::min(major.find_first_not_of('0'), major.size()));
    if (major.empty() || major == "1") return true;
    return major == "2" && minor.find_first_not_of('0') == minor.npos;
}

/** Of an object of each of the document's lists, in the order in which they are checked. */
const std::vector<Property>& listChecks() {
    const Check imageBasedUse =
        object({{"light", indexInto("extensions.EXT_lights_image_based.lights"), required}});
    const Check webp = object({{"source", indexInto("images"), required}});
    static const std::vector<Property> checks = {
        {"buffers", object({{"uri", string()}, {"byteLength", integer(1, maximumSize), required}})},
        {"bufferViews", object({{"buffer", indexInto("buffers"), required},
                                {"byteOffset", size()},
                                {"byteLength", integer(1, maximumSize), required},
                                {"byteStride", integer(4, 252)},
                                {"target", integer(0, maximumInt)},
                                {"extensions", object({})}})},
        {"accessors", accessor()},
        {"images", object({{"name", string()},
                           {"uri", string()},
                           {"mimeType", string()},
                           {"bufferView", indexInto("bufferViews")}})},
        {"samplers", object({{"magFilter", oneOf({9728, 9729})},
                             {"minFilter", oneOf({9728, 9729, 9984, 9985, 9986, 9987})},
                             {"wrapS", oneOf({33071, 33648, 10497})},
                             {"wrapT", oneOf({33071, 33648, 10497})}})},
        {"textures", object({{"name", string()},
                             {"sampler", indexInto("samplers")},
                             {"source", indexInto("images")},
                             {"extensions", object({{"EXT_texture_webp", webp}})}})},
        {"materials", material()},
        {"meshes", mesh()},
        {"cameras", camera()},
        {"nodes", node()},
        {"skins", skin()},
        {"animations", animation()},
        {"scenes", object({{"name", string()},
                           {"nodes", arrayOf(indexInto("nodes"))},
                           {"extensions", object({{"EXT_lights_image_based", imageBasedUse}})}})},
    };
    return checks;
}

/** Of the document without the objects of its lists. */
Check rootCheck() {
    std::vector<Property> members = {
        {"asset", asset(), required},
        {"extensionsUsed", arrayOf(string())},
        {"extensionsRequired", arrayOf(string())},
        {"scene", indexInto("scenes")},
        {"extensions",
         object({{"EXT_lights_image_based", object({{"lights", arrayOf(imageBasedLight()), required}})},
                 {"KHR_lights_punctual", object({{"lights", arrayOf(light()), required}})},
                 {"KHR_materials_variants",
                  object({{"variants", arrayOf(object({{"name", string(), required}})), required}})}})},
    };
    for (const Property& list : listChecks()) members.push_back({list.name, arrayOf(object({}))});
    return object(std::move(members));
}

/** Objects of a list side by side, where they are small; of several faults the first is told. Returns what
 * the largest takes. */
std::size_t checkList(const Context& context, const Property& list) {
    constexpr std::size_t smallText = std::size_t(1) << 16;
    const Place root, place{&root, list.name, 0};
    const std::size_t count = context.document.size(list.name);
    const std::size_t block =
        context.document.longest(list.name) <= smallText ? 256 : std::max<std::size_t>(count, 1);
    std::mutex mutex;
    std::size_t largest = 0, faulty = count;
    std::exception_ptr fault;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, block), [&](const auto& range) {
        std::size_t most = 0, i = range.begin();
        try {
            for (; i < range.end(); ++i) {
                std::size_t bytes = 0;
                const nlohmann::json element = context.document.element(list.name, i, &bytes);
                list.check(context, Place{&place, nullptr, i}, element);
                extras::check(context.file, list.name, i, element);
                most = std::max(most, bytes);
            }
        } catch (...) {
            const std::scoped_lock lock(mutex);
            if (i >= faulty) return;
            faulty = i;
            fault = std::current_exception();
        }
        const std::scoped_lock lock(mutex);
        largest = std::max(largest, most);
    });
    if (fault) std::rethrow_exception(fault);
    return largest;
}

}  // namespace

std::size_t checkSchema(const std::string& file, const Document& document) {
    const Context context{file, document};
    const Place root;
    const nlohmann::json& top = document.root();
    if (!top.is_object()) refuse(context, root, "its JSON is no object", "give a glTF 2.0 document");
    const Place asset{&root, "asset", 0};
    const nlohmann::json::json_pointer version("/asset/version");
    // First: all else that is wrong with a glTF 1.0 file, objects where 2.0 has arrays, would mislead.
    if (top.contains(version) && top[version].is_string() &&
        !top[version].get_ref<const std::string&>().starts_with("2.")) {
        refuse(context, Place{&asset, "version", 0},
               "is '" + top[version].get_ref<const std::string&>().substr(0, 20) + "'", "give glTF 2.0");
    }
    static const Check checkRoot = rootCheck();
    checkRoot(context, root, top);
    const std::string minimum = top["asset"].value("minVersion", "2.0");
    if (!isAtMostTwo(minimum)) {
        refuse(context, Place{&asset, "minVersion", 0}, "is '" + minimum.substr(0, 20) + "', above 2.0",
               "export the file as glTF 2.0");
    }
    extras::checkDocument(file, top);
    std::size_t largest = 0;
    for (const Property& list : listChecks()) largest = std::max(largest, checkList(context, list));
    return largest;
}

}  // namespace helio::gltf
