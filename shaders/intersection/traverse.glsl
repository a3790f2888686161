#ifndef HELIOGRAPH_INTERSECTION_TRAVERSE
#define HELIOGRAPH_INTERSECTION_TRAVERSE
/** @file
 * Traversal of the eight-wide quantised tree of engine/scene/bvh.hpp: each turn takes one step down the tree
 * and tests one triangle, so that lanes busy with either keep together. Triangles found wait in a queue of two
 * nodes' leaves. A Traversal can be left and taken up between turns: a kernel may hand a lane whose ray is
 * done the next one (passes/intersect), or call traverse() and wait for the slowest lane.
 *
 * The boxes' planes are widened by a bound of the rounding in them, so that no box whose triangle is hit is
 * missed. With u = 2^-24 and inv = fl(1/d): a plane's distance is computed as q * a + o with a = fl(s * inv)
 * and o = fl(fl(p - origin) * inv); each product and sum errs by at most 5u of |q a| + |o| in all, q <= 255.
 * Far planes get 6u (255 |a| + |o|) more and near planes less.
 *
 * Distances are compared as integers (IEEE order of non-negative floats), since the float minimum takes three
 * instructions where NaN must be looked after. Negative floats come before all others and in the reverse order: where a
 * far plane lies behind the ray, its near plane lies farther behind and is the greater integer, so that the box is missed.
 *
 * With INSTANCES, some places of the tree's leaves stand for placed meshes (shaders/scene/placed.glsl), whose trees hold
 * boxes in the mesh's own space. A ray that comes to one goes on in that space: its other candidates wait aside, and the
 * stack keeps an empty entry between the two trees. Triangles are tested in the world, so that the test is the
 * same for all. The ray's images err: with A the inverse's linear part, o the origin counted from the mesh's, and r the
 * reach of placed.glsl, a point of the ray within the mesh lies at most 5u |A| |o| + 4u |A| (|o| + r) + u |A| r
 * beside its image, the last for the rounding of corners. 16u |A| (|o| + r) is put on every side of the boxes.
 *
 * The order in which triangles are met does not matter: boxes as far as the nearest hit are still entered, and
 * of triangles at the same distance the first in scene order is the hit.
 */
#include "shaders/intersection/triangle.glsl"
#include "shaders/scene/triangles.glsl"
#ifdef SHAPES
#include "shaders/intersection/shape.glsl"
#endif

/** The tree, 5 texels a node; see BvhNode. */
#ifdef NODES_IN_STORAGE
layout(set = 0, binding = 21, std430) readonly buffer uNodes { uvec4 nodeTexels[]; };
uvec4 nodeTexel(int i) {
    return nodeTexels[i];
}
#else
layout(set = 0, binding = 21) uniform usamplerBuffer uNodes;
uvec4 nodeTexel(int i) {
    return texelFetch(uNodes, i);
}
#endif
/** Levels of the tree at most: each level leaves at most one entry. */
layout(constant_id = 120) const int STACK_SIZE = 24;
/** Entries up to which they are moved, see traversalStack; heliograph/tree_access.hpp. */
layout(constant_id = 146) const int MOVED_STACK_AT_MOST = 16;
/** Whether spatial splits have put triangles into several slots: they are then told apart by g. */
layout(constant_id = 119) const bool SPLIT_TREE = false;

/** Turns a ray may take before it is given up and counted: lavapipe runs 65,535 turns of all loops of an
 * invocation and then silently stops. */
#if defined(SHAPES) && defined(LIGHTS_ASKED)
const int MAX_TRAVERSAL_STEPS = 4000;
#elif defined(SHAPES) || defined(LIGHTS_ASKED)
const int MAX_TRAVERSAL_STEPS = 8000;  // listed shapes take as many; rays to several lights follow one another
#else
const int MAX_TRAVERSAL_STEPS = 16000;
#endif

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

