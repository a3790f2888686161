#include "passes/scene/inversion_tree.hpp"

#include <algorithm>
#include <cassert>

namespace helio {

std::uint32_t inversionLevels(std::size_t entries) {
    std::uint32_t levels = 1;
    while (std::size_t(1) << 2 * levels < entries) ++levels;
    return levels;
}

InversionTree inversionTree(std::span<const std::uint64_t> shares) {
    assert(!shares.empty() && shares.size() <= (std::size_t(1) << 24));
    std::vector<std::uint64_t> first(shares.size() + 1, 0);
    for (std::size_t i = 0; i < shares.size(); ++i) first[i + 1] = first[i] + shares[i];
    assert(first.back() == std::uint64_t(1) << 32);
    InversionTree tree;
    tree.levels = inversionLevels(shares.size());
    for (std::uint32_t level = 0; level < tree.levels; ++level) {
        const std::uint32_t shift = 2 * (tree.levels - level);
        const std::size_t nodes = ((shares.size() - 1) >> shift) + 1, child = std::size_t(1) << (shift - 2);
        for (std::size_t n = 0; n < nodes; ++n) {
            std::array<std::uint32_t, 4>& node = tree.nodes.emplace_back();
            for (std::size_t c = 1; c < 4; ++c) {
                const std::size_t entry = (n << shift) + c * child;
                node[c - 1] = entry < shares.size()
                                  ? std::uint32_t(std::min<std::uint64_t>(first[entry], 0xffffffffu))
                                  : 0xffffffffu;
            }
        }
    }
    return tree;
}

}  // namespace helio
