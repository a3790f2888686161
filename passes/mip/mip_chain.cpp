#include "passes/mip/mip_chain.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/mip.hpp>

#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace helio {
namespace {

// As in shaders/scene/textures.glsl.
constexpr std::uint32_t kFloat = 1u << 5;
constexpr std::uint32_t kMipmaps = 1u << 6;
constexpr std::uint32_t kLinear = 1u << 7;
constexpr std::uint32_t kNormals = 1u << 8;
// As in passes/mip/mip.glsl.
constexpr std::uint32_t kWholeX = 1, kWholeY = 2;

/** A level that fills a workgroup's row and has so many texels is made by a dispatch of its own. */
constexpr std::size_t kNone = ~std::size_t(0);
constexpr std::uint32_t kWideRow = 128;
constexpr std::uint64_t kWideTexels = 1u << 14;

struct Size {
    std::uint32_t width, height;
    Size half() const { return {std::max(width / 2, 1u), std::max(height / 2, 1u)}; }
};

/** A buffer is never empty. */
std::vector<glm::uvec4> atLeastOne(std::vector<glm::uvec4> values) {
    if (values.empty()) values.emplace_back(0u);
    return values;
}

/** Push constants of mip.glsl. */
struct MipPush {
    std::uint32_t firstItem, items, invocations, firstInvocation;
};
/** Push constants of mip_wide.glsl. */
struct WidePush {
    MipLayout::Wide wide;
    std::int32_t firstRow;
};

/** Workgroups of mip_wide.glsl. */
constexpr glm::ivec2 kWideGroup(128, 8);

glm::ivec2 invocations(const MipLayout::Wide& wide) {
    return wide.second >= 0 ? wide.size / 2 : wide.size;
}

/** What the wide kernels are specialized for: TWO_LEVELS, WHOLE_GROUPS, TEXELS, NORMALS, and whether the
 * base's texels of 8 bits are read by fours. */
using WideKind = std::tuple<bool, bool, std::int32_t, bool, bool>;
WideKind wideKind(std::uint32_t flags, const MipLayout::Wide& wide, bool base) {
    const std::int32_t texels = (flags & kFloat) != 0 ? 2 : (flags & kLinear) != 0 ? 1 : 0;
    const bool whole = invocations(wide) % kWideGroup == glm::ivec2(0), two = wide.second >= 0;
    return {two, whole, base ? texels : 0, base && (flags & kNormals) != 0,
            base && two && texels != 2 && wide.source % 4 == 0};
}

}  // namespace

std::uint32_t mipLevelCount(std::uint32_t width, std::uint32_t height) {
    return std::uint32_t(std::bit_width(std::max(width, height)));
}

MipLayout::MipLayout(std::span<const glm::uvec4> textures, bool ripmaps) {
    // Chains of distinct texels: (how they are read, offset) -> first texture that uses them.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> chains;
    std::vector<std::uint32_t> firsts;
    table.resize(textures.size(), glm::uvec4(0, 1, 0, 0));
    for (std::uint32_t t = 0; t < textures.size(); ++t) {
        const glm::uvec4& header = textures[t];
        const std::uint32_t count = mipLevelCount(header.y, header.z);
        if ((header.w & kMipmaps) == 0 || count < 2) continue;
        const auto [place, isNew] =
            chains.try_emplace({header.w & (kFloat | kLinear | kNormals), header.x}, t);
        if (!isNew) {
            table[t] = table[place->second];
            continue;
        }
        table[t] = {std::uint32_t(table.size()), count, 0, 0};
        table.resize(table.size() + count - 1);
        if (ripmaps) {
            const auto across = std::uint32_t(std::bit_width(header.y)),
                       down = std::uint32_t(std::bit_width(header.z));
            table[t].z = std::uint32_t(table.size());
            table[t].w = across;
            table.resize(table.size() + std::size_t(across) * down);
        }
        firsts.push_back(t);
    }
    ripmaps ? layRipmaps(textures, firsts) : layMips(textures, firsts);
}

void MipLayout::checkTexels() const {
    if (texels > (1ull << 27))
        throw InputError("", "textures", fmt::format("mip levels need more than {} texels", 1u << 27),
                         "reduce their sizes");
}

