#include "tests/bench/raster/graphics_rasterizer.hpp"

#include <heliograph/error.hpp>

#include <visibility_frag.h>
#include <visibility_vert.h>

#include <cstring>
#include <utility>

namespace helio::bench {
namespace {

struct Push {
    glm::mat4 toClip;
    glm::vec4 eye;
};

/** Homogeneous pixels to clip space, rows from the top, reversed depth with an infinite far plane. */
glm::mat4 clipMatrix(const RasterView& view) {
    const glm::dvec3 x = view.rowX * (2.0 / view.width), y = view.rowY * (2.0 / view.height), w = view.rowW;
    glm::dmat4 m(0.0);
    if (view.orthographic) {
        for (int k = 0; k < 3; ++k) m[k] = {x[k], y[k], view.depthSlope * w[k], 0.0};
        m[3] = {0.0, 0.0, view.depthOffset, 1.0};
    } else {
        for (int k = 0; k < 3; ++k) m[k] = {x[k] - w[k], y[k] - w[k], 0.0, w[k]};
        m[3] = {0.0, 0.0, view.depthOffset, 0.0};
    }
    return glm::mat4(m);
}

}  // namespace

GraphicsRasterizer::GraphicsRasterizer(Device& device, const RasterView& view,
                                       std::span<const glm::vec4> triangles)
    : gpu_(device.impl()), view_(view), vertices_(std::uint32_t(triangles.size())), stamps_(gpu_, 2) {
    for (const char* needed : {"dynamicRendering", "graphicsQueue"})
        if (!device.info().has(needed))
            throw DeviceError(device.info().name + " lacks " + needed + ": nothing to compare with");
    positions_ = gpu::createBuffer(gpu_, "bench.positions", triangles.size_bytes(), gpu::MemoryUse::Upload,
                                   vk::BufferUsageFlagBits::eVertexBuffer);
    std::memcpy(positions_.mapped, triangles.data(), triangles.size_bytes());
    ids_ = makeImage(gpu_, "bench.ids", vk::Format::eR32Uint, {view.width, view.height}, 1,
                     vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferSrc);
    depth_ = makeImage(gpu_, "bench.depth", vk::Format::eD32Sfloat, {view.width, view.height}, 1,
                       vk::ImageUsageFlagBits::eDepthStencilAttachment);
    makePipeline();
}

void GraphicsRasterizer::makePipeline() {
    const vk::PushConstantRange range{.stageFlags = vk::ShaderStageFlagBits::eVertex, .size = sizeof(Push)};
    layout_ = vk::raii::PipelineLayout(
        gpu_.device,
        vk::PipelineLayoutCreateInfo{.pushConstantRangeCount = 1, .pPushConstantRanges = &range});
    const auto module = [&](std::span<const std::uint32_t> spirv) {
        return vk::raii::ShaderModule(
            gpu_.device, vk::ShaderModuleCreateInfo{.codeSize = spirv.size_bytes(), .pCode = spirv.data()});
    };
    const vk::raii::ShaderModule vertex = module(visibility_vert), fragment = module(visibility_frag);
    const vk::PipelineShaderStageCreateInfo stages[2] = {
        {.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex, .pName = "main"},
        {.stage = vk::ShaderStageFlagBits::eFragment, .module = *fragment, .pName = "main"}};
    const vk::VertexInputBindingDescription binding{.stride = sizeof(glm::vec4)};
    const vk::VertexInputAttributeDescription attribute{.format = vk::Format::eR32G32B32Sfloat};
    const vk::PipelineVertexInputStateCreateInfo input{.vertexBindingDescriptionCount = 1,
                                                       .pVertexBindingDescriptions = &binding,
                                                       .vertexAttributeDescriptionCount = 1,
                                                       .pVertexAttributeDescriptions = &attribute};
    const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
    const vk::Viewport viewport{0, 0, float(view_.width), float(view_.height), 0, 1};
    const vk::Rect2D scissor{{0, 0}, {view_.width, view_.height}};
    const vk::PipelineViewportStateCreateInfo viewports{
        .viewportCount = 1, .pViewports = &viewport, .scissorCount = 1, .pScissors = &scissor};
    const vk::PipelineRasterizationStateCreateInfo rasterization{.lineWidth = 1};
    const vk::PipelineMultisampleStateCreateInfo samples{.rasterizationSamples = vk::SampleCountFlagBits::e1};
    const vk::PipelineDepthStencilStateCreateInfo depth{
        .depthTestEnable = VK_TRUE, .depthWriteEnable = VK_TRUE, .depthCompareOp = vk::CompareOp::eGreater};
    const vk::PipelineColorBlendAttachmentState blend{.colorWriteMask = vk::ColorComponentFlagBits::eR};
    const vk::PipelineColorBlendStateCreateInfo blends{.attachmentCount = 1, .pAttachments = &blend};
    const vk::Format format = vk::Format::eR32Uint;
    const vk::PipelineRenderingCreateInfo rendering{.colorAttachmentCount = 1,
                                                    .pColorAttachmentFormats = &format,
                                                    .depthAttachmentFormat = vk::Format::eD32Sfloat};
    pipeline_ = vk::raii::Pipeline(gpu_.device, nullptr,
                                   vk::GraphicsPipelineCreateInfo{.pNext = &rendering,
                                                                  .stageCount = 2,
                                                                  .pStages = stages,
                                                                  .pVertexInputState = &input,
                                                                  .pInputAssemblyState = &assembly,
                                                                  .pViewportState = &viewports,
                                                                  .pRasterizationState = &rasterization,
                                                                  .pMultisampleState = &samples,
                                                                  .pDepthStencilState = &depth,
                                                                  .pColorBlendState = &blends,
                                                                  .layout = *layout_});
}

double GraphicsRasterizer::draw() {
    gpu::Recording commands = gpu_.queue.begin("bench.graphics");
    stamps_.reset(*commands);
    stamps_.write(*commands, 0);
    // Depth is a layout of its own aspect: the barrier of images names colour alone.
    const vk::ImageMemoryBarrier2 depthLayout{
        .srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
        .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
        .dstAccessMask = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite,
        .newLayout = vk::ImageLayout::eGeneral,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = *depth_.image,
        .subresourceRange = {
            .aspectMask = vk::ImageAspectFlagBits::eDepth, .levelCount = 1, .layerCount = 1}};
    barrier(*commands, {*ids_.image});
    commands->pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &depthLayout});
    vk::RenderingAttachmentInfo color{.imageView = *ids_.view,
                                      .imageLayout = vk::ImageLayout::eGeneral,
                                      .loadOp = vk::AttachmentLoadOp::eClear,
                                      .storeOp = vk::AttachmentStoreOp::eStore};
    color.clearValue.color.setUint32({~0u, 0u, 0u, 0u});
    vk::RenderingAttachmentInfo depth = color;
    depth.imageView = *depth_.view;
    depth.clearValue.depthStencil = vk::ClearDepthStencilValue{.depth = 0.0f};
    commands->beginRendering({.renderArea = {{0, 0}, {view_.width, view_.height}},
                              .layerCount = 1,
                              .colorAttachmentCount = 1,
                              .pColorAttachments = &color,
                              .pDepthAttachment = &depth});
    commands->bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline_);
    commands->bindVertexBuffers(0, {*positions_.buffer}, {vk::DeviceSize(0)});
    const Push push{clipMatrix(view_), glm::vec4(view_.eye, 0.0)};
    commands->pushConstants<Push>(*layout_, vk::ShaderStageFlagBits::eVertex, 0, push);
    commands->draw(vertices_, 1, 0, 0);
    commands->endRendering();
    stamps_.write(*commands, 1);
    finish(gpu_, std::move(commands));
    return stamps_.milliseconds(2)[1] * 1e-3;
}

std::vector<std::uint32_t> GraphicsRasterizer::ids() {
    const std::uint64_t bytes = std::uint64_t(view_.width) * view_.height * 4;
    const gpu::BufferResource target = gpu::createBuffer(
        gpu_, "bench.readback", bytes, gpu::MemoryUse::Readback, vk::BufferUsageFlagBits::eTransferDst);
    gpu::Recording commands = gpu_.queue.begin("bench.readback");
    barrier(*commands);
    commands->copyImageToBuffer(
        *ids_.image, vk::ImageLayout::eGeneral, *target.buffer,
        vk::BufferImageCopy{
            .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
            .imageExtent = {view_.width, view_.height, 1}});
    finish(gpu_, std::move(commands));
    std::vector<std::uint32_t> result(bytes / 4);
    std::memcpy(result.data(), target.mapped, bytes);
    return result;
}

}  // namespace helio::bench
