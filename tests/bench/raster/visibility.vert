#version 460
// The comparison's vertex stage: homogeneous pixels to clip space, the triangle's place as its id.
layout(location = 0) in vec3 position;
layout(push_constant) uniform Push {
    mat4 toClip;  // of position - eye
    vec4 eye;
} push;
layout(location = 0) flat out uint id;

void main() {
    gl_Position = push.toClip * vec4(position - push.eye.xyz, 1.0);
    id = uint(gl_VertexIndex) / 3u;
}
