#pragma once
/** @file The inverse of a cumulative distribution, as a tree that a kernel goes down without a loop. */
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace helio {

/**
 * Entries in a row, each with a whole number of the 2^32 values of a random word, in order: entry i has those
 * from the sum of the shares before it on. So equal distances of the word are equal chances of what it draws,
 * and words that are spread evenly (a low-discrepancy sequence) draw entries evenly, which an alias table
 * does not keep.
 *
 * A node has four children and three first words, of its second to fourth child; a fourth number is unused.
 * Level 0 is the root; level l of L has ceil(entries / 4^(L - l)) nodes, one level after the other; a child
 * of the last level is an entry. First words of what lies behind the last entry are 2^32 - 1: that entry's
 * share ends one word early.
 */
struct InversionTree {
    std::uint32_t levels = 1;
    std::vector<std::array<std::uint32_t, 4>> nodes;
};

/** Levels of a tree over so many entries, at least 1. */
std::uint32_t inversionLevels(std::size_t entries);

/** Shares add up to 2^32; 1 to 2^24 of them. */
InversionTree inversionTree(std::span<const std::uint64_t> shares);

}  // namespace helio