/** A ray on its way through the tree. */
struct Traversal {
    RayShear ray;
#if defined(SHAPES) || defined(INSTANCES)
    vec3 direction;
#endif
    vec3 inverse;
    uint octant;         ///< bit per axis along which the direction is negative
    uint group;          ///< siblings still to visit: first child << 8 | mask of those hit, bit s ^ octant for slot s
    bool descending;     ///< `group` holds something
    uint leafMask;       ///< triangles to test, of those of a node (`leafAll`), which lie from `leafBase` on
    uint leafAll;
    uint leafBase;
    uint nextMask;       ///< and those of the node after
    uint nextAll;
    uint nextBase;
    int source;          ///< slot (with SPLIT_TREE the g) that the ray leaves and cannot meet again
    ivec2 target;        ///< range of triangles (g) that the ray goes to and that do not stand in its way
    float nearest;       ///< distance of the nearest hit so far, or the limit
    int slot;            ///< of the nearest hit so far; -1: none
    int g;               ///< its index in scene order
    int steps;           ///< turns taken
#ifdef INSTANCES
    int pending;         ///< placement that the ray is about to enter; -1: none
    int inside;          ///< scene's instance in whose tree it is; -1: the scene's
    int slotOffset;      ///< from a triangle's place to its slot
    int instance;        ///< of the nearest hit so far
    vec3 from;           ///< origin in the tree's space
    vec3 margin;         ///< of its boxes, in distances along the ray
    vec3 worldInverse;
    Placement placement;
    uint waitingGroup;   ///< of the scene's tree while the ray is in another
    uvec3 waitingLeaves;
    uvec3 waitingNext;
#endif
};

/** Groups left behind on the way down, the last one first where all are moved. Not members of Traversal:
 * drivers copy structures. */
uint traversalStack[STACK_SIZE];
int traversalTop;
/** Whether entries are moved rather than addressed. Few stay in registers; lavapipe writes to an address lane
 * by lane, with branches that it mispredicts. */
const bool MOVE_STACK = STACK_SIZE <= MOVED_STACK_AT_MOST;

void clearStack() {
    traversalTop = 0;
    if (MOVE_STACK) {
        [[unroll]] for (int i = 0; i < STACK_SIZE; ++i) traversalStack[i] = 0u;
    }
}

/** The last entry, 0 for none; then takes it off, or puts `group` on top, or neither. */
uint exchangeOnStack(uint group, bool push, bool pop) {
    if (MOVE_STACK) {
        const uint last = traversalStack[0];
        uint before = group;
        [[unroll]] for (int i = 0; i < STACK_SIZE; ++i) {
            const uint here = traversalStack[i];
            const uint after = i + 1 < STACK_SIZE ? traversalStack[min(i + 1, STACK_SIZE - 1)] : 0u;
            traversalStack[i] = push ? before : (pop ? after : here);
            before = here;
        }
        return last;
    }
    traversalStack[traversalTop] = group;
    const uint last = traversalTop > 0 ? traversalStack[max(traversalTop - 1, 0)] : 0u;
    traversalTop += push ? 1 : (pop && traversalTop > 0 ? -1 : 0);
    return last;
}

/** A ray that is to find the triangle nearest within (0, limit). One with limit <= 0 does nothing. */
Traversal beginTraversal(vec3 origin, vec3 direction, int source, ivec2 target, float limit) {
    Traversal t;
    t.ray = shearOf(origin, direction);
#if defined(SHAPES) || defined(INSTANCES)
    t.direction = direction;
#endif
    t.inverse = vec3(finiteInverse(direction.x), finiteInverse(direction.y), finiteInverse(direction.z));
    t.octant = (t.inverse.x < 0.0 ? 1u : 0u) | (t.inverse.y < 0.0 ? 2u : 0u) | (t.inverse.z < 0.0 ? 4u : 0u);
    t.group = 1u << t.octant;
    t.descending = limit > 0.0;
    t.leafMask = 0u;
    t.leafAll = 0u;
    t.leafBase = 0u;
    t.nextMask = 0u;
    t.nextAll = 0u;
    t.nextBase = 0u;
    clearStack();
    t.source = source;
    if (SPLIT_TREE) t.source = source < 0 ? source : int(texelFetch(uTriangles, max(source, 0) * 3).w);
    t.target = target;
    t.nearest = limit;
    t.slot = -1;
    t.g = -1;
    t.steps = 0;
#ifdef INSTANCES
    t.pending = -1;
    t.inside = -1;
    t.slotOffset = 0;
    t.instance = -1;
    t.from = origin;
    t.margin = vec3(0.0);
    t.worldInverse = t.inverse;
    t.placement = Placement(dvec3(0.0), dvec3(0.0), dvec3(0.0), dvec3(0.0));
    t.waitingGroup = 0u;
    t.waitingLeaves = uvec3(0u);
    t.waitingNext = uvec3(0u);
#endif
    return t;
}

