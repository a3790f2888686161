#version 460
// The Mandelbrot set: black inside, outside a colour that goes smoothly with the escape time.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) uniform writeonly image2D uPicture;
layout(push_constant) uniform View {
    vec2 centre;
    float halfHeight;
} uView;

void main() {
    const ivec2 size = imageSize(uPicture);
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;
    const vec2 offset = vec2(2 * pixel + 1 - size) * vec2(1.0, -1.0) / float(size.y);
    const vec2 c = uView.centre + uView.halfHeight * offset;
    vec2 z = vec2(0.0);
    int steps = 0;
    // |z| > 2 never comes back; going on to 16 smooths the colours.
    while (steps < 256 && dot(z, z) < 256.0) {
        z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c;
        ++steps;
    }
    vec3 colour = vec3(0.0);
    if (steps < 256) {
        const float time = float(steps) + 1.0 - log2(0.5 * log2(dot(z, z)));
        colour = 0.5 + 0.5 * cos(0.15 * time + vec3(3.0, 3.6, 4.2));
    }
    imageStore(uPicture, pixel, vec4(colour, 1.0));
}
