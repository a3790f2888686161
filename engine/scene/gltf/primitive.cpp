#include "engine/scene/gltf/primitive.hpp"

#include "engine/scene/gltf/build.hpp"
#include "engine/scene/gltf/frames.hpp"
#include "engine/scene/parallel.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace helio::gltf {
namespace {

using nlohmann::json;

/** glTF 2.0, section 3.7.2.1: three indices per triangle of a list, strip or fan. */
std::vector<std::uint32_t> triangles(std::vector<std::uint32_t> v, Mode mode) {
    if (mode == Mode::Triangles) return v;
    std::vector<std::uint32_t> result;
    result.reserve(v.size() < 3 ? 0 : (v.size() - 2) * 3);
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
        if (mode == Mode::TriangleStrip) {
            result.insert(result.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
        } else {
            result.insert(result.end(), {v[i + 1], v[i + 2], v[0]});
        }
    }
    return result;
}

class PrimitiveBuilder {
public:
    PrimitiveBuilder(const Asset& asset, helio::Scene& scene, std::string place, MemoryBudget& memory)
        : asset_(asset), scene_(scene), place_(std::move(place)), memory_(memory) {}

    Primitive build(const json& from) {
        Primitive primitive;
        primitive.material = integerOr(from, "material", -1);
        const json& attributes = from["attributes"];
        const auto found = attributes.find("POSITION");
        if (found == attributes.end()) {
            skip(scene_, place_, "it has no POSITION");
            return primitive;
        }
        const int position = found->get<int>();
        asset_.check(position);
        size_ = asset_.count(position);
        readIndices(from, primitive);
        keepUsedVertices(primitive);
        primitive.positions = attribute<glm::vec3>("POSITION", position);
        if (kept_.empty()) checkBounds(position, primitive.positions);
        readAttributes(from, primitive);
        fixNormals(primitive);
        fixTangents(primitive);
        return primitive;
    }

private:
    /** An accessor's min and max must be those of its elements (section 3.6.2.5); what is drawn does not
     * depend on them. */
    void checkBounds(int accessor, const std::vector<glm::vec3>& positions) const {
        if (asset_.accessor(accessor).isNormalized) return;
        const json from = asset_.document().element("accessors", std::size_t(accessor));
        using Box = std::pair<glm::vec3, glm::vec3>;
        const auto join = [](const Box& a, const Box& b) {
            return Box(glm::min(a.first, b.first), glm::max(a.second, b.second));
        };
        const Box box = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, positions.size(), kBlock), Box(positions[0], positions[0]),
            [&](const auto& range, Box part) {
                for (std::size_t i = range.begin(); i < range.end(); ++i)
                    part = join(part, {positions[i], positions[i]});
                return part;
            },
            join);
        const glm::dvec3 low(box.first), high(box.second);
        const double tolerance = 1e-4 * std::max(glm::length(high - low), glm::length(high) * 1e-3);
        const auto differs = [&](const char* member, const glm::dvec3& actual) {
            const auto found = from.find(member);
            if (found == from.end()) return false;
            return found->size() != 3 ||
                   glm::length(vectorOr(from, member, glm::dvec3(0)) - actual) > tolerance;
        };
        for (const auto& [member, actual] : {std::pair{"min", low}, std::pair{"max", high}}) {
            if (differs(member, actual))
                warn(scene_, fmt::format("accessors[{}].{} is not that of its elements", accessor, member));
        }
    }

    /** Primitives often share the vertices of a whole file and use a few each: where a primitive uses fewer
     * than half of them, only those are kept, in their order. */
    void keepUsedVertices(Primitive& primitive) {
        kept_.clear();
        if (primitive.indices.size() < size_) {  // few: sorted, in time that does not depend on the file
            memory_.take(place_, 0, primitive.indices.size() * sizeof(std::uint32_t));
            kept_ = primitive.indices;
            std::sort(kept_.begin(), kept_.end());
            kept_.erase(std::unique(kept_.begin(), kept_.end()), kept_.end());
        } else {
            std::vector<std::uint8_t> isUsed(size_, 0);
            forBlocks(primitive.indices.size(), [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    std::atomic_ref(isUsed[primitive.indices[i]]).store(1, std::memory_order_relaxed);
            });
            const auto used = std::size_t(std::count(isUsed.begin(), isUsed.end(), 1));
            if (used >= size_ - used) return;
            memory_.take(place_, 0, used * sizeof(std::uint32_t));
            kept_.reserve(used);
            for (std::size_t i = 0; i < size_; ++i) {
                if (isUsed[i]) kept_.push_back(std::uint32_t(i));
            }
        }
        if (kept_.size() >= size_ - kept_.size()) {
            kept_.clear();
            return;
        }
        for (std::uint32_t& index : primitive.indices)
            index = std::uint32_t(std::lower_bound(kept_.begin(), kept_.end(), index) - kept_.begin());
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
        if (asset_.accessor(accessor).component == Component::UnsignedInt) {
            throw InputError(asset_.file(), place, fmt::format("accessor {} has the wrong type", accessor),
                             "give floats, or integers of at most 16 bits");
        }
        asset_.check(accessor);
        const std::size_t count = kept_.empty() ? size_ : kept_.size();
        constexpr auto length = std::size_t(Vector::length());
        static_assert(sizeof(Vector) == Vector::length() * sizeof(float));
        if (kept_.empty()) {
            memory_.takeFor(accessor, place, count * sizeof(Vector), 0);
            std::vector<Vector> result(count);
            asset_.floats(accessor, int(length), place, {&result[0][0], count * length});
            return result;
        }
        memory_.take(place, count * sizeof(Vector), count * sizeof(Vector));
        const std::vector<float> values = asset_.floats(accessor, int(length), place, kept_);
        std::vector<Vector> result(count);
        std::memcpy(&result[0][0], values.data(), values.size() * sizeof(float));
        return result;
    }

    void readAttributes(const json& from, Primitive& primitive) {
        const json& attributes = from["attributes"];
        for (const auto& [name, value] : attributes.items()) {
            const int accessor = value.get<int>();
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
            const auto found = attributes.find(name);
            if (found == attributes.end()) break;
            primitive.texcoords.push_back(attribute<glm::vec2>(name, found->get<int>()));
        }
        for (const auto& [name, value] : attributes.items()) {
            int set = 0;
            const bool isTexcoord = std::sscanf(name.c_str(), "TEXCOORD_%d", &set) == 1;
            if (isTexcoord && std::size_t(set) >= primitive.texcoords.size())
                skip(scene_, "attribute " + name.substr(0, 40), "a set before it is missing");
        }
        const bool hasSkins = asset_.document().size("skins") > 0;
        for (int set = 0; hasSkins && readInfluences(attributes, set, primitive); ++set) {
        }
        const json& targets = listOf(from, "targets");
        memory_.take(place_ + ".targets", targets.size() * sizeof(MorphTarget), 0);
        primitive.targets.reserve(targets.size());
        for (std::size_t t = 0; t < targets.size(); ++t)
            primitive.targets.push_back(target(targets[t], fmt::format("targets[{}].", t)));
    }

    /** Joints and weights of a set, if the primitive has it. */
    bool readInfluences(const json& attributes, int set, Primitive& primitive) const {
        const std::string jointsName = fmt::format("JOINTS_{}", set),
                          weightsName = fmt::format("WEIGHTS_{}", set);
        const auto joints = attributes.find(jointsName), weights = attributes.find(weightsName);
        if ((joints == attributes.end()) != (weights == attributes.end())) {
            throw InputError(asset_.file(), place_ + ".attributes",
                             fmt::format("has one of {} and {}", jointsName, weightsName),
                             "give both, or none");
        }
        if (joints == attributes.end()) return false;
        const Component type = asset_.accessor(joints->get<int>()).component;
        if (type != Component::UnsignedByte && type != Component::UnsignedShort) {
            throw InputError(asset_.file(), place_ + ".attributes." + jointsName, "has the wrong type",
                             "give unsigned bytes or shorts");
        }
        const std::vector<glm::vec4> numbers = attribute<glm::vec4>(jointsName, joints->get<int>());
        primitive.joints.emplace_back(numbers.begin(), numbers.end());
        primitive.weights.push_back(attribute<glm::vec4>(weightsName, weights->get<int>()));
        return true;
    }

    MorphTarget target(const json& from, const std::string& place) const {
        MorphTarget result;
        for (const auto& [name, value] : from.items()) {
            const int accessor = value.get<int>();
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
        if (asset_.accessor(accessor).components == 4 && !asset_.accessor(accessor).isMatrix) {
            primitive.colors = attribute<glm::vec4>("COLOR_0", accessor);
            return;
        }
        const std::vector<glm::vec3> colors = attribute<glm::vec3>("COLOR_0", accessor);
        memory_.take(place_ + ".attributes.COLOR_0", colors.size() * (sizeof(glm::vec4) - sizeof(glm::vec3)),
                     colors.size() * sizeof(glm::vec3));
        primitive.colors.reserve(colors.size());
        for (const glm::vec3& color : colors) primitive.colors.emplace_back(color, 1.0f);
    }

    void readIndices(const json& from, Primitive& primitive) {
        std::vector<std::uint32_t> indices;
        const std::string place = place_ + ".indices";
        const int accessor = integerOr(from, "indices", -1);
        const Mode mode = modeOf(from);
        if (accessor >= 0) asset_.checkIndices(accessor, place);
        const std::size_t count = accessor >= 0 ? asset_.count(accessor) : size_;
        const std::size_t unfolded = mode == Mode::Triangles ? count : count * 3;
        const std::size_t kept = unfolded * sizeof(std::uint32_t), read = count * sizeof(std::uint32_t);
        if (accessor >= 0) {
            memory_.takeFor(accessor, place, kept, read);
        } else {
            memory_.take(place, kept, read);
        }
        if (accessor >= 0) {
            indices = asset_.indices(accessor, place);
            const std::size_t wrong =
                firstWhere(indices.size(), [&](std::size_t i) { return indices[i] >= size_; });
            if (wrong < indices.size()) {
                throw InputError(asset_.file(), place,
                                 fmt::format("element {} is {}, the primitive has {} vertices", wrong,
                                             indices[wrong], size_),
                                 "keep indices below the number of vertices");
            }
        } else {
            indices.resize(size_);
            for (std::size_t i = 0; i < size_; ++i) indices[i] = std::uint32_t(i);
        }
        if (mode == Mode::Triangles && indices.size() % 3 != 0) {
            warn(scene_, fmt::format("{}: {} indices are no whole triangles; the last are left out", place_,
                                     indices.size()));
            indices.resize(indices.size() / 3 * 3);
        }
        primitive.indices = triangles(std::move(indices), mode);
    }

    const Asset& asset_;
    helio::Scene& scene_;
    std::string place_;
    MemoryBudget& memory_;
    std::size_t size_ = 0;             ///< vertices in the file
    std::vector<std::uint32_t> kept_;  ///< those that are kept; empty for all
};

}  // namespace

Mode modeOf(const json& primitive) {
    return Mode(integerOr(primitive, "mode", int(Mode::Triangles)));
}

std::size_t elementsOf(const Asset& asset, const json& primitive) {
    const auto countOf = [&](const json& accessor) { return asset.count(accessor.get<int>()); };
    const json& attributes = primitive["attributes"];
    std::size_t count = 0;
    for (const auto& [name, accessor] : attributes.items()) count += countOf(accessor);
    for (const json& target : listOf(primitive, "targets"))
        for (const auto& [name, accessor] : target.items()) count += countOf(accessor);
    const auto indices = primitive.find("indices"), position = attributes.find("POSITION");
    if (indices != primitive.end()) return count + countOf(*indices);
    return position == attributes.end() ? count : count + countOf(*position);
}

Primitive readPrimitive(const Asset& asset, const json& from, const std::string& place, MemoryBudget& memory,
                        helio::Scene& notes) {
    return PrimitiveBuilder(asset, notes, place, memory).build(from);
}

}  // namespace helio::gltf
