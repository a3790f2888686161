// Exact coverage: what a pixel's area has in common with a triangle. The reference that sampling tends to.
#ifndef SHADERS_RASTER_COVERAGE_GLSL
#define SHADERS_RASTER_COVERAGE_GLSL

/// Integral of clamp(y, 0, 1) dx along the straight line from a to b, where x is cut to 0..1.
float clampedIntegral(vec2 a, vec2 b) {
    vec2 from = a.x <= b.x ? a : b, to = a.x <= b.x ? b : a;
    float x0 = max(from.x, 0.0), x1 = min(to.x, 1.0), width = to.x - from.x;
    if (!(x1 > x0)) return 0.0;
    // Heights at both ends, from the nearer corner, so that long edges lose nothing.
    float slope = (to.y - from.y) / width;
    float y0 = x0 == from.x ? from.y : from.y + slope * (x0 - from.x);
    float y1 = x1 == to.x ? to.y : to.y + slope * (x1 - to.x);
    // Of a line over the stretch: int clamp(y) = stretch (F(y1) - F(y0)) / (y1 - y0), F' = clamp.
    float c0 = clamp(y0, 0.0, 1.0), c1 = clamp(y1, 0.0, 1.0), rise = y1 - y0;
    // The part where y is inside 0..1 is a trapezium; beyond 1 it is a rectangle of height 1.
    float inside = abs(rise) > 0.0 ? (c1 - c0) / rise : 1.0;
    float above = abs(rise) > 0.0 ? (max(y1 - 1.0, 0.0) - max(y0 - 1.0, 0.0)) / rise : 0.0;
    float mean = abs(rise) > 0.0 ? inside * 0.5 * (c0 + c1) + above : c0;
    float value = (x1 - x0) * mean;
    return a.x <= b.x ? value : -value;
}

/// Area of the triangle a, b, c inside the unit square, whatever its winding: Green's theorem for the part of the
/// triangle between y = 0 and y = 1.
float pixelCoverage(vec2 a, vec2 b, vec2 c) {
    return abs(clampedIntegral(a, b) + clampedIntegral(b, c) + clampedIntegral(c, a));
}

#endif
