// Rays through a lens of spherical surfaces, from the film outwards. The lens's axis is z, towards the scene.
// Kolb, Mitchell and Hanrahan, "A realistic camera model for computer graphics", 1995.
#ifndef SHADERS_SHARED_LENS_SYSTEM_GLSL
#define SHADERS_SHARED_LENS_SYSTEM_GLSL
#include "shaders/shared/real.glsl"

/// Takes a ray with direction.z > 0 to a surface and through it: `surface` is its radius of curvature (positive where
/// the centre lies on the film's side, 0 for a plane), its vertex on the axis, the index of the film's side over that of
/// the scene's, and half of its diameter. False where the ray misses the surface or what of it is open, or is
/// reflected totally. The direction stays unit.
FN bool crossLensSurface(Vec4 surface, INOUT(Vec3) origin, INOUT(Vec3) direction) {
    Real radius = surface.x;
    Real t = (surface.y - origin.z) / direction.z;
    Vec3 normal = Vec3(0.0, 0.0, 1.0);
    bool passes = true;
    if (radius != 0.0) {
        // From the point where the ray meets the plane of the vertex, which lies near the surface: nothing large cancels.
        Vec3 near = origin + t * direction;
        Vec3 fromCentre = Vec3(near.x, near.y, near.z - surface.y + radius);
        Real b = dot(fromCentre, direction);
        Real c = near.x * near.x + near.y * near.y;
        Real discriminant = b * b - c;
        passes = discriminant >= 0.0;
        Real root = sqrt(max(discriminant, 0.0));
        // Of the two points of the sphere the one on the vertex's side.
        t += radius > 0.0 ? -c / (b + root) : -c / (b - root);
    }
    origin = origin + t * direction;
    passes = passes && origin.x * origin.x + origin.y * origin.y <= surface.w * surface.w;
    if (radius != 0.0) normal = Vec3(origin.x, origin.y, origin.z - surface.y + radius) * (1.0 / radius);
    Real cosine = dot(direction, normal);
    Real transmitted = 1.0 - surface.z * surface.z * (1.0 - cosine * cosine);
    passes = passes && transmitted > 0.0;
    direction = surface.z * direction + (sqrt(max(transmitted, 0.0)) - surface.z * cosine) * normal;
    return passes;
}

#endif
