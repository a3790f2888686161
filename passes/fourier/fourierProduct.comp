// Products of complex numbers.
#version 460

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer uA { vec2 a[]; };
layout(set = 0, binding = 1, std430) readonly buffer uB { vec2 b[]; };
layout(set = 0, binding = 2, std430) writeonly buffer uTo { vec2 to[]; };
layout(push_constant, std430) uniform Push { uint first, count; } push;

void main() {
    uint t = push.first + gl_GlobalInvocationID.x;
    if (t >= push.count) return;
    vec2 p = a[t], q = b[t];
    to[t] = vec2(p.x * q.x - p.y * q.y, p.x * q.y + p.y * q.x);
}
