// Fast approximate antialiasing after Lottes (NVIDIA FXAA, 2009; its "quality" form): where a pixel's neighbourhood
// has contrast, the edge through it is followed to both its ends, and the pixel is mixed with its neighbour across the
// edge by how far the edge has moved there.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform samplerBuffer uColor;
layout(set = 0, binding = 1, std430) writeonly buffer uFiltered { vec4 filtered[]; };
layout(push_constant, std430) uniform Push { ivec2 size; } push;

const float THRESHOLD = 0.125;      // of the neighbourhood's brightest: less contrast is left alone
const float DARK_THRESHOLD = 1.0 / 32.0;
const float SUBPIXEL = 0.75;        // how much of single bright or dark pixels is smoothed
const int MOST_STEPS = 24;          // pixels that an edge is followed either way

vec4 fetch(ivec2 p) {
    p = clamp(p, ivec2(0), push.size - 1);
    return texelFetch(uColor, p.y * push.size.x + p.x);
}

/// Perceived lightness, roughly: the square root of luminance, cut at white.
float luma(ivec2 p) { return sqrt(clamp(dot(fetch(p).rgb, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0)); }

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (p.x >= push.size.x || p.y >= push.size.y) return;
    vec4 centre = fetch(p);
    float m = luma(p), n = luma(p + ivec2(0, -1)), s = luma(p + ivec2(0, 1)), e = luma(p + ivec2(1, 0)),
          w = luma(p + ivec2(-1, 0));
    float brightest = max(m, max(max(n, s), max(e, w))), darkest = min(m, min(min(n, s), min(e, w)));
    float range = brightest - darkest;
    bool isEdge = range >= max(DARK_THRESHOLD, THRESHOLD * brightest);

    float ne = luma(p + ivec2(1, -1)), nw = luma(p + ivec2(-1, -1)), se = luma(p + ivec2(1, 1)),
          sw = luma(p + ivec2(-1, 1));
    // A pixel that stands out of the mean of its neighbours is smoothed though no edge passes.
    float mean = (2.0 * (n + s + e + w) + ne + nw + se + sw) / 12.0;
    float single = smoothstep(0.0, 1.0, clamp(abs(mean - m) / max(range, 1e-6), 0.0, 1.0));
    float subpixel = single * single * SUBPIXEL;

    float horizontal = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e);
    float vertical = abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
    bool isHorizontal = horizontal >= vertical;
    float before = isHorizontal ? n : w, after = isHorizontal ? s : e;
    bool isBefore = abs(before - m) >= abs(after - m);
    ivec2 across = (isHorizontal ? ivec2(0, 1) : ivec2(1, 0)) * (isBefore ? -1 : 1);
    ivec2 along = isHorizontal ? ivec2(1, 0) : ivec2(0, 1);
    float edge = 0.5 * (m + (isBefore ? before : after));
    float gradient = 0.25 * max(abs(before - m), abs(after - m));

    float ends[2];
    int distances[2];
    for (int side = 0; side < 2; ++side) {
        ivec2 step_ = side == 0 ? -along : along, at = p;
        float difference = 0.0;
        int distance_ = 0;
        bool done = false;
        for (int k = 0; k < MOST_STEPS && !done; ++k) {
            at += step_;
            ++distance_;
            difference = 0.5 * (luma(at) + luma(at + across)) - edge;
            done = abs(difference) >= gradient;
        }
        ends[side] = difference;
        distances[side] = distance_;
    }
    int nearest = distances[0] <= distances[1] ? 0 : 1;
    float length_ = float(distances[0] + distances[1]);
    // Only the side of the edge that it leaves is mixed.
    bool leaves = (ends[nearest] < 0.0) != (m < edge);
    float offset = leaves ? 0.5 - float(distances[nearest]) / length_ : 0.0;
    vec4 neighbour = fetch(p + across);
    filtered[p.y * push.size.x + p.x] = isEdge ? mix(centre, neighbour, max(offset, subpixel)) : centre;
}
