#pragma once
/** @file SPIR-V's and SPIRV-Cross's numbers in the engine's terms. */
#include "engine/shader/reflection.hpp"

#include <spirv_cross/spirv_cross_c.h>

#include <string>

namespace helio {

/** Undefined where the engine has no such format. */
Format toFormat(SpvImageFormat format);
TexelType toTexelType(spvc_basetype type);
/** As SPIR-V writes it, "Int64Atomics"; "capability N" where it is none that a compute kernel commonly has.
 */
std::string capabilityName(SpvCapability capability);
/** "float", "uvec3", "mat4x3"; empty where it is no scalar, vector or matrix. */
std::string glslTypeName(spvc_basetype base, unsigned columns, unsigned rows);

}  // namespace helio
