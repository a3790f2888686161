// The camera as the rasterizer takes it, and what a triangle becomes under it: homogeneous pixels in double.
#ifndef SHADERS_RASTER_VIEW_GLSL
#define SHADERS_RASTER_VIEW_GLSL

// One projection for every camera. With d = vertex - eye (exact differences first, so that nothing is lost far
// from the origin) and v = rowW.d, the distance along the viewing axis:
//   perspective:  X = rowX.d, Y = rowY.d, w = v, Z = depthOffset (the near distance): depth = Z / w, reversed
//                 with an infinite far plane, 1 at the near plane;
//   orthographic: X = rowX.d + width/2, Y = rowY.d + height/2, w = 1, Z = depthOffset + depthSlope v.
// Pixel coordinates are X/w, Y/w: x to the right, y down, centres at one half.
layout(constant_id = 122) const bool ORTHOGRAPHIC = false;  ///< the kind of projection
layout(push_constant, std430) uniform RasterPush {
    dvec4 rowX;          // xyz, and the eye's x
    dvec4 rowY;          // xyz, and the eye's y
    dvec4 rowW;          // xyz, and the eye's z
    double depthOffset;
    double depthSlope;   // orthographic; of a perspective view in a conventional format far / (far - near)
    uint size;           // width | height << 16, pixels
    uint first;          // first triangle of the batch
    uint count;          // triangles of the batch
    uint flags;          // RASTER_*
} push;

const uint RASTER_CULL_BACK = 2u;

ivec2 imageSizePixels() { return ivec2(int(push.size & 0xffffu), int(push.size >> 16)); }

/// A vertex in homogeneous pixels, and its signed distance to the near plane (in front is positive).
struct HomogeneousVertex {
    double x, y, w, z;
    double near;
};

HomogeneousVertex projectVertex(vec3 position) {
    precise double dx = double(position.x) - push.rowX.w;
    precise double dy = double(position.y) - push.rowY.w;
    precise double dz = double(position.z) - push.rowW.w;
    precise double x = push.rowX.x * dx + push.rowX.y * dy + push.rowX.z * dz;
    precise double y = push.rowY.x * dx + push.rowY.y * dy + push.rowY.z * dz;
    precise double v = push.rowW.x * dx + push.rowW.y * dy + push.rowW.z * dz;
    HomogeneousVertex vertex;
    if (ORTHOGRAPHIC) {
        ivec2 size = imageSizePixels();
        precise double z = push.depthOffset + push.depthSlope * v;
        precise double near = 1.0LF - z;
        vertex.x = x + 0.5LF * double(size.x);
        vertex.y = y + 0.5LF * double(size.y);
        vertex.w = 1.0LF;
        vertex.z = z;
        vertex.near = near;
    } else {
        precise double near = v - push.depthOffset;
        vertex.x = x;
        vertex.y = y;
        vertex.w = v;
        vertex.z = push.depthOffset;
        vertex.near = near;
    }
    return vertex;
}

#endif
