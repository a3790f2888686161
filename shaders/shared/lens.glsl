// Thin lenses, depth of field and photographic exposure. Distances from the lens are positive on both sides and of one
// unit; f is the focal length, N = f / A the f-number of an aperture of diameter A.
#ifndef SHADERS_SHARED_LENS_GLSL
#define SHADERS_SHARED_LENS_GLSL
#include "shaders/shared/exponential.glsl"
#include "shaders/shared/float_bits.glsl"
#include "shaders/shared/real.glsl"
#include "shaders/shared/trigonometry.glsl"

/// Distance behind the lens at which an object is sharp: 1/f = 1/zi + 1/zo. Negative: a virtual image, zo < f.
FN Real imageDistance(Real f, Real objectDistance) { return f / (1.0 - f / objectDistance); }
/// Size of the image over that of the object, -zi / zo: real images stand on their head.
FN Real lensMagnification(Real f, Real objectDistance) { return f / (f - objectDistance); }
/// Focal length of a lens that has its image at this distance when it is focused on an object.
FN Real focalLengthFor(Real imageDistance_, Real objectDistance) {
    return imageDistance_ / (1.0 + imageDistance_ / objectDistance);
}

/// Diameter on the sensor of the blur of a point at `objectDistance` with the lens focused at `focus`: A |zs - zi| / zi
/// with zs and zi their images, written so that nothing cancels.
FN Real circleOfConfusion(Real aperture, Real f, Real focus, Real objectDistance) {
    return aperture * (f / (focus - f)) * (abs(objectDistance - focus) / objectDistance);
}

/// Focus distance from which on the blur of infinity is no larger than c: f^2 / (N c) + f.
FN Real hyperfocalDistance(Real f, Real fNumber, Real c) { return f * (f / (fNumber * c)) + f; }
/// Nearest and farthest distances whose blur is no larger than that which H, the hyperfocal distance, stands for.
FN Real depthOfFieldNear(Real f, Real hyperfocal, Real focus) {
    return focus * ((hyperfocal - f) / ((hyperfocal - f) + (focus - f)));
}
/// Infinite from the hyperfocal distance on.
FN Real depthOfFieldFar(Real f, Real hyperfocal, Real focus) {
    return focus >= hyperfocal ? infinity() : focus * ((hyperfocal - f) / (hyperfocal - focus));
}

/// Exposure H of a sensor under irradiance E for a time t: H = E t. What a film's density goes by.
FN Real photographicExposure(Real irradiance, Real seconds) { return irradiance * seconds; }
/// Irradiance on the sensor of a far scene of this radiance on the axis: pi L / (4 N^2).
FN Real imageIrradiance(Real radiance, Real fNumber) { return QUARTER_PI * (radiance / (fNumber * fNumber)); }
/// Exposure value at ISO 100: log2(N^2 / t * 100 / S).
FN Real exposureValue100(Real fNumber, Real seconds, Real iso) {
    return realLog2((fNumber / seconds) * (fNumber / iso) * 100.0);
}

/// A point drawn uniformly from the unit disc, or, with blades >= 3, from the regular polygon in it, one of whose
/// corners lies at `rotation` (radians) from +x.
FN Vec2 apertureSample(Vec2 u, int blades, Real rotation) {
    Real s0;
    Real c0;
    if (blades < 3) {
        Real r = sqrt(u.x);
        sinCosTurns(u.y, s0, c0);
        return Vec2(r * c0, r * s0);
    }
    // A triangle from the centre to a side, then a point of it: sqrt(u.y) of the way out, u' along the side.
    Real count = Real(blades);
    Real place = u.x * count;
    Real side = min(floor(place), count - 1.0);
    Real along = place - side;
    Real out_ = sqrt(u.y);
    Real s1;
    Real c1;
    Real turns = rotation * INV_TWO_PI;
    sinCosTurns(turns + side / count, s0, c0);
    sinCosTurns(turns + (side + 1.0) / count, s1, c1);
    return Vec2(out_ * (c0 + (c1 - c0) * along), out_ * (s0 + (s1 - s0) * along));
}

#endif
