// Irradiance from a uniform polygon, unoccluded and exact: Lambert's formula (Photometria, 1760).
#ifndef SHADERS_RASTER_POLYGON_LIGHT_GLSL
#define SHADERS_RASTER_POLYGON_LIGHT_GLSL

#include "shaders/shared/trigonometry.glsl"
#include "shaders/shared/vector.glsl"

// With unit directions u_i to the corners, E = L/2 |n . sum angle_i/sin(angle_i) u_i x u_i+1| over the part of the
// polygon above the receiver's horizon. The walk cuts edges at the horizon one by one; a convex polygon goes down once
// and comes up once, and the edge along the horizon between the two closes it.
//
// A polygon that is small for its distance gives a sum of the order of its area from terms of the order of its size.
// So the sum is split: angle/sin = 1 + f, f ~ angle^2/6. For a closed polygon sum u_i x u_i+1 = sum w_i x w_i+1 with
// w_i = u_i - u_0, which is of the right order, and w_i is formed from the edges without a difference of directions.
struct PolygonWalk {
    vec3 normal;     // of the receiver
    vec3 corner;     // first corner, relative to the receiver; others are given relative to it
    float distance;  // to the first corner
    float sum;
    vec3 down, up;  // where the outline crosses the horizon, relative to the first corner
    bool crosses;
};

PolygonWalk beginPolygon(vec3 normal, vec3 corner) {
    return PolygonWalk(normal, corner, max(lengthSafe(corner), 1e-30), 0.0, vec3(0.0), vec3(0.0), false);
}

/// angle/sin(angle) - 1 for 0 <= angle < pi.
float angleExcess(float sine, float cosine) {
    float s2 = sine * sine;
    float series = s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (15.0 / 336.0 + s2 * (35.0 / 1152.0))));
    float whole = realAtan2(sine, cosine) / max(sine, 1e-30) - 1.0;
    // A corner next to the opposite of another has no plane of its own: the term is left out.
    return cosine > 0.0 && s2 < 0.01 ? series : sine > 0.0 ? whole : 0.0;
}

/// One edge's term of the sum, between corners relative to the first.
float edgeTerm(PolygonWalk walk, vec3 a, vec3 b) {
    vec3 first = walk.corner / walk.distance;
    vec3 va = walk.corner + a, vb = walk.corner + b;
    float la = max(lengthSafe(va), 1e-30), lb = max(lengthSafe(vb), 1e-30);
    // |v| - |v_0| = (v - v_0).(v + v_0) / (|v| + |v_0|).
    vec3 wa = (a - first * (dot(a, va + walk.corner) / (la + walk.distance))) / la;
    vec3 wb = (b - first * (dot(b, vb + walk.corner) / (lb + walk.distance))) / lb;
    vec3 ua = va / la, across = cross(ua, wb - wa);
    float excess = angleExcess(lengthSafe(across), dot(ua, vb) / lb);
    return dot(walk.normal, cross(wa, wb) + excess * across);
}

/// Adds the edge from a to b, relative to the first corner.
void polygonEdge(inout PolygonWalk walk, vec3 a, vec3 b) {
    float ha = dot(walk.normal, walk.corner + a), hb = dot(walk.normal, walk.corner + b);
    bool aAbove = ha > 0.0, bAbove = hb > 0.0;
    vec3 cut = aAbove ? a + (b - a) * (ha / (ha - hb)) : b + (a - b) * (hb / (hb - ha));
    if (aAbove != bAbove) {
        walk.crosses = true;
        if (aAbove) walk.down = cut;
        else walk.up = cut;
    }
    float term = edgeTerm(walk, aAbove ? a : cut, bAbove ? b : cut);
    walk.sum += aAbove || bAbove ? term : 0.0;
}

/// Irradiance over radiance.
float endPolygon(PolygonWalk walk) {
    float closing = edgeTerm(walk, walk.down, walk.up);
    return 0.5 * abs(walk.sum + (walk.crosses ? closing : 0.0));
}

/// Of the convex quadrilateral corner, corner + b, corner + c, corner + d; two corners may coincide.
float quadIrradiance(vec3 normal, vec3 corner, vec3 b, vec3 c, vec3 d) {
    PolygonWalk walk = beginPolygon(normal, corner);
    polygonEdge(walk, vec3(0.0), b);
    polygonEdge(walk, b, c);
    polygonEdge(walk, c, d);
    polygonEdge(walk, d, vec3(0.0));
    return endPolygon(walk);
}

#endif