void MipLayout::layMips(std::span<const glm::uvec4> textures, const std::vector<std::uint32_t>& chains) {
    struct Chain {
        std::uint32_t texture;
        Size size;
        std::uint64_t offset;  // of its newest level
        std::size_t two;       // of the wide work of the level before that makes the next too; kNone
    };
    std::vector<Chain> open;
    for (const std::uint32_t t : chains) open.push_back({t, {textures[t].y, textures[t].z}, 0, kNone});
    for (std::uint32_t level = 1; !open.empty(); ++level) {
        Level step{.firstItem = std::uint32_t(work.size() / 2)};
        std::uint64_t invocations = 0;
        for (Chain& chain : open) {
            const Size finer = chain.size, size = finer.half();
            const std::uint64_t count = std::uint64_t(size.width) * size.height;
            if (chain.two != kNone) {
                levels.back().wide[chain.two].second.second = std::int32_t(texels);
                chain.two = kNone;
            } else if (size.width >= kWideRow && count >= kWideTexels) {
                const glm::uvec4& header = textures[chain.texture];
                if (finer.width % 4 == 0 && finer.height % 4 == 0) chain.two = step.wide.size();
                step.wide.push_back({header.w,
                                     {.size = {size.width, size.height},
                                      .sourceSize = {finer.width, finer.height},
                                      .target = std::int32_t(texels),
                                      .source = std::int32_t(level == 1 ? header.x : chain.offset),
                                      .second = -1}});
            } else {
                work.emplace_back(std::uint32_t(invocations), std::uint32_t(texels), size.width, size.height);
                work.emplace_back(level == 1 ? chain.texture : std::uint32_t(chain.offset), finer.width,
                                  finer.height, 0);
                invocations += count;
                ++step.items;
            }
            table[table[chain.texture].x + level - 1] = {std::uint32_t(texels), size.width, size.height, 0};
            chain.size = size;
            chain.offset = texels;
            texels += count;
            checkTexels();
        }
        step.invocations = std::uint32_t(invocations);
        levels.push_back(std::move(step));
        std::erase_if(open,
                      [&](const Chain& chain) { return chain.size.width == 1 && chain.size.height == 1; });
    }
}

void MipLayout::layRipmaps(std::span<const glm::uvec4> textures, const std::vector<std::uint32_t>& chains) {
    // Level (i, j) is halved i times along x, j times along y: from (i, j - 1), or from (i - 1, 0). What is i
    // + j halvings away is made in step i + j.
    const auto levelOf = [&](std::uint32_t t, std::uint32_t i, std::uint32_t j) -> glm::uvec4& {
        return table[table[t].z + j * table[t].w + i];
    };
    bool open = !chains.empty();
    for (std::uint32_t sum = 1; open; ++sum) {
        Level step{.firstItem = std::uint32_t(work.size() / 2)};
        std::uint64_t invocations = 0;
        for (const std::uint32_t t : chains) {
            const std::uint32_t across = table[t].w, down = std::uint32_t(std::bit_width(textures[t].z));
            for (std::uint32_t j = 0; j < down && j <= sum; ++j) {
                const std::uint32_t i = sum - j;
                if (i >= across) continue;
                const Size finer{textures[t].y >> (j > 0 ? i : i - 1), textures[t].z >> (j > 0 ? j - 1 : 0)};
                const Size size{textures[t].y >> i, textures[t].z >> j};
                const std::uint32_t source = sum == 1 ? t
                                             : j > 0  ? levelOf(t, i, j - 1).x
                                                      : levelOf(t, i - 1, 0).x;
                work.emplace_back(std::uint32_t(invocations), std::uint32_t(texels), size.width, size.height);
                work.emplace_back(source, finer.width, finer.height, j > 0 ? kWholeX : kWholeY);
                levelOf(t, i, j) = {std::uint32_t(texels), size.width, size.height, 0};
                const std::uint64_t count = std::uint64_t(size.width) * size.height;
                invocations += count;
                texels += count;
                ++step.items;
                checkTexels();
            }
        }
        step.invocations = std::uint32_t(invocations);
        open = step.items > 0;
        if (open) levels.push_back(std::move(step));
    }
    for (const std::uint32_t t : chains) {
        const std::uint32_t across = table[t].w, down = std::uint32_t(std::bit_width(textures[t].z));
        for (std::uint32_t k = 1; k < table[t].y; ++k)
            table[table[t].x + k - 1] = levelOf(t, std::min(k, across - 1), std::min(k, down - 1));
    }
}

