#ifndef HELIOGRAPH_SAMPLING_WARP
#define HELIOGRAPH_SAMPLING_WARP
/** @file Maps from the unit square to directions. */

/** (cos, sin) of 2 pi u for u in [0, 1]: exact reduction to an eighth of a turn, then Taylor polynomials whose
 * truncation is below 4e-9. The built-ins' precision is the driver's choice (2^-11 is allowed). */
vec2 unitCircle(float u) {
    const float quarter = floor(u * 4.0 + 0.5);
    const float x = (u - quarter * 0.25) * 6.283185307179586;
    const float x2 = x * x;
    const float s = x * (1.0 + x2 * (-1.6666667e-1 + x2 * (8.3333333e-3 + x2 * (-1.9841270e-4 + x2 * 2.7557319e-6))));
    const float c = 1.0 + x2 * (-0.5 + x2 * (4.1666667e-2 + x2 * (-1.3888889e-3 + x2 * 2.4801587e-5)));
    const int k = int(quarter) & 3;
    const vec2 turned = (k & 1) == 0 ? vec2(c, s) : vec2(-s, c);
    return (k & 2) == 0 ? turned : -turned;
}

/** Two unit vectors that with the unit vector n make a right-handed orthonormal basis. Duff et al., "Building
 * an orthonormal basis, revisited", JCGT 6(1), 2017. */
void basisAround(vec3 n, out vec3 tangent, out vec3 bitangent) {
    const float s = n.z >= 0.0 ? 1.0 : -1.0;
    const float a = -1.0 / (s + n.z);
    const float b = n.x * n.y * a;
    tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    bitangent = vec3(b, s + n.y * n.y * a, -n.y);
}

/** A direction about the unit vector n, uniform over the hemisphere; its cosine is u.x. */
vec3 uniformDirection(vec3 n, vec2 u) {
    vec3 tangent, bitangent;
    basisAround(n, tangent, bitangent);
    const vec2 disk = sqrt(max(1.0 - u.x * u.x, 0.0)) * unitCircle(u.y);
    return tangent * disk.x + bitangent * disk.y + n * u.x;
}

/** A direction, uniform over the sphere. */
vec3 uniformSphere(vec2 u) {
    const float z = 1.0 - 2.0 * u.x;
    return vec3(2.0 * sqrt(u.x * (1.0 - u.x)) * unitCircle(u.y), z);
}

/** A direction about the unit vector n with density `cosine` / pi over solid angle. */
vec3 cosineDirection(vec3 n, vec2 u, out float cosine) {
    vec3 tangent, bitangent;
    basisAround(n, tangent, bitangent);
    const vec2 disk = sqrt(u.x) * unitCircle(u.y);
    cosine = sqrt(max(1.0 - u.x, 0.0));
    return tangent * disk.x + bitangent * disk.y + n * cosine;
}
#endif
