// shadeSurface.comp for sample:cornell alone, stripped by hand: Lambertian surfaces of constant colour without vertex
// normals under one lamp, a parallelogram that shines from its front. No loop over lights, no code for what is not there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/raster/polygon_light.glsl"
#include "shaders/raster/surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std430) readonly buffer uVisibility { uvec2 visibility[]; };
layout(set = 0, binding = 2) uniform usamplerBuffer uInstanceFirst;
layout(set = 0, binding = 25) uniform usamplerBuffer uMaterials;
layout(set = 0, binding = 26) uniform usamplerBuffer uLights;
layout(set = 0, binding = 4, std430) writeonly buffer uColor { vec4 color[]; };
layout(set = 0, binding = 5, std430) writeonly buffer uAlbedoDepth { vec4 albedoDepth[]; };
layout(set = 0, binding = 6, std430) writeonly buffer uNormal { vec4 normals[]; };
layout(set = 0, binding = 7, std430) writeonly buffer uIds { ivec2 ids[]; };

const int MATERIAL_TEXELS = 49;

vec3 lampIrradiance(vec3 position, vec3 normal) {
    dvec3 eye = dvec3(push.rowX.w, push.rowY.w, push.rowW.w);
    vec3 corner = vec3(dvec3(uintBitsToFloat(texelFetch(uLights, 0).xyz)) - eye) - position;
    vec3 edge1 = uintBitsToFloat(texelFetch(uLights, 1).xyz), edge2 = uintBitsToFloat(texelFetch(uLights, 2).xyz);
    vec4 strength = uintBitsToFloat(texelFetch(uLights, 3)), facing = uintBitsToFloat(texelFetch(uLights, 4));
    float factor = quadIrradiance(normal, corner, edge1, edge1 + edge2, edge2);
    return -dot(facing.xyz, corner) > facing.w ? strength.rgb * factor : vec3(0.0);
}

void main() {
    ivec2 size = imageSizePixels(), pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= size.x || pixel.y >= size.y) return;
    int index = pixel.y * size.x + pixel.x;
    uvec2 key = visibility[index];
    bool hit = (key.x | key.y) != 0u;
    int g = hit ? int(~key.x) : 0;
    Triangle source = fetchTriangle(g);
    Surface surface = surfaceAt(source, pixel);
    vec3 albedo = uintBitsToFloat(texelFetch(uMaterials, source.material * MATERIAL_TEXELS).xyz);
    vec3 emission = uintBitsToFloat(texelFetch(uMaterials, source.material * MATERIAL_TEXELS + 1).xyz);
    vec3 normal = surface.front ? surface.faceNormal : -surface.faceNormal;
    vec3 radiance = (surface.front ? emission : vec3(0.0)) +
                    albedo * (INV_PI * lampIrradiance(surface.position, normal));
    color[index] = hit ? vec4(radiance, 1.0) : vec4(0.0);
    albedoDepth[index] = hit ? vec4(albedo, surface.depth) : vec4(0.0);
    normals[index] = hit ? vec4(normal, 0.0) : vec4(0.0);
    int first = int(texelFetch(uInstanceFirst, source.instance).x);
    ids[index] = hit ? ivec2(source.instance, g - first) : ivec2(-1);
}
