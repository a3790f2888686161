#ifndef HELIOGRAPH_SCENE_SOLID_ANGLE_LIGHT
#define HELIOGRAPH_SCENE_SOLID_ANGLE_LIGHT
/** @file
 * Points on rectangles and triangles, uniform over the solid angle that they fill: Urena, Fajardo and King, "An
 * area-preserving parametrization for spherical rectangles", 2013; Arvo, "Stratified sampling of spherical triangles",
 * 1995. Everything is relative to the light's size, so that no scale over- or underflows.
 *
 * A solid angle is a difference of angles, in which rounding leaves an error of 1e-6. From LEAST_SOLID_ANGLE on this is
 * 2e-5 of it; below, the light is far or grazing, and points are taken evenly over its area.
 */
#include "shaders/shared/trigonometry.glsl"

const float LEAST_SOLID_ANGLE = 0.05;

/** A rectangle from its corner along `edge1` and `edge2`, as seen from p, in units of the longer edge. */
struct SeenRectangle {
    vec2 from, to;     ///< corners in its own axes, about the foot of p's perpendicular
    float height;      ///< distance of p from its plane
    float turn;        ///< 2 pi less the spherical angles at the last two corners
    vec2 normals;      ///< z of the normals of the planes through p and the first and third edge
    float solidAngle;
};

bool isRectangle(vec3 edge1, vec3 edge2) {
    const float a = dot(edge1, edge2);
    return abs(a) <= 1e-6 * length(edge1) * length(edge2);
}

SeenRectangle seenRectangle(vec3 p, vec3 corner, vec3 edge1, vec3 edge2) {
    const vec2 lengths = vec2(length(edge1), length(edge2));
    const float unit = 1.0 / max(lengths.x, lengths.y);
    const vec3 x = edge1 / lengths.x, y = edge2 / lengths.y, d = (corner - p) * unit;
    SeenRectangle r;
    r.from = vec2(dot(d, x), dot(d, y));
    r.to = r.from + lengths * unit;
    r.height = max(abs(dot(d, cross(x, y))), 1e-12);
    const float h2 = r.height * r.height;
    // Of the planes through p and the edges at y = from, x = to, y = to, x = from.
    const vec4 sides = vec4(-r.from.y, r.to.x, r.to.y, -r.from.x);
    r.normals = sides.xz / sqrt(h2 + sides.xz * sides.xz);
    // The angle between two of them is pi / 2 + asin(n n'): what is more than a plane quadrangle's 2 pi is the area. As
    // arctangents, since sines near 1 say little.
    const vec4 next = sides.yzwx, up = sides * next, level = r.height * sqrt(h2 + sides * sides + next * next);
    const vec4 angles = vec4(realAtan2(up.x, level.x), realAtan2(up.y, level.y), realAtan2(up.z, level.z), realAtan2(up.w, level.w));
    r.turn = PI - angles.z - angles.w;
    r.solidAngle = (angles.x + angles.z) + (angles.y + angles.w);
    return r;
}

/** The place of the direction that u draws: multiples of the edges. */
vec2 rectanglePlace(SeenRectangle r, vec2 u) {
    float sine, cosine;
    realSinCos(u.x * r.solidAngle + r.turn, sine, cosine);
    const float across = cosine * r.normals.x - r.normals.y;
    const float c = sine * (across < 0.0 ? -1.0 : 1.0) / sqrt(max(across * across + square(sine * r.normals.x), 1e-30));
    const float x = clamp(c * r.height / sqrt(max(1.0 - c * c, 1e-12)), r.from.x, r.to.x);
    const float d = sqrt(x * x + r.height * r.height);
    const vec2 h = vec2(r.from.y / sqrt(d * d + r.from.y * r.from.y), r.to.y / sqrt(d * d + r.to.y * r.to.y));
    const float v = mix(h.x, h.y, u.y);
    const float y = clamp(v * d / sqrt(max(1.0 - v * v, 1e-12)), r.from.y, r.to.y);
    return (vec2(x, y) - r.from) / (r.to - r.from);
}

/** A triangle as seen from p: unit directions to its corners. */
struct SeenTriangle {
    vec3 a, b, c;
    float triple;  ///< six times the volume that they span
    float solidAngle;
};

