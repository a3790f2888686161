#include "engine/scene/mesh/attributes.hpp"
#include "engine/scene/mesh/mesh.hpp"
#include "engine/scene/mesh/ply_faces.hpp"
#include "engine/scene/mesh/ply_slots.hpp"
#include "engine/scene/mesh/ply_values.hpp"
#include "engine/scene/mesh/polygon.hpp"
#include "engine/scene/mesh/textures.hpp"
#include "engine/scene/notes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

namespace helio {
namespace mesh {
namespace {

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
            if (element.name == "vertex") vertexCount_ += std::size_t(element.count);
        }
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
        primitive_.positions.resize(count);
        if (has_[NormalX] && has_[NormalY] && has_[NormalZ]) primitive_.normals.resize(count);
        if (has_[U] && has_[V]) primitive_.texcoords.emplace_back().resize(count);
        if (has_[Red] && has_[Green] && has_[Blue]) primitive_.colors.resize(count);
        Vertex vertex{};
        vertex[Alpha] = 1;
        for (std::size_t i = readVertexRecords(element, slots); i < count; ++i) {
            report(i);
            values_.at(element.name, i);
            for (std::size_t p = 0; p < slots.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (slots[p] == slotCount) {
                    skipProperty(property);
                    continue;
                }
                const double value = values_.next(property.type);
                if (!fitsSinglePrecision(value)) {
                    values_.refuse(fmt::format("{} is {}", property.name, value),
                                   "give finite numbers that single precision can hold");
                }
                vertex[slots[p]] = float(slots[p] >= Red ? value * colorScale(property.type) : value);
            }
            store(i, vertex);
        }
    }

    using Vertex = std::array<float, slotCount>;

    static bool fitsSinglePrecision(double value) { return std::abs(value) < 0x1.ffffffp127; }

    void store(std::size_t i, const Vertex& vertex) {
        primitive_.positions[i] = {vertex[X], vertex[Y], vertex[Z]};
        if (!primitive_.normals.empty())
            primitive_.normals[i] = {vertex[NormalX], vertex[NormalY], vertex[NormalZ]};
        if (!primitive_.texcoords.empty()) primitive_.texcoords[0][i] = {vertex[U], 1 - vertex[V]};
        if (!primitive_.colors.empty())
            primitive_.colors[i] = {vertex[Red], vertex[Green], vertex[Blue], vertex[Alpha]};
    }

    /** Vertices of a binary file lie at equal distances where they have no lists: side by side. Returns how
     * many were read, which ends before one with a fault. */
    std::size_t readVertexRecords(const PlyElement& element, const std::vector<std::size_t>& slots) {
        struct Column {
            std::size_t offset, slot;
            PlyType type;
            double scale;
        };
        std::vector<Column> columns;
        std::size_t size = 0;
        for (std::size_t p = 0; p < slots.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (property.isList || values_.isText()) return 0;
            const double scale = slots[p] >= Red ? colorScale(property.type) : 1.0;
            if (slots[p] != slotCount) columns.push_back({size, slots[p], property.type, scale});
            size += sizeOf(property.type);
        }
        const auto count = std::size_t(element.count);
        std::size_t done = 0;
        while (done < count) {
            monitor_.report("geometry", values_.fraction());
            const std::span<const char> records = values_.records(size, count - done);
            const std::size_t n = records.size() / size;
            if (n == 0) return done;
            std::atomic<bool> hasFault{false};
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 2048), [&](const auto& range) {
                Vertex vertex{};
                vertex[Alpha] = 1;
                for (std::size_t i = range.begin(); i < range.end(); ++i) {
                    for (const Column& column : columns) {
                        const double value =
                            plyValue(&records[i * size + column.offset], column.type, values_.isSwapped());
                        if (!fitsSinglePrecision(value)) hasFault = true;
                        vertex[column.slot] = float(value * column.scale);
                    }
                    store(done + i, vertex);
                }
            });
            if (hasFault) return done;  // these are read again, to say where it is
            values_.take(n * size);
            done += n;
        }
        return done;
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
        if (!isStrips && !isTooMany(std::size_t(element.count), vertexCount_))
            primitive_.indices.reserve(std::size_t(element.count) * 3);
        for (const PlyProperty& property : element.properties) {
            if (!isCorners(property))
                helio::skip(scene_, "PLY " + element.name + " property " + property.name,
                            "it has no meaning here");
        }
        std::vector<std::int32_t> corners;
        elementName_ = &element.name;
        const std::optional<FaceLayout> layout =
            isStrips || values_.isText() ? std::nullopt : faceLayout(element);
        std::uint64_t nextRecords = 0;  // from which face on it is worth trying
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (layout && i >= nextRecords) {
                constexpr std::uint64_t most = 16384, fewest = 1024;
                const std::uint64_t taken = readFaceRecords(*layout, i, most, element.count - i);
                i += taken;
                if (i == element.count) break;
                if (taken < fewest) nextRecords = i + most;
            }
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
                if (!isStrips && size > maximumCorners) {  // one list may hold all strips
                    values_.refuse(fmt::format("{} has {} entries", property.name, size),
                                   fmt::format("give at most {}", maximumCorners));
                }
                checkTriangles(size);
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

    /** Reads faces with as many corners as the next one, up to `most` of those left. Returns how many. */
    std::uint64_t readFaceRecords(const FaceLayout& layout, std::uint64_t face, std::uint64_t most,
                                  std::uint64_t facesLeft) {
        monitor_.report("geometry", values_.fraction());
        const std::span<const char> first = values_.records(layout.size(0), 1);
        if (first.empty()) return 0;
        const double said = plyValue(&first[layout.before], layout.countType, values_.isSwapped());
        if (!(said >= 3 && said <= 255)) return 0;
        const auto corners = std::size_t(said);
        const std::span<const char> records =
            values_.records(layout.size(corners), std::min(most, facesLeft));
        const std::size_t size = records.size() / layout.size(corners), triangles = corners - 2;
        auto& indices = primitive_.indices;
        const std::size_t before = indices.size();
        if (before == 0) {  // else they double, and double the memory
            const std::uint64_t left = values_.left() / layout.size(corners);
            const std::size_t likely = std::size_t(std::min(facesLeft, left)) * triangles;
            if (!isTooMany(likely, vertexCount_)) indices.reserve(likely * 3);
        }
        checkTriangles(size * triangles);
        indices.resize(before + size * triangles * 3);
        const DecodedFaces decoded =
            decodeFaces(records, layout, corners, values_.isSwapped(), std::span(indices).subspan(before));
        indices.resize(before + decoded.count * triangles * 3);
        for (std::size_t i = 0; corners > 3 && i < decoded.count; ++i)
            fans_.push_back({std::uint32_t(before / 3 + i * triangles), std::uint32_t(corners)});
        if (decoded.highest > highest_) {
            highest_ = decoded.highest;
            highestPlace_ = face + decoded.highestFace;
            highestElement_ = elementName_;
        }
        values_.take(decoded.count * layout.size(corners));
        return decoded.count;
    }

    /** Before memory is taken for more. */
    void checkTriangles(std::size_t more) const {
        const std::size_t triangles = primitive_.indices.size() / 3 + more;
        if (isTooMany(triangles, vertexCount_))
            throw InputError(file_, "element " + *elementName_, tooManyFault(triangles, vertexCount_),
                             tooManyRemedy);
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
    std::size_t vertexCount_ = 0;  ///< that the header says
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