bool isBusy(Traversal t) {
#ifdef INSTANCES
    return (t.descending || (t.leafMask | t.nextMask) != 0u || t.inside >= 0 || t.pending >= 0) && t.steps < MAX_TRAVERSAL_STEPS;
#else
    return (t.descending || (t.leafMask | t.nextMask) != 0u) && t.steps < MAX_TRAVERSAL_STEPS;
#endif
}

/** Takes the next node off the tree: its leaves go to the queue, its children or the next group become t.group. */
void visitNode(inout Traversal t) {
    const uint bit = uint(findLSB(t.group));
    const uint rest = t.group & (t.group - 1u);
    const int node = (int(t.group >> 8) + int(bit ^ t.octant)) * 5;
    const uvec4 head = nodeTexel(node);
    const uvec4 child = nodeTexel(node + 1);
    const uvec4 x = nodeTexel(node + 2);
    const uvec4 y = nodeTexel(node + 3);
    const uvec4 z = nodeTexel(node + 4);
    const vec3 step = uintBitsToFloat(uvec3(head.w << 23, head.w << 15, head.w << 7) & 0x7f800000u) * t.inverse;
#ifdef INSTANCES
    const vec3 offset = (uintBitsToFloat(head.xyz) - t.from) * t.inverse;
    const vec3 slack = (abs(offset) + 255.0 * abs(step)) * 3.5762787e-7 + t.margin;
#else
    const vec3 offset = (uintBitsToFloat(head.xyz) - t.ray.origin) * t.inverse;
    const vec3 slack = (abs(offset) + 255.0 * abs(step)) * 3.5762787e-7;
#endif
    const vec3 nearOffset = offset - slack, farOffset = offset + slack;
    const vec3 step8 = step * 0.00390625, step16 = step * 1.52587890625e-5;
    const bvec3 negative = lessThan(t.inverse, vec3(0.0));
    const uvec2 nearX = negative.x ? x.zw : x.xy, farX = negative.x ? x.xy : x.zw;
    const uvec2 nearY = negative.y ? y.zw : y.xy, farY = negative.y ? y.xy : y.zw;
    const uvec2 nearZ = negative.z ? z.zw : z.xy, farZ = negative.z ? z.xy : z.zw;
    const int limit = floatBitsToInt(t.nearest);
    uint hits = 0u;
    [[unroll]] for (int s = 0; s < 8; ++s) {
        const int word = s >> 2, byte = s & 3;
        const vec3 scale = byte == 1 ? step8 : (byte == 2 ? step16 : step);
        const vec3 enter = vec3(scaledByte(nearX[word], byte), scaledByte(nearY[word], byte),
                                scaledByte(nearZ[word], byte)) * scale + nearOffset;
        const vec3 leave = vec3(scaledByte(farX[word], byte), scaledByte(farY[word], byte),
                                scaledByte(farZ[word], byte)) * scale + farOffset;
        const ivec3 e = floatBitsToInt(enter), l = floatBitsToInt(leave);
        const bool hit = max(max(e.x, e.y), e.z) <= min(min(l.x, l.y), min(l.z, limit));
        hits |= hit ? (1u << s) | (7u << (8 + 3 * s)) : 0u;
    }
    hits &= child.z;
    const uint inner = orderedMask(hits & 0xffu, t.octant);
    t.nextMask = hits >> 8;
    t.nextAll = child.z >> 8;
    t.nextBase = child.y;
    const bool more = (rest & 0xffu) != 0u, down = inner != 0u;
    const uint last = exchangeOnStack(rest, down && more, !down && !more);
    t.group = down ? (child.x << 8) | inner : (more ? rest : last);
    t.descending = t.group != 0u;
}

