// Triangle set-up: snapping, exact edge functions with the top-left rule, and the depth plane.
#ifndef SHADERS_RASTER_TRIANGLE_GLSL
#define SHADERS_RASTER_TRIANGLE_GLSL

layout(constant_id = 124) const int DEPTH_FORMAT = 0;  ///< DEPTH_*: how depths are told apart
const int DEPTH_REVERSED = 0, DEPTH_FLOAT = 1, DEPTH_UNORM24 = 2, DEPTH_UNORM16 = 3;

// Vertices are snapped to 1/256 pixel: s = floor(256 X/w + 1/2), components apart.
const int SUBPIXELS = 256;
const int HALF_PIXEL = 128;
// |X/w| <= 2^15 pixels after the guard band's clip, so a snapped coordinate has 24 bits, a difference 25, an
// edge function 51.
const double GUARD_BAND = 32768.0LF;

ivec2 snap(double x, double y, double w) {
    precise double sx = floor(x / w * 256.0LF + 0.5LF);
    precise double sy = floor(y / w * 256.0LF + 0.5LF);
    return ivec2(int(sx), int(sy));
}

/// Twice the signed area in 1/65536 pixel; positive turns from +x to +y (clockwise as seen on the screen).
int64_t signedArea(ivec2 a, ivec2 b, ivec2 c) {
    return int64_t(b.x - a.x) * int64_t(c.y - a.y) - int64_t(b.y - a.y) * int64_t(c.x - a.x);
}

/// Pixels whose centres lie in the closed box of three snapped points, cut to the image: first xy, last zw.
ivec4 pixelBounds(ivec2 a, ivec2 b, ivec2 c, ivec2 size) {
    ivec2 low = min(a, min(b, c));
    ivec2 high = max(a, max(b, c));
    return ivec4(max((low + (HALF_PIXEL - 1)) >> 8, ivec2(0)), min((high - HALF_PIXEL) >> 8, size - 1));
}

/// What an edge from p to q loses when a centre lies exactly on it: nothing where it is a top or a left edge.
/// With a positive area the inside is to the right of an edge that goes up (left edge) and below one that goes
/// right (top edge).
int edgeBias(ivec2 p, ivec2 q) {
    ivec2 d = q - p;
    return d.y < 0 || (d.y == 0 && d.x > 0) ? 0 : -1;
}

// Edge function of p to q at a point s: E = (q-p).x (s-p).y - (q-p).y (s-p).x, inside where E + bias >= 0.
// At centres s = 256 (i, j) + 128 it grows by whole multiples of 256, so the sign of E + bias is that of
//   floor((E(0,0) + bias) / 256) + b j + a i,   a = -(q-p).y, b = (q-p).x.

/// floor((E + bias) / 256) at the centre of a pixel.
int64_t edgeAt(ivec2 p, ivec2 q, ivec2 pixel) {
    ivec2 d = q - p;
    ivec2 s = pixel * SUBPIXELS + HALF_PIXEL - p;
    return (int64_t(d.x) * int64_t(s.y) - int64_t(d.y) * int64_t(s.x) + int64_t(edgeBias(p, q))) >> 8;
}

/// Same where |E| is known to fit 31 bits.
int edgeAtSmall(ivec2 p, ivec2 q, ivec2 pixel) {
    ivec2 d = q - p;
    ivec2 s = pixel * SUBPIXELS + HALF_PIXEL - p;
    return (d.x * s.y - d.y * s.x + edgeBias(p, q)) >> 8;
}

// Of finite numbers: min() and max() cost more where they must mind NaN.
double lesser(double a, double b) { return a < b ? a : b; }
double greater(double a, double b) { return a > b ? a : b; }

/// Depth over the screen: a x + b y + c at pixel coordinates x, y, kept within the vertices' range (snapping can
/// move an edge past the true triangle). `facing` is positive where the front (counter-clockwise) is seen.
struct DepthPlane {
    double a, b, c;
    float low, high;
    double facing;
};

/// The plane through three homogeneous vertices, whatever the signs of their w. With P = (X, Y, w) and depth
/// Z/w affine on the screen, (a, b, c).P = Z at all three; for equal Z (perspective) that is
/// (a, b, c) = Z N / (N.P0) with N = (P1-P0) x (P2-P0): no projection, no division by a w.
DepthPlane depthPlane(HomogeneousVertex p0, HomogeneousVertex p1, HomogeneousVertex p2) {
    DepthPlane plane;
    dvec3 e1 = dvec3(p1.x - p0.x, p1.y - p0.y, ORTHOGRAPHIC ? p1.z - p0.z : p1.w - p0.w);
    dvec3 e2 = dvec3(p2.x - p0.x, p2.y - p0.y, ORTHOGRAPHIC ? p2.z - p0.z : p2.w - p0.w);
    precise double nx = e1.y * e2.z - e1.z * e2.y;
    precise double ny = e1.z * e2.x - e1.x * e2.z;
    precise double nz = e1.x * e2.y - e1.y * e2.x;
    if (ORTHOGRAPHIC) {
        plane.a = -nx / nz;
        plane.b = -ny / nz;
        precise double c = p0.z - plane.a * p0.x - plane.b * p0.y;
        plane.c = c;
        plane.facing = -nz;
    } else {
        precise double volume = nx * p0.x + ny * p0.y + nz * p0.w;
        double scale = push.depthOffset / volume;
        plane.a = nx * scale;
        plane.b = ny * scale;
        plane.c = nz * scale;
        plane.facing = -volume;
    }
    // Behind the near plane depth is cut at 1.
    double least = lesser(p0.near, lesser(p1.near, p2.near)), most = greater(p0.near, greater(p1.near, p2.near));
    double farthest = ORTHOGRAPHIC ? 1.0LF - most : push.depthOffset / (most + push.depthOffset);
    double nearest = ORTHOGRAPHIC ? 1.0LF - least : push.depthOffset / (least + push.depthOffset);
    const float smallest = 1.17549435e-38;  // a hit is never 0, which means none
    plane.low = max(most < 0.0LF ? 1.0 : float(farthest), smallest);
    plane.high = max(least < 0.0LF ? 1.0 : float(nearest), smallest);
    return plane;
}

/// What a key holds of a depth d, larger where nearer. Of reversed floats the bits: positive floats order as their bits
/// do, so clamping integers also catches negative values and NaN. Of the conventional formats, from 0 at the near plane to
/// 1 at the far one and beyond it, the steps that are left to 1, and one: 0 is a miss.
int depthCode(double d) {
    if (DEPTH_FORMAT == DEPTH_REVERSED) return floatBitsToInt(float(d));
    double rest = 1.0LF - d;
    double conventional = clamp(ORTHOGRAPHIC ? rest : rest * push.depthSlope, 0.0LF, 1.0LF);
    if (DEPTH_FORMAT == DEPTH_FLOAT) return 0x3f800001 - floatBitsToInt(float(conventional));
    int steps = DEPTH_FORMAT == DEPTH_UNORM24 ? 16777215 : 65535;
    return steps + 1 - int(conventional * double(steps) + 0.5LF);
}

int depthBits(double a, double rowTerm, double x, int low, int high) {
    return clamp(depthCode(a * x + rowTerm), low, high);
}

/// The key of the visibility buffer: nearer (larger depth) wins, then the smaller id. 0 is a miss.
uint64_t visibilityKey(int depth, uint id) { return (uint64_t(uint(depth)) << 32) | uint64_t(~id); }

#endif
