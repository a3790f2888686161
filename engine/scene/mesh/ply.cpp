#include "engine/scene/mesh/attributes.hpp"
#include "engine/scene/mesh/mesh.hpp"
#include "engine/scene/mesh/ply_values.hpp"
#include "engine/scene/mesh/polygon.hpp"
#include "engine/scene/mesh/textures.hpp"
#include "engine/scene/notes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace helio {
namespace mesh {
namespace {

/** What a property of a vertex is. */
enum Slot : std::size_t { X, Y, Z, NormalX, NormalY, NormalZ, U, V, Red, Green, Blue, Alpha, slotCount };

std::size_t slotOf(const std::string& name) {
    static const std::array<std::vector<const char*>, slotCount> names{{
        {"x"},
        {"y"},
        {"z"},
        {"nx", "normal_x"},
        {"ny", "normal_y"},
        {"nz", "normal_z"},
        {"u", "s", "texture_u", "texture_s", "texcoord_u", "texture_coord_u", "tu"},
        {"v", "t", "texture_v", "texture_t", "texcoord_v", "texture_coord_v", "tv"},
        {"red", "r", "diffuse_red"},
        {"green", "g", "diffuse_green"},
        {"blue", "b", "diffuse_blue"},
        {"alpha", "a", "diffuse_alpha"},
    }};
    for (std::size_t slot = 0; slot < slotCount; ++slot) {
        if (std::find(names[slot].begin(), names[slot].end(), name) != names[slot].end()) return slot;
    }
    return slotCount;
}

/** 1 as an integer type stores it for a colour. */
double colorScale(PlyType type) {
    if (type == PlyType::Uint8) return 1.0 / 255;
    if (type == PlyType::Uint16) return 1.0 / 65535;
    return type < PlyType::Float32 ? 1.0 / 255 : 1.0;
}

class PlyReader {
public:
    PlyReader(const ByteSource& source, const std::string& file, LoadMonitor& monitor)
        : file_(file),
          monitor_(monitor),
          header_(readPlyHeader(source, file)),
          values_(source, header_, file),
          scene_(sceneOf(file)) {}

    Scene read() {
        for (const std::string& line : header_.unknown) warn(scene_, line);
        for (const PlyElement& element : header_.elements) {
            checkCount(element);
            if (element.name == "vertex") {
                readVertices(element);
            } else if (element.name == "face" || element.name == "tristrips") {
                readFaces(element);
            } else {
                if (element.count > 0)
                    helio::skip(scene_, "PLY element " + element.name, "it has no meaning here");
                for (std::uint64_t i = 0; i < element.count; ++i) skipElement(element, i);
            }
        }
        if (values_.hasMore()) warn(scene_, "what follows the last element is left out");
        finish();
        return std::move(scene_);
    }

private:
    /** Before memory is taken, or time, for what a count says. */
    void checkCount(const PlyElement& element) const {
        double size = 0;
        for (const PlyProperty& property : element.properties)
            size += values_.atLeast(property.isList ? property.countType : property.type, 1);
        if (element.properties.empty() && element.count > 0) {
            throw InputError(file_, "element " + element.name, "has no properties",
                             "give it some, or leave it out");
        }
        if (double(element.count) * std::max(size, 1.0) > double(values_.left()) + 1) {
            throw InputError(file_, "element " + element.name,
                             fmt::format("says {} of them, the {} bytes left have no room for so many",
                                         element.count, values_.left()),
                             "write the file again; it may be cut off");
        }
        if (element.count > std::uint64_t(std::numeric_limits<std::int32_t>::max()))
            throw InputError(file_, "element " + element.name, "has too many", "give at most 2147483647");
    }

    void report(std::uint64_t index) {
        if (index % 65536 == 0) monitor_.report("geometry", values_.fraction());
    }

    void skipProperty(const PlyProperty& property) {
        values_.skip(property.type, property.isList ? listSize(property) : 1);
    }
    void skipElement(const PlyElement& element, std::uint64_t index) {
        report(index);
        values_.at(element.name, index);
        for (const PlyProperty& property : element.properties) skipProperty(property);
    }

    std::uint64_t listSize(const PlyProperty& property) {
        const double size = values_.next(property.countType);
        if (!(size >= 0) || size != std::floor(size) ||
            values_.atLeast(property.type, size) > double(values_.left()) + 1) {
            values_.refuse(fmt::format("{} has {} entries, which the file cannot hold", property.name, size),
                           "write the file again; it may be cut off");
        }
        return std::uint64_t(size);
    }