/** Tests the next triangle of the queue, if there is one; where `any` is set, any hit ends the ray. */
void visitTriangle(inout Traversal t, const bool any) {
    const bool waits = t.leafMask != 0u;
    const uint lower = (t.leafMask & -t.leafMask) - 1u;
    const int candidate = waits ? int(t.leafBase) + bitCount(t.leafAll & lower) : 0;
    t.leafMask &= t.leafMask - 1u;
    const uvec4 first = texelFetch(uTriangles, candidate * 3);
#ifdef MOTION_KEYS
    const vec3 a = sheared(t.ray, movingCorner(candidate, 0));
    const vec3 b = sheared(t.ray, movingCorner(candidate, 1));
    const vec3 c = sheared(t.ray, movingCorner(candidate, 2));
#elif defined(INSTANCES)
    const uvec4 second = texelFetch(uTriangles, candidate * 3 + 1);
    const vec3 v0 = uintBitsToFloat(first.xyz), v1 = uintBitsToFloat(second.xyz);
    const vec3 v2 = uintBitsToFloat(texelFetch(uTriangles, candidate * 3 + 2).xyz);
    const bool inside = t.inside >= 0;
    const vec3 a = sheared(t.ray, inside ? placedCorner(t.placement, v0) : v0);
    const vec3 b = sheared(t.ray, inside ? placedCorner(t.placement, v1) : v1);
    const vec3 c = sheared(t.ray, inside ? placedCorner(t.placement, v2) : v2);
    const int instance = inside ? t.inside : int(second.w);
#else
    const vec3 a = sheared(t.ray, uintBitsToFloat(first.xyz));
    const vec3 b = sheared(t.ray, uintBitsToFloat(texelFetch(uTriangles, candidate * 3 + 1).xyz));
    const vec3 c = sheared(t.ray, uintBitsToFloat(texelFetch(uTriangles, candidate * 3 + 2).xyz));
#endif
    const int g = int(first.w);
    float distance;
    bool hit = lineMeetsTriangle(t.ray, a, b, c, distance);
#ifdef INSTANCES
    const int slot = candidate + t.slotOffset;
    const bool stands = int(first.w) < 0;  // for a placement
    t.pending = stands ? g & 0x7fffffff : -1;
#else
    const int slot = candidate;
#endif
    bool counts = (SPLIT_TREE ? g : slot) != t.source;
#ifdef SHAPES
    if (SHAPES_IN_TREE) {
        const Triangle shape = fetchTriangle(slot);
        float there;
        const bool meets = meetsShape(t.ray, t.direction, shape, !counts, INFINITE_DISTANCE, there);
        hit = shape.shape > 0 ? meets : hit;
        distance = shape.shape > 0 ? there : distance;
        counts = counts || shape.shape > 0;
    }
#endif
#ifdef INSTANCES
    const bool before = instance < t.instance || (instance == t.instance && g < t.g);
    hit = hit && !stands;
#else
    const bool before = g < t.g;
#endif
    hit = hit && (isNearer(distance, t.nearest) || (!any && distance == t.nearest && before));
    hit = hit && counts && waits;
    if (any) hit = hit && (g < t.target.x || g > t.target.y);
    t.nearest = hit ? distance : t.nearest;
    t.slot = hit ? slot : t.slot;
    t.g = hit ? g : t.g;
#ifdef INSTANCES
    t.instance = hit ? instance : t.instance;
#endif
    if (any && hit) {
        t.leafMask = 0u;
        t.nextMask = 0u;
        t.descending = false;
#ifdef INSTANCES
        t.inside = -1;
#endif
    }
}

#ifdef INSTANCES
/** Whether the ray has come to a placed mesh, or to the end of one. */
bool changesTree(Traversal t) {
    return t.pending >= 0 || (t.inside >= 0 && !t.descending && (t.leafMask | t.nextMask) == 0u);
}

