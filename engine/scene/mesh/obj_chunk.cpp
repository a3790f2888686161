#include "engine/scene/mesh/obj_chunk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace helio::mesh {
namespace {

constexpr std::array<const char*, attributeCount> attributeNames{"vertex", "texture coordinate", "normal"};
constexpr std::int64_t maximumIndex = std::numeric_limits<std::int32_t>::max();

class ChunkParser {
public:
    explicit ChunkParser(std::string_view text) : lines_(withoutMark(text)) {}

    ObjChunk parse() {
        std::string_view line;
        try {
            while (lines_.next(line)) parseLine(line);
        } catch (TextFault& fault) {
            chunk_.fault = std::move(fault);
        }
        chunk_.lines = lines_.count();
        shrink();
        return std::move(chunk_);
    }

private:
    [[noreturn]] void refuse(std::string fault, std::string remedy) const {
        throw TextFault{lines_.number(), std::move(fault), std::move(remedy)};
    }

    void parseLine(std::string_view line) {
        const std::string_view keyword = takeWord(line);
        if (keyword.empty() || keyword[0] == '#') return;
        ++chunk_.statements;
        if (keyword == "v") {
            vertex(line);
        } else if (keyword == "f" || keyword == "fo") {
            face(line);
        } else if (keyword == "vn") {
            const auto n = numbers<3>(line, 3, "vn");
            chunk_.normals.emplace_back(n[0], n[1], n[2]);
        } else if (keyword == "vt") {
            const auto t = numbers<3>(line, 1, "vt");
            chunk_.texcoords.emplace_back(t[0], t[1]);
        } else if (keyword == "usemtl") {
            useMaterial(trimmed(line));
        } else if (keyword == "mtllib") {
            chunk_.libraries.emplace_back(trimmed(line));
        } else {
            other(keyword, line);
        }
    }

    /** From `fewest` to N numbers; those that are missing are 0. What follows a # is a comment. */
    template <std::size_t N>
    std::array<float, N> numbers(std::string_view line, std::size_t fewest, const char* keyword,
                                 std::size_t* count = nullptr) const {
        std::array<float, N> values{};
        std::size_t given = 0;
        for (std::string_view word = takeWord(line); !word.empty() && word[0] != '#'; word = takeWord(line)) {
            if (given == N) break;
            const std::optional<float> value = parseReal(word);
            if (!value)
                refuse(fmt::format("{} has {} for a number", keyword, shown(word)), "give finite numbers");
            values[given++] = *value;
        }
        if (given < fewest) {
            refuse(fmt::format("{} has {} numbers", keyword, given),
                   fmt::format("give {}; the file may be cut off", fewest));
        }
        if (count != nullptr) *count = given;
        return values;
    }

    /** x y z, then a weight, or a colour, or both. */
    void vertex(std::string_view line) {
        std::size_t count = 0;
        const auto n = numbers<7>(line, 3, "v", &count);
        if (count == 5) refuse("v has 5 numbers", "give 3, or 6 with a colour");
        if ((count == 4 || count == 7) && n[3] != 1)
            skip("weights of vertices", "rational curves are not shown");
        chunk_.positions.emplace_back(n[0], n[1], n[2]);
        if (count >= 6) {
            const std::size_t first = count == 6 ? 3 : 4;
            chunk_.colors.resize(chunk_.positions.size() - 1, glm::vec3(1));
            chunk_.colors.emplace_back(n[first], n[first + 1], n[first + 2]);
        } else if (!chunk_.colors.empty()) {
            chunk_.colors.emplace_back(1);
        }
    }

    struct Corner {
        std::array<std::int32_t, attributeCount> index{-1, -1, -1};
        std::array<bool, attributeCount> isRelative{};
    };

    std::size_t size(std::size_t attribute) const {
        return attribute == Position   ? chunk_.positions.size()
               : attribute == TexCoord ? chunk_.texcoords.size()
                                       : chunk_.normals.size();
    }

    void index(std::string_view word, std::size_t attribute, Corner& corner) {
        const std::optional<std::int64_t> value = parseInteger(word);
        if (!value || *value == 0 || *value > maximumIndex || *value < -maximumIndex) {
            refuse(fmt::format("{} is no index of a {}", shown(word), attributeNames[attribute]),
                   "count from 1, or from -1 backwards");
        }
        if (*value > 0) {
            corner.index[attribute] = std::int32_t(*value - 1);
            auto& highest = chunk_.highest[attribute];
            if (*value > highest.index) highest = {*value, lines_.number()};
        } else {
            const std::int64_t local = std::int64_t(size(attribute)) + *value;
            if (local < -maximumIndex)
                refuse(fmt::format("{} is no index", shown(word)), "count from -1 backwards");
            corner.index[attribute] = std::int32_t(local);
            corner.isRelative[attribute] = true;
            auto& lowest = chunk_.lowestRelative[attribute];
            if (local < lowest.index) lowest = {local, lines_.number()};
        }
    }

