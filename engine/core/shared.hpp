#pragma once
/** @file
 * The shared function library (shaders/shared) as C++: `helio::shared32::f` is the code that runs on the
 * device, `helio::shared64::f` the same source in double, the oracle for its rounding errors. The language of
 * those files is described in shaders/shared/real.glsl.
 *
 * A source file that includes this one is built with -fsingle-precision-constant: list it in
 * `helio_shared_sources(file...)` of CMake. Its own unsuffixed literals are floats then: write 0.1L where the
 * digits matter.
 */
#include <glm/glm.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

static_assert(sizeof(0.0) == sizeof(float),
              "list this source file in helio_shared_sources() of CMake: literals must be floats");

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wfloat-conversion"

#define REAL(literal) Real(literal##L)
#define FN inline
#define CONST inline constexpr
#define OUT(type) type&
#define INOUT(type) type&
#define precise

#define PRECISION_BITS 32
namespace helio::shared32 {
using Scalar = float;
#include "engine/core/shared_builtins.inc"
#include "engine/core/shared_library.inc"
}  // namespace helio::shared32
#undef PRECISION_BITS
#include "engine/core/shared_guards_off.inc"

#define PRECISION_BITS 64
namespace helio::shared64 {
using Scalar = double;
#include "engine/core/shared_builtins.inc"

// GLM's arithmetic deduces one type from vector and scalar, which a bare (float) literal would break.
#define HELIO_SCALAR_OPERATORS(Type)                \
    inline Type operator*(const Type& v, float s) { \
        return v * double(s);                       \
    }                                               \
    inline Type operator*(float s, const Type& v) { \
        return v * double(s);                       \
    }                                               \
    inline Type operator/(const Type& v, float s) { \
        return v / double(s);                       \
    }                                               \
    inline Type operator/(float s, const Type& v) { \
        return double(s) / v;                       \
    }                                               \
    inline Type operator+(const Type& v, float s) { \
        return v + double(s);                       \
    }                                               \
    inline Type operator+(float s, const Type& v) { \
        return v + double(s);                       \
    }                                               \
    inline Type operator-(const Type& v, float s) { \
        return v - double(s);                       \
    }                                               \
    inline Type operator-(float s, const Type& v) { \
        return double(s) - v;                       \
    }
HELIO_SCALAR_OPERATORS(Vec2)
HELIO_SCALAR_OPERATORS(Vec3)
HELIO_SCALAR_OPERATORS(Vec4)
HELIO_SCALAR_OPERATORS(Mat3)
HELIO_SCALAR_OPERATORS(Mat4)
#undef HELIO_SCALAR_OPERATORS
#include "engine/core/shared_double.inc"

#include "engine/core/shared_library.inc"
}  // namespace helio::shared64
#undef PRECISION_BITS
#include "engine/core/shared_guards_off.inc"

#undef REAL
#undef FN
#undef CONST
#undef OUT
#undef INOUT
#undef precise

#pragma GCC diagnostic pop
