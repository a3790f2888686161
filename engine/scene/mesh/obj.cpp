#include "engine/scene/mesh/attributes.hpp"
#include "engine/scene/mesh/blocks.hpp"
#include "engine/scene/mesh/mesh.hpp"
#include "engine/scene/mesh/mtl.hpp"
#include "engine/scene/mesh/obj_chunk.hpp"
#include "engine/scene/mesh/polygon.hpp"
#include "engine/scene/mesh/text.hpp"
#include "engine/scene/mesh/vertex_map.hpp"
#include "engine/scene/notes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <new>
#include <set>

namespace helio {
namespace mesh {
namespace {

/** A material takes some 2 KiB, and a file could name one every 17 bytes. */
constexpr std::size_t maximumMaterials = 1 << 16;

/** Each is looked for in the folder. */
constexpr std::size_t maximumLibraries = 4096;

/** What a chunk's triangles are of: from one triangle on, one material. */
struct Run {
    std::size_t triangle;
    std::size_t material;
};

struct PlacedChunk {
    ObjChunk chunk;
    std::size_t firstTriangle = 0;
    std::vector<Run> runs;
};

/** One material's triangles, on their way to a primitive. */
struct Part {
    VertexMap vertices;
    std::vector<std::uint32_t> indices;
};

class ObjBuilder {
public:
    ObjBuilder(const std::string& file, LoadMonitor& monitor)
        : file_(file), monitor_(monitor), scene_(sceneOf(file)) {}

    /** Takes the file's chunks in their order. */
    void add(ObjChunk chunk) {
        for (const auto& [line, message] : chunk.warnings)
            warn(scene_, fmt::format("line {}: {}", lines_ + line, message));
        for (const auto& [what, why] : chunk.skipped) skip(scene_, what, why);
        if (chunk.fault) refuse(chunk.fault->line, chunk.fault->fault, chunk.fault->remedy);
        resolve(chunk);
        for (std::string& library : chunk.libraries) {
            if (!knownLibraries_.insert(library).second) continue;
            if (libraries_.size() == maximumLibraries)
                throw InputError(file_, "mtllib",
                                 fmt::format("more than {} files are named", maximumLibraries), "name fewer");
            libraries_.push_back(std::move(library));
        }
        PlacedChunk placed;
        placed.firstTriangle = triangles_;
        placed.runs = runs(chunk);
        statements_ += chunk.statements;
        lines_ += chunk.lines;
        triangles_ += chunk.triangles();
        sizes_[Position] += chunk.positions.size();
        sizes_[TexCoord] += chunk.texcoords.size();
        sizes_[Normal] += chunk.normals.size();
        hasColors_ = hasColors_ || !chunk.colors.empty();
        if (isTooMany(triangles_, sizes_[Position])) {
            throw InputError(file_, fmt::format("line {}", lines_),
                             tooManyFault(triangles_, sizes_[Position]), tooManyRemedy);
        }
        placed.chunk = std::move(chunk);
        chunks_.push_back(std::move(placed));
    }

    Scene finish() {
        if (statements_ == 0) {
            throw InputError(file_, lines_ > 0 ? "line 1" : "",
                             lines_ > 0 ? "holds no OBJ statement" : "is empty", "give a Wavefront OBJ file");
        }
        for (std::size_t attribute = 0; attribute < attributeCount; ++attribute) checkRange(attribute);
        gatherAttributes();
        cutPolygons();
        Mesh& mesh = scene_.meshes[0];
        if (isPlain()) {
            mesh.primitives.push_back(plainPrimitive());
        } else {
            buildParts(mesh);
        }
        if (triangles_ == 0) warn(scene_, "the file has no faces: nothing is to be seen");
        loadMaterials(file_, libraries_, usedNames_, hasColors_, monitor_, scene_);
        return std::move(scene_);
    }

private:
    [[noreturn]] void refuse(std::size_t line, const std::string& fault, const std::string& remedy) const {
        throw InputError(file_, fmt::format("line {}", lines_ + line), fault, remedy);
    }

    /** Indices that count backwards become ones from the file's beginning. */
    void resolve(ObjChunk& chunk) {
        for (std::size_t attribute = 0; attribute < attributeCount; ++attribute) {
            const auto base = std::int64_t(sizes_[attribute]);
            const ObjChunk::Extreme& lowest = chunk.lowestRelative[attribute];
            if (base + lowest.index < 0) {
                refuse(lowest.line,
                       fmt::format("an index leads {} elements before the first", -base - lowest.index),
                       "count back from the elements given so far");
            }
            for (const std::uint32_t place : chunk.relative[attribute])
                chunk.corners[attribute][place] += std::int32_t(base);
            chunk.relative[attribute] = {};
            if (chunk.highest[attribute].index > highest_[attribute].index)
                highest_[attribute] = {chunk.highest[attribute].index,
                                       lines_ + chunk.highest[attribute].line};
        }
    }

