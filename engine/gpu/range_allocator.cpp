#include "engine/gpu/range_allocator.hpp"

#include <cassert>
#include <iterator>

namespace helio::gpu {

RangeAllocator::RangeAllocator(std::uint64_t size) : size_(size) {
    if (size > 0) insert(0, size);
}

std::optional<std::uint64_t> RangeAllocator::allocate(std::uint64_t bytes, std::uint64_t alignment) {
    assert(bytes > 0 && alignment > 0 && (alignment & (alignment - 1)) == 0);
    for (auto it = bySize_.lower_bound({bytes, 0}); it != bySize_.end(); ++it) {
        const auto [rangeBytes, rangeOffset] = *it;
        const std::uint64_t offset = (rangeOffset + alignment - 1) & ~(alignment - 1);
        const std::uint64_t padding = offset - rangeOffset;
        if (padding > rangeBytes - bytes) continue;
        erase(rangeOffset, rangeBytes);
        if (padding > 0) insert(rangeOffset, padding);
        const std::uint64_t rest = rangeBytes - padding - bytes;
        if (rest > 0) insert(offset + bytes, rest);
        return offset;
    }
    return std::nullopt;
}

void RangeAllocator::free(std::uint64_t offset, std::uint64_t bytes) {
    assert(bytes > 0 && offset + bytes <= size_);
    auto next = byOffset_.lower_bound(offset);
    assert(next == byOffset_.end() || offset + bytes <= next->first);
    if (next != byOffset_.begin()) {
        const auto previous = std::prev(next);
        assert(previous->first + previous->second <= offset);
        if (previous->first + previous->second == offset) {
            offset = previous->first;
            bytes += previous->second;
            erase(previous->first, previous->second);
        }
    }
    next = byOffset_.lower_bound(offset + bytes);
    if (next != byOffset_.end() && next->first == offset + bytes) {
        const std::uint64_t nextBytes = next->second;
        erase(next->first, nextBytes);
        bytes += nextBytes;
    }
    insert(offset, bytes);
}

void RangeAllocator::insert(std::uint64_t offset, std::uint64_t bytes) {
    byOffset_.emplace(offset, bytes);
    bySize_.emplace(bytes, offset);
    freeBytes_ += bytes;
}

void RangeAllocator::erase(std::uint64_t offset, std::uint64_t bytes) {
    byOffset_.erase(offset);
    bySize_.erase({bytes, offset});
    freeBytes_ -= bytes;
}

}  // namespace helio::gpu
