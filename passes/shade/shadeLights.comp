// Adds the light of further rows of the table to a shaded image: no loop over lights gets longer than drivers bear.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/shading.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, std430) buffer uColor { vec4 color[]; };

void main() {
    ivec2 size = imageSizePixels(), pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= size.x || pixel.y >= size.y) return;
    int index = pixel.y * size.x + pixel.x;
    Shaded shaded = shadePoint(pixel, visibility[index]);
    vec3 light = reflectedLight(pixel, shaded);
    if (shaded.hit) color[index].rgb += light;
}
