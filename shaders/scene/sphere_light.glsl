#ifndef HELIOGRAPH_SCENE_SPHERE_LIGHT
#define HELIOGRAPH_SCENE_SPHERE_LIGHT
/** @file
 * Directions to a sphere, uniform over the cone that it fills; from within, over its surface. Shirley, Wang and
 * Zimmerman, "Monte Carlo techniques for direct lighting calculations", 1996, in forms that do not cancel where the
 * sphere is far or near.
 */
#include "shaders/sampling/warp.glsl"
#include "shaders/shared/trigonometry.glsl"

/** Texture coordinates of the point whose normal is `n`, on a sphere with the axes x and y (engine/scene/shape.hpp). */
vec2 sphereCoordinates(vec3 n, vec3 xAxis, vec3 yAxis) {
    const vec3 x = normalize(xAxis), y = normalize(yAxis), z = cross(x, y);
    return vec2(0.5 + INV_TWO_PI * realAtan2(dot(n, x), dot(n, z)), INV_PI * realAcos(clamp(dot(n, y), -1.0, 1.0)));
}

/** Whether a point as far from the centre is outside; rounding leaves a receiver on the sphere on either side of it, which
 * counts as within. */
bool isOutside(float d, float radius) {
    return d > radius * 1.0001;
}

/** Cosine of the cone's angle, for a sphere of `radius` whose centre lies at the distance `d` > radius. */
float coneCosine(float d, float radius) {
    const float sine = radius / d;
    return sqrt((1.0 - sine) * (1.0 + sine));
}

/** Density over solid angle of a direction from p, times the sphere's area: with it, a chance per area becomes one
 * per solid angle. Where p is inside, `distance` is that along the direction, and `cosine` at the surface. */
float sphereDensity(vec3 p, vec3 centre, float radius, float distance, float cosine) {
    const vec3 w = centre - p;
    const float squared = dot(w, w), d = sqrt(squared);
    // 4 pi r^2 / (2 pi (1 - cos)), where 1 - cos = (r / d)^2 / (1 + cos).
    return isOutside(d, radius) ? 2.0 * squared * (1.0 + coneCosine(d, radius)) : distance * distance / max(cosine, 1e-30);
}

/** The normal (outwards) of the point on the sphere that u draws for p. */
vec3 sphereNormalTowards(vec3 p, vec3 centre, float radius, vec2 u) {
    const vec3 w = centre - p;
    const float d = length(w);
    if (!isOutside(d, radius)) return uniformSphere(u);
    const float sine = radius / d;
    const float oneLess = u.x * sine * sine / (1.0 + coneCosine(d, radius));  // 1 - cosine of the direction
    const float sineSquared = oneLess * (2.0 - oneLess);
    vec3 x, y;
    const vec3 axis = w / d;
    basisAround(axis, x, y);
    const vec2 disk = sqrt(sineSquared) * unitCircle(u.y);
    // By the angle at the centre: the near one of the chord's ends, in units of the radius.
    const float along = (1.0 - oneLess) * d - sqrt(max(radius * radius - d * d * sineSquared, 0.0));
    const vec3 n = (x * disk.x + y * disk.y + axis * (1.0 - oneLess)) * along - w;
    return normalize(n);
}
#endif
