#ifndef HELIOGRAPH_INTERSECTION_TRAVERSE
#define HELIOGRAPH_INTERSECTION_TRAVERSE
/** @file
 * Traversal of the eight-wide quantised tree of engine/scene/bvh.hpp: each turn of the loop takes one step
 * down the tree and tests one triangle, so that lanes busy with either keep together. Triangles found wait in
 * a queue of two nodes' leaves.
 *
 * The boxes' planes are widened by a bound of the rounding in them, so that no box whose triangle is hit is
 * missed. With u = 2^-24 and inv = fl(1/d): a plane's distance is computed as q * a + o with a = fl(s * inv)
 * and o = fl(fl(p - origin) * inv); each product and sum errs by at most 5u of |q a| + |o| in all, q <= 255.
 * Far planes get 6u (255 |a| + |o|) more and near planes less.
 *
 * Distances are compared as integers (IEEE order of non-negative floats; a negative far plane stays negative,
 * which misses), since the float minimum takes three instructions where NaN must be looked after.
 */
#include "shaders/intersection/triangle.glsl"
#include "shaders/scene/triangles.glsl"

/** The tree, 5 texels a node; see BvhNode. */
layout(set = 0, binding = 21) uniform usamplerBuffer uNodes;
/** Levels of the tree at most: each level leaves at most one entry. */
layout(constant_id = 120) const int STACK_SIZE = 24;

/** Turns a ray may take before it is given up and counted: lavapipe runs 65,535 turns of all loops of an
 * invocation and then silently stops. */
const int MAX_TRAVERSAL_STEPS = 16000;

/** 1/x without infinities: a component below 1e-20 takes part in no box test that its rounding does not
 * decide, see above. */
float finiteInverse(float x) {
    return 1.0 / (abs(x) < 1e-20 ? (x < 0.0 ? -1e-20 : 1e-20) : x);
}

/** Byte i of a word as a float scaled by 1, 2^8, 2^16 or 1: the scale is taken out of the plane's step. */
float scaledByte(uint word, int i) {
    return float(int(i == 0 ? word & 0xffu : (i == 1 ? word & 0xff00u : (i == 2 ? word & 0xff0000u : word >> 24))));
}

/** Mask of the node's slots with bit s moved to s ^ octant. */
uint orderedMask(uint mask, uint octant) {
    mask = (octant & 1u) != 0u ? ((mask & 0x55u) << 1) | ((mask >> 1) & 0x55u) : mask;
    mask = (octant & 2u) != 0u ? ((mask & 0x33u) << 2) | ((mask >> 2) & 0x33u) : mask;
    return (octant & 4u) != 0u ? ((mask & 0x0fu) << 4) | ((mask >> 4) & 0x0fu) : mask;
}

/** Finds the triangle nearest along the ray within (0, nearest), or, where `any` is set, any one. `nearest`
 * becomes its distance, `slot` its slot (-1: none). `source`: slot that the ray leaves and cannot meet again;
 * `target`: range of triangles (g) that it goes to and that do not stand in its way. A ray with nearest <= 0 does nothing. Returns the turns taken. */
