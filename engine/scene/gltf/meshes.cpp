#include "engine/scene/gltf/build.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace helio::gltf {
namespace {

/** glTF 2.0, section 3.7.2.1: three indices per triangle of a list, strip or fan. */
std::vector<std::uint32_t> triangles(std::vector<std::uint32_t> v, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return v;
    std::vector<std::uint32_t> result;
    result.reserve(v.size() < 3 ? 0 : (v.size() - 2) * 3);
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            result.insert(result.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
        } else {
            result.insert(result.end(), {v[i + 1], v[i + 2], v[0]});
        }
    }
    return result;
}

/** Unit normals; where the file has a zero, the area-weighted mean of the triangles around. */
void fixNormals(Primitive& primitive) {
    std::vector<glm::dvec3> mean;
    for (std::size_t i = 0; i < primitive.normals.size(); ++i) {
        const glm::dvec3 normal = primitive.normals[i];
        double length = glm::length(normal);
        if (length > 1e-20) {
            primitive.normals[i] = normal / length;
            continue;
        }
        if (mean.empty()) {
            mean.resize(primitive.positions.size());
            for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
                const std::uint32_t* const corner = &primitive.indices[t];
                const glm::dvec3 a = primitive.positions[corner[0]];
                const glm::dvec3 area = glm::cross(glm::dvec3(primitive.positions[corner[1]]) - a,
                                                   glm::dvec3(primitive.positions[corner[2]]) - a);
                for (int k = 0; k < 3; ++k) mean[corner[k]] += area;
            }
        }
        length = glm::length(mean[i]);
        primitive.normals[i] = length > 0 ? glm::vec3(mean[i] / length) : glm::vec3(0, 0, 1);
    }
}

