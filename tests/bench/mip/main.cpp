/** @file
 * Whole mip chains of one texture by passes/mip, against a chain of vkCmdBlitImage and a plain copy of the
 * base level, on the same device in interleaved runs; medians of the device's timestamps. `bench_mip
 * [--rounds N] [--size N]` prints a Markdown table. Bytes are those that must be read and written: of a chain
 * the base and every level, of a copy the base twice. The engine's levels are floats whatever the base is.
 */
#include "engine/gpu/timestamps.hpp"
#include "passes/mip/mip_chain.hpp"
#include "tests/bench/raster/images.hpp"
#include "tests/bench/timing.hpp"

#include <heliograph/device.hpp>
#include <heliograph/error.hpp>
#include <heliograph/graph.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace helio::bench {
namespace {

// Flags of a packed texture, as shaders/scene/textures.glsl reads them.
constexpr std::uint32_t kFloatTexture = 1u << 5, kMipmapped = 1u << 6;

/** The driver's way: each level by a linear blit from the one above. */
class BlitChain {
public:
    BlitChain(Device& device, vk::Format format, std::uint32_t size, std::uint32_t bytesPerTexel)
        : gpu_(device.impl()), size_(size), levels_(mipLevelCount(size, size)), stamps_(gpu_, 2) {
        const vk::FormatFeatureFlags has = gpu_.physical.getFormatProperties(format).optimalTilingFeatures;
        const vk::FormatFeatureFlags needed = vk::FormatFeatureFlagBits::eBlitSrc |
                                              vk::FormatFeatureFlagBits::eBlitDst |
                                              vk::FormatFeatureFlagBits::eSampledImageFilterLinear;
        if ((has & needed) != needed) throw DeviceError("the device cannot blit this format linearly");
        const auto usage = vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst |
                           vk::ImageUsageFlagBits::eSampled;
        image_ = makeImage(gpu_, "bench.blits", format, {size, size}, levels_, usage);
        const std::uint64_t bytes = std::uint64_t(size) * size * bytesPerTexel;
        from_ =
            gpu::createBuffer(gpu_, "bench.from", bytes, gpu::MemoryUse::Device,
                              vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst);
        to_ = gpu::createBuffer(gpu_, "bench.to", bytes, gpu::MemoryUse::Device,
                                vk::BufferUsageFlagBits::eTransferDst);
        bytes_ = bytes;
        gpu::Recording commands = gpu_.queue.begin("bench.fill");
        commands->fillBuffer(*from_.buffer, 0, bytes, 0x3f3f3f3fu);
        barrier(*commands, {*image_.image});
        commands->copyBufferToImage(
            *from_.buffer, *image_.image, vk::ImageLayout::eGeneral,
            vk::BufferImageCopy{
                .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
                .imageExtent = {size, size, 1}});
        finish(gpu_, std::move(commands));
    }

    double blit() {
        return timed([&](const vk::raii::CommandBuffer& commands) {
            for (std::uint32_t level = 1; level < levels_; ++level) {
                const auto side = [&](std::uint32_t k) { return std::int32_t(std::max(size_ >> k, 1u)); };
                vk::ImageBlit region;
                region.srcSubresource = vk::ImageSubresourceLayers{
                    .aspectMask = vk::ImageAspectFlagBits::eColor, .mipLevel = level - 1, .layerCount = 1};
                region.dstSubresource = region.srcSubresource;
                region.dstSubresource.mipLevel = level;
                region.srcOffsets[1] = vk::Offset3D{side(level - 1), side(level - 1), 1};
                region.dstOffsets[1] = vk::Offset3D{side(level), side(level), 1};
                commands.blitImage(*image_.image, vk::ImageLayout::eGeneral, *image_.image,
                                   vk::ImageLayout::eGeneral, region, vk::Filter::eLinear);
                barrier(commands);
            }
        });
    }

    double copy() {
        return timed([&](const vk::raii::CommandBuffer& commands) {
            commands.copyBuffer(*from_.buffer, *to_.buffer, vk::BufferCopy{.size = bytes_});
            barrier(commands);
        });
    }

private:
    template <typename Record>
    double timed(const Record& record) {
        gpu::Recording commands = gpu_.queue.begin("bench.mip");
        stamps_.reset(*commands);
        stamps_.write(*commands, 0);
        record(*commands);
        stamps_.write(*commands, 1);
        finish(gpu_, std::move(commands));
        return stamps_.milliseconds(2)[1] * 1e-3;
    }

