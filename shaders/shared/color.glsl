// The sRGB transfer curve (IEC 61966-2-1) and luminance of linear Rec.709 colours.
#ifndef SHADERS_SHARED_COLOR_GLSL
#define SHADERS_SHARED_COLOR_GLSL
#include "shaders/shared/exponential.glsl"
#include "shaders/shared/real.glsl"

/// The weights of Y in linear Rec.709 with its exact primaries and the white point (0.3127, 0.3290).
CONST Vec3 LUMINANCE_WEIGHTS = Vec3(REAL(0.2126390058715104), REAL(0.7151686787677559), REAL(0.07219231536073371));

FN Real luminance(Vec3 linear) {
    return linear.x * LUMINANCE_WEIGHTS.x + linear.y * LUMINANCE_WEIGHTS.y + linear.z * LUMINANCE_WEIGHTS.z;
}

/// Linear light to the sRGB code value, both 1 at white. Values above 1 continue on the curve, negative ones
/// on its straight part; clamp before storing integers. NaN stays NaN. Error below 1.6e-7 in [0, 1].
FN Real encodeSrgb(Real linear) {
    Real x = isnan(linear) ? 1.0 : clamp(linear, REAL(0.003), REAL(3e38));
    Real curve = REAL(1.055) * powPositive(x, REAL(0.416666666666666666667)) - REAL(0.055);
    Real y = linear <= REAL(0.0031308) ? REAL(12.92) * linear : curve;
    return isnan(linear) ? linear : y;
}
FN Vec3 encodeSrgb(Vec3 linear) {
    return Vec3(encodeSrgb(linear.x), encodeSrgb(linear.y), encodeSrgb(linear.z));
}

/// The sRGB code value to linear light, likewise. Error below 2.4e-7 in [0, 1].
FN Real decodeSrgb(Real encoded) {
    Real x = isnan(encoded) ? 1.0 : clamp(encoded, REAL(0.04), REAL(3e38));
    Real curve = powPositive((x + REAL(0.055)) / REAL(1.055), REAL(2.4));
    Real y = encoded <= REAL(0.04045) ? encoded * REAL(0.0773993808049535603715) : curve;
    return isnan(encoded) ? encoded : y;
}
FN Vec3 decodeSrgb(Vec3 encoded) {
    return Vec3(decodeSrgb(encoded.x), decodeSrgb(encoded.y), decodeSrgb(encoded.z));
}

#endif
