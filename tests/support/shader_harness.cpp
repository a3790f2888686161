#include "tests/support/shader_harness.hpp"

#include "engine/gpu/device_impl.hpp"
#include "engine/shader/reflection.hpp"
#include "tests/support/device.hpp"

#include <heliograph/device.hpp>
#include <heliograph/kernel.hpp>
#include <heliograph/verify.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <ostream>

namespace helio::test {
namespace {

constexpr std::uint32_t localSize = 64;
/** Results of one dispatch: 64 MiB of mat4, half of the storage range that every device has, and workgroups
 * in one dimension. */
constexpr std::size_t chunkResults = std::size_t(1) << 20;

/** GLSL that puts a value together out of words, or takes it apart. */
std::string loadExpression(const DeviceType& type, const std::string& array) {
    const std::string scalar = type.scalar;
    std::string list;
    for (std::uint32_t k = 0; k < type.words; ++k) {
        const std::string word = fmt::format("{}.words[i * {}u + {}u]", array, type.words, k);
        list += (k > 0 ? ", " : "") + (scalar == "float" ? fmt::format("uintBitsToFloat({})", word)
                                       : scalar == "int" ? fmt::format("int({})", word)
                                                         : word);
    }
    return fmt::format("{}({})", type.glsl, list);
}

std::string storeStatements(const DeviceType& type) {
    const std::string scalar = type.scalar;
    const std::string glsl = type.glsl;
    const std::uint32_t rows = glsl.starts_with("mat") ? static_cast<std::uint32_t>(glsl[3] - '0') : 0;
    std::string text;
    for (std::uint32_t k = 0; k < type.words; ++k) {
        const std::string part = type.words == 1 ? "result"
                                 : rows > 0      ? fmt::format("result[{}][{}]", k / rows, k % rows)
                                                 : fmt::format("result[{}]", k);
        text += fmt::format("    uResult.words[i * {}u + {}u] = {}({});\n", type.words, k,
                            scalar == "float" ? "floatBitsToUint" : "uint", part);
    }
    return text;
}

std::string kernelText(const Preamble& preamble, const std::string& expression, const DeviceType& resultType,
                       const std::vector<DeviceInput>& inputs) {
    std::string text = "#version 460\n#extension GL_GOOGLE_include_directive : require\n";
    for (const std::string& line : preamble.lines) {
        if (!line.empty()) text += line.front() == '#' ? line + "\n" : fmt::format("#include \"{}\"\n", line);
    }
    text += fmt::format("layout(local_size_x = {}) in;\n", localSize);
    text += "layout(set = 0, binding = 0) writeonly buffer Result { uint words[]; } uResult;\n";
    text += "layout(push_constant) uniform Push { uint count; } uPush;\n";
    std::string parameters;
    std::string arguments;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
        const char name = static_cast<char>('a' + k);
        const std::string array = fmt::format("uInput{}", k);
        text += fmt::format("layout(set = 0, binding = {}) readonly buffer Input{} {{ uint words[]; }} {};\n",
                            k + 1, k, array);
        parameters += fmt::format("{}{} {}", k > 0 ? ", " : "", inputs[k].type.glsl, name);
        arguments += (k > 0 ? ", " : "") + loadExpression(inputs[k].type, array);
    }
    const bool body = expression.find("return") != std::string::npos;
    text += fmt::format("{} underTest({}) {{\n#line 1 \"expression\"\n{}\n}}\n", resultType.glsl, parameters,
                        body ? expression : fmt::format("return {}({});", resultType.glsl, expression));
    text += "void main() {\n    uint i = gl_GlobalInvocationID.x;\n    if (i >= uPush.count) return;\n";
    text += fmt::format("    {} result = underTest({});\n", resultType.glsl, arguments);
    return text + storeStatements(resultType) + "}\n";
}

}  // namespace

void runOnDeviceWords(const Preamble& preamble, const std::string& expression, const DeviceType& resultType,
                      const std::vector<DeviceInput>& inputs, void* result) {
    const std::size_t count = inputs.front().count;
    for (const DeviceInput& input : inputs) {
        if (input.count != count) throw std::invalid_argument("inputs of different lengths");
    }
    const Kernel kernel = compileKernel("expression", kernelText(preamble, expression, resultType, inputs));
    if (count == 0) return;
    Device& device = test::device();
    Device::Impl& gpu = device.impl();
    gpu::ComputePipelineInfo info;
    info.name = kernel.name;
    info.spirv = kernel.spirv;
    info.pushConstantBytes = reflect(kernel).pushConstants.bytes;
    const std::size_t chunk = std::min(count, chunkResults);
    std::vector<DeviceBuffer> buffers;
    std::vector<gpu::DescriptorWrite> writes;
    const auto bind = [&](const std::string& name, std::uint32_t words) {
        const auto binding = static_cast<std::uint32_t>(buffers.size());
        buffers.emplace_back(device, name, chunk * words * sizeof(std::uint32_t));
        info.bindings.push_back({binding, vk::DescriptorType::eStorageBuffer, 1});
        gpu::DescriptorWrite write;
        write.binding = binding;
        write.buffer = *buffers.back().impl()->resource.buffer;
        writes.push_back(write);
    };
    bind("result", resultType.words);
    for (const DeviceInput& input : inputs) bind("input", input.type.words);
    const auto pipeline = gpu.pipelines.get(info);
    const gpu::DescriptorSet set(gpu, *pipeline, writes);

    for (std::size_t first = 0; first < count; first += chunk) {
        const std::size_t size = std::min(chunk, count - first);
        for (std::size_t k = 0; k < inputs.size(); ++k) {
            const std::size_t bytes = inputs[k].type.words * sizeof(std::uint32_t);
            buffers[k + 1].upload(static_cast<const std::byte*>(inputs[k].data) + first * bytes,
                                  size * bytes);
        }
        gpu::Recording recording = gpu.queue.begin("harness");
        recording->bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline->pipeline);
        recording->bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline->layout, 0, set.handle(),
                                      {});
        recording->pushConstants<std::uint32_t>(*pipeline->layout, vk::ShaderStageFlagBits::eCompute, 0,
                                                static_cast<std::uint32_t>(size));
        recording->dispatch(static_cast<std::uint32_t>((size + localSize - 1) / localSize), 1, 1);
        gpu.queue.wait(gpu.queue.submit(std::move(recording)));
        const std::size_t bytes = resultType.words * sizeof(std::uint32_t);
        buffers[0].download(static_cast<std::byte*>(result) + first * bytes, size * bytes);
    }
}

