// Alpha masks on a layer of a visibility buffer: where the material's base colour lets everything through, the pixel
// stays open for what lies behind; elsewhere its key is final.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/raster/footprint.glsl"

layout(constant_id = 121) const bool SCENE_ORDER = true;  ///< triangles lie in the order of their ids
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std430) readonly buffer uVisibility { uvec2 visibility[]; };  ///< id's complement, depth
layout(set = 0, binding = 1) uniform usamplerBuffer uSlots;                     ///< place of a triangle by its id
layout(set = 0, binding = 4, std430) buffer uLimit { uvec2 limits[]; };         ///< the next layer lies behind; 0: done
layout(set = 0, binding = 5, std430) writeonly buffer uKeys { uvec2 keys[]; };  ///< the picture's from push.first on
layout(set = 0, binding = 6, std430) buffer uOpen { uint open; };

/// Whether the surface stops nothing: masked out, or blended with no share at all.
bool letsAllThrough(uvec2 key, ivec2 pixel) {
    int g = int(~key.x), slot = g;
    if (!SCENE_ORDER) slot = int(texelFetch(uSlots, g).x);
    Triangle source = fetchTriangle(slot);
    int rows = source.material * MATERIAL_TEXELS;
    float alpha = uintBitsToFloat(texelFetch(uMaterials, rows).w);
    if (HAS_COLORS || HAS_BASE_TEXTURES) {
        Surface surface = surfaceAt(source, pixel);
        if (HAS_COLORS) alpha *= vertexColor(g, surface.b).a;
        if (HAS_BASE_TEXTURES) {
            vec4 uv, dx, dy;
            footprint(g, surface, uv, dx, dy);
            alpha *= filteredMaterialTexture(source.material, 3, uv, dx, dy).a;
        }
    }
    uint flags = texelFetch(uMaterials, rows + 1).w;
    float cutoff = uintBitsToFloat(texelFetch(uMaterials, rows + 2).w);
    return ((flags & MATERIAL_MASK) != 0u && alpha < cutoff) || ((flags & MATERIAL_BLEND) != 0u && alpha <= 0.0);
}

void main() {
    ivec2 size = imageSizePixels(), pixel = ivec2(gl_GlobalInvocationID.xy);
    bool inside = pixel.x < size.x && pixel.y < size.y;
    int index = inside ? pixel.y * size.x + pixel.x : 0;
    uvec2 limit = limits[index], key = visibility[index];
    bool isOpen = inside && (limit.x | limit.y) != 0u, hit = (key.x | key.y) != 0u;
    bool passes = hit && letsAllThrough(hit ? key : uvec2(0xffffffffu, 0u), pixel);
    if (isOpen) {
        keys[push.first + uint(index)] = passes ? uvec2(0u) : key;
        limits[index] = passes ? key : uvec2(0u);
    }
    uint count = subgroupAdd(uint(isOpen && passes));
    if (subgroupElect() && count > 0u) atomicAdd(open, count);
}