    void readVertices(const PlyElement& element) {
        std::vector<std::size_t> slots;
        for (const PlyProperty& property : element.properties) {
            std::size_t slot = property.isList ? std::size_t(slotCount) : slotOf(property.name);
            if (slot == slotCount) {
                helio::skip(scene_, "PLY vertex property " + property.name, "it has no meaning here");
            } else if (has_[slot]) {
                slot = slotCount;  // the first of its kind counts
            } else {
                has_[slot] = true;
            }
            slots.push_back(slot);
        }
        if (!has_[X] || !has_[Y] || !has_[Z])
            throw InputError(file_, "element vertex", "has no x, y and z", "give positions");
        const auto count = std::size_t(element.count);
        const bool hasNormals = has_[NormalX] && has_[NormalY] && has_[NormalZ];
        const bool hasTexcoords = has_[U] && has_[V];
        const bool hasColors = has_[Red] && has_[Green] && has_[Blue];
        primitive_.positions.reserve(count);
        if (hasNormals) primitive_.normals.reserve(count);
        if (hasTexcoords) primitive_.texcoords.emplace_back().reserve(count);
        if (hasColors) primitive_.colors.reserve(count);
        std::array<float, slotCount> vertex{};
        vertex[Alpha] = 1;
        for (std::size_t i = 0; i < count; ++i) {
            report(i);
            values_.at(element.name, i);
            for (std::size_t p = 0; p < slots.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (slots[p] == slotCount) {
                    skipProperty(property);
                    continue;
                }
                double value = values_.next(property.type);
                if (!(std::abs(value) < 0x1.ffffffp127)) {
                    values_.refuse(fmt::format("{} is {}", property.name, value),
                                   "give finite numbers that single precision can hold");
                }
                if (slots[p] >= Red) value *= colorScale(property.type);
                vertex[slots[p]] = float(value);
            }
            primitive_.positions.emplace_back(vertex[X], vertex[Y], vertex[Z]);
            if (hasNormals)
                primitive_.normals.emplace_back(vertex[NormalX], vertex[NormalY], vertex[NormalZ]);
            if (hasTexcoords) primitive_.texcoords[0].emplace_back(vertex[U], 1 - vertex[V]);
            if (hasColors)
                primitive_.colors.emplace_back(vertex[Red], vertex[Green], vertex[Blue], vertex[Alpha]);
        }
    }

    void readFaces(const PlyElement& element) {
        const bool isStrips = element.name == "tristrips";
        const auto isCorners = [](const PlyProperty& property) {
            return property.isList && (property.name == "vertex_indices" || property.name == "vertex_index");
        };
        if (element.count > 0 &&
            std::none_of(element.properties.begin(), element.properties.end(), isCorners)) {
            throw InputError(file_, "element " + element.name, "has no list vertex_indices",
                             "give the corners of the faces");
        }
        if (!isStrips) primitive_.indices.reserve(std::size_t(element.count) * 3);
        for (const PlyProperty& property : element.properties) {
            if (!isCorners(property))
                helio::skip(scene_, "PLY " + element.name + " property " + property.name,
                            "it has no meaning here");
        }
        std::vector<std::int32_t> corners;
        elementName_ = &element.name;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            report(i);
            index_ = i;
            values_.at(element.name, i);
            for (const PlyProperty& property : element.properties) {
                if (!isCorners(property)) {
                    skipProperty(property);
                    continue;
                }
                corners.clear();
                const std::uint64_t size = listSize(property);
                constexpr std::uint64_t large = 1 << 16;  // else they double, and double the memory
                if (size > large) {
                    corners.reserve(std::size_t(size));
                    primitive_.indices.reserve(primitive_.indices.size() + std::size_t(size) * 3);
                }
                for (std::uint64_t left = size; left > 0; --left)
                    corners.push_back(index(values_.next(property.type), isStrips));
                if (isStrips) {
                    addStrips(corners);
                } else {
                    addFace(corners);
                }
            }
        }
    }

