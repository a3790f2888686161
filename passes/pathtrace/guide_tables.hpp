#pragma once
/** @file Tables that guide paths to caustics, made from photons on the host: see guide.glsl for what they
 * say. */
#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace helio {

/** What photons.comp notes of a photon. */
struct PhotonRecord {
    glm::vec3 position{0.0f};
    float flux = 0;             ///< 0: it came nowhere
    glm::vec3 direction{0.0f};  ///< unit, to where it came from
    float distance = 0;         ///< how far it came last
    glm::vec3 normal{0.0f};     ///< unit, of the side that it came to
    float radiance = 0;         ///< of its lamp
    float direct = 0;           ///< irradiance from lamps in sight, estimated
};

/** Bins of a table, 2^kGuideBits, kGuideSide across the map of directions; guide.glsl has them too. */
inline constexpr std::uint32_t kGuideBits = 10, kGuideSide = 32;

/** Cells along the longest side of the grid, and tables at most: 24 MiB of cells, 64 MiB of tables. */
inline constexpr std::int32_t kGuideCells = 64;
inline constexpr std::size_t kMostGuideTables = 4096;

struct GuideTables {
    std::vector<glm::uvec4> cells;   ///< of uGuideCells, by axis and cell
    std::vector<glm::uvec4> texels;  ///< of uGuideTables
    glm::ivec3 size{0};              ///< cells
    glm::vec3 origin{0.0f};
    float scale = 0;         ///< cells per metre
    std::size_t kept = 0;    ///< photons that came somewhere
    std::size_t tables = 0;  ///< that guide somewhere
    double gain = 0;         ///< causticVariance()
    bool empty() const { return tables == 0; }
    std::uint64_t cellCount() const {
        return std::uint64_t(size.x) * std::uint64_t(size.y) * std::uint64_t(size.z);
    }
};

/** Tables for what the photons found, with fewer cells of the grid to a table where more photons came. The
 * same for the same photons in the same order. `share`: of directions that are drawn from a table, at most.
 */
GuideTables guideTables(std::span<const PhotonRecord> photons, float share);

/** How much variance a sample of unguided paths has from what these photons bring, relative to the square of
 * what lamps in sight make of surfaces there: a mean over a scene of this size (its diagonal). */
double causticVariance(std::span<const PhotonRecord> photons, double size);

/** The direction under which the centre of a cell sees what lies along w from `offset` (k (x - c) of
 * guide.glsl, shorter than 1), and back. Unit. */
glm::dvec3 seenFromCentre(const glm::dvec3& w, const glm::dvec3& offset);

}  // namespace helio
