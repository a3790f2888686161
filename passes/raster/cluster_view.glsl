// What the camera sees of a cluster's box.
#ifndef PASSES_RASTER_CLUSTER_VIEW_GLSL
#define PASSES_RASTER_CLUSTER_VIEW_GLSL
#include "shaders/raster/view.glsl"
#include "shaders/raster/triangle.glsl"
#include "shaders/raster/cluster.glsl"

layout(set = 0, binding = 0) uniform samplerBuffer uBounds;  ///< lower, upper corner
layout(set = 0, binding = 3, std430) buffer uList { uint list[]; };
layout(set = 0, binding = 4, std430) buffer uCounters { uint64_t counters[]; };

struct ClusterView {
    bool outside;   // no part is in the view
    bool isWhole;   // all of it lies before the near plane: the following holds
    ivec4 pixels;   // first and last pixel that it may cover, within the image
    int nearest;    // no part has a larger depth code
};

ClusterView viewOf(uint cluster) {
    vec3 corners[2] = vec3[2](texelFetch(uBounds, int(cluster) * 2).xyz, texelFetch(uBounds, int(cluster) * 2 + 1).xyz);
    ivec2 size = imageSizePixels();
    double width = double(size.x), height = double(size.y);
    bool left = true, right = true, above = true, below = true;
    double least = 1e300LF, most = -1e300LF, x0 = 1e300LF, x1 = -1e300LF, y0 = 1e300LF, y1 = -1e300LF;
    for (int k = 0; k < 8; ++k) {
        HomogeneousVertex v =
            projectVertex(vec3(corners[k & 1].x, corners[k >> 1 & 1].y, corners[k >> 2].z));
        // As for triangles: linear, hence right for corners behind the eye too.
        left = left && v.x < 0.0LF;
        right = right && v.x > width * v.w;
        above = above && v.y < 0.0LF;
        below = below && v.y > height * v.w;
        least = lesser(least, v.near);
        most = greater(most, v.near);
        double x = v.x / v.w, y = v.y / v.w;
        x0 = lesser(x0, x);
        x1 = greater(x1, x);
        y0 = lesser(y0, y);
        y1 = greater(y1, y);
    }
    ClusterView view;
    view.outside = left || right || above || below || most < 0.0LF;
    // The rest allows for rounding: of the corners' distances, of depth in float, and of snapping to the grid.
    double depth = ORTHOGRAPHIC ? 1.0LF - least + 1e-6LF : push.depthOffset / (least + push.depthOffset) * 1.000001LF;
    view.isWhole = least > (ORTHOGRAPHIC ? 0.0LF : 1e-3LF * push.depthOffset) && x0 > -1e8LF && x1 < 1e8LF &&
                   y0 > -1e8LF && y1 < 1e8LF;
    view.nearest = depthCode(depth);
    ivec2 first = ivec2(clamp(x0 - 2.0LF, 0.0LF, width - 1.0LF), clamp(y0 - 2.0LF, 0.0LF, height - 1.0LF));
    ivec2 last = ivec2(clamp(x1 + 2.0LF, 0.0LF, width - 1.0LF), clamp(y1 + 2.0LF, 0.0LF, height - 1.0LF));
    view.pixels = view.isWhole ? ivec4(first, last) : ivec4(0);
    return view;
}

uint trianglesOf(uint cluster) { return min(CLUSTER_TRIANGLES, push.count - cluster * CLUSTER_TRIANGLES); }

#endif
