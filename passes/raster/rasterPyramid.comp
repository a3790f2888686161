// The pyramid's other levels: each cell has the least of four. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/raster/view.glsl"
#include "shaders/raster/cluster.glsl"

layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) coherent buffer uPyramid { int depths[]; };

void main() {
    ivec2 size = imageSizePixels(), below = depthCells(size, 0);
    int start = 0;
    for (int level = 1; max(below.x, below.y) > 1; ++level) {
        ivec2 cells = depthCells(size, level);
        int next = start + below.x * below.y;
        for (int i = int(gl_LocalInvocationIndex); i < cells.x * cells.y; i += 256) {
            int y = i / cells.x, x = i - y * cells.x;
            ivec2 a = ivec2(2 * x, 2 * y), b = min(a + 1, below - 1);
            depths[next + i] = min(min(depths[start + a.y * below.x + a.x], depths[start + a.y * below.x + b.x]),
                                   min(depths[start + b.y * below.x + a.x], depths[start + b.y * below.x + b.x]));
        }
        start = next;
        below = cells;
        memoryBarrierBuffer();
        barrier();
    }
}
