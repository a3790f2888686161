#ifndef HELIOGRAPH_SCENE_TRIANGLES
#define HELIOGRAPH_SCENE_TRIANGLES
/** @file
 * World-space triangles. "Slot" is the place in the buffer (the tree's order), g the index in scene order.
 * Read as unsigned words, so that the integers among them can never be flushed as denormal floats.
 */

/** 3 texels a slot: v0.xyz | g, v1.xyz | instance, v2.xyz | material. */
layout(set = 0, binding = 20) uniform usamplerBuffer uTriangles;

struct Triangle {
    vec3 v0;
    vec3 v1;
    vec3 v2;
    int g;         ///< index in scene order: of normals, texcoords, colours
    int instance;
    int material;
};

Triangle fetchTriangle(int slot) {
    const uvec4 a = texelFetch(uTriangles, slot * 3);
    const uvec4 b = texelFetch(uTriangles, slot * 3 + 1);
    const uvec4 c = texelFetch(uTriangles, slot * 3 + 2);
    return Triangle(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz), int(a.w), int(b.w),
                    int(c.w));
}
#endif
