#include "passes/pathtrace/guide_tables.hpp"

#include "passes/scene/alias_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace helio {
namespace {

constexpr int kGridLevels = 6;
static_assert(kGuideCells == 1 << kGridLevels);
/** Photons of a table beyond which its cells are parted, and below which they are not worth a table. */
constexpr std::size_t kPartedFrom = 1024, kLeastPhotons = 8;
/** See shareOf(): the caustic counts for more than its irradiance, since tables do not know it exactly. */
constexpr double kTrust = 8;
constexpr float kLeastShare = 0.1f;
/** Of the length of k (x - c). */
constexpr double kLargestOffset = 0.7;
constexpr std::size_t kGuideBins = std::size_t(1) << kGuideBits;
static_assert(kGuideSide * kGuideSide == kGuideBins);

using GuideHistogram = std::array<double, kGuideBins>;

/** The place of a direction on the octahedral map, in bins. */
glm::dvec2 octahedral(const glm::dvec3& w) {
    const double size = std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
    glm::dvec2 at(w.x / size, w.y / size);
    if (w.z < 0)
        at = {(1 - std::abs(w.y / size)) * (w.x < 0 ? -1 : 1),
              (1 - std::abs(w.x / size)) * (w.y < 0 ? -1 : 1)};
    return (at * 0.5 + 0.5) * double(kGuideSide);
}

std::uint32_t axisOf(const glm::vec3& n) {
    const glm::vec3 m = glm::abs(n);
    if (m.x > m.y && m.x > m.z) return n.x > 0 ? 0 : 1;
    if (m.y > m.z) return n.y > 0 ? 2 : 3;
    return n.z > 0 ? 4 : 5;
}

std::uint32_t mortonBits(std::uint32_t x) {
    std::uint32_t bits = 0;
    for (int i = 0; i < kGridLevels; ++i) bits |= (x >> i & 1u) << (3 * i);
    return bits;
}

struct SortedPhoton {
    std::uint32_t key = 0;  ///< axis, then the cell's Morton code
    std::uint32_t record = 0;
};

class GuideTableBuilder {
public:
    GuideTableBuilder(std::span<const PhotonRecord> records, float share, GuideTables& tables)
        : records_(records), share_(share), tables_(tables) {}

    void build() {
        if (!chooseGrid()) return;
        tables_.cells.assign(
            std::size_t(tables_.size.x) * std::size_t(tables_.size.y) * std::size_t(tables_.size.z) * 6,
            glm::uvec4(0));
        for (std::uint32_t axis = 0; axis < 6; ++axis) {
            const auto first =
                std::ranges::lower_bound(photons_, axis << 3 * kGridLevels, {}, &SortedPhoton::key);
            const auto last =
                std::ranges::lower_bound(photons_, (axis + 1) << 3 * kGridLevels, {}, &SortedPhoton::key);
            part(std::span(first, last), axis, glm::ivec3(0), kGridLevels, glm::uvec4(0));
        }
    }

private:
    bool chooseGrid() {
        glm::dvec3 lower(1e300), upper(-1e300);
        std::vector<std::uint32_t> kept;
        double sum = 0, direct = 0;
        for (std::size_t i = 0; i < records_.size(); ++i) {
            const PhotonRecord& r = records_[i];
            const glm::vec3 all = r.position + r.direction + r.normal;
            if (!(r.flux > 0) || !std::isfinite(r.flux) || !std::isfinite(all.x + all.y + all.z)) continue;
            kept.push_back(std::uint32_t(i));
            sum += double(r.flux);
            direct += std::isfinite(r.direct) ? double(r.direct) : 0.0;
            lower = glm::min(lower, glm::dvec3(r.position));
            upper = glm::max(upper, glm::dvec3(r.position));
        }
        tables_.kept = kept.size();
        if (kept.size() < kLeastPhotons) return false;
        const glm::dvec3 sides = upper - lower;
        const double longest = std::max({sides.x, sides.y, sides.z, 1e-30});
        tables_.scale = float(kGuideCells / longest * (1 - 1e-3));
        // Cells begin and end a little before and behind the photons, whatever rounding does.
        tables_.origin = glm::vec3(lower - 1e-3 * longest / kGuideCells);
        if (!std::isfinite(tables_.scale) || !(tables_.scale > 0)) return false;
        for (int i = 0; i < 3; ++i)
            tables_.size[i] = std::clamp(int(sides[i] * tables_.scale) + 1, 1, kGuideCells);
        most_ = 8 * sum / double(kept.size());
        irradiance_ = direct / double(kept.size());
        for (const std::uint32_t i : kept) {
            const glm::vec3 at = (records_[i].position - tables_.origin) * tables_.scale;
            const glm::ivec3 c = glm::clamp(glm::ivec3(at), glm::ivec3(0), tables_.size - 1);
            const std::uint32_t morton = mortonBits(std::uint32_t(c.x)) |
                                         mortonBits(std::uint32_t(c.y)) << 1 |
                                         mortonBits(std::uint32_t(c.z)) << 2;
            photons_.push_back({axisOf(records_[i].normal) << 3 * kGridLevels | morton, i});
        }
        std::ranges::sort(photons_, {},
                          [](const SortedPhoton& p) { return std::uint64_t(p.key) << 32 | p.record; });
        return true;
    }