int traverse(vec3 origin, vec3 direction, const bool any, int source, ivec2 target, inout float nearest, out int slot) {
    slot = -1;
    const vec3 inverse = vec3(finiteInverse(direction.x), finiteInverse(direction.y), finiteInverse(direction.z));
    const bvec3 negative = lessThan(inverse, vec3(0.0));
    const uint octant = (negative.x ? 1u : 0u) | (negative.y ? 2u : 0u) | (negative.z ? 4u : 0u);
    const RayShear ray = shearOf(origin, direction);

    int stack[STACK_SIZE];
    int top = 0;
    // A group of siblings still to visit: first child << 8 | mask of those hit, bit s ^ octant for slot s.
    uint group = 1u << octant;
    bool descending = nearest > 0.0;
    uint leafMask = 0u, leafBase = 0u, nextMask = 0u, nextBase = 0u;
    int steps = 0;
    while ((descending || (leafMask | nextMask) != 0u) && steps < MAX_TRAVERSAL_STEPS) {
        ++steps;
        if (descending && nextMask == 0u) {
            const uint bit = uint(findLSB(group));
            const uint rest = group & (group - 1u);
            const int node = (int(group >> 8) + int(bit ^ octant)) * 5;
            const uvec4 head = texelFetch(uNodes, node);
            const uvec4 child = texelFetch(uNodes, node + 1);
            const uvec4 x = texelFetch(uNodes, node + 2);
            const uvec4 y = texelFetch(uNodes, node + 3);
            const uvec4 z = texelFetch(uNodes, node + 4);
            const vec3 step = uintBitsToFloat(uvec3(head.w << 23, head.w << 15, head.w << 7) & 0x7f800000u) * inverse;
            const vec3 offset = (uintBitsToFloat(head.xyz) - origin) * inverse;
            const vec3 slack = (abs(offset) + 255.0 * abs(step)) * 3.5762787e-7;
            const vec3 nearOffset = offset - slack, farOffset = offset + slack;
            const vec3 step8 = step * 0.00390625, step16 = step * 1.52587890625e-5;
            const uvec2 nearX = negative.x ? x.zw : x.xy, farX = negative.x ? x.xy : x.zw;
            const uvec2 nearY = negative.y ? y.zw : y.xy, farY = negative.y ? y.xy : y.zw;
            const uvec2 nearZ = negative.z ? z.zw : z.xy, farZ = negative.z ? z.xy : z.zw;
            const int limit = floatBitsToInt(nearest);
            uint inner = 0u, leaves = 0u;
            [[unroll]] for (int s = 0; s < 8; ++s) {
                const int word = s >> 2, byte = s & 3;
                const vec3 scale = byte == 1 ? step8 : (byte == 2 ? step16 : step);
                const vec3 enter = vec3(scaledByte(nearX[word], byte), scaledByte(nearY[word], byte),
                                        scaledByte(nearZ[word], byte)) * scale + nearOffset;
                const vec3 leave = vec3(scaledByte(farX[word], byte), scaledByte(farY[word], byte),
                                        scaledByte(farZ[word], byte)) * scale + farOffset;
                const ivec3 e = floatBitsToInt(enter), l = floatBitsToInt(leave);
                const bool hit = max(max(e.x, e.y), max(e.z, 0)) <= min(min(l.x, l.y), min(l.z, limit));
                const uint leaf = (child[2 + word] >> (byte * 8)) & 0xffu;
                inner |= hit ? (1u << s) : 0u;
                leaves |= hit ? (leaf >> 5) << (leaf & 31u) : 0u;
            }
            inner = orderedMask(inner & (head.w >> 24), octant);
            nextMask = leaves;
            nextBase = child.y;
            stack[top] = int(rest);
            const bool more = (rest & 0xffu) != 0u, down = inner != 0u;
            const uint popped = uint(stack[max(top - 1, 0)]);
            group = down ? (child.x << 8) | inner : (more ? rest : popped);
            descending = down || more || top > 0;
            top += down ? (more ? 1 : 0) : (more ? 0 : -1);
        }
        if (leafMask == 0u) {
            leafMask = nextMask;
            leafBase = nextBase;
            nextMask = 0u;
        }
        if (leafMask != 0u) {
            const int candidate = int(leafBase) + findLSB(leafMask);
            leafMask &= leafMask - 1u;
            const uvec4 first = texelFetch(uTriangles, candidate * 3);
            const vec3 a = sheared(ray, uintBitsToFloat(first.xyz));
            const vec3 b = sheared(ray, uintBitsToFloat(texelFetch(uTriangles, candidate * 3 + 1).xyz));
            const vec3 c = sheared(ray, uintBitsToFloat(texelFetch(uTriangles, candidate * 3 + 2).xyz));
            float t;
            bool hit = meetsTriangle(ray, a, b, c, nearest, t) && candidate != source;
            if (any) hit = hit && (int(first.w) < target.x || int(first.w) > target.y);
            nearest = hit ? t : nearest;
            slot = hit ? candidate : slot;
            if (any && hit) {
                leafMask = 0u;
                nextMask = 0u;
                descending = false;
            }
        }
    }
    return steps;
}
#endif
