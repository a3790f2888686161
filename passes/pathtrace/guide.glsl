#ifndef HELIOGRAPH_PATHTRACE_GUIDE
#define HELIOGRAPH_PATHTRACE_GUIDE
/** @file
 * Where light comes from by way of mirrors and glass: for cells of a grid over the scene and six axes of the surface's
 * normal, a table of chances over directions, made from photons (passes/pathtrace/guide_tables.hpp). Only in kernels
 * compiled with GUIDED. Vorba et al., "On-line learning of parametric mixture models for light transport simulation",
 * 2014, and Jensen, "Importance driven path tracing using the photon map", 1995, guide paths likewise.
 *
 * A table counts directions w' as its cell's centre c would see them: those of x are w ~ w' - k (x - c), which all meet
 * (k > 0) at the distance 1 / k from c, or part there (k < 0). Light that comes through one focus falls into one bin of all
 * of the cell then, whatever the cell's size (the parallax of Ruppert et al., "Robust fitting of parallax-aware mixtures
 * for path guiding", 2020). Bins are equal squares of the octahedral map of the sphere.
 */
/** By axis and cell: first texel of a table, k, share of directions that are drawn from it (0: there is none), and the
 * level of the cell, 2^level cells each way, that the table is for. */
layout(set = 0, binding = 42) uniform usamplerBuffer uGuideCells;
/** Tables of 2^GUIDE_BITS texels: threshold, alias, own chance, the alias's (passes/scene/alias_table.hpp). */
layout(set = 0, binding = 43) uniform usamplerBuffer uGuideTables;
layout(constant_id = 170) const int GUIDE_X = 1;  ///< cells
layout(constant_id = 171) const int GUIDE_Y = 1;
layout(constant_id = 172) const int GUIDE_Z = 1;
layout(constant_id = 173) const float GUIDE_ORIGIN_X = 0.0;
layout(constant_id = 174) const float GUIDE_ORIGIN_Y = 0.0;
layout(constant_id = 175) const float GUIDE_ORIGIN_Z = 0.0;
layout(constant_id = 176) const float GUIDE_SCALE = 0.0;  ///< cells per metre

const int GUIDE_BITS = 10;
const float GUIDE_SIDE = 32.0;  ///< bins across the map: 2^(GUIDE_BITS / 2)

/** What guides paths at one place. */
struct Guide {
    int bins;      ///< first texel
    float share;   ///< chance that a direction is drawn from the table
    vec3 offset;   ///< k (x - c), shorter than 1
};

Guide guideAt(vec3 p, vec3 n, bool wanted) {
    const vec3 size = vec3(GUIDE_X, GUIDE_Y, GUIDE_Z);
    const vec3 q = (p - vec3(GUIDE_ORIGIN_X, GUIDE_ORIGIN_Y, GUIDE_ORIGIN_Z)) * GUIDE_SCALE;
    const bool inside = wanted && all(greaterThanEqual(q, vec3(0.0))) && all(lessThan(q, size));
    const ivec3 c = inside ? ivec3(q) : ivec3(0);
    const vec3 m = abs(n);
    const int axis = m.x > m.y && m.x > m.z ? (n.x > 0.0 ? 0 : 1) : m.y > m.z ? (n.y > 0.0 ? 2 : 3) : (n.z > 0.0 ? 4 : 5);
    const uvec4 cell = texelFetch(uGuideCells, ((axis * GUIDE_Z + c.z) * GUIDE_Y + c.y) * GUIDE_X + c.x);
    const int level = int(cell.w);
    const vec3 centre = (vec3((c >> level) << level) + 0.5 * float(1 << level));
    Guide guide;
    guide.bins = int(cell.x);
    guide.share = inside ? uintBitsToFloat(cell.z) : 0.0;
    guide.offset = uintBitsToFloat(cell.y) * (inside ? q - centre : vec3(0.0));  // k per cell
    return guide;
}

vec2 folded(vec2 at) {
    return (1.0 - abs(at.yx)) * vec2(at.x < 0.0 ? -1.0 : 1.0, at.y < 0.0 ? -1.0 : 1.0);
}

/** How the cell's centre sees the unit vector w, and how many times as large solid angles are there. */
vec3 seenFromCentre(Guide guide, vec3 w, out float larger) {
    const float along = dot(w, guide.offset);
    const float cosine = sqrt(max(1.0 - dot(guide.offset, guide.offset) + along * along, 1e-3));
    const float t = cosine - along;
    larger = t * t / cosine;
    return t * w + guide.offset;
}

/** Takes the guide into account: where `guided` puts a direction of the table in the place of w, else leaves w. `choice`
 * picks the bin, u the place within, each in [0, 1). Returns the chance per solid angle with which the table gives w. */
float guideDirection(Guide guide, bool guided, float choice, vec2 u, inout vec3 w) {
    float larger;
    vec3 seen = seenFromCentre(guide, w, larger);
    float size = abs(seen.x) + abs(seen.y) + abs(seen.z);
    const vec2 at = seen.xy / size;
    const ivec2 place = ivec2(clamp(((seen.z < 0.0 ? folded(at) : at) * 0.5 + 0.5) * GUIDE_SIDE, 0.0, GUIDE_SIDE - 1.0));
    const uint bits = uint(choice * 16777216.0) << 8;
    const int slot = guided ? int(bits >> (32 - GUIDE_BITS)) : place.y * int(GUIDE_SIDE) + place.x;
    const uvec4 entry = texelFetch(uGuideTables, guide.bins + slot);
    const bool own = !guided || (bits & ((1u << (32 - GUIDE_BITS)) - 1u)) < entry.x;
    const float chance = uintBitsToFloat(own ? entry.z : entry.w);
    const uint bin = own ? uint(slot) : entry.y;
    const vec2 drawn = (vec2(bin % uint(GUIDE_SIDE), bin / uint(GUIDE_SIDE)) + u) * (2.0 / GUIDE_SIDE) - 1.0;
    vec3 v = vec3(drawn, 1.0 - abs(drawn.x) - abs(drawn.y));
    if (v.z < 0.0) v.xy = folded(drawn);
    if (guided) {
        w = normalize(normalize(v) - guide.offset);
        seen = seenFromCentre(guide, w, larger);
        size = abs(seen.x) + abs(seen.y) + abs(seen.z);
    }
    return chance * (0.25 * GUIDE_SIDE * GUIDE_SIDE) * larger / (size * size * size);
}
#endif