    void checkRange(std::size_t attribute) const {
        constexpr std::array<const char*, attributeCount> plural{"vertices", "texture coordinates",
                                                                 "normals"};
        const ObjChunk::Extreme& highest = highest_[attribute];
        if (highest.index <= std::int64_t(sizes_[attribute])) return;
        throw InputError(file_, fmt::format("line {}", highest.line),
                         fmt::format("index {} is past the file's {} {}", highest.index, sizes_[attribute],
                                     plural[attribute]),
                         "give the elements that faces count on; the file may be cut off");
    }

    /** Materials count in the order in which triangles use them. */
    std::size_t materialIndex(const std::string& name) {
        const auto [known, isNew] = materials_.try_emplace(name, usedNames_.size());
        if (isNew) {
            if (usedNames_.size() == maximumMaterials) {
                throw InputError(file_, "usemtl",
                                 fmt::format("more than {} materials are used", maximumMaterials),
                                 "use fewer");
            }
            usedNames_.push_back(name);
        }
        return known->second;
    }

    std::vector<Run> runs(const ObjChunk& chunk) {
        std::vector<Run> result;
        const auto begin = [&](std::size_t triangle, std::size_t end, const std::string& name) {
            if (triangle == end) return;
            const std::size_t material = materialIndex(name);
            if (result.empty() || result.back().material != material) result.push_back({triangle, material});
        };
        std::size_t at = 0;
        for (const ObjChunk::MaterialChange& change : chunk.materialChanges) {
            begin(at, change.triangle, currentMaterial_);
            at = change.triangle;
            currentMaterial_ = chunk.materialNames[change.name];
        }
        begin(at, chunk.triangles(), currentMaterial_);
        return result;
    }

    void gatherAttributes() {
        positions_.reserve(sizes_[Position]);
        normals_.reserve(sizes_[Normal]);
        texcoords_.reserve(sizes_[TexCoord]);
        if (hasColors_) colors_.reserve(sizes_[Position]);
        for (PlacedChunk& placed : chunks_) {
            ObjChunk& chunk = placed.chunk;
            const auto take = [](auto& from, auto& to) {
                to.insert(to.end(), from.begin(), from.end());
                from = {};
            };
            take(chunk.positions, positions_);
            take(chunk.normals, normals_);
            take(chunk.texcoords, texcoords_);
            if (!hasColors_) continue;
            take(chunk.colors, colors_);
            colors_.resize(positions_.size(), glm::vec3(1));
        }
        for (glm::vec2& t : texcoords_) t.y = 1 - t.y;
    }

    /** Polygons lie in the corners as fans; those that are not convex are cut anew. */
    void cutPolygons() {
        std::atomic<bool> hasLarge{false};
        tbb::parallel_for(std::size_t(0), chunks_.size(), [&](std::size_t i) {
            ObjChunk& chunk = chunks_[i].chunk;
            auto& corners = chunk.corners;
            if (cutFans(positions_, chunk.polygons,
                        {&corners[Position], &corners[TexCoord], &corners[Normal]}))
                hasLarge = true;
            chunk.polygons = {};
        });
        if (hasLarge) warn(scene_, largePolygonWarning());
    }

    /** One material, and every corner has the same index in all lists or none: they can stay as they are. */
    bool isPlain() const {
        if (usedNames_.size() != 1 || sizes_[Position] > 3 * triangles_) return false;
        for (const std::size_t attribute : {std::size_t(TexCoord), std::size_t(Normal)}) {
            if (!isUsed(attribute)) continue;
            if (sizes_[attribute] != sizes_[Position]) return false;
            for (const PlacedChunk& placed : chunks_) {
                if (placed.chunk.corners[attribute] != placed.chunk.corners[Position]) return false;
            }
        }
        return std::all_of(normals_.begin(), normals_.end(), isNormal);
    }

    bool isUsed(std::size_t attribute) const {
        return std::any_of(chunks_.begin(), chunks_.end(), [&](const PlacedChunk& placed) {
            return !placed.chunk.corners[attribute].empty();
        });
    }

    Primitive plainPrimitive() {
        Primitive primitive;
        primitive.material = 0;
        primitive.positions = std::move(positions_);
        if (isUsed(Normal)) {
            primitive.normals = std::move(normals_);
            for (glm::vec3& normal : primitive.normals) normal = unit(normal);
        }
        if (isUsed(TexCoord)) primitive.texcoords.push_back(std::move(texcoords_));
        if (hasColors_) {
            primitive.colors.reserve(colors_.size());
            for (const glm::vec3& color : colors_) primitive.colors.emplace_back(linearFromSrgb(color), 1);
        }
        primitive.indices.reserve(triangles_ * 3);
        for (PlacedChunk& placed : chunks_) {
            const auto& corners = placed.chunk.corners[Position];
            primitive.indices.insert(primitive.indices.end(), corners.begin(), corners.end());
            placed.chunk = {};
        }
        return primitive;
    }

