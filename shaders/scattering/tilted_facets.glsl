// A tilted normal as a surface can have it: facets along the normal, and upright ones that close the steps between
// them, which are mirrors. Schuessler, Heitz, Hanika and Dachsbacher, "Microfacet-based normal mapping for robust Monte
// Carlo path tracing", ACM TOG 36(6), 2017. No light is lost between facets, and all that follows is reciprocal.
//
// A unit area of the surface carries 1 / cos t of tilted facets and tan t of upright ones, t the tilt: seen along w,
// <w, p> / cos t + <w, t> tan t = <w, g> where w sees both, and more than that where it sees one, whose facets then hide
// each other. Directions are unit and point away from the surface.
#ifndef SHADERS_SCATTERING_TILTED_FACETS_GLSL
#define SHADERS_SCATTERING_TILTED_FACETS_GLSL
#include "shaders/shared/vector.glsl"

struct TiltedFacets {
    Vec3 surface;  // normal of the surface
    Vec3 tilted;   // normal of the tilted facets, above the surface
    Vec3 upright;  // of the upright ones; 0 where nothing is tilted
    Real cosine;   // of the tilt
    Real sine;
};

/// Tilts beyond are taken back to it: light turns about 1 / cosine times between steeper facets.
CONST Real LEAST_FACET_COSINE = REAL(0.2);

FN TiltedFacets tiltedFacets(Vec3 surface, Vec3 normal) {
    Vec3 along = normal - dot(normal, surface) * surface;
    Real sine = length(along);
    if (!(sine > REAL(1e-6))) return TiltedFacets(surface, surface, Vec3(0.0), 1.0, 0.0);
    Vec3 aside = along / sine;
    Real cosine = max(dot(normal, surface), LEAST_FACET_COSINE);
    sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    return TiltedFacets(surface, cosine * surface + sine * aside, -aside, cosine, sine);
}

/// Mirrored at the upright facets.
FN Vec3 mirroredUpright(TiltedFacets f, Vec3 w) { return w - (2.0 * dot(w, f.upright)) * f.upright; }

/// What of the tilted and upright facets a direction sees, per <w, g> / cos t where none hide others.
FN Real facetsInView(TiltedFacets f, Vec3 w) {
    return max(dot(w, f.tilted), 0.0) + max(dot(w, f.upright), 0.0) * f.sine;
}

/// Share of the tilted facets in what a direction above the surface sees.
FN Real tiltedInView(TiltedFacets f, Vec3 w) {
    Real all = facetsInView(f, w);
    return all > 0.0 ? max(dot(w, f.tilted), 0.0) / all : Real(1.0);
}

/// What a tilted facet sees of the viewer along w: straight, or by way of an upright facet. u: uniform.
FN Vec3 seenByTilted(TiltedFacets f, Vec3 w, Real u) { return u < tiltedInView(f, w) ? w : mirroredUpright(f, w); }

/// Chance that light on its way from a facet leaves the surface: it does not meet one that faces away from w.
FN Real leavesFacets(TiltedFacets f, Vec3 w) {
    Real above = max(dot(w, f.surface), 0.0) * f.cosine;
    Real all = facetsInView(f, w);
    return all > 0.0 ? min(above / all, REAL(1.0)) : Real(0.0);
}

/// Chance that light which a tilted facet sends along w mirrored leaves along w, by way of an upright facet.
FN Real leavesByUpright(TiltedFacets f, Vec3 w) {
    if (!(dot(w, f.upright) > 0.0)) return 0.0;
    return (1.0 - leavesFacets(f, mirroredUpright(f, w))) * leavesFacets(f, w);
}

#endif
