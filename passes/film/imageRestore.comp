#version 460
// Texels of a buffer, row by row, into an image: what a checkpoint brings back.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform samplerBuffer uSaved;
layout(binding = 1, rgba32f) writeonly uniform image2D uImage;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(uImage);
    if (all(lessThan(texel, size))) imageStore(uImage, texel, texelFetch(uSaved, texel.y * size.x + texel.x));
}
