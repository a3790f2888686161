#include "passes/scene/light_tables.hpp"

#include "passes/scene/alias_table.hpp"
#include "passes/scene/light_tree.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <queue>

namespace helio::pack {
namespace {

constexpr std::size_t kSamplesPerTable = 6;
constexpr std::size_t kMostSlots = std::size_t(1) << 22;  // 64 MB
constexpr int kFinestGrid = 40;                           // cells along the longest side

/** Cells and axes in which there are surfaces, and some places on these. */
class Places {
public:
    Places(std::span<const glm::vec3> positions, int cells) {
        glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
        for (const glm::vec3& p : positions) {
            lower = glm::min(lower, glm::dvec3(p));
            upper = glm::max(upper, glm::dvec3(p));
        }
        const glm::dvec3 extent = upper - lower;
        const double longest = std::max({extent.x, extent.y, extent.z});
        side_ = longest / cells;
        if (!(side_ > 0) || !std::isfinite(1.0 / float(side_))) return;
        origin = glm::vec3(lower);
        scale = float(1.0 / side_);
        size = glm::max(glm::ivec3(glm::ceil(extent / side_ * 1.0001)), glm::ivec3(1));
        number_.assign(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) * 6, 0);
        for (std::size_t i = 0; i + 2 < positions.size(); i += 3) addTriangle(&positions[i]);
    }

    glm::ivec3 size{0};
    glm::vec3 origin{0.0f};
    float scale = 0;
    /** Per table from 1 on. */
    std::vector<std::array<SurfaceSample, kSamplesPerTable>> samples{{}};
    std::vector<std::uint32_t> counts{0};
    std::vector<std::uint32_t> takeNumbers() { return std::move(number_); }

private:
    void addTriangle(const glm::vec3* corners) {
        const glm::dvec3 a(corners[0]), e1 = glm::dvec3(corners[1]) - a, e2 = glm::dvec3(corners[2]) - a;
        const glm::dvec3 across = glm::cross(e1, e2);
        const double area = glm::length(across);
        if (!(area > 0)) return;
        const glm::dvec3 normal = across / area;
        const double edge = std::max({glm::length(e1), glm::length(e2), glm::distance(e1, e2)});
        const int steps = std::clamp(int(std::ceil(2.0 * edge / side_)), 1, 200);
        for (int y = 0; y < steps; ++y)
            for (int x = 0; x + y < steps; ++x) {
                const double u = (x + 1.0 / 3.0) / steps, v = (y + 1.0 / 3.0) / steps;
                add(a + u * e1 + v * e2, normal);
            }
        for (const auto& [u, v] : {std::pair{0.01, 0.01}, {0.98, 0.01}, {0.01, 0.98}})
            add(a + u * e1 + v * e2, normal);
    }

    void add(const glm::dvec3& p, const glm::dvec3& normal) {
        const glm::ivec3 cell =
            glm::clamp(glm::ivec3((p - glm::dvec3(origin)) * double(scale)), glm::ivec3(0), size - 1);
        const std::size_t base =
            ((std::size_t(cell.z) * std::size_t(size.y) + std::size_t(cell.y)) * std::size_t(size.x) +
             std::size_t(cell.x)) *
            6;
        // Surfaces scatter on both faces.
        for (double side : {1.0, -1.0}) {
            const glm::dvec3 n = normal * side, m = glm::abs(n);
            const glm::length_t axis = m.x > m.y && m.x > m.z ? 0 : m.y > m.z ? 1 : 2;
            std::uint32_t& table = number_[base + std::size_t(axis) * 2 + (n[axis] > 0 ? 0 : 1)];
            if (table == 0) {
                table = std::uint32_t(samples.size());
                samples.emplace_back();
                counts.push_back(0);
            }
            const std::uint32_t seen = counts[table]++;
            // A reservoir whose choices are a fixed function of the count.
            const std::size_t place = seen < kSamplesPerTable ? seen : (seen * 2654435761u >> 8) % (seen + 1);
            if (place < kSamplesPerTable) samples[table][place] = {p, n};
        }
    }

