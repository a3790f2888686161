#include "engine/scene/mesh/ply_header.hpp"

#include "engine/scene/mesh/text.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

namespace helio::mesh {
namespace {

/** Longer headers than any program writes. */
constexpr std::size_t maximumHeader = std::size_t(1) << 20;

std::optional<PlyType> typeNamed(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, PlyType>, 16> names{{
        {"char", PlyType::Int8},
        {"uchar", PlyType::Uint8},
        {"short", PlyType::Int16},
        {"ushort", PlyType::Uint16},
        {"int", PlyType::Int32},
        {"uint", PlyType::Uint32},
        {"float", PlyType::Float32},
        {"double", PlyType::Float64},
        {"int8", PlyType::Int8},
        {"uint8", PlyType::Uint8},
        {"int16", PlyType::Int16},
        {"uint16", PlyType::Uint16},
        {"int32", PlyType::Int32},
        {"uint32", PlyType::Uint32},
        {"float32", PlyType::Float32},
        {"float64", PlyType::Float64},
    }};
    const auto found =
        std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == name; });
    return found == names.end() ? std::nullopt : std::optional(found->second);
}

class HeaderParser {
public:
    HeaderParser(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

    PlyHeader parse() {
        std::string_view line = takeLine();
        if (takeWord(line) != "ply") refuse("is no PLY file", "begin with a line that says ply");
        bool hasFormat = false;
        while (true) {
            line = takeLine();
            const std::string_view keyword = takeWord(line);
            if (keyword == "end_header") break;
            if (keyword == "format") {
                format(line);
                hasFormat = true;
            } else if (keyword == "element") {
                element(line);
            } else if (keyword == "property") {
                property(line);
            } else if (keyword == "comment" || keyword == "obj_info") {
                if (takeWord(line) == "TextureFile") header_.texture = trimmed(line);
            } else if (!keyword.empty()) {
                header_.unknown.push_back(
                    fmt::format("line {}: {} is no part of a header; left out", line_, shown(keyword)));
                if (header_.unknown.size() > 100)
                    refuse("the header has more than 100 lines that say nothing", "write the file again");
            }
        }
        if (!hasFormat) refuse("the header names no format", "give a line such as: format ascii 1.0");
        header_.size = used_;
        header_.lines = line_;
        return std::move(header_);
    }

private:
    [[noreturn]] void refuse(std::string fault, std::string remedy) const {
        throw InputError(file_, fmt::format("line {}", std::max<std::size_t>(line_, 1)), std::move(fault),
                         std::move(remedy));
    }

    std::string_view takeLine() {
        if (line_ == 0) {  // what ends the first line ends all
            const std::size_t end = rest_.find_first_of("\r\n");
            if (end != std::string_view::npos && rest_[end] == '\r' && !rest_.substr(end).starts_with("\r\n"))
                lineEnd_ = '\r';
        }
        const std::size_t end = rest_.find(lineEnd_);
        if (end == std::string_view::npos) {
            ++line_;
            if (line_ == 1) refuse("is no PLY file", "begin with a line that says ply");
            refuse("the header has no end_header", "write the file again; it may be cut off");
        }
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        used_ += end + 1;
        ++line_;
        return line;
    }

    void format(std::string_view line) {
        const std::string_view name = takeWord(line);
        if (name == "ascii") {
            header_.format = PlyHeader::Format::Ascii;
        } else if (name == "binary_little_endian") {
            header_.format = PlyHeader::Format::LittleEndian;
        } else if (name == "binary_big_endian") {
            header_.format = PlyHeader::Format::BigEndian;
        } else {
            refuse(fmt::format("format {} is not known", shown(name)),
                   "give ascii, binary_little_endian or binary_big_endian");
        }
        if (takeWord(line) != "1.0")
            refuse("the format's version is not 1.0", "write the file as version 1.0");
    }

    void element(std::string_view line) {
        PlyElement element;
        element.name = takeWord(line);
        const std::optional<std::int64_t> count = parseInteger(takeWord(line));
        if (element.name.empty() || !count || *count < 0)
            refuse("an element has no name or no count", "give: element NAME COUNT");
        if (!names_.insert(element.name).second)
            refuse(fmt::format("element {} is there twice", shown(element.name)), "give it once");
        element.count = std::uint64_t(*count);
        header_.elements.push_back(std::move(element));
    }

    void property(std::string_view line) {
        if (header_.elements.empty()) refuse("a property belongs to no element", "give an element first");
        PlyProperty property;
        std::string_view word = takeWord(line);
        if (word == "list") {
            property.isList = true;
            const std::optional<PlyType> count = typeNamed(takeWord(line));
            if (!count || *count >= PlyType::Float32)
                refuse("a list's count has no type of integers", "give a type such as uchar");
            property.countType = *count;
            word = takeWord(line);
        }
        const std::optional<PlyType> type = typeNamed(word);
        if (!type) refuse(fmt::format("{} is no type", shown(word)), "give a type such as float");
        property.type = *type;
        property.name = takeWord(line);
        if (property.name.empty()) refuse("a property has no name", "give it one");
        // Blender to 2.79 writes no line for the faces of a mesh that has none, but for their list.
        const bool isOfFaces = property.name == "vertex_indices" || property.name == "vertex_index";
        if (property.isList && isOfFaces && header_.elements.back().name == "vertex") {
            header_.unknown.push_back(fmt::format("line {}: {} is of faces, which no element names; left out",
                                                  line_, property.name));
            return;
        }
        header_.elements.back().properties.push_back(std::move(property));
    }

    std::string_view rest_;
    const std::string& file_;
    PlyHeader header_;
    char lineEnd_ = '\n';
    std::size_t line_ = 0;
    std::uint64_t used_ = 0;
    std::set<std::string> names_;
};

}  // namespace

std::size_t sizeOf(PlyType type) {
    switch (type) {
        case PlyType::Int8:
        case PlyType::Uint8:
            return 1;
        case PlyType::Int16:
        case PlyType::Uint16:
            return 2;
        case PlyType::Float64:
            return 8;
        default:
            return 4;
    }
}

PlyHeader readPlyHeader(const ByteSource& source, const std::string& file) {
    if (source.size() == 0) throw InputError(file, "", "is empty", "give a PLY file");
    std::vector<char> start(std::size_t(std::min<std::uint64_t>(source.size(), maximumHeader)));
    source.read(0, std::as_writable_bytes(std::span(start)));
    return HeaderParser(std::string_view(start.data(), start.size()), file).parse();
}

}  // namespace helio::mesh
