#pragma once
/** @file Loops over the elements of large lists, in blocks side by side. */
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstddef>
#include <functional>

namespace helio {

/** Elements that are worth a task of their own. */
inline constexpr std::size_t kBlock = 8192;

/** Calls body(begin, end) for blocks that make up [0, count). */
template <class Body>
void forBlocks(std::size_t count, Body&& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kBlock),
                      [&](const auto& range) { body(range.begin(), range.end()); });
}

/** The least i below `count` for which predicate(i) holds; `count` for none. */
template <class Predicate>
std::size_t firstWhere(std::size_t count, Predicate&& predicate) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, count, kBlock), count,
        [&](const auto& range, std::size_t first) {
            for (std::size_t i = range.begin(); i < std::min(range.end(), first); ++i) {
                if (predicate(i)) return i;
            }
            return first;
        },
        [](std::size_t left, std::size_t right) { return std::min(left, right); });
}

/** How many i below `count` predicate(i) holds for. */
template <class Predicate>
std::size_t countWhere(std::size_t count, Predicate&& predicate) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, count, kBlock), std::size_t(0),
        [&](const auto& range, std::size_t sum) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) sum += predicate(i) ? 1 : 0;
            return sum;
        },
        std::plus<>());
}

}  // namespace helio
