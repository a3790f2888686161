// Colour and guide channels of every pixel of a visibility buffer, under the first lights of the table.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/shading.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, std430) writeonly buffer uColor { vec4 color[]; };              ///< RGB, 1 where hit
layout(set = 0, binding = 5, std430) writeonly buffer uAlbedoDepth { vec4 albedoDepth[]; };  ///< RGB, distance
layout(set = 0, binding = 6, std430) writeonly buffer uNormal { vec4 normals[]; };           ///< towards the viewer, 0
layout(set = 0, binding = 7, std430) writeonly buffer uIds { ivec2 ids[]; };                 ///< instance, triangle

void main() {
    ivec2 size = imageSizePixels(), pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= size.x || pixel.y >= size.y) return;
    int index = pixel.y * size.x + pixel.x;
    Shaded shaded = shadePoint(pixel, visibility[index]);
    vec3 radiance = shaded.emission + reflectedLight(pixel, shaded) + reflectedAmbient(shaded);
    vec3 surroundings = visibleSurroundings(pixel);
    color[index] = shaded.hit ? vec4(radiance, 1.0) : vec4(surroundings, 0.0);
    albedoDepth[index] = shaded.hit ? vec4(shaded.albedo, shaded.depth) : vec4(0.0);
    normals[index] = shaded.hit ? vec4(shaded.normal, 0.0) : vec4(0.0);
    ids[index] = shaded.hit ? ivec2(shaded.instance, shaded.triangle) : ivec2(-1);
}
