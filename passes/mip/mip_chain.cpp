#include "passes/mip/mip_chain.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/mip.hpp>

#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <utility>

namespace helio {
namespace {

// As in shaders/scene/textures.glsl.
constexpr std::uint32_t kFloat = 1u << 5;
constexpr std::uint32_t kMipmaps = 1u << 6;

struct Size {
    std::uint32_t width, height;
    Size half() const { return {std::max(width / 2, 1u), std::max(height / 2, 1u)}; }
};

/** A buffer is never empty. */
std::vector<glm::uvec4> atLeastOne(std::vector<glm::uvec4> values) {
    if (values.empty()) values.emplace_back(0u);
    return values;
}

/** Push constants of both kernels. */
struct MipPush {
    MipLayout::Level level;
    std::uint32_t firstInvocation;
};

}  // namespace

std::uint32_t mipLevelCount(std::uint32_t width, std::uint32_t height) {
    return std::uint32_t(std::bit_width(std::max(width, height)));
}

MipLayout::MipLayout(std::span<const glm::uvec4> textures) {
    // Chains of distinct texels: (stored as floats, offset) -> first texture that uses them.
    std::map<std::pair<bool, std::uint32_t>, std::uint32_t> chains;
    struct Chain {
        std::uint32_t texture;
        Size size;
        std::uint64_t offset;  // of its newest level
    };
    std::vector<Chain> open;
    table.resize(textures.size(), glm::uvec4(0, 1, 0, 0));
    for (std::uint32_t t = 0; t < textures.size(); ++t) {
        const glm::uvec4& header = textures[t];
        const std::uint32_t count = mipLevelCount(header.y, header.z);
        if ((header.w & kMipmaps) == 0 || count < 2) continue;
        const auto [place, isNew] = chains.try_emplace({(header.w & kFloat) != 0, header.x}, t);
        if (!isNew) {
            table[t] = table[place->second];
            continue;
        }
        table[t] = {std::uint32_t(table.size()), count, 0, 0};
        table.resize(table.size() + count - 1);
        open.push_back({t, {header.y, header.z}, 0});
    }
    for (std::uint32_t level = 1; !open.empty(); ++level) {
        Level step{std::uint32_t(work.size() / 2), 0, 0};
        std::uint64_t invocations = 0;
        for (Chain& chain : open) {
            const Size finer = chain.size, size = finer.half();
            const std::uint64_t count = std::uint64_t(size.width) * size.height;
            work.emplace_back(std::uint32_t(invocations), std::uint32_t(texels), size.width, size.height);
            work.emplace_back(level == 1 ? chain.texture : std::uint32_t(chain.offset), finer.width,
                              finer.height, 0);
            table[table[chain.texture].x + level - 1] = {std::uint32_t(texels), size.width, size.height, 0};
            chain.size = size;
            chain.offset = texels;
            invocations += count;
            texels += count;
            ++step.items;
            if (texels > (1ull << 27))
                throw InputError("", "textures", fmt::format("mip levels need more than {} texels", 1u << 27),
                                 "reduce their sizes");
        }
        step.invocations = std::uint32_t(invocations);
        levels.push_back(step);
        std::erase_if(open,
                      [&](const Chain& chain) { return chain.size.width == 1 && chain.size.height == 1; });
    }
}

MipChains::MipChains(Device& device, std::span<const glm::uvec4> textures)
    : layout_(textures),
      table_(makeBuffer(device, "mip.table", atLeastOne(layout_.table))),
      work_(makeBuffer(device, "mip.work", atLeastOne(layout_.work))),
      mips_(device, "mip.levels", std::max<std::uint64_t>(layout_.texels, 1) * 16) {}

void MipChains::declare(Graph& graph, const std::vector<Binding>& textures, const SpecConstants& spec) {
    if (!needed()) return;
    const Buffer work = graph.import(work_), mips = graph.import(mips_);
    for (std::size_t k = 0; k < layout_.levels.size(); ++k) {
        const MipLayout::Level level = layout_.levels[k];
        Pass pass = k == 0 ? graph.compute("mip.base", shaders::mipBase, {.spec = spec})
                           : graph.compute(fmt::format("mip.level{}", k + 1), shaders::mipDown);
        if (k == 0) pass.reads(textures);
        pass.reads({{"uMipWork", work}}).record([level](Commands& c) {
            // A dispatch has at most 65,535 workgroups of 64.
            constexpr std::uint32_t most = 1u << 21;
            for (std::uint32_t first = 0; first < level.invocations; first += most)
                c.push(MipPush{level, first}).dispatchInvocations(std::min(most, level.invocations - first));
        });
        if (k == 0)
            pass.writes({{"uMips", mips, Format::RGBA32F}});
        else
            pass.modifies({{"uMips", mips, Format::RGBA32F}});
    }
}

std::vector<Binding> MipChains::bindings(Graph& graph) {
    return {{"uMipTable", graph.import(table_)}, {"uMips", graph.import(mips_)}};
}

}  // namespace helio