    /** v, v/t, v//n or v/t/n. */
    Corner corner(std::string_view word) {
        Corner result;
        for (std::size_t attribute = Position; attribute < attributeCount; ++attribute) {
            const std::size_t slash = word.find('/');
            const std::string_view part = word.substr(0, slash);
            if (!part.empty() || attribute == Position) index(part, attribute, result);
            if (slash == std::string_view::npos) return result;
            word.remove_prefix(slash + 1);
        }
        refuse("a corner has more than three indices", "give vertex/texture/normal");
    }

    void addCorner(const Corner& corner) {
        const std::size_t place = chunk_.corners[Position].size();
        for (std::size_t attribute = 0; attribute < attributeCount; ++attribute) {
            std::vector<std::int32_t>& list = chunk_.corners[attribute];
            const bool isGiven = corner.index[attribute] != -1 || corner.isRelative[attribute];
            if (!isGiven && list.empty()) continue;
            list.resize(place, -1);
            list.push_back(corner.index[attribute]);
            if (corner.isRelative[attribute]) chunk_.relative[attribute].push_back(std::uint32_t(place));
        }
    }

    void face(std::string_view line) {
        face_.clear();
        for (std::string_view word = takeWord(line); !word.empty() && word[0] != '#'; word = takeWord(line)) {
            if (face_.size() == maximumCorners)
                refuse(fmt::format("a face has more than {} corners", maximumCorners), "give smaller faces");
            face_.push_back(corner(word));
        }
        if (face_.size() < 3) {
            refuse(fmt::format("a face has {} corners", face_.size()),
                   "give at least 3; the file may be cut off");
        }
        if (face_.size() > 3) {
            chunk_.polygons.push_back({std::uint32_t(chunk_.triangles()), std::uint32_t(face_.size())});
        }
        for (std::size_t k = 1; k + 1 < face_.size(); ++k) {
            addCorner(face_[0]);
            addCorner(face_[k]);
            addCorner(face_[k + 1]);
        }
    }

    void useMaterial(std::string_view name) {
        auto known = names_.find(name);
        if (known == names_.end()) {
            known = names_.emplace(std::string(name), std::uint32_t(chunk_.materialNames.size())).first;
            chunk_.materialNames.emplace_back(name);
        }
        const auto triangle = std::uint32_t(chunk_.triangles());
        auto& changes = chunk_.materialChanges;
        if (!changes.empty() && changes.back().triangle == triangle) changes.pop_back();
        changes.push_back({triangle, known->second});
    }

    void skip(const char* what, const char* why) {
        const std::pair<std::string, std::string> entry{what, why};
        if (std::find(chunk_.skipped.begin(), chunk_.skipped.end(), entry) == chunk_.skipped.end())
            chunk_.skipped.push_back(entry);
    }

    void other(std::string_view keyword, std::string_view line) {
        const auto is = [keyword](std::initializer_list<std::string_view> names) {
            return std::find(names.begin(), names.end(), keyword) != names.end();
        };
        if (is({"g", "o", "mg"})) return;  // the whole file is one mesh
        if (keyword == "s") {
            const std::string_view group = takeWord(line);
            if (group != "off" && group != "0" && chunk_.normals.empty())
                skip("smoothing groups", "faces without normals are shaded flat");
        } else if (is({"l", "p"})) {
            skip(keyword == "l" ? "lines" : "points", "only triangles are shown");
        } else if (is({"vp",   "cstype", "deg",  "bmat", "step",  "curv", "curv2", "surf",
                       "parm", "trim",   "hole", "scrv", "sp",    "end",  "con",   "bsp",
                       "bzp",  "cdc",    "cdp",  "res",  "ctech", "stech"})) {
            skip("free-form curves and surfaces", "only polygons are shown");
        } else if (is({"usemap", "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj",
                       "call", "csh"})) {
            skip("OBJ statement " + std::string(keyword), "it has no meaning here");
        } else {
            --chunk_.statements;
            constexpr std::size_t enough = 100;
            if (chunk_.warnings.size() < enough) {
                chunk_.warnings.emplace_back(lines_.number(),
                                             fmt::format("{} is no OBJ statement; left out", shown(keyword)));
            }
        }
    }

    void skip(const std::string& what, const char* why) { skip(what.c_str(), why); }

    void shrink() {
        const auto fit = [](auto&... lists) { (lists.shrink_to_fit(), ...); };
        fit(chunk_.positions, chunk_.normals, chunk_.colors, chunk_.texcoords, chunk_.polygons,
            chunk_.materialChanges);
        for (std::size_t attribute = 0; attribute < attributeCount; ++attribute) {
            auto& list = chunk_.corners[attribute];
            if (!list.empty()) list.resize(chunk_.corners[Position].size(), -1);
            fit(list, chunk_.relative[attribute]);
        }
    }

    Lines lines_;
    ObjChunk chunk_;
    std::vector<Corner> face_;
    std::map<std::string, std::uint32_t, std::less<>> names_;
};

}  // namespace

ObjChunk parseObjChunk(std::string_view text) {
    return ChunkParser(text).parse();
}

}  // namespace helio::mesh
