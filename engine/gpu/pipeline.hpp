#pragma once
/** @file Compute pipelines, cached in the process and on disk, and descriptor sets for them. */
#include "engine/gpu/vk.hpp"

#include <heliograph/device.hpp>
#include <heliograph/kernel.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace helio::gpu {

struct BufferResource;

/** One binding of descriptor set 0. */
struct BindingSlot {
    std::uint32_t binding = 0;
    vk::DescriptorType type = vk::DescriptorType::eStorageBuffer;
    std::uint32_t count = 1;  ///< array elements
};

/** What makes a compute pipeline. */
struct ComputePipelineInfo {
    std::string name;                      ///< for messages; not part of its identity
    std::span<const std::uint32_t> spirv;  ///< entry point "main"
    std::vector<BindingSlot> bindings = {};
    std::uint32_t pushConstantBytes = 0;
    std::vector<std::pair<std::uint32_t, SpecValue>> spec = {};  ///< constant_id and value
    std::uint32_t subgroupSize = 0;                              ///< required size, 0 for the device's choice
    /** Writes the constants into the words and leaves out what they rule out, where the pipeline is not there
     * yet; nothing: the driver does. Not part of its identity. */
    std::vector<std::uint32_t> (*specialize)(
        std::span<const std::uint32_t> spirv,
        std::span<const std::pair<std::uint32_t, std::uint32_t>> constants) = nullptr;
};

struct ComputePipeline {
    std::string name;
    std::vector<BindingSlot> bindings;
    vk::raii::DescriptorSetLayout setLayout = nullptr;
    vk::raii::PipelineLayout layout = nullptr;
    vk::raii::Pipeline pipeline = nullptr;
    double createMilliseconds = 0;
};

/** Pipelines by content. The driver's cache is kept in a file across processes: read when the device opens,
 * and written whole (temporary beside it, then renamed) when it closes; a file that is damaged or another
 * device's is passed over. Thread-safe. */
class PipelineCache {
public:
    /** `folder` empty: nothing is kept on disk. */
    PipelineCache(const vk::raii::Device& device, const vk::PhysicalDeviceProperties& properties,
                  const std::filesystem::path& folder);
    ~PipelineCache();

    /** The pipeline, made where it is not there yet. Throws DeviceError. */
    std::shared_ptr<const ComputePipeline> get(const ComputePipelineInfo& info);
    /** Writes the file now. Failure is logged, never thrown. */
    void save();

    const std::filesystem::path& file() const { return file_; }  ///< empty where nothing is kept
    std::uint64_t loadedBytes() const { return loadedBytes_; }   ///< taken from the file
    std::uint32_t created() const { return created_; }           ///< pipelines made, not found in the process
    vk::PipelineCache handle() const { return *cache_; }

private:
    std::shared_ptr<const ComputePipeline> create(const ComputePipelineInfo& info);

    const vk::raii::Device& device_;
    vk::PhysicalDeviceProperties properties_;
    std::filesystem::path file_;
    std::uint64_t loadedBytes_ = 0;
    std::uint64_t savedHash_ = 0;
    std::uint32_t created_ = 0;
    vk::raii::PipelineCache cache_ = nullptr;
    std::mutex mutex_;
    std::unordered_map<std::string, std::shared_ptr<const ComputePipeline>> byContent_;
};

/** The folder for DeviceOptions::pipelineCache empty; empty where the environment names no home. */
std::filesystem::path defaultPipelineCacheFolder();

/** What one descriptor refers to; exactly one kind is filled, as the binding's type asks. */
struct DescriptorWrite {
    std::uint32_t binding = 0;
    std::uint32_t element = 0;
    vk::Buffer buffer = {};    ///< uniform and storage buffers
    std::uint64_t offset = 0;  ///< a multiple of the device's min...OffsetAlignment
    std::uint64_t range = VK_WHOLE_SIZE;
    vk::BufferView texelView = {};  ///< texel buffers
    vk::ImageView imageView = {};   ///< images
    vk::ImageLayout imageLayout = vk::ImageLayout::eGeneral;
    vk::Sampler sampler = {};
};

/** A descriptor set with a pool of its own size, for set 0 of a pipeline. Move-only. */
class DescriptorSet {
public:
    DescriptorSet() = default;
    DescriptorSet(Device::Impl& gpu, const ComputePipeline& pipeline,
                  std::span<const DescriptorWrite> writes);
    vk::DescriptorSet handle() const { return set_; }

private:
    vk::raii::DescriptorPool pool_ = nullptr;
    vk::DescriptorSet set_;
};

}  // namespace helio::gpu
