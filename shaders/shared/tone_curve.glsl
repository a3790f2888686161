// Tone curves: exposed linear Rec.709 to linear display values of 0 to 1. All are increasing, take 0 to 0 and leave
// clamping to the encoder where a channel passes 1.
//   TONE_NONE      as it is
//   TONE_REINHARD  c / (1 + Y): luminance Y to Y / (1 + Y), hue kept. Reinhard et al., "Photographic tone reproduction
//                  for digital images", 2002, equation 3.
//   TONE_FILMIC    Hable's fit of film, per channel, white at 11.2, at twice the exposure as he shows it. Hable,
//                  "Uncharted 2: HDR lighting", GDC 2010.
//   TONE_ACES      Hill's fit of the Academy's reference rendering and sRGB output transforms (2016).
#ifndef SHADERS_SHARED_TONE_CURVE_GLSL
#define SHADERS_SHARED_TONE_CURVE_GLSL
#include "shaders/shared/color.glsl"
#include "shaders/shared/real.glsl"

CONST uint TONE_NONE = 0u;
CONST uint TONE_REINHARD = 1u;
CONST uint TONE_FILMIC = 2u;
CONST uint TONE_ACES = 3u;

/// Hable's curve ((x (A x + C B) + D E) / (x (A x + B) + D F) - E / F with A to F = .15, .5, .1, .2, .02, .3), put over
/// one denominator so that small values do not cancel.
FN Real filmicCurve(Real x) {
    Real numerator = x * (REAL(0.14) * x + REAL(0.0166666666666666666667));
    return numerator / (x * (REAL(0.15) * x + 0.5) + REAL(0.06));
}
FN Real acesCurve(Real x) {
    Real numerator = x * (x + REAL(0.0245786)) - REAL(0.000090537);
    return max(numerator, 0.0) / (x * (REAL(0.983729) * x + REAL(0.4329510)) + REAL(0.238081));
}

/// `c`: not negative, not NaN. Beyond 2^16 curves are flat.
FN Vec3 toneCurve(uint kind, Vec3 c) {
    if (kind == TONE_NONE) return c;
    Vec3 x = Vec3(min(c.x, 65536.0), min(c.y, 65536.0), min(c.z, 65536.0));
    if (kind == TONE_REINHARD) return x * (1.0 / (1.0 + luminance(x)));
    if (kind == TONE_FILMIC) {
        Real white = 1.0 / filmicCurve(REAL(11.2));
        return Vec3(filmicCurve(2.0 * x.x) * white, filmicCurve(2.0 * x.y) * white, filmicCurve(2.0 * x.z) * white);
    }
    Vec3 a = Vec3(acesCurve(REAL(0.59719) * x.x + REAL(0.35458) * x.y + REAL(0.04823) * x.z),
                  acesCurve(REAL(0.07600) * x.x + REAL(0.90834) * x.y + REAL(0.01566) * x.z),
                  acesCurve(REAL(0.02840) * x.x + REAL(0.13383) * x.y + REAL(0.83777) * x.z));
    return Vec3(max(REAL(1.60475) * a.x - REAL(0.53108) * a.y - REAL(0.07367) * a.z, 0.0),
                max(-REAL(0.10208) * a.x + REAL(1.10813) * a.y - REAL(0.00605) * a.z, 0.0),
                max(-REAL(0.00327) * a.x - REAL(0.07276) * a.y + REAL(1.07602) * a.z, 0.0));
}

#endif