/** Unit tangents with a sign of 1 or -1; a zero becomes any direction across the normal. */
void fixTangents(Primitive& primitive) {
    for (std::size_t i = 0; i < primitive.tangents.size(); ++i) {
        glm::dvec3 tangent(primitive.tangents[i]);
        if (!(glm::length(tangent) > 1e-20)) {
            const glm::dvec3 normal = primitive.normals.empty() ? glm::vec3(0, 0, 1) : primitive.normals[i];
            tangent =
                glm::cross(normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
        }
        primitive.tangents[i] =
            glm::vec4(glm::vec3(glm::normalize(tangent)), primitive.tangents[i].w < 0 ? -1 : 1);
    }
}

class PrimitiveBuilder {
public:
    PrimitiveBuilder(const Asset& asset, helio::Scene& scene, std::string place, MemoryBudget& memory)
        : asset_(asset), scene_(scene), place_(std::move(place)), memory_(memory) {}

    Primitive build(const tinygltf::Primitive& from) {
        Primitive primitive;
        primitive.material = from.material;
        const auto position = from.attributes.find("POSITION");
        if (position == from.attributes.end()) {
            skip(scene_, place_, "it has no POSITION");
            return primitive;
        }
        asset_.check(position->second);
        size_ = asset_.count(position->second);
        readIndices(from, primitive);
        keepUsedVertices(primitive);
        primitive.positions = attribute<glm::vec3>("POSITION", position->second);
        readAttributes(from, primitive);
        fixNormals(primitive);
        fixTangents(primitive);
        return primitive;
    }

private:
    /** Primitives often share the vertices of a whole file and use a few each: where a primitive uses fewer
     * than half of them, only those are kept, in their order. */
    void keepUsedVertices(Primitive& primitive) {
        kept_.clear();
        std::vector<bool> isUsed(size_, false);
        for (const std::uint32_t index : primitive.indices) isUsed[index] = true;
        const auto used = std::size_t(std::count(isUsed.begin(), isUsed.end(), true));
        if (used >= size_ - used) return;
        memory_.take(place_, 0, size_ * sizeof(std::uint32_t) + used * sizeof(std::uint32_t));
        std::vector<std::uint32_t> place(size_);
        kept_.reserve(used);
        for (std::size_t i = 0; i < size_; ++i) {
            if (!isUsed[i]) continue;
            place[i] = std::uint32_t(kept_.size());
            kept_.push_back(std::uint32_t(i));
        }
        for (std::uint32_t& index : primitive.indices) index = place[index];
    }

    template <class Vector>
    std::vector<Vector> attribute(const std::string& name, int accessor,
                                  const std::string& of = "attributes.") const {
        const std::string place = place_ + "." + of + name;
        if (asset_.count(accessor) != size_) {
            throw InputError(asset_.file(), place,
                             fmt::format("has {} elements, POSITION {}", asset_.count(accessor), size_),
                             "give every attribute one element per vertex");
        }
        asset_.check(accessor);
        const std::size_t count = kept_.empty() ? size_ : kept_.size();
        constexpr auto length = std::size_t(Vector::length());
        static_assert(sizeof(Vector) == Vector::length() * sizeof(float));
        if (kept_.empty()) {
            memory_.take(place, count * sizeof(Vector), 0);
            std::vector<Vector> result(count);
            asset_.floats(accessor, int(length), place, {&result[0][0], count * length});
            return result;
        }
        memory_.take(place, count * sizeof(Vector), size_ * length * sizeof(float));
        const std::vector<float> values = asset_.floats(accessor, int(length), place);
        std::vector<Vector> result(count);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t c = 0; c < length; ++c) result[i][int(c)] = values[kept_[i] * length + c];
        }
        return result;
    }

    void readAttributes(const tinygltf::Primitive& from, Primitive& primitive) {
        for (const auto& [name, accessor] : from.attributes) {
            if (name == "POSITION") continue;
            if (name == "NORMAL") {
                primitive.normals = attribute<glm::vec3>(name, accessor);
            } else if (name == "TANGENT") {
                primitive.tangents = attribute<glm::vec4>(name, accessor);
            } else if (name == "COLOR_0") {
                readColors(accessor, primitive);
            } else if (!name.starts_with("TEXCOORD_") && !name.starts_with("JOINTS_") &&
                       !name.starts_with("WEIGHTS_") && !name.starts_with("_")) {
                skip(scene_, "attribute " + name, "the scene model has no place for it");
            }
        }
        for (int set = 0;; ++set) {
            const std::string name = fmt::format("TEXCOORD_{}", set);
            const auto found = from.attributes.find(name);
            if (found == from.attributes.end()) break;
            primitive.texcoords.push_back(attribute<glm::vec2>(name, found->second));
        }
        const bool hasSkins = asset_.document().contains("skins");
        for (int set = 0; hasSkins && readInfluences(from, set, primitive); ++set) {
        }
        for (std::size_t t = 0; t < from.targets.size(); ++t)
            primitive.targets.push_back(target(from.targets[t], fmt::format("targets[{}].", t)));
    }

    /** Joints and weights of a set, if the primitive has it. */
    bool readInfluences(const tinygltf::Primitive& from, int set, Primitive& primitive) const {
        const std::string jointsName = fmt::format("JOINTS_{}", set),
                          weightsName = fmt::format("WEIGHTS_{}", set);
        const auto joints = from.attributes.find(jointsName), weights = from.attributes.find(weightsName);
        if ((joints == from.attributes.end()) != (weights == from.attributes.end())) {
            throw InputError(asset_.file(), place_ + ".attributes",
                             fmt::format("has one of {} and {}", jointsName, weightsName),
                             "give both, or none");
        }
        if (joints == from.attributes.end()) return false;
        const int type = asset_.model().accessors[std::size_t(joints->second)].componentType;
        if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
            throw InputError(asset_.file(), place_ + ".attributes." + jointsName, "has the wrong type",
                             "give unsigned bytes or shorts");
        }
        const std::vector<glm::vec4> numbers = attribute<glm::vec4>(jointsName, joints->second);
        primitive.joints.emplace_back(numbers.begin(), numbers.end());
        primitive.weights.push_back(attribute<glm::vec4>(weightsName, weights->second));
        return true;
    }

    MorphTarget target(const std::map<std::string, int>& from, const std::string& place) const {
        MorphTarget result;
        for (const auto& [name, accessor] : from) {
            if (name == "POSITION") {
                result.positions = attribute<glm::vec3>(name, accessor, place);
            } else if (name == "NORMAL") {
                result.normals = attribute<glm::vec3>(name, accessor, place);
            } else if (name == "TANGENT") {
                result.tangents = attribute<glm::vec3>(name, accessor, place);
            } else if (!name.starts_with("_")) {
                skip(scene_, "morph targets of " + name, "positions, normals and tangents are morphed");
            }
        }
        return result;
    }

    void readColors(int accessor, Primitive& primitive) const {
        if (asset_.model().accessors[std::size_t(accessor)].type == TINYGLTF_TYPE_VEC4) {
            primitive.colors = attribute<glm::vec4>("COLOR_0", accessor);
            return;
        }
        const std::vector<glm::vec3> colors = attribute<glm::vec3>("COLOR_0", accessor);
        memory_.take(place_ + ".attributes.COLOR_0", colors.size() * (sizeof(glm::vec4) - sizeof(glm::vec3)),
                     colors.size() * sizeof(glm::vec3));
        primitive.colors.reserve(colors.size());
        for (const glm::vec3& color : colors) primitive.colors.emplace_back(color, 1.0f);
    }

    void readIndices(const tinygltf::Primitive& from, Primitive& primitive) {
        std::vector<std::uint32_t> indices;
        const std::string place = place_ + ".indices";
        if (from.indices >= 0) asset_.checkIndices(from.indices, place);
        const std::size_t count = from.indices >= 0 ? asset_.count(from.indices) : size_;
        const std::size_t unfolded = from.mode == TINYGLTF_MODE_TRIANGLES ? count : count * 3;
        memory_.take(place, unfolded * sizeof(std::uint32_t), count * sizeof(std::uint32_t));
        if (from.indices >= 0) {
            indices = asset_.indices(from.indices, place);
            const auto wrong = std::find_if(indices.begin(), indices.end(),
                                            [this](std::uint32_t index) { return index >= size_; });
            if (wrong != indices.end()) {
                throw InputError(asset_.file(), place,
                                 fmt::format("element {} is {}, the primitive has {} vertices",
                                             wrong - indices.begin(), *wrong, size_),
                                 "keep indices below the number of vertices");
            }
        } else {
            indices.resize(size_);
            for (std::size_t i = 0; i < size_; ++i) indices[i] = std::uint32_t(i);
        }
        if (from.mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0) {
            warn(scene_, fmt::format("{}: {} indices are no whole triangles; the last are left out", place_,
                                     indices.size()));
            indices.resize(indices.size() / 3 * 3);
        }
        primitive.indices = triangles(std::move(indices), from.mode);
    }

    const Asset& asset_;
    helio::Scene& scene_;
    std::string place_;
    MemoryBudget& memory_;
    std::size_t size_ = 0;             ///< vertices in the file
    std::vector<std::uint32_t> kept_;  ///< those that are kept; empty for all
};