    double side_ = 0;
    std::vector<std::uint32_t> number_;
};

/** The estimate of one node, over the places of a table. */
class Estimate {
public:
    Estimate(std::span<const SurfaceSample> samples, const AxisIrradiance& environment)
        : samples_(samples), environment_(environment) {}
    double operator()(const LightSource& light) const {
        double sum = 0;
        for (const SurfaceSample& at : samples_) sum += estimatedIrradiance(light, at, environment_);
        return sum / double(samples_.size());
    }
    /** How coarse a node is as seen from here: its estimate times the square of its angular size. */
    double coarseness(const LightNode& node, double estimate) const {
        if (node.left < 0) return -1.0;
        double sum = 0;
        for (const SurfaceSample& at : samples_) {
            const glm::dvec3 way = node.bound.centre - at.position;
            const double r = node.bound.radius * node.bound.radius;
            sum += r / std::max(glm::dot(way, way) + 0.25 * r, 1e-300);
        }
        return estimate * sum;
    }

private:
    std::span<const SurfaceSample> samples_;
    const AxisIrradiance& environment_;
};

struct CutEntry {
    double priority = 0, weight = 0;
    std::int32_t node = -1;
    bool operator<(const CutEntry& other) const {
        return priority != other.priority ? priority < other.priority : node < other.node;
    }
};

/** Nodes for one table: the coarsest is split until there are kCutEntries. In order of their lights. */
template <typename Weigh>
std::vector<CutEntry> cut(const LightTree& tree, const Weigh& weigh) {
    std::priority_queue<CutEntry> open;
    for (std::int32_t root : tree.roots()) open.push(weigh(root));
    while (open.size() < kCutEntries && open.top().priority >= 0) {
        const LightNode& node = tree.nodes()[std::size_t(open.top().node)];
        open.pop();
        open.push(weigh(node.left));
        open.push(weigh(node.right));
    }
    std::vector<CutEntry> entries;
    for (; !open.empty(); open.pop()) entries.push_back(open.top());
    std::ranges::sort(entries, {},
                      [&](const CutEntry& e) { return tree.nodes()[std::size_t(e.node)].first; });
    return entries;
}

void storeTable(LightTables& tables, std::size_t number, std::span<const double> weights) {
    const AliasTable alias = aliasTable(weights);
    // Fewer entries than slots: chances are those of a table of this size.
    const std::size_t slots = std::size_t(1) << tables.bits;
    const auto chance = [&](std::uint32_t i) {
        return glm::floatBitsToUint(i < alias.chance.size() ? float(alias.chance[i]) : 0.0f);
    };
    for (std::size_t i = 0; i < slots; ++i) {
        const AliasSlot& slot = alias.slots[i];
        tables.slots[number * slots + i] = {slot.threshold, slot.alias, chance(std::uint32_t(i)),
                                            chance(slot.alias)};
    }
}

}  // namespace

LightTables lightTables(std::span<const LightSource> lights, std::span<const glm::vec3> positions,
                        const AxisIrradiance& environment, bool adaptive) {
    LightTables tables;
    const LightTree tree(lights);
    tables.order = tree.order();
    tables.cuts = lights.size() > kDirectLights;
    tables.bits = tables.cuts ? std::uint32_t(std::bit_width(kCutEntries - 1)) : aliasBits(lights.size());
    const std::size_t slots = std::size_t(1) << tables.bits;

    int resolution = kFinestGrid;
    Places places(adaptive ? positions : std::span<const glm::vec3>(), resolution);
    while (places.samples.size() * slots > kMostSlots && resolution > 4) {
        resolution = resolution * 3 / 4;
        places = Places(positions, resolution);
    }
    const std::size_t count = places.samples.size();
    tables.slots.resize(count * slots);
    tables.size = places.size;
    tables.origin = places.origin;
    tables.scale = places.scale;
    tables.cells = places.takeNumbers();

    const auto mass = [&](const LightSource& light) { return adaptive ? light.power : 1.0; };
    const std::size_t n = lights.size();
    if (tables.cuts) {
        std::vector<double> masses;
        for (std::uint32_t i : tables.order) masses.push_back(mass(lights[i]));
        const AliasTable shares = aliasTable(masses);
        std::uint64_t sum = 0;
        tables.ranges.push_back(0);
        for (double chance : shares.chance) {
            sum += std::uint64_t(std::ldexp(chance, 32));
            tables.ranges.push_back(std::uint32_t(std::min<std::uint64_t>(sum, 0xffffffffu)));
        }
        tables.ranges.resize(n + 1 + count * kCutEntries, std::uint32_t(n));
    }
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t number) {
        const std::size_t seen = std::min<std::size_t>(places.counts[number], kSamplesPerTable);
        const Estimate estimate(std::span(places.samples[number]).first(seen), environment);
        const auto weight = [&](const LightNode& node) {
            if (number > 0) return estimate(node.bound);
            return adaptive ? node.bound.power : double(node.end - node.first);
        };
        std::vector<double> weights;
        if (tables.cuts) {
            const auto entries = cut(tree, [&](std::int32_t index) {
                const LightNode& node = tree.nodes()[std::size_t(index)];
                const double w = weight(node);
                return CutEntry{number > 0      ? estimate.coarseness(node, w)
                                : node.left < 0 ? -1.0
                                                : w,
                                w, index};
            });
            for (std::size_t e = 0; e < entries.size(); ++e) {
                weights.push_back(entries[e].weight);
                tables.ranges[n + 1 + number * kCutEntries + e] =
                    tree.nodes()[std::size_t(entries[e].node)].first;
            }
            weights.resize(kCutEntries, 0.0);
        } else {
            for (std::uint32_t i : tables.order) {
                const LightNode single{0, 1, -1, -1, lights[i]};
                weights.push_back(weight(single));
            }
        }
        storeTable(tables, number, weights);
    });
    return tables;
}

}  // namespace helio::pack
