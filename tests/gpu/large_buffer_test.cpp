// Data beyond maxStorageBufferRange: written through windows, read through one texel view.
#include "tests/gpu/raw_dispatch.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace helio {
namespace {

constexpr std::uint64_t kBytes = 300ull << 20;

/** What word `index` of the buffer holds. */
std::uint32_t expectedWord(std::uint32_t index) {
    return index * 2654435761u ^ (index >> 7);
}

constexpr const char* kWrite = R"(#version 460
layout(local_size_x = 256) in;
layout(binding = 0) writeonly buffer Window { uvec4 texels[]; };
layout(push_constant) uniform Push { uint firstTexel; uint texelCount; };
uvec4 word(uvec4 i) { return (i * 2654435761u) ^ (i >> 7); }
void main() {
    for (uint t = gl_GlobalInvocationID.x; t < texelCount; t += gl_NumWorkGroups.x * 256)
        texels[t] = word((firstTexel + t) * 4 + uvec4(0, 1, 2, 3));
})";

// Each invocation counts the wrong words of its share, read through the texel view of everything.
constexpr const char* kCheck = R"(#version 460
layout(local_size_x = 256) in;
layout(binding = 0) uniform usamplerBuffer uAll;
layout(binding = 1) buffer Result { uint wrong; uint last; };
layout(push_constant) uniform Push { uint texelCount; };
uvec4 word(uvec4 i) { return (i * 2654435761u) ^ (i >> 7); }
void main() {
    uint bad = 0;
    for (uint t = gl_GlobalInvocationID.x; t < texelCount; t += gl_NumWorkGroups.x * 256)
        if (texelFetch(uAll, int(t)) != word(t * 4 + uvec4(0, 1, 2, 3))) { ++bad; }
    if (bad > 0) { atomicAdd(wrong, bad); }
    if (gl_GlobalInvocationID.x == 0) last = texelFetch(uAll, int(texelCount) - 1).w;
})";

TEST(LargeBuffer, IsWrittenInWindowsAndReadWholeOnTheDevice) {
    Device& device = test::device();
    Device::Impl& impl = device.impl();
    const std::uint64_t windowLimit = std::min<std::uint64_t>(impl.info.maxStorageBufferRange, 128ull << 20);
    ASSERT_GT(kBytes, windowLimit) << "the buffer must not fit one storage binding";
    DeviceBuffer buffer(device, "large", kBytes);
    const auto& resource = buffer.impl()->resource;

    const std::uint64_t align = impl.limits().minStorageBufferOffsetAlignment;
    for (std::uint64_t offset = 0; offset < kBytes;) {
        const std::uint64_t bytes = std::min(kBytes - offset, windowLimit / align * align);
        test::submitDispatch(
            device,
            {.name = "write window",
             .glsl = kWrite,
             .bindings = {{{.binding = 0}, {.buffer = *resource.buffer, .offset = offset, .range = bytes}}},
             .push = {std::uint32_t(offset / 16), std::uint32_t(bytes / 16)},
             .groups = 1024});
        offset += bytes;
    }

    const vk::raii::BufferView all = gpu::createTexelView(impl, resource, vk::Format::eR32G32B32A32Uint);
    DeviceBuffer result = makeBuffer(device, "result", std::vector<std::uint32_t>{0, 0});
    const auto check = [&] {
        const std::vector<std::uint32_t> zero{0, 0};
        result.upload(zero.data(), 8);
        test::submitDispatch(device,
                             {.name = "check",
                              .glsl = kCheck,
                              .bindings = {{{.binding = 0, .type = vk::DescriptorType::eUniformTexelBuffer},
                                            {.texelView = *all}},
                                           {{.binding = 1}, {.buffer = *result.impl()->resource.buffer}}},
                              .push = {std::uint32_t(kBytes / 16)},
                              .groups = 1024});
        std::vector<std::uint32_t> out(2);
        result.download(out.data(), 8);
        return out;
    };
    EXPECT_EQ(check(), (std::vector<std::uint32_t>{0, expectedWord(kBytes / 4 - 1)}));

    // The host sees the same on both sides of each boundary.
    for (const std::uint64_t boundary : {windowLimit, 2 * windowLimit, kBytes - 64}) {
        std::vector<std::uint32_t> out(32);
        buffer.download(out.data(), 64, boundary - 64);
        buffer.download(out.data() + 16, 64, boundary);
        for (std::uint32_t i = 0; i < 32; ++i) {
            EXPECT_EQ(out[i], expectedWord(std::uint32_t(boundary / 4) - 16 + i))
                << "byte " << boundary - 64 + i * 4;
        }
    }

    // One word wrong beyond the range is seen: the check does read there.
    const std::uint32_t wrong = ~expectedWord(std::uint32_t((windowLimit + 4096) / 4));
    buffer.upload(&wrong, 4, windowLimit + 4096);
    EXPECT_EQ(check()[0], 1u);
}

