#pragma once
/** @file
 * The comparator: Vulkan's graphics pipeline by dynamic rendering, to the same visibility output as the
 * compute rasterizer: an id per pixel (R32UI) and a reversed depth (D32), nearer wins, of equal depths the
 * first drawn.
 */
#include "passes/raster/view.hpp"
#include "tests/bench/raster/images.hpp"

#include <heliograph/device.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace helio::bench {

class GraphicsRasterizer {
public:
    /** `triangles` as RasterPipeline reads them: three texels each, xyz of a corner and a word. Throws
     * DeviceError where the device has no dynamic rendering or its queue no graphics. */
    GraphicsRasterizer(Device& device, const RasterView& view, std::span<const glm::vec4> triangles);

    /** Clears, draws all triangles and waits. Seconds on the device. */
    double draw();
    /** Of the last draw, rows from the top: places in `triangles`, ~0 where nothing is seen. */
    std::vector<std::uint32_t> ids();

private:
    void makePipeline();

    Device::Impl& gpu_;
    RasterView view_;
    std::uint32_t vertices_;
    gpu::TimestampPool stamps_;
    gpu::BufferResource positions_;
    BenchImage ids_, depth_;
    vk::raii::PipelineLayout layout_ = nullptr;
    vk::raii::Pipeline pipeline_ = nullptr;
};

}  // namespace helio::bench
