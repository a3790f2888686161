#include "engine/gpu/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>

namespace helio::gpu {

namespace {

constexpr std::uint64_t kSmallestBlock = 16ull << 20;
constexpr std::uint64_t kLargestBlock = 256ull << 20;

std::string mebibytes(std::uint64_t bytes) {
    return fmt::format("{:.1f} MiB", double(bytes) / (1 << 20));
}

}  // namespace

struct Allocation::Block {
    vk::raii::DeviceMemory memory;
    std::byte* mapped;
    std::uint32_t type;
    MemoryContent content;
    bool dedicated;
    RangeAllocator ranges;
};

std::optional<std::uint32_t> chooseMemoryType(const vk::PhysicalDeviceMemoryProperties& properties,
                                              std::uint32_t typeBits, MemoryUse use, bool unifiedMemory) {
    using Flag = vk::MemoryPropertyFlagBits;
    const vk::MemoryPropertyFlags hostAccess = Flag::eHostVisible | Flag::eHostCoherent;
    // Types that need a feature of their own to be used at all.
    const vk::MemoryPropertyFlags special = Flag::eLazilyAllocated | Flag::eProtected |
                                            Flag::eDeviceCoherentAMD | Flag::eDeviceUncachedAMD |
                                            Flag::eRdmaCapableNV;
    std::optional<std::uint32_t> best;
    int bestScore = -1;
    for (std::uint32_t type = 0; type < properties.memoryTypeCount; ++type) {
        if ((typeBits >> type & 1u) == 0) continue;
        const vk::MemoryPropertyFlags flags = properties.memoryTypes[type].propertyFlags;
        if (flags & special) continue;
        const bool local = bool(flags & Flag::eDeviceLocal);
        const bool host = (flags & hostAccess) == hostAccess;
        const bool cached = bool(flags & Flag::eHostCached);
        int score = 0;
        switch (use) {
            case MemoryUse::Device:
                score = (local ? 8 : 0) + (host == unifiedMemory ? 4 : 0) + (cached == unifiedMemory ? 2 : 0);
                break;
            case MemoryUse::Upload:
                if (!host) continue;
                score = (local ? 0 : 2) + (cached ? 0 : 1);
                break;
            case MemoryUse::Readback:
                if (!host) continue;
                score = (cached ? 2 : 0) + (local ? 0 : 1);
                break;
        }
        if (score > bestScore) {
            best = type;
            bestScore = score;
        }
    }
    return best;
}

Allocation& Allocation::operator=(Allocation&& other) noexcept {
    if (this != &other) {
        reset();
        memory_ = std::exchange(other.memory_, nullptr);
        block_ = std::exchange(other.block_, nullptr);
        offset_ = std::exchange(other.offset_, 0);
        bytes_ = std::exchange(other.bytes_, 0);
    }
    return *this;
}
vk::DeviceMemory Allocation::memory() const {
    return *block_->memory;
}
std::uint32_t Allocation::memoryType() const {
    return block_->type;
}
std::byte* Allocation::mapped() const {
    return block_->mapped ? block_->mapped + offset_ : nullptr;
}
void Allocation::reset() {
    if (memory_) memory_->free(*block_, offset_, bytes_);
    memory_ = nullptr;
    block_ = nullptr;
}

Memory::Memory(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, bool unifiedMemory,
               bool knowsBudget)
    : physical_(physical),
      device_(device),
      properties_(physical.getMemoryProperties()),
      unified_(unifiedMemory),
      knowsBudget_(knowsBudget) {
    const auto chain =
        physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties>();
    granularity_ = std::max<std::uint64_t>(
        1, chain.get<vk::PhysicalDeviceProperties2>().properties.limits.bufferImageGranularity);
    maxAllocationBytes_ = chain.get<vk::PhysicalDeviceVulkan11Properties>().maxMemoryAllocationSize;
}

Memory::~Memory() {
    assert(statistics_.allocations == 0 && "a resource outlives its device");
}

Allocation Memory::allocate(const MemoryRequest& request) {
    assert(request.bytes > 0 && std::has_single_bit(request.alignment));
    std::uint64_t bytes = request.bytes;
    std::uint64_t alignment = request.alignment;
    const std::optional<std::uint32_t> type =
        chooseMemoryType(properties_, request.typeBits, request.use, unified_);
    if (!type) {
        throw OutOfDeviceMemory(
            request.name, request.bytes,
            fmt::format("no memory type of the device fits (allowed 0x{:x})", request.typeBits));
    }
    if (bytes > maxAllocationBytes_) {
        throw OutOfDeviceMemory(
            request.name, request.bytes,
            fmt::format("the device allocates at most {} bytes at once", maxAllocationBytes_));
    }
    if (request.content == MemoryContent::Mixed) {
        alignment = std::max(alignment, granularity_);
        bytes = (bytes + granularity_ - 1) / granularity_ * granularity_;
    }

    const std::lock_guard lock(mutex_);
    Block* block = nullptr;
    std::optional<std::uint64_t> offset;
    std::uint32_t shared = 0;
    for (Block& candidate : blocks_) {
        if (candidate.dedicated || candidate.type != *type || candidate.content != request.content) continue;
        ++shared;
        if (!offset && (offset = candidate.ranges.allocate(bytes, alignment))) block = &candidate;
    }
    std::string failure;
    if (!block) {
        const std::uint64_t heapBytes =
            properties_.memoryHeaps[properties_.memoryTypes[*type].heapIndex].size;
        const std::uint64_t blockBytes =
            std::min({kSmallestBlock << std::min(shared, 4u), kLargestBlock, heapBytes / 8});
        if (bytes <= blockBytes / 2) block = addBlock(*type, request.content, blockBytes, false, failure);
        if (!block) block = addBlock(*type, request.content, bytes, true, failure);
        if (!block) {
            throw OutOfDeviceMemory(request.name, request.bytes,
                                    fmt::format("{}; {} in {} blocks are taken, of which {} are used",
                                                failure, mebibytes(statistics_.reservedBytes),
                                                statistics_.blocks, mebibytes(statistics_.usedBytes)));
        }
        offset = block->ranges.allocate(bytes, alignment);
    }
    Allocation allocation;
    allocation.memory_ = this;
    allocation.block_ = block;
    allocation.offset_ = offset.value();
    allocation.bytes_ = bytes;
    statistics_.usedBytes += bytes;
    statistics_.peakUsedBytes = std::max(statistics_.peakUsedBytes, statistics_.usedBytes);
    ++statistics_.allocations;
    return allocation;
}

Memory::Block* Memory::addBlock(std::uint32_t type, MemoryContent content, std::uint64_t bytes,
                                bool dedicated, std::string& failure) {
    if (bytes > limit_ || statistics_.reservedBytes > limit_ - bytes) {
        failure = fmt::format("the limit of {} is reached", mebibytes(limit_));
        return nullptr;
    }
    try {
        const vk::StructureChain<vk::MemoryAllocateInfo, vk::MemoryAllocateFlagsInfo> info{
            {.allocationSize = bytes, .memoryTypeIndex = type},
            {.flags = vk::MemoryAllocateFlagBits::eDeviceAddress}};
        vk::raii::DeviceMemory memory(device_, info.get());
        std::byte* mapped = nullptr;
        if (properties_.memoryTypes[type].propertyFlags & vk::MemoryPropertyFlagBits::eHostVisible &&
            properties_.memoryTypes[type].propertyFlags & vk::MemoryPropertyFlagBits::eHostCoherent) {
            mapped = static_cast<std::byte*>(memory.mapMemory(0, VK_WHOLE_SIZE));
        }
        blocks_.push_back({std::move(memory), mapped, type, content, dedicated, RangeAllocator(bytes)});
    } catch (const vk::SystemError& error) {
        failure = fmt::format("the driver refuses {} of memory type {} ({}): {}", mebibytes(bytes), type,
                              heapState(type), error.what());
        return nullptr;
    }
    statistics_.reservedBytes += bytes;
    ++statistics_.blocks;
    return &blocks_.back();
}

void Memory::free(Block& block, std::uint64_t offset, std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    block.ranges.free(offset, bytes);
    statistics_.usedBytes -= bytes;
    --statistics_.allocations;
    if (!block.ranges.empty()) return;
    // One empty block per pool stays, so that a resource made and destroyed in turn costs no driver call.
    bool release = block.dedicated;
    for (const Block& other : blocks_) {
        release = release || (&other != &block && !other.dedicated && other.type == block.type &&
                              other.content == block.content && other.ranges.empty());
    }
    if (!release) return;
    statistics_.reservedBytes -= block.ranges.size();
    --statistics_.blocks;
    blocks_.remove_if([&](const Block& each) { return &each == &block; });
}

std::string Memory::heapState(std::uint32_t type) const {
    const std::uint32_t heap = properties_.memoryTypes[type].heapIndex;
    if (!knowsBudget_) return fmt::format("heap of {}", mebibytes(properties_.memoryHeaps[heap].size));
    const auto budget = physical_
                            .getMemoryProperties2<vk::PhysicalDeviceMemoryProperties2,
                                                  vk::PhysicalDeviceMemoryBudgetPropertiesEXT>()
                            .get<vk::PhysicalDeviceMemoryBudgetPropertiesEXT>();
    return fmt::format("heap with {} of a budget of {} in use", mebibytes(budget.heapUsage[heap]),
                       mebibytes(budget.heapBudget[heap]));
}

MemoryStatistics Memory::statistics() const {
    const std::lock_guard lock(mutex_);
    return statistics_;
}

void Memory::trim() {
    const std::lock_guard lock(mutex_);
    blocks_.remove_if([&](const Block& block) {
        if (!block.ranges.empty()) return false;
        statistics_.reservedBytes -= block.ranges.size();
        --statistics_.blocks;
        return true;
    });
}

}  // namespace helio::gpu