/** Takes the ray into the placed mesh that it has come to, or back to the scene's tree. */
void changeTree(inout Traversal t) {
    const bool enters = t.pending >= 0;
    const int index = max(t.pending, 0) * 9;
    const Placement placement = placementOf(max(t.pending, 0));
    const uvec4 row0 = texelFetch(uPlaced, index + 6), row1 = texelFetch(uPlaced, index + 7), row2 = texelFetch(uPlaced, index + 8);
    const vec3 x = uintBitsToFloat(row0.xyz), y = uintBitsToFloat(row1.xyz), z = uintBitsToFloat(row2.xyz);
    const vec3 moved = vec3(dvec3(t.ray.origin) - placement.origin);
    const vec3 direction = vec3(dot(x, t.direction), dot(y, t.direction), dot(z, t.direction));
    const vec3 inverse = vec3(finiteInverse(direction.x), finiteInverse(direction.y), finiteInverse(direction.z));
    const float reach = uintBitsToFloat((row0.w >> 24) << 23);
    const float size = (max(max(abs(moved.x), abs(moved.y)), abs(moved.z)) + reach) * 9.5367431640625e-07;
    const vec3 rows = vec3(dot(abs(x), vec3(1.0)), dot(abs(y), vec3(1.0)), dot(abs(z), vec3(1.0)));
    t.from = enters ? vec3(dot(x, moved), dot(y, moved), dot(z, moved)) : t.ray.origin;
    t.inverse = enters ? inverse : t.worldInverse;
    t.margin = enters ? rows * size * abs(inverse) : vec3(0.0);
    t.octant = (t.inverse.x < 0.0 ? 1u : 0u) | (t.inverse.y < 0.0 ? 2u : 0u) | (t.inverse.z < 0.0 ? 4u : 0u);
    t.placement = placement;
    t.slotOffset = enters ? int(row1.w) : 0;
    t.inside = enters ? int(row2.w) : -1;
    t.pending = -1;
    // What is left of the one tree takes the other's place.
    const uint group = t.group;
    const uvec3 leaves = uvec3(t.leafMask, t.leafAll, t.leafBase), next = uvec3(t.nextMask, t.nextAll, t.nextBase);
    t.group = enters ? ((row0.w & 0xffffffu) << 8) | (1u << t.octant) : t.waitingGroup;
    t.descending = t.group != 0u;
    t.leafMask = enters ? 0u : t.waitingLeaves.x;
    t.leafAll = t.waitingLeaves.y;
    t.leafBase = t.waitingLeaves.z;
    t.nextMask = enters ? 0u : t.waitingNext.x;
    t.nextAll = t.waitingNext.y;
    t.nextBase = t.waitingNext.z;
    t.waitingGroup = group;
    t.waitingLeaves = leaves;
    t.waitingNext = next;
    exchangeOnStack(0u, enters, false);
}
#endif

/** One turn: a node where the queue has room, and a triangle where one waits. */
void takeTurn(inout Traversal t, const bool any) {
    ++t.steps;
#ifdef INSTANCES
    if (changesTree(t)) changeTree(t);
#endif
    if (t.descending && t.nextMask == 0u) visitNode(t);
    if (t.leafMask == 0u) {
        t.leafMask = t.nextMask;
        t.leafAll = t.nextAll;
        t.leafBase = t.nextBase;
        t.nextMask = 0u;
    }
#if defined(SHAPES) || defined(INSTANCES)
    if (t.leafMask != 0u) visitTriangle(t, any);
#else
    visitTriangle(t, any);  // a condition here has lavapipe mask each of its results a second time
#endif
}

/** Finds the triangle nearest along the ray within (0, nearest), or, where `any` is set, any one. `nearest`
 * becomes its distance, `slot` its slot (-1: none). `source` and `target`: see Traversal. A ray with
 * nearest <= 0 does nothing. Returns the turns taken. */
int traverse(vec3 origin, vec3 direction, const bool any, int source, ivec2 target, inout float nearest, out int slot) {
    Traversal t = beginTraversal(origin, direction, source, target, nearest);
    while (isBusy(t)) takeTurn(t, any);
    nearest = t.nearest;
    slot = t.slot;
    return t.steps;
}
#endif