    void buildParts(Mesh& mesh) {
        hasNormals_ = isUsed(Normal);
        const bool hasTexcoords = isUsed(TexCoord);
        std::vector<Part> parts(usedNames_.size());
        for (PlacedChunk& placed : chunks_) {
            for (std::size_t r = 0; r < placed.runs.size(); ++r) {
                const std::size_t end =
                    r + 1 < placed.runs.size() ? placed.runs[r + 1].triangle : placed.chunk.triangles();
                Part& part = parts[placed.runs[r].material];
                for (std::size_t t = placed.runs[r].triangle; t < end; ++t) addTriangle(placed, t, part);
            }
            placed.chunk = {};
        }
        bool isTexcoordMissing = false;
        for (std::size_t m = 0; m < parts.size(); ++m) {
            monitor_.report("geometry", double(m) / double(parts.size()));
            Part& part = parts[m];
            Primitive primitive;
            primitive.material = int(m);
            primitive.indices = std::move(part.indices);
            const std::vector<VertexMap::Key>& keys = part.vertices.keys();
            primitive.positions.reserve(keys.size());
            for (const auto& key : keys)
                primitive.positions.push_back(positions_[std::size_t(key[Position])]);
            if (hasNormals_) gatherNormals(keys, primitive);
            if (hasTexcoords) {
                auto& set = primitive.texcoords.emplace_back();
                set.reserve(keys.size());
                for (const auto& key : keys) {
                    const std::int32_t t = key[TexCoord];
                    isTexcoordMissing = isTexcoordMissing || t < 0;
                    set.push_back(t < 0 ? glm::vec2(0) : texcoords_[std::size_t(t)]);
                }
            }
            if (hasColors_) {
                primitive.colors.reserve(keys.size());
                for (const auto& key : keys)
                    primitive.colors.emplace_back(linearFromSrgb(colors_[std::size_t(key[Position])]), 1);
            }
            part = {};
            mesh.primitives.push_back(std::move(primitive));
        }
        if (isTexcoordMissing) warn(scene_, "some faces have no texture coordinates; they count as (0, 0)");
    }

    void addTriangle(const PlacedChunk& placed, std::size_t triangle, Part& part) {
        const auto index = [&](std::size_t attribute, std::size_t corner) {
            const auto& list = placed.chunk.corners[attribute];
            return list.empty() ? -1 : list[triangle * 3 + corner];
        };
        for (std::size_t corner = 0; corner < 3; ++corner) {
            VertexMap::Key key{index(Position, corner), index(TexCoord, corner), index(Normal, corner)};
            if (key[Normal] >= 0 && !isNormal(normals_[std::size_t(key[Normal])])) key[Normal] = -1;
            // Without a normal the corner is flat: a vertex that only this triangle has.
            if (key[Normal] < 0 && hasNormals_)
                key[Normal] = -2 - std::int32_t(placed.firstTriangle + triangle);
            part.indices.push_back(part.vertices.add(key));
        }
    }

    void gatherNormals(const std::vector<VertexMap::Key>& keys, Primitive& primitive) const {
        primitive.normals.resize(keys.size());
        std::vector<bool> isFlat(keys.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const std::int32_t n = keys[i][Normal];
            isFlat[i] = n < 0;
            if (n >= 0) primitive.normals[i] = unit(normals_[std::size_t(n)]);
        }
        for (std::size_t t = 0; t < primitive.indices.size(); t += 3) {
            const std::uint32_t* const corner = &primitive.indices[t];
            if (!isFlat[corner[0]] && !isFlat[corner[1]] && !isFlat[corner[2]]) continue;
            const glm::vec3 normal =
                faceNormal(primitive.positions[corner[0]], primitive.positions[corner[1]],
                           primitive.positions[corner[2]]);
            for (int k = 0; k < 3; ++k) {
                if (isFlat[corner[k]]) primitive.normals[corner[k]] = normal;
            }
        }
    }

    const std::string& file_;
    LoadMonitor& monitor_;
    Scene scene_;
    std::vector<PlacedChunk> chunks_;
    std::size_t lines_ = 0, statements_ = 0, triangles_ = 0;
    std::array<std::size_t, attributeCount> sizes_{};
    std::array<ObjChunk::Extreme, attributeCount> highest_{};
    bool hasColors_ = false, hasNormals_ = false;
    std::vector<std::string> libraries_;
    std::set<std::string> knownLibraries_;
    std::string currentMaterial_;
    std::map<std::string, std::size_t> materials_;  ///< into usedNames_
    std::vector<std::string> usedNames_;
    std::vector<glm::vec3> positions_, normals_, colors_;
    std::vector<glm::vec2> texcoords_;
};

}  // namespace
}  // namespace mesh

Scene loadObj(const ByteSource& source, const std::string& file, LoadMonitor& monitor) {
    std::array<char, 2> start{};
    source.read(0, std::as_writable_bytes(std::span(start)).first(std::min<std::size_t>(2, source.size())));
    if (mesh::isUtf16({start.data(), start.size()}))
        throw InputError(file, "byte 0", "is text in UTF-16", "save it as UTF-8");
    mesh::ObjBuilder builder(file, monitor);
    mesh::forEachBlock(source, mesh::cutAfterLine, monitor, mesh::parseObjChunk,
                       [&](mesh::ObjChunk chunk) { builder.add(std::move(chunk)); });
    return builder.finish();
}

}  // namespace helio