TEST(LargeBuffer, TexelViewsReachAsFarAsOneAllocation) {
    // A buffer as large as the device allows up to 2 GiB, of which a few texels are touched: on a CPU device
    // the rest costs no memory.
    Device& device = test::device();
    Device::Impl& impl = device.impl();
    const std::uint64_t bytes =
        std::min({std::uint64_t(2) << 30, impl.info.maxBufferSize, impl.info.maxTexelBufferElements * 16,
                  impl.facts.properties11.maxMemoryAllocationSize - (1 << 20)}) /
        16 * 16;
    ASSERT_GT(bytes, impl.info.maxStorageBufferRange) << "texel views would gain nothing";
    DeviceBuffer buffer(device, "vast", bytes);
    const vk::raii::BufferView view =
        gpu::createTexelView(impl, buffer.impl()->resource, vk::Format::eR32G32B32A32Uint);
    const std::uint32_t last = std::uint32_t(bytes / 16) - 1;
    const std::vector<std::uint32_t> places = {
        0, (128u << 20) / 16 - 1, (128u << 20) / 16, (1u << 30) / 16, last - 1, last};
    DeviceBuffer at = makeBuffer(device, "places", places);
    DeviceBuffer seen(device, "seen", places.size() * 4);
    test::submitDispatch(
        device,
        {.name = "store",
         .glsl = R"(#version 460
layout(local_size_x = 1) in;
layout(binding = 0, rgba32ui) writeonly uniform uimageBuffer uVast;
layout(binding = 1) readonly buffer Places { uint at[]; };
void main() { uint p = at[gl_WorkGroupID.x]; imageStore(uVast, int(p), uvec4(p ^ 0xabcdefu)); })",
         .bindings = {{{.binding = 0, .type = vk::DescriptorType::eStorageTexelBuffer}, {.texelView = *view}},
                      {{.binding = 1}, {.buffer = *at.impl()->resource.buffer}}},
         .groups = std::uint32_t(places.size())});
    test::submitDispatch(
        device,
        {.name = "fetch",
         .glsl = R"(#version 460
layout(local_size_x = 1) in;
layout(binding = 0) uniform usamplerBuffer uVast;
layout(binding = 1) readonly buffer Places { uint at[]; };
layout(binding = 2) writeonly buffer Seen { uint seen[]; };
void main() { seen[gl_WorkGroupID.x] = texelFetch(uVast, int(at[gl_WorkGroupID.x])).z; })",
         .bindings = {{{.binding = 0, .type = vk::DescriptorType::eUniformTexelBuffer}, {.texelView = *view}},
                      {{.binding = 1}, {.buffer = *at.impl()->resource.buffer}},
                      {{.binding = 2}, {.buffer = *seen.impl()->resource.buffer}}},
         .groups = std::uint32_t(places.size())});
    std::vector<std::uint32_t> out(places.size());
    seen.download(out.data(), out.size() * 4);
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_EQ(out[i], places[i] ^ 0xabcdefu) << "texel " << places[i];
        std::uint32_t host = 0;
        buffer.download(&host, 4, places[i] * 16ull);
        EXPECT_EQ(host, places[i] ^ 0xabcdefu) << "byte " << places[i] * 16ull;
    }
}

TEST(LargeBuffer, ViewBeyondTheDevicesTexelsIsRefusedByName) {
    Device& device = test::device();
    Device::Impl& impl = device.impl();
    if (impl.info.maxTexelBufferElements >= kBytes) return;  // Devices without such a limit within reach.
    DeviceBuffer buffer(device, "bytes", kBytes);
    try {
        gpu::createTexelView(impl, buffer.impl()->resource, vk::Format::eR8Unorm);
        FAIL() << "a view of " << kBytes << " texels was made";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("'bytes'"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace helio
