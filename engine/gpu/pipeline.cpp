#include "engine/gpu/pipeline.hpp"

#include "engine/core/log.hpp"
#include "engine/gpu/cache_file.hpp"
#include "engine/gpu/device_impl.hpp"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <map>

namespace helio::gpu {

namespace {

/** Pipelines kept before those not in use are dropped. */
constexpr std::size_t kMostPipelines = 256;

std::uint32_t bits(const SpecValue& value) {
    return std::visit(
        [](auto v) -> std::uint32_t {
            if constexpr (std::is_same_v<decltype(v), bool>) {
                return v ? VK_TRUE : VK_FALSE;
            } else {
                return std::bit_cast<std::uint32_t>(v);
            }
        },
        value);
}

/** Everything that decides what the pipeline is, as bytes. */
std::string contentKey(const ComputePipelineInfo& info) {
    std::string key;
    const auto add = [&](std::uint32_t value) {
        key.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(info.pushConstantBytes);
    add(info.subgroupSize);
    add(std::uint32_t(info.bindings.size()));
    for (const BindingSlot& slot : info.bindings) {
        add(slot.binding);
        add(std::uint32_t(slot.type));
        add(slot.count);
    }
    add(std::uint32_t(info.spec.size()));
    for (const auto& [id, value] : info.spec) {
        add(id);
        add(bits(value));
    }
    key.append(reinterpret_cast<const char*>(info.spirv.data()), info.spirv.size_bytes());
    return key;
}

}  // namespace

PipelineCache::PipelineCache(const vk::raii::Device& device, const vk::PhysicalDeviceProperties& properties,
                             const std::filesystem::path& folder)
    : device_(device), properties_(properties) {
    std::vector<std::byte> data;
    if (!folder.empty()) {
        file_ = folder / cacheFileName(properties_);
        if (auto loaded = readCacheFile(file_, properties_)) data = std::move(*loaded);
    }
    loadedBytes_ = data.size();
    savedHash_ = cacheHash(data);
    cache_ = translateErrors("creating the pipeline cache", [&] {
        return vk::raii::PipelineCache(device_, vk::PipelineCacheCreateInfo{.initialDataSize = data.size(),
                                                                            .pInitialData = data.data()});
    });
}

PipelineCache::~PipelineCache() {
    save();
}

void PipelineCache::save() {
    const std::lock_guard lock(mutex_);
    if (file_.empty() || created_ == 0) return;
    try {
        // Another process may have written since: what it found is kept.
        if (const auto other = readCacheFile(file_, properties_); other && cacheHash(*other) != savedHash_) {
            const vk::raii::PipelineCache theirs(
                device_,
                vk::PipelineCacheCreateInfo{.initialDataSize = other->size(), .pInitialData = other->data()});
            cache_.merge(*theirs);
        }
        const std::vector<std::uint8_t> raw = cache_.getData();
        const auto* bytes = reinterpret_cast<const std::byte*>(raw.data());
        const std::vector<std::byte> data(bytes, bytes + raw.size());
        if (cacheHash(data) == savedHash_ && loadedBytes_ > 0) return;
        if (writeCacheFile(file_, data)) savedHash_ = cacheHash(data);
    } catch (const std::exception& error) {
        log().info("the pipeline cache is not saved: {}", error.what());
    }
}

std::shared_ptr<const ComputePipeline> PipelineCache::get(const ComputePipelineInfo& info) {
    const std::string key = contentKey(info);
    const std::lock_guard lock(mutex_);
    if (const auto found = byContent_.find(key); found != byContent_.end()) return found->second;
    // An application that edits its scenes for days makes ever new variants; those that nobody holds go.
    if (byContent_.size() >= kMostPipelines) {
        std::erase_if(byContent_, [](const auto& entry) { return entry.second.use_count() == 1; });
    }
    auto pipeline = create(info);
    ++created_;
    byContent_.emplace(key, pipeline);
    return pipeline;
}

std::shared_ptr<const ComputePipeline> PipelineCache::create(const ComputePipelineInfo& info) {
    const auto start = std::chrono::steady_clock::now();
    if (info.pushConstantBytes > properties_.limits.maxPushConstantsSize) {
        throw DeviceError(fmt::format("pipeline '{}' has {} bytes of push constants; the device has {}",
                                      info.name, info.pushConstantBytes,
                                      properties_.limits.maxPushConstantsSize));
    }
    auto result = std::make_shared<ComputePipeline>();
    result->name = info.name;
    result->bindings = info.bindings;
    translateErrors("creating pipeline '" + info.name + "'", [&] {
        std::vector<vk::DescriptorSetLayoutBinding> slots;
        for (const BindingSlot& slot : info.bindings) {
            slots.push_back({.binding = slot.binding,
                             .descriptorType = slot.type,
                             .descriptorCount = slot.count,
                             .stageFlags = vk::ShaderStageFlagBits::eCompute});
        }
        result->setLayout = vk::raii::DescriptorSetLayout(
            device_, vk::DescriptorSetLayoutCreateInfo{.bindingCount = std::uint32_t(slots.size()),
                                                       .pBindings = slots.data()});
        const vk::DescriptorSetLayout setLayout = *result->setLayout;
        const vk::PushConstantRange push{.stageFlags = vk::ShaderStageFlagBits::eCompute,
                                         .size = info.pushConstantBytes};
        result->layout = vk::raii::PipelineLayout(
            device_,
            vk::PipelineLayoutCreateInfo{.setLayoutCount = 1,
                                         .pSetLayouts = &setLayout,
                                         .pushConstantRangeCount = info.pushConstantBytes > 0 ? 1u : 0u,
                                         .pPushConstantRanges = &push});
        std::vector<std::pair<std::uint32_t, std::uint32_t>> values;
        for (const auto& [id, value] : info.spec) values.emplace_back(id, bits(value));
        const std::vector<std::uint32_t> specialized =
            info.specialize ? info.specialize(info.spirv, values) : std::vector<std::uint32_t>{};
        if (!specialized.empty()) values.clear();  // they are in the words
        const std::span<const std::uint32_t> spirv = specialized.empty() ? info.spirv : specialized;
        const vk::raii::ShaderModule module(
            device_, vk::ShaderModuleCreateInfo{.codeSize = spirv.size_bytes(), .pCode = spirv.data()});
        setName(device_, *module, info.name);

        std::vector<std::uint32_t> words;
        std::vector<vk::SpecializationMapEntry> entries;
        for (const auto& [id, value] : values) {
            entries.push_back({.constantID = id, .offset = std::uint32_t(words.size() * 4), .size = 4});
            words.push_back(value);
        }
        const vk::SpecializationInfo specialization{.mapEntryCount = std::uint32_t(entries.size()),
                                                    .pMapEntries = entries.data(),
                                                    .dataSize = words.size() * 4,
                                                    .pData = words.data()};
        const vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup{.requiredSubgroupSize =
                                                                                 info.subgroupSize};
        const vk::ComputePipelineCreateInfo create{
            .stage = {.pNext = info.subgroupSize > 0 ? &subgroup : nullptr,
                      .stage = vk::ShaderStageFlagBits::eCompute,
                      .module = *module,
                      .pName = "main",
                      .pSpecializationInfo = entries.empty() ? nullptr : &specialization},
            .layout = *result->layout};
        result->pipeline = vk::raii::Pipeline(device_, cache_, create);
        setName(device_, *result->pipeline, info.name);
        setName(device_, *result->layout, info.name);
        setName(device_, *result->setLayout, info.name);
    });
    result->createMilliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    log().debug("pipeline '{}' made in {:.2f} ms", info.name, result->createMilliseconds);
    return result;
}

std::filesystem::path defaultPipelineCacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) {
        return std::filesystem::path(cache) / "heliograph";
    }
    if (const char* home = std::getenv("HOME"); home && *home) {
        return std::filesystem::path(home) / ".cache" / "heliograph";
    }
    return {};
}