bool UlpComparison::add(const float* got, const double* wanted) {
    double largest = 0;
    if (scale_ == UlpScale::Largest) {
        for (std::size_t k = 0; k < components_; ++k) largest = std::max(largest, std::abs(wanted[k]));
    }
    ++report_.count;
    bool worst = false;
    for (std::size_t k = 0; k < components_; ++k) {
        double error;
        if (scale_ == UlpScale::Largest && std::isfinite(got[k]) && std::isfinite(wanted[k])) {
            // The last place of the largest component: 24 bits below its binade, the least subnormal at
            // least.
            const double ulp = std::ldexp(1.0, std::max(largest > 0 ? std::ilogb(largest) : -149, -126) - 23);
            error = std::abs(double(got[k]) - wanted[k]) / ulp;
        } else {
            error = verify::ulpError(got[k], wanted[k]);
        }
        if (std::isfinite(error)) {
            sum_ += error;
            ++finite_;
        }
        if (report_.count > 1 || k > 0) {
            if (!(error > report_.worst)) continue;
        }
        report_.worst = error;
        report_.component = k;
        report_.got = double(got[k]);
        report_.wanted = wanted[k];
        worst = true;
    }
    return worst;
}

void UlpComparison::finish() {
    report_.mean = finite_ > 0 ? sum_ / double(finite_) : 0;
}

std::ostream& operator<<(std::ostream& out, const UlpReport& report) {
    return out << fmt::format(
               "worst {:.3g} ULP, mean {:.3g}, of {} results; at [{}] component {}: got {:.9g}, wanted "
               "{:.17g}, for {}",
               report.worst, report.mean, report.count, report.index, report.component, report.got,
               report.wanted, report.input);
}

std::string describeWords(const DeviceType& type, const void* value) {
    std::string text = type.words > 1 ? "(" : "";
    for (std::uint32_t k = 0; k < type.words; ++k) {
        std::uint32_t word;
        std::memcpy(&word, static_cast<const std::byte*>(value) + k * sizeof(word), sizeof(word));
        if (k > 0) text += ", ";
        if (std::string_view(type.scalar) == "float") {
            text += fmt::format("{:.9g} [0x{:08x}]", std::bit_cast<float>(word), word);
        } else if (std::string_view(type.scalar) == "int") {
            text += fmt::format("{}", std::bit_cast<std::int32_t>(word));
        } else {
            text += fmt::format("{}", word);
        }
    }
    return type.words > 1 ? text + ")" : text;
}

std::vector<float> floatsBetween(float low, float high, std::size_t count) {
    assert(low <= high && count >= 2);
    // The order of floats is that of these integers: magnitudes, negative ones below zero.
    const auto rank = [](float x) -> std::int64_t {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
        const std::int64_t magnitude = bits & 0x7fffffffu;
        return bits >> 31 != 0 ? -magnitude : magnitude;
    };
    const std::int64_t from = rank(low);
    const std::int64_t span = rank(high) - from;
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double part = double(i) / double(count - 1);
        const std::int64_t at =
            i + 1 == count ? from + span : from + std::int64_t(std::floor(part * double(span)));
        const std::uint32_t magnitude = static_cast<std::uint32_t>(at < 0 ? -at : at);
        values[i] = std::bit_cast<float>(at < 0 ? magnitude | 0x80000000u : magnitude);
    }
    return values;
}

std::vector<float> floatsSpaced(float low, float high, std::size_t count) {
    assert(low <= high && count >= 2);
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double part = double(i) / double(count - 1);
        values[i] = static_cast<float>(double(low) * (1 - part) + double(high) * part);
    }
    return values;
}

std::vector<float> specialFloats() {
    using Limits = std::numeric_limits<float>;
    std::vector<float> values;
    for (const float x :
         {0.0f, Limits::denorm_min(), 1e-40f, Limits::min(), 1e-30f, 0.5f, std::nextafter(1.0f, 0.0f), 1.0f,
          std::nextafter(1.0f, 2.0f), 2.0f, 1e30f, Limits::max(), Limits::infinity()}) {
        values.push_back(x);
        values.push_back(-x);
    }
    values.push_back(Limits::quiet_NaN());
    return values;
}

}  // namespace helio::test
