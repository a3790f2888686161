#version 460
// Texels of an image into a buffer, row by row: what a checkpoint keeps. Texel buffers hold more than storage buffers.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba32f) readonly uniform image2D uImage;
layout(binding = 1, rgba32f) writeonly uniform imageBuffer uSaved;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(uImage);
    if (all(lessThan(texel, size))) imageStore(uSaved, texel.y * size.x + texel.x, imageLoad(uImage, texel));
}
