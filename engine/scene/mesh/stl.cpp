#include "engine/scene/mesh/attributes.hpp"
#include "engine/scene/mesh/blocks.hpp"
#include "engine/scene/mesh/mesh.hpp"
#include "engine/scene/mesh/text.hpp"
#include "engine/scene/notes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <numeric>

namespace helio {
namespace mesh {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it is");

// 80 bytes of text, a count; then per facet a normal, three corners and two bytes of attributes.
constexpr std::size_t headerSize = 84, facetSize = 50;

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/** Binary files may begin with "solid" too: the size tells them, or bytes that no text has. */
bool isBinary(const ByteSource& source) {
    std::array<char, 1024> start{};
    const std::size_t length = std::size_t(std::min<std::uint64_t>(source.size(), start.size()));
    source.read(0, std::as_writable_bytes(std::span(start)).first(length));
    if (length >= headerSize) {
        std::uint32_t facets = 0;
        std::memcpy(&facets, &start[headerSize - 4], 4);
        if (source.size() == headerSize + facetSize * std::uint64_t(facets)) return true;
    }
    std::string_view text = withoutMark({start.data(), length});
    const bool isText = std::none_of(text.begin(), text.end(), [](unsigned char c) {
        return c == 0x7f || (c < ' ' && (c < '\t' || c > '\r'));
    });
    const std::string_view word = takeWord(text);
    return !(isText && equalsIgnoringCase(word.substr(0, 5), "solid"));
}

Scene sceneOfFacets(const std::string& file, std::vector<glm::vec3> corners) {
    Scene scene = sceneOf(file);
    Primitive primitive;
    primitive.material = 0;
    primitive.indices.resize(corners.size());
    std::iota(primitive.indices.begin(), primitive.indices.end(), 0u);
    primitive.positions = std::move(corners);
    if (primitive.indices.empty()) {
        warn(scene, "the file has no facets: nothing is to be seen");
    } else {
        scene.meshes[0].primitives.push_back(std::move(primitive));
    }
    scene.materials.push_back(neutralMaterial(false));
    return scene;
}

Scene loadBinary(const ByteSource& source, const std::string& file, LoadMonitor& monitor) {
    if (source.size() < headerSize) {
        throw InputError(file, "header", fmt::format("has {} bytes of {}", source.size(), headerSize),
                         "give an STL file, or write this one again; it may be cut off");
    }
    std::uint32_t count = 0;
    source.read(headerSize - 4, std::as_writable_bytes(std::span(&count, 1)));
    const std::uint64_t room = (source.size() - headerSize) / facetSize;
    if (count > room) {
        throw InputError(file, "header", fmt::format("says {} facets, the file has {}", count, room),
                         "write the file again; it may be cut off");
    }
    if (std::uint64_t(count) * 3 > 0xffffffffu) {
        throw InputError(file, "header", fmt::format("says {} facets", count), "give at most 1431655765");
    }
    std::vector<glm::vec3> corners(std::size_t(count) * 3);
    std::atomic<std::size_t> done{0};
    constexpr std::size_t none = std::size_t(-1);
    std::atomic<std::size_t> firstFault{none};
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 32768), [&](const auto& range) {
        monitor.report("geometry", double(done) / double(count));
        std::vector<std::byte> bytes(range.size() * facetSize);
        source.read(headerSize + range.begin() * facetSize, bytes);
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            glm::vec3* const corner = &corners[i * 3];
            std::memcpy(corner, &bytes[(i - range.begin()) * facetSize + 12], 36);
            for (int k = 0; k < 9; ++k) {
                if (std::isfinite(corner[k / 3][k % 3])) continue;
                for (std::size_t first = firstFault;
                     i < first && !firstFault.compare_exchange_weak(first, i);) {
                }
            }
        }
        done += range.size();
    });
    if (firstFault != none) {
        throw InputError(file, fmt::format("facet {}", firstFault.load()), "has a corner that is not finite",
                         "give finite numbers");
    }
    Scene scene = sceneOfFacets(file, std::move(corners));
    if (source.size() != headerSize + facetSize * std::uint64_t(count))
        warn(scene, fmt::format("what follows the {} facets is left out", count));
    return scene;
}