SeenTriangle seenTriangle(vec3 p, vec3 corner, vec3 edge1, vec3 edge2) {
    SeenTriangle t;
    const float unit = 1.0 / max(length(edge1), length(edge2));
    const vec3 d = (corner - p) * unit, e1 = edge1 * unit, e2 = edge2 * unit;
    const vec3 lengths = max(vec3(length(d), length(d + e1), length(d + e2)), 1e-12);
    t.a = d / lengths.x;
    t.b = (d + e1) / lengths.y;
    t.c = (d + e2) / lengths.z;
    // Of edges rather than of corners, which cancel where the triangle is far.
    t.triple = abs(dot(d, cross(e1, e2))) / (lengths.x * lengths.y * lengths.z);
    // Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983.
    t.solidAngle = 2.0 * realAtan2(t.triple, 1.0 + dot(t.a, t.b) + dot(t.b, t.c) + dot(t.c, t.a));
    return t;
}

/** What is left of v across the unit vector `axis`, as a unit vector. */
vec3 acrossAxis(vec3 v, vec3 axis) {
    const vec3 w = v - dot(v, axis) * axis;
    return w / max(length(w), 1e-12);
}

/** The direction from p that u draws. */
vec3 triangleDirection(SeenTriangle t, vec2 u) {
    // The angle at a: sine and cosine up to a common factor.
    const float ab = dot(t.a, t.b), ac = dot(t.a, t.c);
    const float beside = dot(t.b, t.c) - ab * ac;
    const float scale = 1.0 / max(length(vec2(t.triple, beside)), 1e-20);
    const float sine = t.triple * scale, cosine = beside * scale;
    float sineArea, cosineArea;
    realSinCos(u.x * t.solidAngle, sineArea, cosineArea);
    const float s = sineArea * cosine - cosineArea * sine, c = cosineArea * cosine + sineArea * sine;
    const float m = c - cosine, k = s + sine * ab;
    const float below = (k * s + m * c) * sine;
    const float q = clamp(((k * c - m * s) * cosine - k) / (abs(below) > 1e-20 ? below : 1e-20), -1.0, 1.0);
    const vec3 third = q * t.a + sqrt(max(1.0 - q * q, 0.0)) * acrossAxis(t.c, t.a);
    const float z = 1.0 - u.y * (1.0 - dot(third, t.b));
    return z * t.b + sqrt(max(1.0 - z * z, 0.0)) * acrossAxis(third, t.b);
}

/** Where a direction from p meets the triangle: multiples of its edges, within it. */
vec2 trianglePlace(vec3 p, vec3 corner, vec3 edge1, vec3 edge2, vec3 direction) {
    const float unit = 1.0 / max(length(edge1), length(edge2));
    const vec3 d = (corner - p) * unit, e1 = edge1 * unit, e2 = edge2 * unit;
    const vec3 n = cross(e1, e2);
    const float towards = dot(n, direction);
    const vec3 r = direction * (dot(n, d) / (towards != 0.0 ? towards : 1e-20)) - d;
    const float squared = max(dot(n, n), 1e-30);
    const vec2 s = clamp(vec2(dot(cross(r, e2), n), dot(cross(e1, r), n)) / squared, 0.0, 1.0);
    return s / max(s.x + s.y, 1.0);
}

/** What the chance per solid angle of a light needs: 0 where points are taken over its area. `isTriangle`: else a
 * parallelogram, whose solid angle is known where it is a rectangle. */
float sampledSolidAngle(vec3 p, bool isTriangle, vec3 corner, vec3 edge1, vec3 edge2) {
    float found = 0.0;
    if ((SOLID_ANGLES & 1) != 0 && !isTriangle && isRectangle(edge1, edge2))
        found = seenRectangle(p, corner, edge1, edge2).solidAngle;
    if ((SOLID_ANGLES & 2) != 0 && isTriangle) found = seenTriangle(p, corner, edge1, edge2).solidAngle;
    return found >= LEAST_SOLID_ANGLE ? found : 0.0;
}

/** The same, and the place that u draws where it is not 0: multiples of the edges. */
float sampleSolidAngle(vec3 p, bool isTriangle, vec3 corner, vec3 edge1, vec3 edge2, vec2 u, inout vec2 place) {
    float found = 0.0;
    if ((SOLID_ANGLES & 1) != 0 && !isTriangle && isRectangle(edge1, edge2)) {
        const SeenRectangle r = seenRectangle(p, corner, edge1, edge2);
        found = r.solidAngle;
        if (found >= LEAST_SOLID_ANGLE) place = rectanglePlace(r, u);
    }
    if ((SOLID_ANGLES & 2) != 0 && isTriangle) {
        const SeenTriangle t = seenTriangle(p, corner, edge1, edge2);
        found = t.solidAngle;
        if (found >= LEAST_SOLID_ANGLE) place = trianglePlace(p, corner, edge1, edge2, triangleDirection(t, u));
    }
    return found >= LEAST_SOLID_ANGLE ? found : 0.0;
}
#endif
