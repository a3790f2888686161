#ifndef HELIOGRAPH_SCENE_PLACED
#define HELIOGRAPH_SCENE_PLACED
/** @file
 * Meshes that stand in the scene many times and are stored once, in their own space (PackOptions::placing). Kernels of
 * scenes that have some are compiled with INSTANCES. A placed triangle's slot is TRIANGLE_COUNT + (placement <<
 * PLACED_BITS) + its place in its mesh.
 *
 * Corners are brought to the world before they are tested: in double, in the order of operations in which the host
 * flattens the others, and rounded once. The geometry is thus that of the flattened scene to the last bit; boxes alone
 * are met in the mesh's space.
 */

/** 9 texels a placement: the columns of object to world as 12 doubles; the rows of the inverse's linear part in floats, with
 * the mesh's root | exponent of the reach << 24, the first of its slots less its first triangle's place, and the
 * scene's instance. The reach bounds every coordinate of the placed mesh and of its origin, counted from either. */
layout(set = 0, binding = 41) uniform usamplerBuffer uPlaced;

/** Object to world. */
struct Placement {
    dvec3 x;
    dvec3 y;
    dvec3 z;
    dvec3 origin;
};

Placement placementOf(int index) {
    const uvec4 a = texelFetch(uPlaced, index * 9), b = texelFetch(uPlaced, index * 9 + 1), c = texelFetch(uPlaced, index * 9 + 2);
    const uvec4 d = texelFetch(uPlaced, index * 9 + 3), e = texelFetch(uPlaced, index * 9 + 4), f = texelFetch(uPlaced, index * 9 + 5);
    return Placement(dvec3(packDouble2x32(a.xy), packDouble2x32(a.zw), packDouble2x32(b.xy)),
                     dvec3(packDouble2x32(b.zw), packDouble2x32(c.xy), packDouble2x32(c.zw)),
                     dvec3(packDouble2x32(d.xy), packDouble2x32(d.zw), packDouble2x32(e.xy)),
                     dvec3(packDouble2x32(e.zw), packDouble2x32(f.xy), packDouble2x32(f.zw)));
}

vec3 placedCorner(Placement p, vec3 corner) {
    const dvec3 v = dvec3(corner);
    precise dvec3 world = (p.x * v.x + p.y * v.y) + (p.z * v.z + p.origin);
    return vec3(world);
}

/** A mesh's unit normal in the world, unit: by the cofactors, their sign taken out (normalMatrix of pack_geometry.cpp). */
vec3 placedNormal(Placement p, vec3 normal) {
    const dvec3 c = cross(p.x, p.y), n = cross(p.y, p.z) * double(normal.x) + cross(p.z, p.x) * double(normal.y) + c * double(normal.z);
    const double largest = max(max(abs(n.x), abs(n.y)), abs(n.z));
    const vec3 scaled = vec3(n / (largest > 0.0LF ? largest : 1.0LF));
    const float size = length(scaled);
    return scaled * ((dot(c, p.z) < 0.0LF ? -1.0 : 1.0) / (size > 0.0 ? size : 1.0));
}
#endif
