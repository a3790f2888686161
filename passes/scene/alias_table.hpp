#pragma once
/** @file Discrete distributions in integers, so that the chances the device reckons with are those it draws
 * by. */
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace helio {

/** Shares of 2^32 in proportion to the weights, which are finite and not negative: rounded down, at least 1
 * where the weight is positive, and what is left over goes to the largest. All weights zero: equal shares. */
std::vector<std::uint64_t> wholeShares(std::span<const double> weights);

/** One slot: with f the bits below those that chose the slot, the slot's own entry is taken where f <
 * threshold, else `alias`. */
struct AliasSlot {
    std::uint32_t threshold = 0;
    std::uint32_t alias = 0;
};

/**
 * Walker's alias method (Vose 1991) over 32 random bits x: the upper `bits` choose one of 2^bits slots, the
 * other 32 - bits are compared with its threshold. Every entry has a whole number of the 2^32 values of x, at
 * least one where its weight is positive: `chance` is exact, however many entries there are and however far
 * apart their weights lie. Slots beyond the entries are filler.
 */
struct AliasTable {
    std::uint32_t bits = 1;
    std::vector<AliasSlot> slots;  ///< 2^bits
    std::vector<double> chance;    ///< per entry; a multiple of 2^-32
};

/** Weights are finite and not negative. All zero: every entry has the same chance. At most 2^24 entries. */
AliasTable aliasTable(std::span<const double> weights);

/** Bits that choose a slot for `entries` entries, at least 1. */
std::uint32_t aliasBits(std::size_t entries);

}  // namespace helio
