#include "engine/shader/spirv_names.hpp"

#include <fmt/format.h>

#include <map>

namespace helio {

Format toFormat(SpvImageFormat format) {
    switch (format) {
        case SpvImageFormatRgba32f:
            return Format::RGBA32F;
        case SpvImageFormatRgba16f:
            return Format::RGBA16F;
        case SpvImageFormatR32f:
            return Format::R32F;
        case SpvImageFormatRgba8:
            return Format::RGBA8;
        case SpvImageFormatRg32f:
            return Format::RG32F;
        case SpvImageFormatR8:
            return Format::R8;
        case SpvImageFormatR32i:
            return Format::R32I;
        case SpvImageFormatRgba32ui:
            return Format::RGBA32UI;
        case SpvImageFormatR32ui:
            return Format::R32UI;
        case SpvImageFormatRg32ui:
            return Format::RG32UI;
        default:
            return Format::Undefined;
    }
}

TexelType toTexelType(spvc_basetype type) {
    switch (type) {
        case SPVC_BASETYPE_FP16:
        case SPVC_BASETYPE_FP32:
        case SPVC_BASETYPE_FP64:
            return TexelType::Float;
        case SPVC_BASETYPE_INT32:
        case SPVC_BASETYPE_INT64:
            return TexelType::Int;
        case SPVC_BASETYPE_UINT32:
        case SPVC_BASETYPE_UINT64:
            return TexelType::Uint;
        default:
            return TexelType::None;
    }
}

std::string capabilityName(SpvCapability capability) {
    static const std::map<SpvCapability, const char*> names{
        {SpvCapabilityMatrix, "Matrix"},
        {SpvCapabilityShader, "Shader"},
        {SpvCapabilityFloat16, "Float16"},
        {SpvCapabilityFloat64, "Float64"},
        {SpvCapabilityInt64, "Int64"},
        {SpvCapabilityInt64Atomics, "Int64Atomics"},
        {SpvCapabilityInt16, "Int16"},
        {SpvCapabilityInt8, "Int8"},
        {SpvCapabilityImageGatherExtended, "ImageGatherExtended"},
        {SpvCapabilityStorageImageMultisample, "StorageImageMultisample"},
        {SpvCapabilityUniformBufferArrayDynamicIndexing, "UniformBufferArrayDynamicIndexing"},
        {SpvCapabilitySampledImageArrayDynamicIndexing, "SampledImageArrayDynamicIndexing"},
        {SpvCapabilityStorageBufferArrayDynamicIndexing, "StorageBufferArrayDynamicIndexing"},
        {SpvCapabilityStorageImageArrayDynamicIndexing, "StorageImageArrayDynamicIndexing"},
        {SpvCapabilityImageCubeArray, "ImageCubeArray"},
        {SpvCapabilitySampledCubeArray, "SampledCubeArray"},
        {SpvCapabilityMinLod, "MinLod"},
        {SpvCapabilitySampled1D, "Sampled1D"},
        {SpvCapabilityImage1D, "Image1D"},
        {SpvCapabilitySampledBuffer, "SampledBuffer"},
        {SpvCapabilityImageBuffer, "ImageBuffer"},
        {SpvCapabilityImageMSArray, "ImageMSArray"},
        {SpvCapabilityStorageImageExtendedFormats, "StorageImageExtendedFormats"},
        {SpvCapabilityImageQuery, "ImageQuery"},
        {SpvCapabilityStorageImageReadWithoutFormat, "StorageImageReadWithoutFormat"},
        {SpvCapabilityStorageImageWriteWithoutFormat, "StorageImageWriteWithoutFormat"},
        {SpvCapabilityGroupNonUniform, "GroupNonUniform"},
        {SpvCapabilityGroupNonUniformVote, "GroupNonUniformVote"},
        {SpvCapabilityGroupNonUniformArithmetic, "GroupNonUniformArithmetic"},
        {SpvCapabilityGroupNonUniformBallot, "GroupNonUniformBallot"},
        {SpvCapabilityGroupNonUniformShuffle, "GroupNonUniformShuffle"},
        {SpvCapabilityGroupNonUniformShuffleRelative, "GroupNonUniformShuffleRelative"},
        {SpvCapabilityGroupNonUniformClustered, "GroupNonUniformClustered"},
        {SpvCapabilityGroupNonUniformQuad, "GroupNonUniformQuad"},
        {SpvCapabilityVulkanMemoryModel, "VulkanMemoryModel"},
        {SpvCapabilityVulkanMemoryModelDeviceScope, "VulkanMemoryModelDeviceScope"},
        {SpvCapabilityVariablePointers, "VariablePointers"},
        {SpvCapabilityVariablePointersStorageBuffer, "VariablePointersStorageBuffer"},
        {SpvCapabilityPhysicalStorageBufferAddresses, "PhysicalStorageBufferAddresses"},
        {SpvCapabilityStorageBuffer8BitAccess, "StorageBuffer8BitAccess"},
        {SpvCapabilityUniformAndStorageBuffer8BitAccess, "UniformAndStorageBuffer8BitAccess"},
        {SpvCapabilityStorageBuffer16BitAccess, "StorageBuffer16BitAccess"},
        {SpvCapabilityUniformAndStorageBuffer16BitAccess, "UniformAndStorageBuffer16BitAccess"},
        {SpvCapabilityStoragePushConstant8, "StoragePushConstant8"},
        {SpvCapabilityStoragePushConstant16, "StoragePushConstant16"},
        {SpvCapabilityDenormPreserve, "DenormPreserve"},
        {SpvCapabilityDenormFlushToZero, "DenormFlushToZero"},
        {SpvCapabilitySignedZeroInfNanPreserve, "SignedZeroInfNanPreserve"},
        {SpvCapabilityRoundingModeRTE, "RoundingModeRTE"},
        {SpvCapabilityRoundingModeRTZ, "RoundingModeRTZ"},
        {SpvCapabilityShaderNonUniform, "ShaderNonUniform"},
        {SpvCapabilityRuntimeDescriptorArray, "RuntimeDescriptorArray"},
        {SpvCapabilitySampledImageArrayNonUniformIndexing, "SampledImageArrayNonUniformIndexing"},
        {SpvCapabilityStorageBufferArrayNonUniformIndexing, "StorageBufferArrayNonUniformIndexing"},
        {SpvCapabilityInt64ImageEXT, "Int64ImageEXT"},
        {SpvCapabilityAtomicFloat32AddEXT, "AtomicFloat32AddEXT"},
        {SpvCapabilityAtomicFloat32MinMaxEXT, "AtomicFloat32MinMaxEXT"},
        {SpvCapabilityAtomicFloat64AddEXT, "AtomicFloat64AddEXT"},
        {SpvCapabilityDeviceGroup, "DeviceGroup"},
        {SpvCapabilityShaderClockKHR, "ShaderClockKHR"},
        {SpvCapabilityRayQueryKHR, "RayQueryKHR"},
        {SpvCapabilityDotProduct, "DotProduct"},
        {SpvCapabilityDemoteToHelperInvocation, "DemoteToHelperInvocation"},
    };
    const auto found = names.find(capability);
    return found != names.end() ? found->second : fmt::format("capability {}", static_cast<int>(capability));
}

std::string glslTypeName(spvc_basetype base, unsigned columns, unsigned rows) {
    struct Names {
        const char* scalar;
        const char* vector;
    };
    static const std::map<spvc_basetype, Names> names{
        {SPVC_BASETYPE_BOOLEAN, {"bool", "bvec"}},      {SPVC_BASETYPE_INT8, {"int8_t", "i8vec"}},
        {SPVC_BASETYPE_UINT8, {"uint8_t", "u8vec"}},    {SPVC_BASETYPE_INT16, {"int16_t", "i16vec"}},
        {SPVC_BASETYPE_UINT16, {"uint16_t", "u16vec"}}, {SPVC_BASETYPE_INT32, {"int", "ivec"}},
        {SPVC_BASETYPE_UINT32, {"uint", "uvec"}},       {SPVC_BASETYPE_INT64, {"int64_t", "i64vec"}},
        {SPVC_BASETYPE_UINT64, {"uint64_t", "u64vec"}}, {SPVC_BASETYPE_FP16, {"float16_t", "f16vec"}},
        {SPVC_BASETYPE_FP32, {"float", "vec"}},         {SPVC_BASETYPE_FP64, {"double", "dvec"}},
    };
    const auto found = names.find(base);
    if (found == names.end()) return "";
    if (columns > 1) {
        const std::string prefix = base == SPVC_BASETYPE_FP64 ? "dmat" : "mat";
        return columns == rows ? fmt::format("{}{}", prefix, rows)
                               : fmt::format("{}{}x{}", prefix, columns, rows);
    }
    return rows > 1 ? fmt::format("{}{}", found->second.vector, rows) : found->second.scalar;
}

}  // namespace helio
