// What a pixel's centre sees on the triangle of its visibility key: perspective-correct barycentrics, their exact
// derivatives over the screen, and distance.
#ifndef SHADERS_RASTER_SURFACE_GLSL
#define SHADERS_RASTER_SURFACE_GLSL

#include "shaders/raster/view.glsl"
#include "shaders/scene/triangles.glsl"

/// World-space directions of the pixel grid: the ray of pixel coordinates (x, y) is
///   perspective:  from the eye along   origin + x right + y down, one unit deep along the viewing axis;
///   orthographic: from eye + origin + x right + y down along `axis`, also one unit deep.
struct PixelGrid {
    dvec3 origin, right, down;
    dvec3 axis;  // orthographic only
};

/// The inverse of the view's rows, by cross products.
PixelGrid pixelGrid() {
    dvec3 x = push.rowX.xyz, y = push.rowY.xyz, w = push.rowW.xyz;
    dvec3 yw = cross(y, w), wx = cross(w, x), xy = cross(x, y);
    double scale = 1.0LF / dot(x, yw);
    PixelGrid grid;
    grid.right = yw * scale;
    grid.down = wx * scale;
    dvec3 forward = xy * scale;
    dvec2 half_ = 0.5LF * dvec2(imageSizePixels());
    grid.origin = ORTHOGRAPHIC ? -(half_.x * grid.right + half_.y * grid.down) : forward;
    grid.axis = forward;
    return grid;
}

/// Unit direction of the ray through a pixel's centre.
vec3 pixelDirection(ivec2 pixel) {
    PixelGrid grid = pixelGrid();
    dvec2 centre = dvec2(pixel) + 0.5LF;
    return normalize(vec3(ORTHOGRAPHIC ? grid.axis : grid.origin + centre.x * grid.right + centre.y * grid.down));
}

struct Surface {
    vec3 b;          // barycentrics of v0, v1, v2; within 0..1, sum 1
    vec2 db1, db2;   // derivatives of the second and third over x and y, per pixel
    vec3 position;   // relative to the eye
    vec3 faceNormal; // unit, of the counter-clockwise side
    vec3 toEye;      // unit
    float depth;     // distance along the viewing axis
    bool front;      // the counter-clockwise side is seen
};

/// In double, since a triangle that is small for its distance leaves few digits of a float. The barycentrics of a ray
/// o + t r with T = o - v0 are b1 = r.(e2 x T) / r.(e2 x e1) and b2 = r.(T x e1) / r.(e2 x e1); numerators and
/// denominator are linear on the screen, which gives the derivatives.
Surface surfaceAt(Triangle source, ivec2 pixel) {
    PixelGrid grid = pixelGrid();
    dvec3 eye = dvec3(push.rowX.w, push.rowY.w, push.rowW.w);
    dvec3 v0 = dvec3(source.v0) - eye, v1 = dvec3(source.v1) - eye, v2 = dvec3(source.v2) - eye;
    dvec3 e1 = v1 - v0, e2 = v2 - v0;
    dvec2 centre = dvec2(pixel) + 0.5LF;
    dvec3 at = grid.origin + centre.x * grid.right + centre.y * grid.down;
    dvec3 r = ORTHOGRAPHIC ? grid.axis : at;
    dvec3 o = ORTHOGRAPHIC ? at : dvec3(0.0LF);
    dvec3 normal = cross(e1, e2);
    dvec3 T = o - v0;
    dvec3 a1 = cross(e2, T), a2 = cross(T, e1);
    double denominator = -dot(r, normal);
    double inverse = denominator != 0.0LF ? 1.0LF / denominator : 0.0LF;
    double b1 = dot(r, a1) * inverse, b2 = dot(r, a2) * inverse;

    Surface surface;
    dvec2 db1, db2;
    if (ORTHOGRAPHIC) {
        db1 = dvec2(dot(r, cross(e2, grid.right)), dot(r, cross(e2, grid.down))) * inverse;
        db2 = dvec2(dot(r, cross(grid.right, e1)), dot(r, cross(grid.down, e1))) * inverse;
    } else {
        dvec2 dDenominator = -dvec2(dot(grid.right, normal), dot(grid.down, normal));
        db1 = (dvec2(dot(grid.right, a1), dot(grid.down, a1)) - b1 * dDenominator) * inverse;
        db2 = (dvec2(dot(grid.right, a2), dot(grid.down, a2)) - b2 * dDenominator) * inverse;
    }
    surface.db1 = vec2(db1);
    surface.db2 = vec2(db2);
    // Snapping can put a centre just outside of the true triangle.
    dvec3 b = clamp(dvec3(1.0LF - b1 - b2, b1, b2), 0.0LF, 1.0LF);
    b /= b.x + b.y + b.z;
    dvec3 position = b.x * v0 + b.y * v1 + b.z * v2;
    surface.b = vec3(b);
    surface.position = vec3(position);
    surface.depth = float(dot(push.rowW.xyz, position));
    double squared = dot(normal, normal);
    surface.faceNormal = squared > 0.0LF ? vec3(normal / sqrt(squared)) : -vec3(normalize(r));
    surface.toEye = -vec3(normalize(r));
    surface.front = denominator > 0.0LF;
    return surface;
}

#endif
