#pragma once
/** @file Device memory: few large driver allocations, cut into the ranges that resources are bound to. */
#include "engine/gpu/range_allocator.hpp"
#include "engine/gpu/vk.hpp"

#include <heliograph/device.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace helio::gpu {

/** Who touches the memory. */
enum class MemoryUse : std::uint8_t {
    Device,   ///< the device; mapped all the same where device memory is the host's (CPU and integrated
              ///< devices)
    Upload,   ///< written by the host in order, read by the device; mapped, coherent
    Readback  ///< written by the device, read by the host; mapped, coherent, cached where there is such a
              ///< type
};

/** What will be bound. Buffers and optimally tiled images live in different blocks, so that
 * bufferImageGranularity never matters between resources; a Mixed range (memory that a plan's buffers and
 * images share) begins and ends on a multiple of it, and whoever places both kinds within keeps to it. */
enum class MemoryContent : std::uint8_t { Buffers, Images, Mixed };

struct MemoryRequest {
    std::string name;  ///< of the resource, for messages
    std::uint64_t bytes = 0;
    std::uint64_t alignment = 1;
    std::uint32_t typeBits = ~0u;  ///< VkMemoryRequirements::memoryTypeBits
    MemoryUse use = MemoryUse::Device;
    MemoryContent content = MemoryContent::Buffers;
};

/** The memory type to take, or nothing where none is allowed. Pure. */
std::optional<std::uint32_t> chooseMemoryType(const vk::PhysicalDeviceMemoryProperties& properties,
                                              std::uint32_t typeBits, MemoryUse use, bool unifiedMemory);

class Memory;

/** A range of device memory, given back when destroyed. Move-only. */
class Allocation {
public:
    Allocation() = default;
    ~Allocation() { reset(); }
    Allocation(Allocation&& other) noexcept { *this = std::move(other); }
    Allocation& operator=(Allocation&& other) noexcept;

    explicit operator bool() const { return memory_ != nullptr; }
    vk::DeviceMemory memory() const;
    std::uint64_t offset() const { return offset_; }  ///< within memory()
    std::uint64_t bytes() const { return bytes_; }
    std::uint32_t memoryType() const;
    /** Host address of the first byte, null where the memory is not mapped. */
    std::byte* mapped() const;
    void reset();

private:
    friend class Memory;
    struct Block;
    Memory* memory_ = nullptr;
    Block* block_ = nullptr;
    std::uint64_t offset_ = 0;
    std::uint64_t bytes_ = 0;
};

/** Allocates ranges. Blocks of one memory type and content grow from 16 MiB to 256 MiB; a request above half
 * a block gets a driver allocation of its own. Thread-safe. */
class Memory {
public:
    /** `knowsBudget`: VK_EXT_memory_budget is there, for messages. */
    Memory(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, bool unifiedMemory,
           bool knowsBudget);
    ~Memory();

    /** Throws OutOfDeviceMemory that names the request. */
    Allocation allocate(const MemoryRequest& request);
    MemoryStatistics statistics() const;
    /** Returns blocks that hold nothing to the driver. */
    void trim();
    /** Refuses to take more than this from the driver in all. */
    void setLimit(std::uint64_t bytes) { limit_ = bytes; }
    std::uint64_t bufferImageGranularity() const { return granularity_; }
    /** True where device memory is host memory, so that Device allocations are mapped and cached. */
    bool unified() const { return unified_; }

private:
    friend class Allocation;
    using Block = Allocation::Block;
    void free(Block& block, std::uint64_t offset, std::uint64_t bytes);
    Block* addBlock(std::uint32_t type, MemoryContent content, std::uint64_t bytes, bool dedicated,
                    std::string& failure);

    std::string heapState(std::uint32_t type) const;

    const vk::raii::PhysicalDevice& physical_;
    const vk::raii::Device& device_;
    vk::PhysicalDeviceMemoryProperties properties_;
    std::uint64_t maxAllocationBytes_ = 0;
    std::uint64_t granularity_ = 1;
    std::uint64_t limit_ = std::numeric_limits<std::uint64_t>::max();
    bool unified_ = false;
    bool knowsBudget_ = false;

    mutable std::mutex mutex_;
    std::list<Block> blocks_;
    MemoryStatistics statistics_;
};

}  // namespace helio::gpu
