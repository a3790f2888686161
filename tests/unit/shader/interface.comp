#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// One of every kind of thing that reflection reports. local_size_y has no constant of its own name.
layout(local_size_x = 32, local_size_x_id = 3, local_size_y_id = 9, local_size_z = 2) in;
layout(constant_id = 3) const uint WORKGROUP = 32u;
layout(constant_id = 1) const float SCALE = 0.5;
layout(constant_id = 2) const bool FLIP = true;
layout(constant_id = 7) const int BIAS = -3;
struct Item {
    vec3 position;
    uint id;
    mat3 frame;
    float weights[3];
};
layout(set = 0, binding = 0, std430) readonly buffer Items { uint count; Item items[]; } uItems;
layout(set = 0, binding = 1) writeonly buffer Nameless { uint64_t keys[]; };
layout(set = 0, binding = 2) buffer Totals { uint64_t total; float sum; } uTotals;
layout(set = 0, binding = 3) uniform Settings { vec4 colour; float exposure; } uSettings;
layout(set = 0, binding = 4) uniform samplerBuffer uNodes;
layout(set = 0, binding = 5) uniform usamplerBuffer uIndices;
layout(set = 0, binding = 6, r32ui) uniform uimageBuffer uCounters;
layout(set = 1, binding = 0, rgba32f) writeonly uniform image2D uHdr;
layout(set = 1, binding = 1, rgba8) readonly uniform image2D uLdr;
layout(set = 1, binding = 2) uniform sampler2D uAlbedo;
layout(set = 1, binding = 3) uniform sampler2DArray uLayers[4];
layout(set = 2, binding = 5) readonly buffer Unused { float values[]; } uUnused;
layout(push_constant) uniform Push { mat4 transform; vec3 origin; float scale; uvec2 size; } uPush;
void main() {
    uint i = gl_GlobalInvocationID.x;
    Item item = uItems.items[min(i, uItems.count)];
    float v = SCALE * subgroupAdd(item.weights[1]) + texelFetch(uNodes, int(i)).x + uSettings.exposure;
    keys[i] = uint64_t(texelFetch(uIndices, BIAS).x);
    atomicMin(uTotals.total, uint64_t(i));
    imageAtomicAdd(uCounters, int(i), 1u);
    vec4 colour = imageLoad(uLdr, ivec2(0)) + textureLod(uAlbedo, vec2(0), 0.0) + textureLod(uLayers[2], vec3(0), 0.0);
    imageStore(uHdr, ivec2(i, FLIP ? 0 : 1), colour * v * uPush.scale);
}
