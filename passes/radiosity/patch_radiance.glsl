#ifndef HELIOGRAPH_RADIOSITY_PATCH_RADIANCE
#define HELIOGRAPH_RADIOSITY_PATCH_RADIANCE
/** @file What patches shine with once their light is known: linear over each (passes/radiosity). */
layout(set = 0, binding = 47) uniform usamplerBuffer uPatchSlots;    ///< PatchList::slots
layout(set = 0, binding = 48) uniform samplerBuffer uPatchRadiance;  ///< 2 sides x 3 corners a patch

/** Radiance that the point of barycentrics b in `slot` gives off its front or back. */
vec3 patchRadiance(int slot, vec3 b, bool front) {
    const uvec4 cut = texelFetch(uPatchSlots, slot);
    const int n = int(cut.y);
    const vec2 place = clamp(b.yz, 0.0, 1.0) * float(n);
    const int i = clamp(int(place.x), 0, n - 1), j = clamp(int(place.y), 0, n - 1 - i);
    const vec2 within = place - vec2(i, j);
    const bool upper = within.x + within.y > 1.0 && i + j + 1 < n;
    const vec2 s = clamp(upper ? 1.0 - within : within, 0.0, 1.0);
    const int first = ((int(cut.x) + i * (2 * n - i) + 2 * j + (upper ? 1 : 0)) * 2 + (front ? 0 : 1)) * 3;
    const vec3 value = texelFetch(uPatchRadiance, first).xyz * (1.0 - s.x - s.y) +
                       texelFetch(uPatchRadiance, first + 1).xyz * s.x + texelFetch(uPatchRadiance, first + 2).xyz * s.y;
    return n > 0 ? max(value, vec3(0.0)) : vec3(0.0);
}
#endif