DescriptorSet::DescriptorSet(Device::Impl& gpu, const ComputePipeline& pipeline,
                             std::span<const DescriptorWrite> writes) {
    if (pipeline.bindings.empty()) return;
    translateErrors("binding resources of '" + pipeline.name + "'", [&] {
        std::map<vk::DescriptorType, std::uint32_t> counts;
        std::map<std::uint32_t, vk::DescriptorType> types;
        for (const BindingSlot& slot : pipeline.bindings) {
            counts[slot.type] += slot.count;
            types[slot.binding] = slot.type;
        }
        std::vector<vk::DescriptorPoolSize> sizes;
        for (const auto& [type, count] : counts) sizes.push_back({.type = type, .descriptorCount = count});
        pool_ = vk::raii::DescriptorPool(
            gpu.device,
            vk::DescriptorPoolCreateInfo{
                .maxSets = 1, .poolSizeCount = std::uint32_t(sizes.size()), .pPoolSizes = sizes.data()});
        setName(gpu.device, *pool_, pipeline.name);
        const vk::DescriptorSetLayout layout = *pipeline.setLayout;
        // Freed with its pool, so the set is not an RAII object of its own.
        set_ = (*gpu.device)
                   .allocateDescriptorSets(
                       {.descriptorPool = *pool_, .descriptorSetCount = 1, .pSetLayouts = &layout},
                       *gpu.device.getDispatcher())
                   .front();
        setName(gpu.device, set_, pipeline.name);

        std::vector<vk::DescriptorBufferInfo> buffers(writes.size());
        std::vector<vk::DescriptorImageInfo> images(writes.size());
        std::vector<vk::BufferView> views(writes.size());
        std::vector<vk::WriteDescriptorSet> updates;
        for (std::size_t i = 0; i < writes.size(); ++i) {
            const DescriptorWrite& write = writes[i];
            const auto type = types.find(write.binding);
            assert(type != types.end() && "the pipeline has no such binding");
            buffers[i] = vk::DescriptorBufferInfo{
                .buffer = write.buffer, .offset = write.offset, .range = write.range};
            images[i] = vk::DescriptorImageInfo{
                .sampler = write.sampler, .imageView = write.imageView, .imageLayout = write.imageLayout};
            views[i] = write.texelView;
            updates.push_back({.dstSet = set_,
                               .dstBinding = write.binding,
                               .dstArrayElement = write.element,
                               .descriptorCount = 1,
                               .descriptorType = type->second,
                               .pImageInfo = &images[i],
                               .pBufferInfo = &buffers[i],
                               .pTexelBufferView = &views[i]});
        }
        gpu.device.updateDescriptorSets(updates, {});
    });
}

}  // namespace helio::gpu