    /** Gives the cells from `cell` on, 2^level each way, their tables; `above`: that of the cells around. */
    void part(std::span<const SortedPhoton> photons, std::uint32_t axis, glm::ivec3 cell, int level,
              glm::uvec4 above) {
        if (photons.empty() || glm::any(glm::greaterThanEqual(cell, tables_.size))) return;
        if (level > 0 && photons.size() > kPartedFrom && tables_.tables + 1 < kMostGuideTables) {
            const std::uint32_t bits = 3 * std::uint32_t(level - 1);
            std::array<std::span<const SortedPhoton>, 8> children;
            bool someAreFew = false;
            for (std::uint32_t k = 0; k < 8; ++k) {
                const auto of = [&](const SortedPhoton& p) { return p.key >> bits & 7u; };
                children[k] = std::span(std::ranges::lower_bound(photons, k, {}, of),
                                        std::ranges::upper_bound(photons, k, {}, of));
                someAreFew |= !children[k].empty() && children[k].size() < kLeastPhotons;
            }
            if (someAreFew) above = addTable(photons, cell, level);
            for (std::uint32_t k = 0; k < 8; ++k)
                part(children[k], axis, cell + (glm::ivec3(k & 1, k >> 1 & 1, k >> 2 & 1) << (level - 1)),
                     level - 1, above);
            return;
        }
        const bool own = photons.size() >= kLeastPhotons && tables_.tables < kMostGuideTables;
        const glm::uvec4 table = own ? addTable(photons, cell, level) : above;
        const glm::ivec3 end = glm::min(cell + (1 << level), tables_.size);
        for (int z = cell.z; z < end.z; ++z)
            for (int y = cell.y; y < end.y; ++y)
                for (int x = cell.x; x < end.x; ++x)
                    tables_.cells[std::size_t(
                        ((int(axis) * tables_.size.z + z) * tables_.size.y + y) * tables_.size.x + x)] =
                        table;
    }

    GuideHistogram histogram(std::span<const SortedPhoton> photons, const glm::dvec3& centre,
                             double k) const {
        GuideHistogram bins{};
        for (const SortedPhoton& photon : photons) {
            const PhotonRecord& r = records_[photon.record];
            const glm::dvec3 w =
                seenFromCentre(glm::dvec3(r.direction), (glm::dvec3(r.position) - centre) * k);
            // Shared with the bins that are near: what few photons missed is found there too.
            const glm::dvec2 at = octahedral(w) - 0.5;
            const glm::dvec2 base = glm::floor(at), f = at - base;
            const double flux = std::min(double(r.flux), most_);
            for (int i = 0; i < 4; ++i) {
                const int x = std::clamp(int(base.x) + (i & 1), 0, int(kGuideSide) - 1);
                const int y = std::clamp(int(base.y) + (i >> 1), 0, int(kGuideSide) - 1);
                bins[std::size_t(y) * kGuideSide + std::size_t(x)] +=
                    flux * ((i & 1) != 0 ? f.x : 1 - f.x) * ((i >> 1) != 0 ? f.y : 1 - f.y);
            }
        }
        return bins;
    }

