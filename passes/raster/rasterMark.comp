// Notes which clusters show: what the next image draws first. A quarter of the pixels is enough, since nothing but speed
// depends on it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/raster/view.glsl"
#include "shaders/raster/cluster.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform usamplerBuffer uVisibility;  ///< id's complement, depth
layout(set = 0, binding = 1, std430) writeonly buffer uSeen { uint seen[]; };

void main() {
    ivec2 size = imageSizePixels(), at = ivec2(gl_GlobalInvocationID.xy), pixel = 2 * at + (at.yx & 1);
    bool inside = pixel.x < size.x && pixel.y < size.y;
    uvec2 key = texelFetch(uVisibility, inside ? pixel.y * size.x + pixel.x : 0).xy;
    if (inside && (key.x | key.y) != 0u) seen[~key.x / CLUSTER_TRIANGLES] = 1u;
}
