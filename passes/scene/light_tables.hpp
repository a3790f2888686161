#pragma once
/** @file
 * Which light a place should ask: for each cell of a grid over the scene and each of six axes of the surface
 * normal a table of chances, in proportion to an estimate of what every light brings to surfaces there. Where
 * there are many lights a table holds a cut through a tree of lights, fine near the cell and coarse far from
 * it; within a node of the cut lights are taken by power.
 */
#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace helio::pack {

/** A light as the choice among lights sees it. */
struct LightSource {
    enum class Shape : std::uint8_t { Surface, Point, Spot, Directional, Environment };
    Shape shape = Shape::Surface;
    glm::dvec3 centre{0.0};
    double radius = 0;       ///< about the centre
    glm::dvec3 normal{0.0};  ///< of the emitting face; of a spot or directional light the way that light goes
    bool bothFaces = false;
    double strength = 0;  ///< radiance times area; intensity; irradiance; of the environment its power
    double coneScale = 0, coneOffset = 0;  ///< of a spot: clamp(cosine * scale + offset, 0, 1)^2
    double power = 0;                      ///< decides where nothing is known of the place
};

/** Irradiance of the environment on surfaces that face +x, -x, +y, ... */
using AxisIrradiance = std::array<double, 6>;

/** Up to this many lights every table has an entry for each; beyond, tables are cuts of at most kCutEntries.
 */
inline constexpr std::size_t kDirectLights = 512, kCutEntries = 256;

/** The tables and what finds them. Table 0 is for places outside of all that was foreseen, by power alone:
 * every light has a chance everywhere. */
struct LightTables {
    std::vector<std::uint32_t> order;  ///< the light at each place of the light table
    std::uint32_t bits = 1;            ///< a table has 2^bits slots
    std::vector<glm::uvec4> slots;     ///< threshold, alias, bits of own chance, bits of the alias's chance
    std::vector<std::uint32_t> cells;  ///< number of a table per cell and axis; empty: always table 0
    glm::ivec3 size{0};                ///< cells
    glm::vec3 origin{0.0f};
    float scale = 0;  ///< cells per metre
    bool cuts = false;
    /** Of cuts: running sums of the lights' shares of 2^32 (one more than lights), then per table the first
     * light of each entry, padded with the number of lights. */
    std::vector<std::uint32_t> ranges;
};

/** Builds tables for surfaces at `positions` (three a triangle). `adaptive` false: one table, all lights
 * alike. */
LightTables lightTables(std::span<const LightSource> lights, std::span<const glm::vec3> positions,
                        const AxisIrradiance& environment, bool adaptive);

}  // namespace helio::pack
