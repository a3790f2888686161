#include "engine/graph/compile.hpp"

#include <algorithm>
#include <cassert>
#include <map>

namespace helio::graph {
namespace {

std::uint64_t roundUp(std::uint64_t value, std::uint64_t unit) {
    return (value + unit - 1) / unit * unit;
}
std::uint64_t roundDown(std::uint64_t value, std::uint64_t unit) {
    return value / unit * unit;
}

struct Layouted {
    std::vector<Arena> arenas;
    std::vector<Placement> placements;
    std::uint64_t bytes = 0;
};

class Placer {
public:
    explicit Placer(const Input& input) : input_(input) {}

    /** Places in the order given; each resource at the lowest free offset of the first arena that takes it.
     */
    Layouted place(const std::vector<Placement>& order) const {
        Layouted result;
        for (Placement item : order) {
            const ResourceInput& resource = input_.resources[item.resource];
            for (item.arena = 0;; ++item.arena) {
                if (item.arena == result.arenas.size()) result.arenas.push_back({resource.memoryClass, 0});
                Arena& arena = result.arenas[item.arena];
                if (arena.memoryClass != resource.memoryClass) continue;
                item.offset = lowestOffset(item, result.placements);
                const std::uint64_t end = item.offset + item.bytes;
                // An arena of its own always takes a resource: validate() refused larger ones.
                if (end > input_.limits.maxArenaBytes && arena.bytes > 0) continue;
                arena.bytes = std::max(arena.bytes, end);
                break;
            }
            result.placements.push_back(item);
        }
        for (const Arena& arena : result.arenas) result.bytes += arena.bytes;
        return result;
    }

private:
    /** The gaps between placed resources whose lives meet this one's, first fit. */
    std::uint64_t lowestOffset(const Placement& item, const std::vector<Placement>& placed) const {
        const ResourceInput& resource = input_.resources[item.resource];
        std::vector<std::pair<std::uint64_t, std::uint64_t>> taken;
        for (const Placement& other : placed) {
            if (other.arena != item.arena) continue;
            const bool apart = other.last < item.first || item.last < other.first;
            if (apart && input_.alias) continue;
            // Linear and tiled resources in use at once must not meet in one page of bufferImageGranularity.
            const std::uint64_t page = input_.resources[other.resource].kind == resource.kind
                                           ? 1
                                           : input_.limits.bufferImageGranularity;
            taken.emplace_back(roundDown(other.offset, page), roundUp(other.offset + other.bytes, page));
        }
        std::sort(taken.begin(), taken.end());
        std::uint64_t cursor = 0;
        for (const auto& [begin, end] : taken) {
            if (roundUp(cursor, resource.alignment) + item.bytes <= begin) break;
            cursor = std::max(cursor, end);
        }
        return roundUp(cursor, resource.alignment);
    }

    const Input& input_;
};

}  // namespace

void place(const Input& input, Compiled& compiled) {
    std::map<std::uint32_t, Placement> live;
    for (std::uint32_t i = 0; i < compiled.steps.size(); ++i) {
        for (const Use& use : compiled.steps[i].uses) {
            const ResourceInput& resource = input.resources[use.resource];
            if (resource.imported) continue;
            auto [entry, isNew] = live.try_emplace(
                use.resource, Placement{.resource = use.resource, .bytes = resource.memoryBytes, .first = i});
            entry->second.last = i;
        }
    }
    std::vector<Placement> items;
    for (const auto& [resource, placement] : live) {
        items.push_back(placement);
        compiled.aliasing.transientBytes += placement.bytes;
    }

    const auto life = [](const Placement& p) { return p.last - p.first; };
    const Placer placer(input);
    std::stable_sort(items.begin(), items.end(), [&](const Placement& a, const Placement& b) {
        return a.bytes != b.bytes ? a.bytes > b.bytes : life(a) > life(b);
    });
    Layouted best = placer.place(items);
    std::stable_sort(items.begin(), items.end(), [&](const Placement& a, const Placement& b) {
        return life(a) != life(b) ? life(a) > life(b) : a.bytes > b.bytes;
    });
    if (Layouted other = placer.place(items); other.bytes < best.bytes) best = std::move(other);

    std::sort(best.placements.begin(), best.placements.end(),
              [](const Placement& a, const Placement& b) { return a.resource < b.resource; });
    compiled.arenas = std::move(best.arenas);
    compiled.placements = std::move(best.placements);
    compiled.aliasing.allocatedBytes = best.bytes;
}

}  // namespace helio::graph
