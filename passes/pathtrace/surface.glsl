#ifndef HELIOGRAPH_PATHTRACE_SURFACE
#define HELIOGRAPH_PATHTRACE_SURFACE
/** @file The surface at a hit. */
#include "shaders/intersection/offset.glsl"
#include "shaders/intersection/triangle.glsl"
#include "shaders/scene/attributes.glsl"
#include "shaders/scene/materials.glsl"
#include "shaders/scene/triangles.glsl"

/** Directions to lights that are asked where the camera's ray arrives; at later surfaces it is one. The rays to a surface
 * and on from it cost more than one to a light, which brings most of the noise where lamps or surroundings are large. */
#ifndef LIGHTS_ASKED
#define LIGHTS_ASKED 1
#endif

/** Where a ray met the scene. */
struct SurfacePoint {
    vec3 position;
    vec3 face;      ///< unit geometric normal on the ray's side
    vec3 shading;   ///< unit shading normal, turned with `face`
    bool front;
    float offset;   ///< along `face`, for rays that leave
    vec3 b;         ///< barycentrics of the corners
    Triangle triangle;
};

#ifdef SHAPES
#include "shaders/intersection/shape.glsl"
#include "shaders/scene/sphere_light.glsl"

/** The point of a shape that a ray meets, in `s`, whose triangle is the shape. `b` are such that attributes at a
 * triangle's corners give the shape's (shapeTexcoords in engine/scene/shape.hpp). */
void shapePoint(vec3 origin, vec3 direction, bool leaves, inout SurfacePoint s) {
    vec3 normal = vec3(0.0);
    if (HAS_FLAT_SHAPES && isFlat(s.triangle)) {
        const vec2 at = flatCoordinates(shearOf(origin, direction), s.triangle);
        const vec3 a = s.triangle.v1 * at.x, b = s.triangle.v2 * at.y;
        s.b = vec3(1.0 - at.x - at.y, at);
        s.position = s.triangle.v0 + a + b;
        normal = flatNormal(s.triangle);
        s.offset = OFFSET_ROUNDOFF * dot(abs(normal), abs(s.triangle.v0) + abs(a) + abs(b));
    }
    if (HAS_SPHERES && s.triangle.shape == SHAPE_SPHERE) {
        const float radius = length(s.triangle.v1);
        const SphereMeeting m = meetSphere(origin, direction, s.triangle.v0, radius);
        normal = normalize(m.inside ? m.middle + m.half_ : m.middle - m.half_);
        s.position = s.triangle.v0 + radius * normal;
        // Two sums err by u of the position each, the normal's length by 3u; u is a tenth of OFFSET_ROUNDOFF.
        s.offset = OFFSET_ROUNDOFF * (0.3 * dot(abs(normal), abs(s.position)) + 0.6 * radius);
        const vec2 uv = sphereCoordinates(normal, s.triangle.v1, s.triangle.v2);
        s.b = vec3(1.0 - uv.x - uv.y, uv);
    }
    if (HAS_TORI && s.triangle.shape == SHAPE_TORUS) {
        const TorusMeeting m = meetsTorus(origin, direction, s.triangle, leaves);
        normal = m.normal;
        s.position = s.triangle.v0 + m.point;
        s.offset = OFFSET_ROUNDOFF * (0.3 * dot(abs(normal), abs(s.position)) + 0.6 * (length(s.triangle.v1) + length(s.triangle.v2)));
        const vec3 x = normalize(s.triangle.v1), y = normalize(s.triangle.v2), z = cross(x, y);
        const vec2 level = vec2(dot(m.point, x), dot(m.point, y));
        const vec2 uv = 0.5 + INV_TWO_PI * vec2(realAtan2(level.y, level.x),
                                                realAtan2(dot(normal, z), dot(normal, x * level.x + y * level.y) / length(level)));
        s.b = vec3(1.0 - uv.x - uv.y, uv);
    }
    s.front = dot(normal, direction) < 0.0;
    s.face = s.front ? normal : -normal;
    s.shading = s.face;
}
#endif

/** The point of the triangle or shape in `slot` that a ray from `source` meets. */
SurfacePoint surfaceAt(vec3 origin, vec3 direction, int source, int slot) {
    SurfacePoint s;
    s.triangle = fetchTriangle(slot);
    const vec3 v0 = s.triangle.v0, v1 = s.triangle.v1, v2 = s.triangle.v2;
    s.b = barycentrics(shearOf(origin, direction), v0, v1, v2);
    s.position = s.b.x * v0 + s.b.y * v1 + s.b.z * v2;
    const vec3 across = cross(v1 - v0, v2 - v0);
    // Scaled first: the square of a small triangle's normal is no normal float.
    const float largest = max(max(abs(across.x), abs(across.y)), abs(across.z));
    const vec3 scaled = across / (largest > 0.0 ? largest : 1.0);
    const vec3 normal = scaled / max(length(scaled), 0.5);
    s.front = dot(normal, direction) < 0.0;
    s.face = s.front ? normal : -normal;
#ifdef INSTANCES
    const vec3 shading = shadingNormal(s.triangle, s.b, normal);
#else
    const vec3 shading = shadingNormal(s.triangle.g, s.b, normal);
#endif
    s.shading = s.front ? shading : -shading;
    s.offset = offsetDistance(v0, v1, v2, normal);
#ifdef SHAPES
    if (s.triangle.shape > 0) shapePoint(origin, direction, source == slot, s);
#endif
    return s;
}

/** Derivatives of the position by the second and the third of `b`. */
void surfaceEdges(SurfacePoint s, out vec3 e1, out vec3 e2) {
    e1 = s.triangle.v1 - s.triangle.v0;
    e2 = s.triangle.v2 - s.triangle.v0;
#ifdef SHAPES
    if (s.triangle.shape > 0) {
        e1 = s.triangle.v1;
        e2 = s.triangle.v2;
    }
    if (HAS_SPHERES && s.triangle.shape == SHAPE_SPHERE) {
        const vec3 y = normalize(s.triangle.v2), z = cross(normalize(s.triangle.v1), y);
        const vec3 out_ = s.position - s.triangle.v0;
        e1 = TWO_PI * cross(y, out_);
        const float across = length(e1);
        // Downwards along the meridian: the normal times the parallel's direction.
        e2 = PI * (across > 0.0 ? cross(out_, e1 / -across) : length(out_) * z);
    }
    if (HAS_TORI && s.triangle.shape == SHAPE_TORUS) {
        const vec3 axis = flatNormal(s.triangle), normal = s.front ? s.face : -s.face;
        const vec3 out_ = s.position - s.triangle.v0;
        e1 = TWO_PI * cross(axis, out_);
        e2 = TWO_PI * length(s.triangle.v2) * cross(normal, normalize(e1));
    }
#endif
}

/** Whether a ray that left the surface in `slot` along `direction` and came `distance` far, to `end`, went behind its front. */
bool leftInwards(int slot, vec3 end, vec3 direction, float distance) {
    const Triangle t = fetchTriangle(slot);
    vec3 normal = cross(t.v1 - t.v0, t.v2 - t.v0);
#ifdef SHAPES
    if (t.shape > 0) normal = isFlat(t) ? flatNormal(t) : end - direction * distance - t.v0;
    if (HAS_TORI && t.shape == SHAPE_TORUS) {
        // From the ring to where the ray started.
        const vec3 axis = flatNormal(t), level = normal - dot(normal, axis) * axis;
        normal -= level * (length(t.v1) / max(length(level), 1e-30));
    }
#endif
    return dot(normal, direction) < 0.0;
}
#endif