/** Whole facets, parsed by themselves. */
struct FacetBlock {
    std::vector<glm::vec3> corners;
    std::size_t lines = 0;
    bool isEnded = false;  ///< by endsolid
    std::optional<TextFault> fault;
};

FacetBlock parseFacets(std::string_view text) {
    FacetBlock block;
    Lines lines(withoutMark(text));
    std::string_view line;
    bool isInFacet = false;
    std::size_t cornersBefore = 0;
    const auto refuse = [&](std::string fault, std::string remedy) {
        if (!block.fault) block.fault = TextFault{lines.number(), std::move(fault), std::move(remedy)};
    };
    while (!block.fault && lines.next(line)) {
        const std::string_view keyword = takeWord(line);
        const auto is = [keyword](std::string_view name) { return equalsIgnoringCase(keyword, name); };
        if (keyword.empty()) continue;
        if (is("vertex")) {
            std::array<float, 3> numbers{};
            for (float& number : numbers) {
                const std::string_view word = takeWord(line);
                const std::optional<float> value = parseReal(word);
                if (!value) {
                    refuse(word.empty() ? "a vertex has too few numbers"
                                        : fmt::format("a vertex has {} for a number", shown(word)),
                           "give three finite numbers; the file may be cut off");
                }
                number = value.value_or(0);
            }
            if (!isInFacet) refuse("a vertex is in no facet", "begin with facet and outer loop");
            block.corners.emplace_back(numbers[0], numbers[1], numbers[2]);
        } else if (is("facet")) {
            if (isInFacet) refuse("a facet begins in another", "end it with endfacet");
            isInFacet = true;
            cornersBefore = block.corners.size();
        } else if (is("endfacet")) {
            const std::size_t corners = block.corners.size() - cornersBefore;
            if (!isInFacet || corners != 3)
                refuse(fmt::format("a facet has {} corners", corners), "give three");
            isInFacet = false;
        } else if (is("endsolid")) {
            block.isEnded = true;
        } else if (!is("solid") && !is("outer") && !is("endloop") && !is("color")) {
            refuse(fmt::format("{} is no STL statement", shown(keyword)), "give an STL file");
        }
    }
    if (isInFacet) refuse("the file ends within a facet", "write it again; it may be cut off");
    block.lines = lines.count();
    return block;
}

/** After the last endfacet and its line. */
std::size_t cutAfterFacet(std::string_view text) {
    std::size_t at = std::string_view::npos;
    for (const char* const word : {"endfacet", "ENDFACET", "EndFacet"}) {
        const std::size_t found = text.rfind(word);
        if (found != std::string_view::npos && (at == std::string_view::npos || found > at)) at = found;
    }
    if (at == std::string_view::npos) return 0;
    const std::size_t end = text.find('\n', at);
    return end == std::string_view::npos ? 0 : end + 1;
}

Scene loadText(const ByteSource& source, const std::string& file, LoadMonitor& monitor) {
    std::vector<std::vector<glm::vec3>> blocks;
    std::size_t lines = 0, size = 0;
    bool isEnded = false;
    forEachBlock(source, cutAfterFacet, monitor, parseFacets, [&](FacetBlock block) {
        if (block.fault) {
            throw InputError(file, fmt::format("line {}", lines + block.fault->line), block.fault->fault,
                             block.fault->remedy);
        }
        lines += block.lines;
        size += block.corners.size();
        isEnded = block.isEnded;
        blocks.push_back(std::move(block.corners));
    });
    std::vector<glm::vec3> corners;
    corners.reserve(size);
    for (auto& block : blocks) {
        corners.insert(corners.end(), block.begin(), block.end());
        block = {};
    }
    Scene scene = sceneOfFacets(file, std::move(corners));
    if (!isEnded) warn(scene, "the file does not end with endsolid; it may be cut off");
    return scene;
}

}  // namespace
}  // namespace mesh

Scene loadStl(const ByteSource& source, const std::string& file, LoadMonitor& monitor) {
    if (source.size() == 0) throw InputError(file, "", "is empty", "give an STL file");
    return mesh::isBinary(source) ? mesh::loadBinary(source, file, monitor)
                                  : mesh::loadText(source, file, monitor);
}

}  // namespace helio