    /** Share of guided directions where photons bring this irradiance. Of a caustic C that tables know and
     * light S that they do not, C^2 / share + S^2 / (1 - share) is least at C / (C + S). */
    float shareOf(double caustic) const {
        const double wanted = kTrust * caustic / (kTrust * caustic + irradiance_);
        return std::isfinite(wanted) ? std::clamp(float(wanted), kLeastShare, share_) : kLeastShare;
    }

    /** Adds a table of what these photons say; returns the texel of its cells. */
    glm::uvec4 addTable(std::span<const SortedPhoton> photons, glm::ivec3 cell, int level) {
        const double side = double(1 << level) / double(tables_.scale);
        const glm::dvec3 centre = glm::dvec3(tables_.origin) +
                                  (glm::dvec3(cell) + 0.5 * double(1 << level)) / double(tables_.scale);
        double distance = 0, sum = 0;
        for (const SortedPhoton& photon : photons) {
            const PhotonRecord& r = records_[photon.record];
            distance += double(r.flux) * std::max(double(r.distance), 1e-30);
            sum += double(r.flux);
        }
        // Of some depths the one that brings the photons into the fewest bins.
        const double largest = kLargestOffset / (0.5 * std::sqrt(3.0) * side);
        double best = -1, chosen = 0;
        GuideHistogram bins{};
        for (const double factor : {0.0, 0.5, 1.0, 2.0, 4.0, -0.5, -1.0}) {
            const double k = std::clamp(factor * sum / distance, -largest, largest);
            const GuideHistogram these = histogram(photons, centre, std::isfinite(k) ? k : 0.0);
            const double squares = std::inner_product(these.begin(), these.end(), these.begin(), 0.0);
            if (squares > best * 1.05) {
                best = squares;
                chosen = std::isfinite(k) ? k : 0.0;
                bins = these;
            }
        }
        const AliasTable alias = aliasTable(bins);
        const auto first = std::uint32_t(tables_.texels.size());
        for (const AliasSlot& slot : alias.slots)
            tables_.texels.push_back({slot.threshold, slot.alias, 0, 0});
        for (std::size_t i = 0; i < kGuideBins; ++i) {
            glm::uvec4& texel = tables_.texels[first + i];
            texel.z = glm::floatBitsToUint(float(alias.chance[i]));
            texel.w = glm::floatBitsToUint(float(alias.chance[texel.y]));
        }
        ++tables_.tables;
        return {first, glm::floatBitsToUint(float(chosen / double(tables_.scale))),
                glm::floatBitsToUint(shareOf(sum / (side * side))), std::uint32_t(level)};
    }

    std::span<const PhotonRecord> records_;
    float share_;
    GuideTables& tables_;
    std::vector<SortedPhoton> photons_;
    double most_ = 0;        ///< flux of a photon that counts: few rare ones do not decide a table
    double irradiance_ = 0;  ///< from lamps in sight, a mean over the photons' places
};

}  // namespace

glm::dvec3 seenFromCentre(const glm::dvec3& w, const glm::dvec3& offset) {
    const double along = glm::dot(w, offset);
    const double t = std::sqrt(std::max(1.0 - glm::dot(offset, offset) + along * along, 1e-3)) - along;
    return t * w + offset;
}

double causticVariance(std::span<const PhotonRecord> photons, double size) {
    // A path that finds its way to a lamp, at a chance of the caustic's irradiance over pi and the lamp's
    // radiance, brings albedo times that radiance.
    constexpr double albedo = 0.5, pi = 3.14159265358979;
    double squares = 0, direct = 0, kept = 0;
    for (const PhotonRecord& p : photons) {
        if (!(p.flux > 0) || !std::isfinite(p.flux) || !std::isfinite(p.radiance) || !std::isfinite(p.direct))
            continue;
        squares += albedo * albedo / pi * double(p.flux) * double(p.radiance);
        direct += albedo / pi * double(p.direct);
        kept += 1;
    }
    if (!(kept > 0)) return 0;
    const double shown = direct / kept;
    return squares / (size * size) / (shown * shown + 0.01);  // 0.01: relMSE's
}

GuideTables guideTables(std::span<const PhotonRecord> photons, float share) {
    GuideTables tables;
    GuideTableBuilder(photons, share, tables).build();
    return tables;
}

}  // namespace helio
