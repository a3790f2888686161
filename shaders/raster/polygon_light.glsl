// Irradiance from a uniform polygon, unoccluded and exact: Lambert's formula (Photometria, 1760).
#ifndef SHADERS_RASTER_POLYGON_LIGHT_GLSL
#define SHADERS_RASTER_POLYGON_LIGHT_GLSL

#include "shaders/shared/trigonometry.glsl"
#include "shaders/shared/vector.glsl"

// With unit directions u_i to the corners, E = L/2 |sum angle(u_i, u_i+1) n.(u_i x u_i+1)/|u_i x u_i+1||, for the part
// of the polygon above the receiver's horizon. The walk cuts edges at the horizon one by one; a convex polygon goes
// down once and comes up once, and the edge along the horizon between the two closes it.
struct PolygonWalk {
    vec3 normal;    // of the receiver
    float sum;
    vec3 down, up;  // where the outline crosses the horizon
    bool crosses;
};

PolygonWalk beginPolygon(vec3 normal) { return PolygonWalk(normal, 0.0, vec3(0.0), vec3(0.0), false); }

/// angle(a, b) n.(a x b)/|a x b| for directions of any length.
float edgeTerm(vec3 a, vec3 b, vec3 normal) {
    // b - a first: for a polygon far away a x b would cancel.
    vec3 c = cross(a, b - a);
    float sine = lengthSafe(c);
    float cosine = dot(a, b);
    return sine > 0.0 ? realAtan2(sine, cosine) / sine * dot(normal, c) : 0.0;
}

/// Adds the edge from a to b, corners relative to the receiver.
void polygonEdge(inout PolygonWalk walk, vec3 a, vec3 b) {
    float ha = dot(walk.normal, a), hb = dot(walk.normal, b);
    bool aAbove = ha > 0.0, bAbove = hb > 0.0;
    // The same expression whichever way the edge is walked.
    vec3 cut = aAbove ? a + (b - a) * (ha / (ha - hb)) : b + (a - b) * (hb / (hb - ha));
    if (aAbove != bAbove) {
        walk.crosses = true;
        if (aAbove) walk.down = cut;
        else walk.up = cut;
    }
    vec3 from = aAbove ? a : cut, to = bAbove ? b : cut;
    float term = edgeTerm(from, to, walk.normal);
    walk.sum += aAbove || bAbove ? term : 0.0;
}

/// Irradiance over radiance.
float endPolygon(PolygonWalk walk) {
    float closing = edgeTerm(walk.down, walk.up, walk.normal);
    return 0.5 * abs(walk.sum + (walk.crosses ? closing : 0.0));
}

float triangleIrradiance(vec3 normal, vec3 a, vec3 b, vec3 c) {
    PolygonWalk walk = beginPolygon(normal);
    polygonEdge(walk, a, b);
    polygonEdge(walk, b, c);
    polygonEdge(walk, c, a);
    return endPolygon(walk);
}

float quadIrradiance(vec3 normal, vec3 a, vec3 b, vec3 c, vec3 d) {
    PolygonWalk walk = beginPolygon(normal);
    polygonEdge(walk, a, b);
    polygonEdge(walk, b, c);
    polygonEdge(walk, c, d);
    polygonEdge(walk, d, a);
    return endPolygon(walk);
}

#endif
