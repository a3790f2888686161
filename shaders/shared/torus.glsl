// Where a ray meets a torus: a quartic whose roots are bracketed before they are searched for, so that none is missed
// and none is sought where there is none. Between neighbouring extrema a polynomial has one root or none, by its signs
// there; the extrema are the derivative's roots, which are bracketed likewise by those of the second derivative, a
// quadratic. Each search is bisection that takes Newton's step where that stays in its bracket.
#ifndef SHADERS_SHARED_TORUS_GLSL
#define SHADERS_SHARED_TORUS_GLSL
#include "shaders/shared/sphere.glsl"

/// x^4 + c3 x^3 + c2 x^2 + c1 x + c0.
struct Quartic {
    Real c3, c2, c1, c0;
};

FN Real quarticValue(Quartic f, Real x) { return (((x + f.c3) * x + f.c2) * x + f.c1) * x + f.c0; }
FN Real quarticSlope(Quartic f, Real x) { return ((4.0 * x + 3.0 * f.c3) * x + 2.0 * f.c2) * x + f.c1; }
FN Real quarticBend(Quartic f, Real x) { return (12.0 * x + 6.0 * f.c3) * x + 2.0 * f.c2; }

/// Steps of a search; and turns of all loops that meetTorus() may take.
CONST int ROOT_STEPS = 24;
CONST int TORUS_TURNS = 192;

/// The root between low and high, where the quartic (or where `slope`, its derivative) has values of two signs.
FN Real bracketedRoot(Quartic f, bool slope, Real low, Real high) {
    bool rises = (slope ? quarticSlope(f, high) : quarticValue(f, high)) > 0.0;
    Real x = 0.5 * (low + high), before = high - low;
    for (int i = 0; i < ROOT_STEPS; ++i) {
        Real value = slope ? quarticSlope(f, x) : quarticValue(f, x);
        bool above = (value > 0.0) == rises;
        low = above ? low : x;
        high = above ? x : high;
        // Steps at least halve.
        Real next = x - value / (slope ? quarticBend(f, x) : quarticSlope(f, x));
        bool newton = next >= low && next <= high && abs(next - x) <= 0.5 * before;
        next = newton ? next : 0.5 * (low + high);
        before = newton ? abs(next - x) : 0.5 * (high - low);
        x = next;
    }
    return x;
}

/// Extrema between low and high in ascending order, with the ends where there are none: low <= x <= y <= z <= high.
FN Vec3 quarticExtrema(Quartic f, Real low, Real high) {
    Real b0, b1;
    int bends = solveQuadratic(12.0, 6.0 * f.c3, 2.0 * f.c2, b0, b1);
    b0 = bends < 2 ? low : clamp(b0, low, high);
    b1 = bends < 2 ? low : clamp(b1, low, high);
    Vec3 extrema = Vec3(low, b0, b1);
    Real from = low, fromSlope = quarticSlope(f, low);
    for (int i = 0; i < 3; ++i) {
        Real to = i == 0 ? b0 : (i == 1 ? b1 : high);
        Real toSlope = quarticSlope(f, to);
        Real found = from;
        if ((fromSlope > 0.0) != (toSlope > 0.0)) found = bracketedRoot(f, true, from, to);
        if (i == 0) extrema.x = found;
        if (i == 1) extrema.y = found;
        if (i == 2) extrema.z = found;
        from = to;
        fromSlope = toSlope;
    }
    return extrema;
}

/// The least root of the quartic in (after, high), high where there is none.
FN Real firstQuarticRoot(Quartic f, Real low, Real high, Real after) {
    Vec3 extrema = quarticExtrema(f, low, high);
    Real root = high, from = low, fromValue = quarticValue(f, low);
    bool found = false;
    for (int i = 0; i < 4; ++i) {
        Real to = i == 0 ? extrema.x : (i == 1 ? extrema.y : (i == 2 ? extrema.z : high));
        Real toValue = quarticValue(f, to);
        if (!found && to > after && (fromValue > 0.0) != (toValue > 0.0)) {
            Real x = bracketedRoot(f, false, from, to);
            found = x > after;
            root = found ? x : root;
        }
        from = to;
        fromValue = toValue;
    }
    return root;
}

struct TorusMeeting {
    bool meets;
    Real distance;  ///< in lengths of the direction
    Vec3 point;     ///< from the centre to the surface
    Vec3 normal;    ///< unit, outwards
};

/// The nearest meeting beyond `least` (a distance, 0 or more) of a ray with the torus about `centre` whose tube of radius
/// `tube` runs round the unit vector `axis` at the distance `ring` > tube.
FN TorusMeeting meetTorus(Vec3 origin, Vec3 direction, Vec3 centre, Vec3 axis, Real ring, Real tube, Real least) {
    SphereMeeting around = meetSphere(origin, direction, centre, (ring + tube) * REAL(1.0001));
    Real size = sqrt(dot(direction, direction));
    // From the chord's middle, in units of the ring's radius.
    Vec3 way = direction / size, middle = around.middle / ring;
    Real k = tube / ring, reach = sqrt(dot(around.half_, around.half_)) / ring;
    Real along = dot(middle, way), upMiddle = dot(middle, axis), upWay = dot(way, axis);
    Vec3 flatMiddle = middle - upMiddle * axis, flatWay = way - upWay * axis;
    Real rest = dot(middle, middle) + (1.0 - k) * (1.0 + k);
    Quartic f;
    f.c3 = 4.0 * along;
    f.c2 = 2.0 * rest + 4.0 * along * along - 4.0 * dot(flatWay, flatWay);
    f.c1 = 4.0 * along * rest - 8.0 * dot(flatMiddle, flatWay);
    // (m^2 + 1 - k^2)^2 - 4 flat^2, as a product.
    Real out_ = sqrt(dot(flatMiddle, flatMiddle)), up2 = upMiddle * upMiddle - k * k;
    f.c0 = (square(out_ - 1.0) + up2) * (square(out_ + 1.0) + up2);
    Real middleAt = 0.5 * (around.low + around.high) * size / ring;  // of the chord's middle from the origin
    Real after = max(-reach, least * size / ring - middleAt);
    TorusMeeting m;
    Real s = firstQuarticRoot(f, -reach, reach, after);
    m.meets = around.meets && s < reach;
    // Newton's steps on the distance itself, which the quartic's rounding does not touch.
    Vec3 out3 = Vec3(0.0);
    for (int i = 0; i < 2; ++i) {
        Vec3 p = middle + s * way;
        Vec3 level = p - dot(p, axis) * axis;
        Real radius = sqrt(dot(level, level));
        out3 = p - level / (radius > 0.0 ? radius : 1.0);
        Real off = sqrt(dot(out3, out3));
        Real slope = dot(out3, way) / (off > 0.0 ? off : 1.0);
        Real step_ = abs(slope) > REAL(1e-3) ? (off - k) / slope : 0.0;
        s -= clamp(step_, REAL(-1e-4), REAL(1e-4));
    }
    m.distance = (middleAt + s) * ring / size;
    Vec3 p = middle + s * way;
    Vec3 level = p - dot(p, axis) * axis;
    Real radius = sqrt(dot(level, level));
    Vec3 onRing = level / (radius > 0.0 ? radius : 1.0);
    out3 = p - onRing;
    Real off = sqrt(dot(out3, out3));
    m.normal = out3 / (off > 0.0 ? off : 1.0);
    m.point = ring * onRing + tube * m.normal;
    return m;
}

#endif
