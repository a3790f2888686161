// The mathematical functions in one include.
#ifndef SHADERS_SHARED_MATH_GLSL
#define SHADERS_SHARED_MATH_GLSL
#include "shaders/shared/error_free.glsl"
#include "shaders/shared/error_function.glsl"
#include "shaders/shared/exponential.glsl"
#include "shaders/shared/float_bits.glsl"
#include "shaders/shared/real.glsl"
#include "shaders/shared/trigonometry.glsl"
#include "shaders/shared/vector.glsl"
#endif
