// Light on the corners of every triangle (Gouraud), or on its centre (flat), by Blinn and Phong's model: what pixels
// interpolate. Textures do not matter but for the roughness, taken from the base level at the corner.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#ifndef CORNERS
#define CORNERS 3
#endif
#ifndef BLINN_PHONG
#define BLINN_PHONG 1
#endif
const int LIT_POINTS = CORNERS;  ///< of a triangle
#undef CORNERS                   // the pixels' kernels read what this one writes
#include "shaders/raster/shading.glsl"

layout(constant_id = 125) const bool FIRST_LIGHTS = true;

layout(local_size_x = 64) in;
layout(set = 0, binding = 4, std430) buffer uLight { vec4 light[]; };  ///< two a point, as uCornerLight

void main() {
    int index = int(gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x);
    if (index * 2 >= light.length()) return;
    int g = index / LIT_POINTS, corner = index - g * LIT_POINTS;
    int slot = g;
    if (!SCENE_ORDER) slot = int(texelFetch(uSlots, g).x);
    Triangle source = fetchTriangle(slot);
    bool flat_ = LIT_POINTS == 1;
    vec3 b = flat_ ? vec3(1.0 / 3.0) : vec3(corner == 0, corner == 1, corner == 2);
    dvec3 eye = dvec3(push.rowX.w, push.rowY.w, push.rowW.w);
    dvec3 v0 = dvec3(source.v0) - eye, v1 = dvec3(source.v1) - eye, v2 = dvec3(source.v2) - eye;
    dvec3 across = cross(v1 - v0, v2 - v0);
    double squared = dot(across, across);

    Surface surface;
    surface.b = b;
    surface.position = vec3(double(b.x) * v0 + double(b.y) * v1 + double(b.z) * v2);
    surface.toEye = ORTHOGRAPHIC ? -vec3(normalize(push.rowW.xyz)) : normalizeSafe(-surface.position, vec3(0.0, 0.0, 1.0));
    surface.faceNormal = squared > 0.0LF ? vec3(across / sqrt(squared)) : surface.toEye;
    // The whole triangle shows one side.
    surface.front = dot(surface.faceNormal, ORTHOGRAPHIC ? surface.toEye : -vec3(v0)) > 0.0;
    vec3 normal = flat_ ? surface.faceNormal : shadingNormal(g, b, surface.faceNormal);
    normal = surface.front ? normal : -normal;

    float exponent = 1.0;
#ifdef SURFACE_MATERIALS
    vec4 color = uintBitsToFloat(texelFetch(uMaterials, source.material * MATERIAL_TEXELS));
    exponent = blinnPhongOf(rasterBsdf(source, surface, normal, color.rgb), color.rgb).exponent;
#endif
    ivec2 draw = ivec2(index & 0xffff, index >> 16);
    LightSums sums = blinnPhongSums(draw, surface.position, normal, surface.toEye, exponent, surface.faceNormal, g);
    if (FIRST_LIGHTS) {
        vec3 ambient = reflectedSurroundings(normal);
        light[index * 2] = vec4(sums.diffuse + PI * ambient, 0.0);
        light[index * 2 + 1] = vec4(sums.gloss + ambient, 0.0);
    } else {
        light[index * 2].rgb += sums.diffuse;
        light[index * 2 + 1].rgb += sums.gloss;
    }
}
