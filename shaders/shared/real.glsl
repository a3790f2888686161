// The preamble of the shared library: what makes one source valid GLSL, C++ float and C++ double.
//
// Every file in shaders/shared starts with this include and is written in the common part of both languages:
//   Real Vec2 Vec3 Vec4 Mat3 Mat4   floating-point types; int, uint, bool, ivecN, uvecN, bvecN are as in GLSL
//   REAL(0.1)                       a literal rounded once to Real. A bare literal is allowed only where it is
//                                   exact in float (0.5, 2.0, 1024.0): C++ sources are built with
//                                   -fsingle-precision-constant, so a bare 0.1 is a float even in the double build
//   FN Real f(Real x)               every function; CONST Real name = ...; every global constant
//   OUT(Vec3) v, INOUT(Real) x      output parameters; inputs are by value
//   precise Real s = a + b;         keeps the operations and their order (GLSL), a no-op in C++
//   PRECISION_BITS                  32 or 64; GLSL is 32
// Structs work as in GLSL, `Ray(origin, direction)` constructs. Components are v.x, v[i] and m[column][row];
// write Vec3(v4) and Vec2(v.x, v.y) instead of swizzles. The built-ins there are in C++ are listed in
// engine/core/shared_builtins.inc; those whose precision Vulkan leaves open (sin, exp, pow, ...) are absent
// on purpose: use the own versions of shaders/shared/math.glsl (realSin, realExp, realPow, ...). fma is
// absent too: it is fused on some devices only. Include guards are SHADERS_SHARED_<FILE>_GLSL; a new file is
// listed in engine/core/shared_library.inc.
#ifndef SHADERS_SHARED_REAL_GLSL
#define SHADERS_SHARED_REAL_GLSL

#ifndef __cplusplus
#define Real float
#define Vec2 vec2
#define Vec3 vec3
#define Vec4 vec4
#define Mat2 mat2
#define Mat3 mat3
#define Mat4 mat4
#define REAL(literal) literal
#define FN
#define CONST const
#define OUT(type) out type
#define INOUT(type) inout type
#define PRECISION_BITS 32
#elif !defined(PRECISION_BITS)
#error "include engine/core/shared.hpp instead: it includes the shared library in both precisions"
#endif

CONST Real PI = REAL(3.14159265358979323846);
CONST Real TWO_PI = REAL(6.28318530717958647693);
CONST Real HALF_PI = REAL(1.57079632679489661923);
CONST Real QUARTER_PI = REAL(0.785398163397448309616);
CONST Real INV_PI = REAL(0.318309886183790671538);
CONST Real INV_TWO_PI = REAL(0.159154943091895335769);
CONST Real INV_FOUR_PI = REAL(0.0795774715459476678844);
CONST Real SQRT_TWO = REAL(1.41421356237309504880);
CONST Real INV_SQRT_TWO = REAL(0.707106781186547524401);
CONST Real LN_TWO = REAL(0.693147180559945309417);

/// Half the distance from 1 to the next number: the bound of one rounding's relative error.
#if PRECISION_BITS == 32
CONST Real UNIT_ROUNDOFF = REAL(5.9604644775390625e-08);
CONST Real REAL_MAX = REAL(3.4028234663852886e+38);
CONST Real REAL_MIN_NORMAL = REAL(1.1754943508222875e-38);
#else
CONST Real UNIT_ROUNDOFF = REAL(1.1102230246251565e-16);
CONST Real REAL_MAX = REAL(1.7976931348623157081e+308);
CONST Real REAL_MIN_NORMAL = REAL(2.2250738585072013831e-308);
#endif

/// Bound of the relative error that n roundings in a row can build up: n u / (1 - n u).
FN Real gammaBound(int n) { return Real(n) * UNIT_ROUNDOFF / (1.0 - Real(n) * UNIT_ROUNDOFF); }

FN Real square(Real x) { return x * x; }

#endif