    /** Held against the vertices once these are known. */
    std::int32_t index(double value, bool isStrips) {
        if (isStrips && value == -1) return -1;
        if (!(value >= 0) || value != std::floor(value) || value > std::numeric_limits<std::int32_t>::max())
            values_.refuse(fmt::format("{} is no index of a vertex", value), "count from 0");
        const auto result = std::int32_t(value);
        if (result > highest_) {
            highest_ = result;
            highestPlace_ = index_;
            highestElement_ = elementName_;
        }
        return result;
    }

    void addFace(const std::vector<std::int32_t>& corners) {
        if (corners.size() < 3)
            values_.refuse(fmt::format("a face has {} corners", corners.size()), "give at least 3");
        if (corners.size() > 3)
            fans_.push_back({std::uint32_t(primitive_.indices.size() / 3), std::uint32_t(corners.size())});
        for (std::size_t k = 1; k + 1 < corners.size(); ++k) add(corners[0], corners[k], corners[k + 1]);
    }

    /** -1 begins anew; every second triangle is turned around. */
    void addStrips(const std::vector<std::int32_t>& corners) {
        std::size_t first = 0;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            if (corners[k] < 0) {
                first = k + 1;
            } else if (k >= first + 2) {
                const bool isOdd = (k - first) % 2 == 1;
                add(corners[k - 2], corners[k - (isOdd ? 0 : 1)], corners[k - (isOdd ? 1 : 0)]);
            }
        }
    }

    void add(std::int32_t a, std::int32_t b, std::int32_t c) {
        for (const std::int32_t corner : {a, b, c}) primitive_.indices.push_back(std::uint32_t(corner));
    }

    void finish() {
        if (highest_ >= std::int64_t(primitive_.positions.size())) {
            throw InputError(
                file_, fmt::format("{} {}", *highestElement_, highestPlace_),
                fmt::format("index {} is past the {} vertices", highest_, primitive_.positions.size()),
                "keep indices below the number of vertices");
        }
        if (cutFans(primitive_.positions, fans_, {&primitive_.indices})) warn(scene_, largePolygonWarning());
        const bool hasColors = !primitive_.colors.empty();
        Material material = neutralMaterial(hasColors);
        const bool isClear = std::any_of(primitive_.colors.begin(), primitive_.colors.end(),
                                         [](const glm::vec4& color) { return color.a < 1; });
        if (isClear) material.alphaMode = AlphaMode::Blend;
        tbb::parallel_for(std::size_t(0), primitive_.colors.size(), [&](std::size_t i) {
            glm::vec4& color = primitive_.colors[i];
            color = glm::vec4(linearFromSrgb(glm::vec3(color)), std::clamp(color.a, 0.0f, 1.0f));
        });
        if (std::all_of(primitive_.normals.begin(), primitive_.normals.end(), isNormal)) {
            for (glm::vec3& normal : primitive_.normals) normal = unit(normal);
        } else {
            warn(scene_, "some normals have no length: the mesh is shaded flat");
            primitive_.normals = {};
        }
        TextureFiles textures(file_, scene_);
        if (!header_.texture.empty() && !primitive_.texcoords.empty()) {
            material.baseColorTexture.texture = textures.texture(header_.texture, false);
            if (material.baseColorTexture) material.baseColor = glm::vec4(1);
        }
        scene_.materials.push_back(std::move(material));
        if (primitive_.indices.empty()) {
            warn(scene_, "the file has no faces: nothing is to be seen");
            if (!primitive_.positions.empty()) helio::skip(scene_, "points", "only triangles are shown");
        } else {
            primitive_.material = 0;
            scene_.meshes[0].primitives.push_back(std::move(primitive_));
        }
        textures.decode(monitor_);
    }

    const std::string& file_;
    LoadMonitor& monitor_;
    PlyHeader header_;
    PlyValues values_;
    Scene scene_;
    Primitive primitive_;
    std::array<bool, slotCount> has_{};
    std::vector<Fan> fans_;
    std::int64_t highest_ = -1;
    const std::string* elementName_ = nullptr;  ///< of the face that is being read
    std::uint64_t index_ = 0;
    const std::string* highestElement_ = nullptr;  ///< of the face with the highest index
    std::uint64_t highestPlace_ = 0;
};

}  // namespace
}  // namespace mesh

Scene loadPly(const ByteSource& source, const std::string& file, LoadMonitor& monitor) {
    return mesh::PlyReader(source, file, monitor).read();
}

}  // namespace helio
