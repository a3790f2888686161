#ifndef HELIOGRAPH_TREE
#define HELIOGRAPH_TREE
/** @file
 * What the kernels share that build a tree over triangles (passes/tree/tree_builder.hpp).
 *
 * References: 0 to n - 2 are nodes of the binary radix tree, 0 the root; n - 1 + i is the
 * i-th sorted triangle by itself. A box is six floats: lower, then upper corner.
 */
const uint TREE_NONE = 0xffffffffu;
/** Triangles of a leaf at most, see BvhNode. */
const uint TREE_LEAF = 3u;
/** Values that an invocation takes one after another where their order matters. */
const uint TREE_RUN = 256u;
/** A digit of the radix sort. */
const uint TREE_DIGIT_BITS = 6u, TREE_DIGITS = 64u;

layout(local_size_x = 64) in;

layout(push_constant, std430) uniform Push {
    uint first;           ///< invocation of this dispatch
    uint count;           ///< values of a sum; the end of a level's places; boxes of a level
    uint begin;           ///< of a level's places or boxes
    uint shift;           ///< of the sorted digit
    vec3 lower;           ///< of all boxes
    float scale;          ///< 1 / largest extent, 0 where there is none
    uint triangles;
} push;

uint invocation() {
    return push.first + gl_GlobalInvocationID.x;
}
#endif
