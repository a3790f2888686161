#ifndef HELIOGRAPH_SCENE_LIGHT_TABLES
#define HELIOGRAPH_SCENE_LIGHT_TABLES
/** @file
 * Choosing a light by what it brings to a place: passes/scene/light_tables.hpp says how the tables are made. Only in
 * kernels compiled with LIGHT_TABLES.
 */
#include "shaders/scene/features.glsl"

layout(set = 0, binding = 33) uniform usamplerBuffer uLightSlots;       ///< threshold, alias, chances of both
layout(set = 0, binding = 34) uniform usamplerBuffer uLightCells;       ///< R32UI: number of a table
layout(set = 0, binding = 35) uniform usamplerBuffer uLightRanges;      ///< R32UI: running sums, then firsts of entries
layout(set = 0, binding = 36) uniform usamplerBuffer uLightOfTriangle;  ///< R32UI: row of the light table by g
layout(constant_id = 150) const int LIGHT_SLOT_BITS = 1;
layout(constant_id = 151) const bool LIGHT_CUTS = false;  ///< entries are ranges of lights, not single ones
layout(constant_id = 152) const int LIGHT_GRID_X = 0;     ///< 0: one table for all places
layout(constant_id = 153) const int LIGHT_GRID_Y = 0;
layout(constant_id = 154) const int LIGHT_GRID_Z = 0;
layout(constant_id = 155) const float LIGHT_ORIGIN_X = 0.0;
layout(constant_id = 156) const float LIGHT_ORIGIN_Y = 0.0;
layout(constant_id = 157) const float LIGHT_ORIGIN_Z = 0.0;
layout(constant_id = 158) const float LIGHT_GRID_SCALE = 0.0;

/** First slot of the table for a surface at p that faces n; of table 0 where n is 0. */
int lightPlace(vec3 p, vec3 n) {
    if (LIGHT_GRID_X == 0 || n == vec3(0.0)) return 0;
    const vec3 q = (p - vec3(LIGHT_ORIGIN_X, LIGHT_ORIGIN_Y, LIGHT_ORIGIN_Z)) * LIGHT_GRID_SCALE;
    const ivec3 c = ivec3(clamp(q, vec3(0.0), vec3(LIGHT_GRID_X - 1, LIGHT_GRID_Y - 1, LIGHT_GRID_Z - 1)));
    const vec3 m = abs(n);
    const int axis = m.x > m.y && m.x > m.z ? (n.x > 0.0 ? 0 : 1) : m.y > m.z ? (n.y > 0.0 ? 2 : 3) : (n.z > 0.0 ? 4 : 5);
    return int(texelFetch(uLightCells, ((c.z * LIGHT_GRID_Y + c.y) * LIGHT_GRID_X + c.x) * 6 + axis).x) << LIGHT_SLOT_BITS;
}

uint lightRange(int i) {
    return texelFetch(uLightRanges, i).x;
}

/** Last i in [low, high) with uLightRanges[base + i] <= value. No more than 24 turns. */
int lastNotAbove(int base, int low, int high, uint value) {
    while (high - low > 1) {
        const int middle = (low + high) >> 1;
        if (lightRange(base + middle) <= value)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/** A light for a place, from 32 random bits: its row, and the chance that it is chosen. */
int chooseLight(int place, uint random, out float chance) {
    const uint capacity = 1u << (32 - LIGHT_SLOT_BITS);
    const int slot = int(random >> (32 - LIGHT_SLOT_BITS));
    const uint fraction = random & (capacity - 1u);
    const uvec4 entry = texelFetch(uLightSlots, place + slot);
    const bool own = fraction < entry.x;
    int row = own ? slot : int(entry.y);
    chance = uintBitsToFloat(own ? entry.z : entry.w);
    if (LIGHT_CUTS) {
        const float rest = float(own ? fraction : fraction - entry.x) / float(own ? entry.x : capacity - entry.x);
        const int firsts = LIGHT_COUNT + 1 + place + row;
        const int first = int(lightRange(firsts));
        const int end = row + 1 < (1 << LIGHT_SLOT_BITS) ? int(lightRange(firsts + 1)) : LIGHT_COUNT;
        const uint low = lightRange(first), extent = lightRange(end) - low;
        const uint at = low + min(uint(rest * float(extent)), extent - 1u);
        row = lastNotAbove(0, first, end, at);
        chance *= float(lightRange(row + 1) - lightRange(row)) / float(extent);
    }
    return row;
}

/** The chance that chooseLight() finds this row. */
float lightChance(int place, int row) {
    if (!LIGHT_CUTS) return uintBitsToFloat(texelFetch(uLightSlots, place + row).z);
    const int slots = 1 << LIGHT_SLOT_BITS;
    const int base = LIGHT_COUNT + 1 + place;
    const int entry = lastNotAbove(base, 0, slots, uint(row));
    const int first = int(lightRange(base + entry));
    const int end = entry + 1 < slots ? int(lightRange(base + entry + 1)) : LIGHT_COUNT;
    const float share = float(lightRange(row + 1) - lightRange(row)) / float(lightRange(end) - lightRange(first));
    return uintBitsToFloat(texelFetch(uLightSlots, place + entry).z) * share;
}
#endif
