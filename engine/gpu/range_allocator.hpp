#pragma once
/** @file Ranges within one span of memory, host-side bookkeeping only. */
#include <cstdint>
#include <map>
#include <optional>
#include <set>

namespace helio::gpu {

/** Hands out aligned, disjoint ranges of [0, size). Best fit (smallest free range that holds the request,
 * lowest offset among equals), neighbours merge when freed. Logarithmic in the number of free ranges, except
 * that alignment may make it try several. */
class RangeAllocator {
public:
    explicit RangeAllocator(std::uint64_t size);

    /** Offset of a range of `bytes` > 0 at a multiple of `alignment` (a power of two), or nothing when it
     * does not fit. */
    std::optional<std::uint64_t> allocate(std::uint64_t bytes, std::uint64_t alignment);
    /** Gives back exactly a range that allocate() returned. */
    void free(std::uint64_t offset, std::uint64_t bytes);

    std::uint64_t size() const { return size_; }
    std::uint64_t freeBytes() const { return freeBytes_; }
    bool empty() const { return freeBytes_ == size_; }
    std::uint64_t largestFree() const { return bySize_.empty() ? 0 : bySize_.rbegin()->first; }

private:
    void insert(std::uint64_t offset, std::uint64_t bytes);
    void erase(std::uint64_t offset, std::uint64_t bytes);

    std::uint64_t size_;
    std::uint64_t freeBytes_ = 0;
    std::map<std::uint64_t, std::uint64_t> byOffset_;           // offset -> bytes, of free ranges
    std::set<std::pair<std::uint64_t, std::uint64_t>> bySize_;  // (bytes, offset)
};

}  // namespace helio::gpu