    Device::Impl& gpu_;
    std::uint32_t size_, levels_;
    std::uint64_t bytes_ = 0;
    gpu::TimestampPool stamps_;
    BenchImage image_;
    gpu::BufferResource from_, to_;
};

/** The engine's plan over the same texels. */
class ComputeChain {
public:
    ComputeChain(Device& device, std::uint32_t size, bool floats)
        : headers_(makeBuffer(
              device, "bench.textures",
              std::vector<glm::uvec4>{{0, size, size, kMipmapped | (floats ? kFloatTexture : 0)}})),
          texels8_(
              makeBuffer(device, "bench.texels8",
                         std::vector<std::uint32_t>(floats ? 4 : std::size_t(size) * size, 0x3f3f3f3fu))),
          texelsFloat_(
              makeBuffer(device, "bench.texelsFloat",
                         std::vector<glm::vec4>(floats ? std::size_t(size) * size : 1, glm::vec4(0.75f)))),
          chains_(device,
                  std::vector<glm::uvec4>{{0, size, size, kMipmapped | (floats ? kFloatTexture : 0)}}) {
        Graph graph(device);
        chains_.declare(graph,
                        {{"uTextures", graph.import(headers_)},
                         {"uTexels8", graph.import(texels8_), Format::R32UI},
                         {"uTexelsFloat", graph.import(texelsFloat_)}},
                        {{"HAS_FLOAT_TEXTURES", floats}});
        plan_ = graph.compile({.executionsInFlight = 1});
    }
    double run() {
        const Execution done = plan_.execute();
        double sum = 0;
        for (const PassTiming& pass : plan_.timings(done)) sum += pass.milliseconds;
        return sum * 1e-3;
    }

private:
    DeviceBuffer headers_, texels8_, texelsFloat_;
    MipChains chains_;
    Plan plan_;
};

void measure(Device& device, const char* name, vk::Format format, std::uint32_t size,
             std::uint32_t bytesPerTexel, int rounds) {
    BlitChain driver(device, format, size, bytesPerTexel);
    ComputeChain engine(device, size, bytesPerTexel == 16);
    driver.copy();
    driver.blit();
    engine.run();
    std::vector<double> copies, blits, chains;
    for (int round = 0; round < rounds; ++round) {
        copies.push_back(driver.copy());
        blits.push_back(driver.blit());
        chains.push_back(engine.run());
    }
    const double base = double(size) * size, levels = base / 3;
    const auto row = [&](const char* what, const std::vector<double>& times, double bytes) {
        const double t = median(times);
        fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.2f} | {:.2f} |\n", name, what, t * 1e3,
                   std::ranges::min(times) * 1e3, bytes * 1e-9 / t, median(blits) / t);
    };
    row("copy of the base", copies, 2 * base * bytesPerTexel);
    row("chain of vkCmdBlitImage", blits, (base + 2 * levels) * bytesPerTexel);
    row("passes/mip", chains, base * bytesPerTexel + 2 * levels * 16);
    std::fflush(stdout);
}

int run(int argc, char** argv) {
    int rounds = 9;
    std::uint32_t size = 4096;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string option = argv[i];
        if (option == "--rounds") rounds = std::max(1, std::atoi(argv[i + 1]));
        if (option == "--size") size = std::uint32_t(std::clamp(std::atoi(argv[i + 1]), 2, 8192));
    }
    Device device;
    fmt::print("{}, {}x{}, {} rounds\n\n", device.info().name, size, size, rounds);
    fmt::print(
        "| base | what | median, ms | fastest, ms | GB/s | blit chain over this "
        "|\n|---|---|---|---|---|---|\n");
    measure(device, "RGBA8, sRGB", vk::Format::eR8G8B8A8Srgb, size, 4, rounds);
    measure(device, "RGBA32F", vk::Format::eR32G32B32A32Sfloat, size, 16, rounds);
    return 0;
}

}  // namespace
}  // namespace helio::bench

int main(int argc, char** argv) {
    try {
        return helio::bench::run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_mip: {}\n", error.what());
        return 1;
    }
}
