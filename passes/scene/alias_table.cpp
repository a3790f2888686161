#include "passes/scene/alias_table.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

namespace helio {
std::vector<std::uint64_t> wholeShares(std::span<const double> weights) {
    constexpr double whole = 4294967296.0;
    const std::size_t n = weights.size();
    const double largest = *std::max_element(weights.begin(), weights.end());
    std::vector<std::uint64_t> result(n, 1);
    double total = 0;  // of weights over the largest: neither overflows nor vanishes
    for (double w : weights) total += largest > 0 ? w / largest : 1.0;
    std::int64_t left = std::int64_t(1) << 32;
    std::size_t greatest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double w = largest > 0 ? weights[i] / largest : 1.0;
        result[i] = w > 0 ? std::max<std::uint64_t>(1, std::uint64_t(w / total * whole)) : 0;
        left -= std::int64_t(result[i]);
        if (result[i] > result[greatest]) greatest = i;
    }
    if (left >= 0) {
        result[greatest] += std::uint64_t(left);
    } else {
        // Many entries were raised to 1: all others give a part of theirs.
        for (std::size_t i = 0; left < 0; i = (i + 1) % n) {
            const std::int64_t given = std::min<std::int64_t>(-left, std::int64_t(result[i] / 2));
            result[i] -= std::uint64_t(given);
            left += given;
        }
    }
    return result;
}

std::uint32_t aliasBits(std::size_t entries) {
    return std::max(1u, std::uint32_t(std::bit_width(entries - 1)));
}

AliasTable aliasTable(std::span<const double> weights) {
    assert(!weights.empty() && weights.size() <= (std::size_t(1) << 24));
    AliasTable table;
    table.bits = aliasBits(weights.size());
    std::vector<std::uint64_t> share = wholeShares(weights);
    for (std::uint64_t s : share) table.chance.push_back(std::ldexp(double(s), -32));
    const std::size_t slots = std::size_t(1) << table.bits;
    const std::uint64_t capacity = std::uint64_t(1) << (32 - table.bits);
    share.resize(slots, 0);
    table.slots.resize(slots);
    std::vector<std::uint32_t> small, large;
    for (std::uint32_t i = 0; i < slots; ++i) {
        table.slots[i] = {std::uint32_t(capacity), i};
        if (share[i] < capacity) small.push_back(i);
        if (share[i] > capacity) large.push_back(i);
    }
    // Shares are whole and their sum is that of the capacities: nothing is left over at the end.
    while (!large.empty()) {
        const std::uint32_t l = large.back(), s = small.back();
        small.pop_back();
        table.slots[s] = {std::uint32_t(share[s]), l};
        share[l] -= capacity - share[s];
        if (share[l] > capacity) continue;
        large.pop_back();
        if (share[l] < capacity) small.push_back(l);
    }
    assert(small.empty());
    return table;
}

}  // namespace helio