MipChains::MipChains(Device& device, std::span<const glm::uvec4> textures, bool ripmaps)
    : layout_(textures, ripmaps),
      table_(makeBuffer(device, "mip.table", atLeastOne(layout_.table))),
      work_(makeBuffer(device, "mip.work", atLeastOne(layout_.work))),
      mips_(device, "mip.levels", std::max<std::uint64_t>(layout_.texels, 1) * 16) {}

void MipChains::declareWide(Graph& graph, const std::vector<Binding>& textures, std::size_t level,
                            Buffer mips) {
    std::map<WideKind, std::vector<MipLayout::Wide>> kinds;
    for (const auto& [flags, wide] : layout_.levels[level].wide)
        kinds[wideKind(flags, wide, level == 0)].push_back(wide);
    for (const auto& [kind, list] : kinds) {
        const auto [two, whole, texels, normals, packed] = kind;
        SpecConstants spec = {{"TWO_LEVELS", two}, {"WHOLE_GROUPS", whole}};
        if (level == 0) spec["TEXELS"] = texels;
        if (level == 0) spec["NORMALS"] = normals;
        Pass pass = graph.compute(level == 0 ? "mip.base" : fmt::format("mip.level{}", level + 1),
                                  level > 0 ? shaders::mipDownWide
                                  : packed  ? shaders::mipBasePacked
                                            : shaders::mipBaseWide,
                                  {.spec = spec});
        if (level == 0)
            for (Binding binding : textures) {
                if (binding.name == "uTextures" || (packed && binding.name != "uTexels8")) continue;
                if (packed) binding.view = Format::RGBA32UI;
                pass.reads({binding});
            }
        pass.modifies({{"uMips", mips, Format::RGBA32F}}).record([list](Commands& c) {
            for (const MipLayout::Wide& wide : list) {
                // A dispatch has at most 65,535 workgroups of 8 rows.
                constexpr std::int32_t most = 1 << 18;
                const glm::ivec2 grid = invocations(wide);
                for (std::int32_t row = 0; row < grid.y; row += most)
                    c.push(WidePush{wide, row})
                        .dispatchOver(std::uint32_t(grid.x), std::uint32_t(std::min(most, grid.y - row)));
            }
        });
    }
}

void MipChains::declare(Graph& graph, const std::vector<Binding>& textures, const SpecConstants& spec) {
    if (!needed()) return;
    const Buffer work = graph.import(work_), mips = graph.import(mips_);
    for (std::size_t k = 0; k < layout_.levels.size(); ++k) {
        declareWide(graph, textures, k, mips);
        const MipLayout::Level& level = layout_.levels[k];
        if (level.items == 0) continue;
        Pass pass = k == 0 ? graph.compute("mip.base", shaders::mipBase, {.spec = spec})
                           : graph.compute(fmt::format("mip.level{}", k + 1), shaders::mipDown);
        if (k == 0)
            pass.reads(textures).writes({{"uMips", mips, Format::RGBA32F}});
        else
            pass.modifies({{"uMips", mips, Format::RGBA32F}});
        pass.reads({{"uMipWork", work}})
            .record([first = level.firstItem, items = level.items, all = level.invocations](Commands& c) {
                // A dispatch has at most 65,535 workgroups of 64.
                constexpr std::uint32_t most = 1u << 21;
                for (std::uint32_t done = 0; done < all; done += most)
                    c.push(MipPush{first, items, all, done}).dispatchInvocations(std::min(most, all - done));
            });
    }
}

std::vector<Binding> MipChains::bindings(Graph& graph) {
    return {{"uMipTable", graph.import(table_)}, {"uMips", graph.import(mips_)}};
}

}  // namespace helio
