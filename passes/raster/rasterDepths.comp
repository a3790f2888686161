// The finest level of the pyramid: the least depth code of every cell of pixels, 0 where some pixel shows nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/raster/view.glsl"
#include "shaders/raster/cluster.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform usamplerBuffer uVisibility;  ///< id's complement, depth
layout(set = 0, binding = 1, std430) writeonly buffer uPyramid { int depths[]; };

shared int least;

void main() {
    ivec2 size = imageSizePixels(), cell = ivec2(gl_WorkGroupID.xy);
    int lane = int(gl_LocalInvocationIndex);
    if (lane == 0) least = 0x7fffffff;
    barrier();
    int own = 0x7fffffff;
    ivec2 first = cell * DEPTH_CELL + ivec2(lane & 15, lane >> 4);
    for (int k = 0; k < 4; ++k) {
        // Beyond the edge the last pixel counts again.
        ivec2 pixel = min(first + ivec2(0, 4 * k), size - 1);
        own = min(own, int(texelFetch(uVisibility, pixel.y * size.x + pixel.x).y));
    }
    own = subgroupMin(own);
    if (subgroupElect()) atomicMin(least, own);
    barrier();
    if (lane == 0) depths[cell.y * depthCells(size, 0).x + cell.x] = least;
}
