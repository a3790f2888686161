// What every scattering model gives. Directions are unit, point away from the surface, and are in the local
// frame of the shading normal (z) and tangent (x); wo, where light goes to, has z > 0, so that a transmitted wi
// has z < 0. `value` is the BSDF times |cos| of wi, for radiance: it is finite at grazing angles where the BSDF
// is not, and holds the n^2 scaling of refraction.
#ifndef SHADERS_SCATTERING_SCATTER_GLSL
#define SHADERS_SCATTERING_SCATTER_GLSL
#include "shaders/shared/trigonometry.glsl"
#include "shaders/shared/vector.glsl"

struct ScatterValue {
    Vec3 value;    // f |cos wi|, 1/sr
    Real density;  // chance per solid angle that sampling gives wi
};

struct ScatterSample {
    Vec3 direction;  // wi
    Vec3 weight;     // f |cos wi| / density; 0: nothing is scattered
    Real density;    // negative: the direction is one of a finite set, which no other way finds
};

/// A microfacet distribution below this width is a mirror: half vectors of float directions err by 6e-8, which
/// would be more than a thousandth of such a lobe's width.
CONST Real SMOOTH_ALPHA = REAL(1e-4);

FN ScatterValue noScattering() { return ScatterValue(Vec3(0.0), 0.0); }
FN ScatterSample noSample() { return ScatterSample(Vec3(0.0, 0.0, 1.0), Vec3(0.0), 0.0); }

FN Vec3 mirrored(Vec3 w) { return Vec3(-w.x, -w.y, w.z); }
/// w reflected about the unit vector h.
FN Vec3 reflectedAbout(Vec3 w, Vec3 h) { return (2.0 * dot(w, h)) * h - w; }

/// Direction of density cos / pi.
FN Vec3 cosineHemisphere(Vec2 u) {
    Real s, c;
    sinCosTurns(u.y, s, c);
    Real radius = sqrt(u.x);
    return Vec3(radius * c, radius * s, sqrt(max(1.0 - u.x, 0.0)));
}

/// A direction whose worth is still to be judged by its model's value.
FN ScatterSample unjudged(Vec3 direction) { return ScatterSample(direction, Vec3(0.0), 1.0); }

FN ScatterSample sampleOf(Vec3 direction, ScatterValue v) {
    bool any = v.density > 0.0;
    return ScatterSample(direction, any ? v.value / v.density : Vec3(0.0), any ? v.density : Real(0.0));
}

#endif
