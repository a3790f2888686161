// One layer of surfaces that let light through, nearest first: shaded, and added to what the layers before let through.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/raster/shading.glsl"
#ifdef TRANSMISSION
#include "shaders/raster/transmission.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, std430) buffer uColor { vec4 color[]; };              ///< RGB, what is stopped
layout(set = 0, binding = 5, std430) buffer uAlbedoDepth { vec4 albedoDepth[]; };  ///< RGB, distance
layout(set = 0, binding = 6, std430) buffer uNormal { vec4 normals[]; };           ///< towards the viewer, 0
layout(set = 0, binding = 7, std430) buffer uIds { ivec2 ids[]; };                 ///< instance, triangle
layout(set = 0, binding = 12, std430) buffer uLimit { uvec2 limits[]; };
layout(set = 0, binding = 13, std430) buffer uOpen {
    uint open;
#ifdef TRANSMISSION
    uint refracting;  ///< most refracting layers of a pixel so far
#endif
};
#ifdef TRANSMISSION
/// Shares of the light behind that pass, and 1 + the refracting layers before.
layout(set = 0, binding = 16, std430) buffer uPassed { vec4 passed[]; };
#endif

/// A pixel is done when so little of the light behind passes: far below an 8-bit picture's steps.
const float UNSEEN = 1e-5;

void main() {
    ivec2 size = imageSizePixels(), pixel = ivec2(gl_GlobalInvocationID.xy);
    bool inside = pixel.x < size.x && pixel.y < size.y;
    int index = inside ? pixel.y * size.x + pixel.x : 0;
    uvec2 limit = limits[index];
    bool isOpen = inside && (limit.x | limit.y) != 0u;
    uvec2 key = visibility[index];
    Shaded shaded = shadePoint(pixel, key);
    vec3 radiance = shaded.emission + reflectedLight(pixel, shaded) +
                    reflectedAmbient(shaded);
    vec4 sum = color[index];
#ifdef TRANSMISSION
    // A picture of what refracting layers show: the nearest push.flags of them are left out, as is before them all that
    // lets light through.
    vec4 state = passed[index];
    LightThrough through = lightThrough(shaded);
    bool isBefore = state.w - 1.0 < float(push.flags);
    bool isLeftOut = shaded.hit && (through.hidden || (isBefore && (through.any || shaded.opacity < 1.0)));
    if (through.deflects && !isLeftOut) radiance += refracted(pixel, shaded, through);
    if (through.any) radiance += reflectedWithin(shaded, through);
    vec3 goesBy = vec3(0.0);
    if (through.any && !through.deflects) goesBy = slabShares(shaded.bsdf, through, shaded.bsdf.wo.z).through;
    float stopped = shaded.hit ? (isLeftOut ? 0.0 : shaded.opacity) : 1.0;
    sum.rgb += state.rgb * stopped * (shaded.hit ? radiance : visibleSurroundings(pixel));
    if (shaded.hit) state.rgb *= (1.0 - stopped) + stopped * goesBy;
    if (shaded.hit && through.deflects && isBefore) state.w += 1.0;
    if (shaded.hit) sum.w = 1.0 - maxComponent(state.rgb);
#else
    float passed = 1.0 - sum.w;
    float stopped = shaded.hit ? shaded.opacity : 1.0;
    sum.rgb += passed * stopped * (shaded.hit ? radiance : visibleSurroundings(pixel));
    if (shaded.hit) sum.w = stopped < 1.0 ? sum.w + passed * stopped : 1.0;
#endif
    bool goesOn = isOpen && shaded.hit && 1.0 - sum.w > UNSEEN;
    if (isOpen) {
        color[index] = sum;
#ifdef TRANSMISSION
        passed[index] = state;
#endif
        limits[index] = goesOn ? key : uvec2(0u);
        if (shaded.hit && stopped > 0.0 && ids[index].x < 0) {
            albedoDepth[index] = vec4(shaded.albedo, shaded.depth);
            normals[index] = vec4(shaded.normal, 0.0);
            ids[index] = ivec2(shaded.instance, shaded.triangle);
        }
    }
    uint count = subgroupAdd(uint(goesOn));
    if (subgroupElect()) atomicAdd(open, count);
#ifdef TRANSMISSION
    uint most = subgroupMax(isOpen ? uint(state.w) - 1u : 0u);
    if (subgroupElect()) atomicMax(refracting, most);
#endif
}
