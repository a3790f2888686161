#include "engine/shader/spirv_reader.hpp"

#include "engine/shader/spirv_names.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace helio {

SpirvReader::SpirvReader(std::string_view kernel, std::span<const std::uint32_t> spirv) : kernel_(kernel) {
    if (spvc_context_create(&context_) != SPVC_SUCCESS) fail("SPIRV-Cross cannot start");
    try {
        spvc_parsed_ir ir = nullptr;
        check(spvc_context_parse_spirv(context_, spirv.data(), spirv.size(), &ir));
        check(spvc_context_create_compiler(context_, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                           &compiler_));
        check(spvc_compiler_create_shader_resources(compiler_, &resources_));
    } catch (...) {
        spvc_context_destroy(context_);
        throw;
    }
}

SpirvReader::~SpirvReader() {
    spvc_context_destroy(context_);
}

void SpirvReader::fail(const std::string& fault) const {
    throw ShaderError(fmt::format("kernel '{}': {}", kernel_, fault));
}

void SpirvReader::check(spvc_result result) const {
    if (result == SPVC_SUCCESS) return;
    const char* message = spvc_context_get_last_error_string(context_);
    fail(fmt::format("its SPIR-V is broken: {}", message != nullptr ? message : "unknown fault"));
}

std::string SpirvReader::nameOf(std::uint32_t id) const {
    const char* name = spvc_compiler_get_name(compiler_, id);
    return name != nullptr ? name : "";
}

std::string SpirvReader::typeName(spvc_type type) const {
    const spvc_basetype base = spvc_type_get_basetype(type);
    if (base == SPVC_BASETYPE_STRUCT) return nameOf(spvc_type_get_base_type_id(type));
    return glslTypeName(base, spvc_type_get_columns(type), spvc_type_get_vector_size(type));
}

std::vector<ReflectedMember> SpirvReader::readMembers(spvc_type structure) const {
    std::vector<ReflectedMember> members;
    const spvc_type_id id = spvc_type_get_base_type_id(structure);
    for (unsigned i = 0; i < spvc_type_get_num_member_types(structure); ++i) {
        ReflectedMember member;
        const spvc_type type =
            spvc_compiler_get_type_handle(compiler_, spvc_type_get_member_type(structure, i));
        const char* name = spvc_compiler_get_member_name(compiler_, id, i);
        member.name = name != nullptr ? name : "";
        member.type = typeName(type);
        check(spvc_compiler_type_struct_member_offset(compiler_, structure, i, &member.offset));
        std::size_t bytes = 0;
        check(spvc_compiler_get_declared_struct_member_size(compiler_, structure, i, &bytes));
        member.bytes = static_cast<std::uint32_t>(bytes);
        if (spvc_type_get_num_array_dimensions(type) > 0) {
            check(
                spvc_compiler_type_struct_member_array_stride(compiler_, structure, i, &member.arrayStride));
        }
        if (spvc_type_get_columns(type) > 1) {
            check(spvc_compiler_type_struct_member_matrix_stride(compiler_, structure, i,
                                                                 &member.matrixStride));
        }
        if (spvc_type_get_basetype(type) == SPVC_BASETYPE_STRUCT) {
            member.members =
                readMembers(spvc_compiler_get_type_handle(compiler_, spvc_type_get_base_type_id(type)));
        }
        members.push_back(std::move(member));
    }
    return members;
}

