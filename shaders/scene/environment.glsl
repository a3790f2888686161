#ifndef HELIOGRAPH_SCENE_ENVIRONMENT
#define HELIOGRAPH_SCENE_ENVIRONMENT
/** @file
 * A latitude-longitude image as light from everywhere: +Y up, u = 1/2 - atan2(x, z) / 2 pi, v = acos(y) / pi from
 * the top, looked up bilinearly, repeating in u.
 *
 * Directions are drawn with a density that follows the same interpolation: a *cell* lies between four texel
 * centres, and within it the density is bilinear in longitude and in the cosine of the polar angle, in which solid
 * angle is uniform. It is positive wherever the image is not black, continuous, finite at the poles, and costs the
 * same four texels as the radiance. Cosines are kept as h = sin^2 of half the angle from the nearer pole, so that
 * nothing cancels there.
 *
 * Only in kernels compiled with ENVIRONMENT_IMAGE.
 */
#include "shaders/sampling/hash.glsl"
#include "shaders/shared/trigonometry.glsl"

/**
 * Header (kEnvironmentHeader texels): chance of the light table to choose the environment, bits of its row there
 * (-1: none); rows of the rotation from the world to the image. Then width x height texels: radiance RGB, density over
 * solid angle. Then of each row of cells, height + 1: h of its upper boundary, its extent in h. Then trees of
 * passes/scene/inversion_tree.hpp, a node a texel: over the rows, and of each row over its cells.
 */
layout(set = 0, binding = 32) uniform samplerBuffer uEnvironmentMap;
const int ENVIRONMENT_HEADER = 4;
layout(constant_id = 112) const int ENVIRONMENT_WIDTH = 1;
layout(constant_id = 113) const int ENVIRONMENT_HEIGHT = 1;
layout(constant_id = 114) const int ENVIRONMENT_ROW_LEVELS = 1;
layout(constant_id = 115) const int ENVIRONMENT_COLUMN_LEVELS = 1;
layout(constant_id = 116) const bool ENVIRONMENT_ROTATED = false;
layout(constant_id = 133) const int ENVIRONMENT_ROW_NODES = 1;
layout(constant_id = 134) const int ENVIRONMENT_COLUMN_NODES = 1;

struct EnvironmentRadiance {
    vec3 radiance;
    float density;  ///< over solid angle, with which sampleEnvironment() draws the direction
};

int environmentRow(int row) {
    return ENVIRONMENT_HEADER + ENVIRONMENT_WIDTH * ENVIRONMENT_HEIGHT + row;
}

/** The four texels around a cell. */
void environmentCorners(ivec2 cell, out vec4 a, out vec4 b, out vec4 c, out vec4 d) {
    const int right = cell.x + 1 == ENVIRONMENT_WIDTH ? 0 : cell.x + 1;
    const int above = ENVIRONMENT_HEADER + ENVIRONMENT_WIDTH * max(cell.y - 1, 0);
    const int below = ENVIRONMENT_HEADER + ENVIRONMENT_WIDTH * min(cell.y, ENVIRONMENT_HEIGHT - 1);
    a = texelFetch(uEnvironmentMap, above + cell.x);
    b = texelFetch(uEnvironmentMap, above + right);
    c = texelFetch(uEnvironmentMap, below + cell.x);
    d = texelFetch(uEnvironmentMap, below + right);
}

/** s: along u, from the left texel; t: along v, from the upper one; area: the same in the cosine. */
EnvironmentRadiance environmentBlend(vec4 a, vec4 b, vec4 c, vec4 d, float s, float t, float area) {
    // Exact where texels are equal: a constant image is the constant environment.
    const vec4 upper = a + (b - a) * s, lower = c + (d - c) * s;
    return EnvironmentRadiance(upper.rgb + (lower.rgb - upper.rgb) * t, max(upper.w + (lower.w - upper.w) * area, 0.0));
}

/** A direction of the world in the image's frame. */
vec3 toEnvironment(vec3 direction) {
    vec3 q = direction;
    if (ENVIRONMENT_ROTATED)
        q = vec3(dot(texelFetch(uEnvironmentMap, 1).xyz, direction), dot(texelFetch(uEnvironmentMap, 2).xyz, direction),
                 dot(texelFetch(uEnvironmentMap, 3).xyz, direction));
    return q;
}

/** What comes from a unit direction. */
EnvironmentRadiance environmentAt(vec3 direction) {
    const vec3 q = toEnvironment(direction);
    const float x = (0.5 - realAtan2(q.x, q.z) * INV_TWO_PI) * float(ENVIRONMENT_WIDTH) - 0.5;
    const float left = floor(x);
    const int column = left < 0.0 ? ENVIRONMENT_WIDTH - 1 : min(int(left), ENVIRONMENT_WIDTH - 1);

    const bool top = q.y >= 0.0;
    const float aside = q.x * q.x + q.z * q.z;
    const float h = min(aside / (2.0 * (1.0 + abs(q.y))), 1.0);  // sin^2 of half the angle
    const float angle = realAsin(sqrt(h)) * (2.0 * INV_PI);
    const float y = (top ? angle : 1.0 - angle) * float(ENVIRONMENT_HEIGHT) + 0.5;
    const int row = clamp(int(y), 0, ENVIRONMENT_HEIGHT);
    const vec2 boundary = texelFetch(uEnvironmentMap, environmentRow(row)).xy;
    const bool rowTop = row <= ENVIRONMENT_HEIGHT / 2;
    const float area = clamp(((rowTop == top ? h : 1.0 - h) - boundary.x) / boundary.y, 0.0, 1.0);

    vec4 a, b, c, d;
    environmentCorners(ivec2(column, row), a, b, c, d);
    return environmentBlend(a, b, c, d, clamp(x - left, 0.0, 1.0), clamp(y - float(row), 0.0, 1.0), area);
}