void readVariantNames(const Asset& asset, helio::Scene& scene) {
    const nlohmann::json::json_pointer path("/extensions/KHR_materials_variants/variants");
    if (!asset.document().contains(path)) return;
    for (const nlohmann::json& variant : asset.document()[path])
        scene.variants.push_back(variant["name"].get<std::string>());
}

/** KHR_materials_variants: a variant that no mapping names keeps the primitive's own material. */
void readVariants(const tinygltf::Primitive& from, const std::string& place, const helio::Scene& scene,
                  MemoryBudget& memory, Primitive& primitive) {
    const auto found = from.extensions.find("KHR_materials_variants");
    if (found == from.extensions.end()) return;
    memory.take(place, scene.variants.size() * sizeof(int), 0);
    primitive.variantMaterials.assign(scene.variants.size(), primitive.material);
    const tinygltf::Value& mappings = found->second.Get("mappings");
    for (std::size_t m = 0; m < mappings.ArrayLen(); ++m) {
        const tinygltf::Value& mapping = mappings.Get(int(m));
        const tinygltf::Value& variants = mapping.Get("variants");
        for (std::size_t v = 0; v < variants.ArrayLen(); ++v) {
            const auto variant = std::size_t(variants.Get(int(v)).GetNumberAsInt());
            primitive.variantMaterials[variant] = mapping.Get("material").GetNumberAsInt();
        }
    }
}

}  // namespace

std::vector<float> morphWeights(const Asset& asset, const std::vector<double>& weights,
                                const tinygltf::Mesh& mesh, const std::string& place) {
    const std::size_t targets = mesh.primitives[0].targets.size();
    if (!weights.empty() && weights.size() != targets) {
        throw InputError(asset.file(), place,
                         fmt::format("has {} elements for {} morph targets", weights.size(), targets),
                         "give one weight per morph target");
    }
    return {weights.begin(), weights.end()};
}

void buildMeshes(const Asset& asset, MemoryBudget& memory, LoadMonitor& monitor, helio::Scene& scene) {
    readVariantNames(asset, scene);
    for (std::size_t m = 0; m < asset.model().meshes.size(); ++m) {
        const tinygltf::Mesh& from = asset.model().meshes[m];
        Mesh mesh;
        mesh.name = from.name;
        for (std::size_t p = 0; p < from.primitives.size(); ++p) {
            const tinygltf::Primitive& primitive = from.primitives[p];
            monitor.report("geometry", (double(m) + double(p) / double(from.primitives.size())) /
                                           double(asset.model().meshes.size()));
            const std::string place = fmt::format("meshes[{}].primitives[{}]", m, p);
            if (primitive.targets.size() != from.primitives[0].targets.size()) {
                throw InputError(asset.file(), place + ".targets",
                                 fmt::format("has {} elements, the mesh's first primitive {}",
                                             primitive.targets.size(), from.primitives[0].targets.size()),
                                 "give every primitive of a mesh as many morph targets");
            }
            if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                skip(scene, primitive.mode == TINYGLTF_MODE_POINTS ? "points" : "lines",
                     "only triangles are shown");
                continue;
            }
            for (const auto& [name, value] : primitive.extensions) {
                if (!isSupported(name)) skip(scene, name, "is not supported");
            }
            Primitive built = PrimitiveBuilder(asset, scene, place, memory).build(primitive);
            readVariants(primitive, place, scene, memory, built);
            if (!built.indices.empty()) mesh.primitives.push_back(std::move(built));
        }
        if (!mesh.primitives.empty())
            mesh.weights = morphWeights(asset, from.weights, from, fmt::format("meshes[{}].weights", m));
        scene.meshes.push_back(std::move(mesh));
    }
}

}  // namespace helio::gltf