KernelReflection SpirvReader::read() {
    if (spvc_compiler_get_execution_model(compiler_) != SpvExecutionModelGLCompute)
        fail("it is no compute shader");
    try {
        KernelReflection out;
        readBindings(out);
        readPushConstants(out);
        readConstants(out);
        readCapabilities(out);
        return out;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {  // some functions of the C interface let them through
        fail(fmt::format("its SPIR-V cannot be read: {}", error.what()));
    }
}

void SpirvReader::readBindings(KernelReflection& out) {
    constexpr spvc_resource_type types[] = {
        SPVC_RESOURCE_TYPE_STORAGE_BUFFER, SPVC_RESOURCE_TYPE_UNIFORM_BUFFER,
        SPVC_RESOURCE_TYPE_STORAGE_IMAGE, SPVC_RESOURCE_TYPE_SAMPLED_IMAGE,
        SPVC_RESOURCE_TYPE_SEPARATE_IMAGE};
    constexpr std::pair<spvc_resource_type, const char*> refused[] = {
        {SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS,
         "a separate sampler; write it as one with its image, e.g. sampler2D"},
        {SPVC_RESOURCE_TYPE_ATOMIC_COUNTER, "an atomic counter; use a storage buffer"},
        {SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE,
         "an acceleration structure, which the engine has no use of"},
        {SPVC_RESOURCE_TYPE_SUBPASS_INPUT, "a subpass input, which compute kernels cannot have"}};
    const auto list = [&](spvc_resources from, spvc_resource_type type) {
        const spvc_reflected_resource* resources = nullptr;
        std::size_t count = 0;
        check(spvc_resources_get_resource_list_for_type(from, type, &resources, &count));
        return std::span(resources, count);
    };
    spvc_set active = nullptr;
    spvc_resources activeResources = nullptr;
    check(spvc_compiler_get_active_interface_variables(compiler_, &active));
    check(spvc_compiler_create_shader_resources_for_active_variables(compiler_, &activeResources, active));
    for (const auto& [type, what] : refused) {
        for (const auto& resource : list(resources_, type)) {
            fail(fmt::format("binding '{}' is {}", nameOf(resource.id), what));
        }
    }
    for (const spvc_resource_type type : types) {
        for (const auto& resource : list(activeResources, type)) used_.insert(resource.id);
        for (const auto& resource : list(resources_, type))
            out.bindings.push_back(readBinding(resource, type));
    }
    std::sort(out.bindings.begin(), out.bindings.end(),
              [](const ReflectedBinding& a, const ReflectedBinding& b) {
                  return std::tie(a.set, a.binding, a.name) < std::tie(b.set, b.binding, b.name);
              });
}

ReflectedBinding SpirvReader::readBinding(const spvc_reflected_resource& resource,
                                          spvc_resource_type kind) const {
    ReflectedBinding out;
    out.name = nameOf(resource.id);
    if (out.name.empty()) out.name = nameOf(resource.base_type_id);
    if (out.name.empty()) fail("a binding has no name; it was compiled without names");
    out.set = spvc_compiler_get_decoration(compiler_, resource.id, SpvDecorationDescriptorSet);
    out.binding = spvc_compiler_get_decoration(compiler_, resource.id, SpvDecorationBinding);
    out.used = used_.contains(resource.id);

    const spvc_type type = spvc_compiler_get_type_handle(compiler_, resource.type_id);
    for (unsigned dimension = 0; dimension < spvc_type_get_num_array_dimensions(type); ++dimension) {
        const std::uint32_t size = spvc_type_get_array_dimension(type, dimension);
        if (!spvc_type_array_dimension_is_literal(type, dimension) || size == 0) {
            fail(fmt::format("binding '{}' is an array of no fixed size; give the size as a number",
                             out.name));
        }
        out.count *= size;
    }

    bool nonReadable = spvc_compiler_has_decoration(compiler_, resource.id, SpvDecorationNonReadable);
    bool nonWritable = spvc_compiler_has_decoration(compiler_, resource.id, SpvDecorationNonWritable);
    if (kind == SPVC_RESOURCE_TYPE_STORAGE_BUFFER || kind == SPVC_RESOURCE_TYPE_UNIFORM_BUFFER) {
        const spvc_type block = spvc_compiler_get_type_handle(compiler_, resource.base_type_id);
        std::size_t bytes = 0;
        check(spvc_compiler_get_declared_struct_size(compiler_, block, &bytes));
        out.bytes = static_cast<std::uint32_t>(bytes);
        out.members = readMembers(block);
    }
    switch (kind) {
        case SPVC_RESOURCE_TYPE_STORAGE_BUFFER: {
            out.kind = BindingKind::StorageBuffer;
            const SpvDecoration* decorations = nullptr;  // those that every member has
            std::size_t count = 0;
            check(spvc_compiler_get_buffer_block_decorations(compiler_, resource.id, &decorations, &count));
            for (const SpvDecoration decoration : std::span(decorations, count)) {
                nonReadable |= decoration == SpvDecorationNonReadable;
                nonWritable |= decoration == SpvDecorationNonWritable;
            }
            out.readable = !nonReadable;
            out.writable = !nonWritable;
            return out;
        }
        case SPVC_RESOURCE_TYPE_UNIFORM_BUFFER:
            out.kind = BindingKind::UniformBuffer;
            return out;
        default:
            break;
    }

    const spvc_type image = spvc_compiler_get_type_handle(compiler_, resource.base_type_id);
    const bool buffer = spvc_type_get_image_dimension(image) == SpvDimBuffer;
    out.texel = toTexelType(spvc_type_get_basetype(
        spvc_compiler_get_type_handle(compiler_, spvc_type_get_image_sampled_type(image))));
    if (kind == SPVC_RESOURCE_TYPE_STORAGE_IMAGE) {
        out.kind = buffer ? BindingKind::StorageTexelBuffer : BindingKind::StorageImage;
        out.format = toFormat(spvc_type_get_image_storage_format(image));
        out.readable = !nonReadable;
        out.writable = !nonWritable;
    } else {
        if (kind == SPVC_RESOURCE_TYPE_SEPARATE_IMAGE && !buffer) {
            fail(fmt::format(
                "binding '{}' is a separate image; write it as one with its sampler, e.g. sampler2D",
                out.name));
        }
        out.kind = buffer ? BindingKind::UniformTexelBuffer : BindingKind::SampledImage;
    }
    return out;
}

void SpirvReader::readPushConstants(KernelReflection& out) {
    const spvc_reflected_resource* blocks = nullptr;
    std::size_t count = 0;
    check(spvc_resources_get_resource_list_for_type(resources_, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, &blocks,
                                                    &count));
    if (count == 0) return;
    const spvc_type type = spvc_compiler_get_type_handle(compiler_, blocks[0].base_type_id);
    std::size_t bytes = 0;
    check(spvc_compiler_get_declared_struct_size(compiler_, type, &bytes));
    out.pushConstants.bytes = static_cast<std::uint32_t>(bytes);
    out.pushConstants.name = nameOf(blocks[0].id);
    if (out.pushConstants.name.empty()) out.pushConstants.name = nameOf(blocks[0].base_type_id);
    out.pushConstants.members = readMembers(type);
}

void SpirvReader::readConstants(KernelReflection& out) {
    for (unsigned axis = 0; axis < 3; ++axis) {
        out.localSize[axis] =
            spvc_compiler_get_execution_mode_argument_by_index(compiler_, SpvExecutionModeLocalSize, axis);
    }
    spvc_specialization_constant sizes[3] = {};
    spvc_compiler_get_work_group_size_specialization_constants(compiler_, &sizes[0], &sizes[1], &sizes[2]);
    const spvc_specialization_constant* constants = nullptr;
    std::size_t count = 0;
    check(spvc_compiler_get_specialization_constants(compiler_, &constants, &count));
    for (const auto& constant : std::span(constants, count)) {
        ReflectedSpecConstant spec;
        spec.name = nameOf(constant.id);
        spec.id = constant.constant_id;
        const spvc_constant value = spvc_compiler_get_constant_handle(compiler_, constant.id);
        const spvc_type type = spvc_compiler_get_type_handle(compiler_, spvc_constant_get_type(value));
        switch (spvc_type_get_basetype(type)) {
            case SPVC_BASETYPE_BOOLEAN:
                spec.defaultValue = spvc_constant_get_scalar_u32(value, 0, 0) != 0;
                break;
            case SPVC_BASETYPE_INT32:
                spec.defaultValue = spvc_constant_get_scalar_i32(value, 0, 0);
                break;
            case SPVC_BASETYPE_UINT32:
                spec.defaultValue = spvc_constant_get_scalar_u32(value, 0, 0);
                break;
            case SPVC_BASETYPE_FP32:
                spec.defaultValue = spvc_constant_get_scalar_fp32(value, 0, 0);
                break;
            default:
                fail(fmt::format("specialization constant '{}' is of type {}; use bool, int, uint or float",
                                 spec.name, typeName(type)));
        }
        for (unsigned axis = 0; axis < 3; ++axis) {
            if (sizes[axis].id == 0 || sizes[axis].constant_id != spec.id) continue;
            out.localSizeIds[axis] = spec.id;
            if (sizes[axis].id == constant.id)
                out.localSize[axis] = spvc_constant_get_scalar_u32(value, 0, 0);
            if (spec.name.empty()) spec.name = std::string("local_size_") + "xyz"[axis];
        }
        addSpecConstant(out.specConstants, std::move(spec));
    }
    std::sort(out.specConstants.begin(), out.specConstants.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
}

/** glslang writes local_size_x_id and a named constant of that id as constants of their own. */
void SpirvReader::addSpecConstant(std::vector<ReflectedSpecConstant>& constants,
                                  ReflectedSpecConstant added) const {
    const auto same =
        std::find_if(constants.begin(), constants.end(), [&](const auto& c) { return c.id == added.id; });
    if (same == constants.end()) {
        constants.push_back(std::move(added));
        return;
    }
    const bool rename = same->name.starts_with("local_size_");
    if (same->defaultValue != added.defaultValue) {
        fail(fmt::format(
            "specialization constant {} has one default as '{}' and another as '{}'; where it sets the "
            "workgroup's size, give local_size_x = DEFAULT next to local_size_x_id",
            added.id, same->name, added.name));
    }
    if (rename) same->name = added.name;
}

void SpirvReader::readCapabilities(KernelReflection& out) {
    const SpvCapability* capabilities = nullptr;
    std::size_t count = 0;
    check(spvc_compiler_get_declared_capabilities(compiler_, &capabilities, &count));
    for (const SpvCapability capability : std::span(capabilities, count)) {
        out.capabilities.push_back(capabilityName(capability));
    }
    std::sort(out.capabilities.begin(), out.capabilities.end());
}

}  // namespace helio