/** Where a way down a tree is: its node and level's first texel, and the words, `low` to before `high`, that lead here. */
struct InversionStep {
    int level, node;
    uint low, high;
};

void goDown(inout InversionStep at, uint word, int nodes) {
    const uvec3 first = floatBitsToUint(texelFetch(uEnvironmentMap, at.level + at.node).xyz);
    const bvec3 past = greaterThanEqual(uvec3(word), first);
    at.low = past.z ? first.z : past.y ? first.y : past.x ? first.x : at.low;
    at.high = !past.x ? first.x : !past.y ? first.y : !past.z ? first.z : at.high;
    at.node = 4 * at.node + int(past.x) + int(past.y) + int(past.z);
    at.level += nodes;
}

/** The entry of a tree at texel `root` that has a random word, and uniform numbers from what is left of it. `entries`
 * and `levels` are constants: the driver leaves out the steps that are not there. */
int inversion(int root, int entries, int levels, uint random, out float rest) {
    const uint word = min(random, 0xfffffffeu);
    InversionStep at = InversionStep(root, 0, 0u, 0xffffffffu);
#define INVERSION_STEP(depth) \
    if (levels > depth) goDown(at, word, ((entries - 1) >> (2 * (levels - depth))) + 1);
    INVERSION_STEP(0)
    INVERSION_STEP(1)
    INVERSION_STEP(2)
    INVERSION_STEP(3)
    INVERSION_STEP(4)
    INVERSION_STEP(5)
    INVERSION_STEP(6)
    INVERSION_STEP(7)
    INVERSION_STEP(8)
    INVERSION_STEP(9)
    INVERSION_STEP(10)
    INVERSION_STEP(11)
    INVERSION_STEP(12)
#undef INVERSION_STEP
    rest = float(word - at.low) / float(max(at.high - at.low, 1u));
    return at.node;
}

/** x in [0, 1] with density in proportion to a (1 - x) + b x, from a uniform number; in a form without
 * cancellation. */
float sampleLinear(float u, float a, float b) {
    const float largest = max(max(a, b), 1e-37);
    const float from = a / largest, to = b / largest;
    return min(u * (from + to) / max(from + sqrt(from * from + u * (to * to - from * from)), 1e-37), 1.0);
}

/** Draws a direction in proportion to brightness, from 2 x 32 random bits. */
EnvironmentRadiance sampleEnvironment(uvec2 random, out vec3 direction) {
    const int rows = ENVIRONMENT_HEIGHT + 1, tree = environmentRow(rows);
    vec2 rest;
    const int row = inversion(tree, rows, ENVIRONMENT_ROW_LEVELS, random.x, rest.x);
    const vec2 boundary = texelFetch(uEnvironmentMap, environmentRow(row)).xy;
    const int column = inversion(tree + ENVIRONMENT_ROW_NODES + row * ENVIRONMENT_COLUMN_NODES, ENVIRONMENT_WIDTH,
                                 ENVIRONMENT_COLUMN_LEVELS, random.y, rest.y);

    vec4 a, b, c, d;
    environmentCorners(ivec2(column, row), a, b, c, d);
    const float area = sampleLinear(rest.x, a.w + b.w, c.w + d.w);
    const float s = sampleLinear(rest.y, a.w + (c.w - a.w) * area, b.w + (d.w - b.w) * area);

    const float h = clamp(boundary.x + area * boundary.y, 0.0, 1.0);
    const bool top = row <= ENVIRONMENT_HEIGHT / 2;
    const float angle = realAsin(sqrt(h)) * (2.0 * INV_PI);
    const float y = (top ? angle : 1.0 - angle) * float(ENVIRONMENT_HEIGHT) + 0.5 - float(row);
    float sine, cosine;
    sinCosTurns((float(column) + 0.5 + s) / float(ENVIRONMENT_WIDTH), sine, cosine);
    const float aside = 2.0 * sqrt(h * (1.0 - h)), along = 1.0 - 2.0 * h;
    direction = vec3(aside * sine, top ? along : -along, -aside * cosine);
    if (ENVIRONMENT_ROTATED)
        direction = texelFetch(uEnvironmentMap, 1).xyz * direction.x + texelFetch(uEnvironmentMap, 2).xyz * direction.y +
                    texelFetch(uEnvironmentMap, 3).xyz * direction.z;
    return environmentBlend(a, b, c, d, s, clamp(y, 0.0, 1.0), area);
}
#endif
