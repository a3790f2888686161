// Where a ray meets a sphere. The textbook's discriminant b^2 - 4 a c loses all its digits where the sphere is small
// in its distance. Here the ray's origin is first moved next to the centre, with the rounding of that move kept, and
// the square of the miss distance is compared with the radius there (after Haines, Gunther and Akenine-Moller, "Precision
// improvements for ray/sphere intersection", Ray Tracing Gems, 2019); the root that the sum for the other one would
// cancel comes from their product.
#ifndef SHADERS_SHARED_SPHERE_GLSL
#define SHADERS_SHARED_SPHERE_GLSL
#include "shaders/shared/error_free.glsl"

struct SphereMeeting {
    bool meets;      ///< the ray's whole line does
    bool inside;     ///< the origin is
    Real low, high;  ///< distances, low <= high, in lengths of the direction
    Vec3 middle;     ///< from the centre to the middle of the chord
    Vec3 half_;      ///< from there to its end at `high`
};

/// A line through `origin` along `direction` and the sphere about `centre`. Distances have relative errors of a few units
/// of rounding, whatever the distance; whether they meet is wrong only within such errors of the radius.
FN SphereMeeting meetSphere(Vec3 origin, Vec3 direction, Vec3 centre, Real radius) {
    Vec3 rest;
    Vec3 from = Vec3(twoSum(origin.x, -centre.x, rest.x), twoSum(origin.y, -centre.y, rest.y),
                     twoSum(origin.z, -centre.z, rest.z));
    Real squared = dot(direction, direction);
    // Any number near the middle of the chord will do, as long as the point there is exact.
    Real near = -dot(from, direction) / squared;
    Vec3 move, error, lost;
    move.x = twoProduct(near, direction.x, error.x);
    move.y = twoProduct(near, direction.y, error.y);
    move.z = twoProduct(near, direction.z, error.z);
    Vec3 point = Vec3(twoSum(from.x, move.x, lost.x), twoSum(from.y, move.y, lost.y), twoSum(from.z, move.z, lost.z));
    point = point + (lost + (error + rest));
    Real left = -dot(point, direction) / squared;
    SphereMeeting m;
    m.middle = point + left * direction;
    Real miss = sqrt(dot(m.middle, m.middle));
    Real discriminant = (radius - miss) * (radius + miss);
    m.meets = discriminant >= 0.0;
    Real halfChord = sqrt(max(discriminant, 0.0) / squared);
    m.half_ = halfChord * direction;
    // |from|^2 - radius^2 in twice the precision: the product of the distances times `squared`.
    Real e0, e1, e2, e3, s1, s2, s3;
    Real sum = twoProduct(from.x, from.x, e0);
    sum = twoSum(sum, twoProduct(from.y, from.y, e1), s1);
    sum = twoSum(sum, twoProduct(from.z, from.z, e2), s2);
    sum = twoSum(sum, -twoProduct(radius, radius, e3), s3);
    Real power = sum + (((e0 + e1) + (e2 - e3)) + ((s1 + s2) + s3) + 2.0 * dot(from, rest));
    m.inside = power < 0.0;
    Real middleAt = near + left;
    Real larger = middleAt < 0.0 ? middleAt - halfChord : middleAt + halfChord;
    Real other = larger == 0.0 ? 0.0 : power / (squared * larger);
    m.low = middleAt < 0.0 ? larger : other;
    m.high = middleAt < 0.0 ? other : larger;
    return m;
}

#endif
