#pragma once
/** @file
 * Plain data that the graph's compiler takes and gives. No Vulkan here: stages, accesses and layouts have
 * synchronization2's meaning under names of our own, and the executor translates them one to one.
 */
#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace helio::graph {

/** Pipeline stages, a bit set. */
using Stages = std::uint32_t;
namespace stage {
inline constexpr Stages None = 0;
inline constexpr Stages Compute = 1;
inline constexpr Stages Indirect = 2;  ///< fetch of indirect dispatch arguments
inline constexpr Stages Copy = 4;
inline constexpr Stages Clear = 8;  ///< fills and clears
inline constexpr Stages Host = 16;
inline constexpr Stages All = 0x80000000u;  ///< every stage of the queue (the host's is not one)
}  // namespace stage

/** Memory accesses, a bit set. */
using Accesses = std::uint32_t;
namespace access {
inline constexpr Accesses None = 0;
inline constexpr Accesses StorageRead = 1;
inline constexpr Accesses StorageWrite = 2;
inline constexpr Accesses SampledRead = 4;  ///< sampled images and uniform texel buffers
inline constexpr Accesses UniformRead = 8;
inline constexpr Accesses IndirectRead = 16;
inline constexpr Accesses TransferRead = 32;
inline constexpr Accesses TransferWrite = 64;
inline constexpr Accesses HostRead = 128;
inline constexpr Accesses HostWrite = 256;
inline constexpr Accesses AllWrites = 0x40000000u;
inline constexpr Accesses AllReads = 0x80000000u;
inline constexpr Accesses Writes = StorageWrite | TransferWrite | AllWrites;
}  // namespace access

/** Image layouts. Buffers are always in Undefined. */
enum class Layout : std::uint8_t { Undefined, General, ShaderRead, TransferSource, TransferDestination };

enum class ResourceKind : std::uint8_t { Buffer, Image };

/** What a binding does with its resource, as the pass declared it. */
enum class Mode : std::uint8_t {
    Read,
    Write,      ///< parts not written keep the version before
    Overwrite,  ///< every byte is written, none read
    Modify,
};

inline bool isWrite(Mode mode) {
    return mode != Mode::Read;
}

/** How a binding reaches its resource. */
enum class Usage : std::uint8_t {
    StorageBuffer,
    UniformBuffer,
    UniformTexelBuffer,
    StorageTexelBuffer,
    StorageImage,
    SampledImage,
    IndirectArguments,
    CopySource,
    CopyDestination,
    Fill,
};

inline constexpr std::uint32_t none = ~0u;

struct ResourceInput {
    std::string name;
    ResourceKind kind = ResourceKind::Buffer;
    bool imported = false;
    std::uint64_t bytes = 0;                     ///< of a buffer
    std::array<std::uint32_t, 2> size = {0, 0};  ///< of an image, texels
    Format format = Format::Undefined;           ///< of an image
    /** What the device asks for a transient's memory. `memoryClass` numbers sets of compatible memory types:
     * only resources of one class can share memory. */
    std::uint64_t memoryBytes = 0;
    std::uint64_t alignment = 1;
    std::uint32_t memoryClass = 0;
};

struct AccessInput {
    std::string binding;
    std::uint32_t resource = none;
    std::uint32_t graph = 0;  ///< serial of the graph the handle came from
    Mode mode = Mode::Read;
    Usage usage = Usage::StorageBuffer;
    Window window = {};
};

struct PassInput {
    std::string name;
    std::vector<AccessInput> accesses;
    bool keep = false;
};

struct ReadbackInput {
    std::uint32_t resource = none;
    std::uint32_t graph = 0;
};

/** Limits of the device that the compiler has to know. */
struct Limits {
    std::uint64_t bufferImageGranularity = 1;         ///< bytes, a power of two
    std::uint64_t maxArenaBytes = ~std::uint64_t(0);  ///< of one allocation
};

struct Input {
    std::uint32_t graph = 0;
    std::vector<ResourceInput> resources;
    std::vector<PassInput> passes;
    std::vector<ReadbackInput> readbacks;
    Limits limits = {};
    bool alias = true;
    bool poison = false;
};

/** One stage's accesses. */
struct Touch {
    Stages stage = stage::None;
    Accesses access = access::None;
};

/** All that one step does with one resource: the union over its bindings. */
struct Use {
    std::uint32_t resource = none;
    bool reads = false;
    bool writes = false;
    bool discards = false;  ///< writes every byte and reads none
    Layout layout = Layout::Undefined;
    std::vector<Touch> touches;       ///< one per stage
    std::uint32_t versionBefore = 0;  ///< 0 is what the resource held when the execution began
    std::uint32_t versionAfter = 0;   ///< versionBefore, or one more where the step writes
};

/** Why a barrier is there, for the dumps. */
enum class Cause : std::uint8_t {
    ReadAfterWrite,
    WriteAfterRead,
    WriteAfterWrite,
    LayoutChange,
    FirstUse,   ///< an image leaves the undefined layout
    Aliasing,   ///< the memory held other resources before
    Execution,  ///< between executions
    HostAccess,
};

/** A dependency. A memory barrier (resource == none) covers all memory. Steps issue their memory barriers in
 * one command and then the others in a second one, so that a layout change follows the memory barrier that
 * hands the image its memory. */
struct Barrier {
    std::uint32_t resource = none;
    Stages fromStages = stage::None;
    Accesses fromAccess = access::None;
    Stages toStages = stage::None;
    Accesses toAccess = access::None;
    Layout oldLayout = Layout::Undefined;
    Layout newLayout = Layout::Undefined;
    Cause cause = Cause::ReadAfterWrite;
    std::vector<std::uint32_t> former = {};  ///< for Aliasing, the resources that held the memory
};

enum class StepKind : std::uint8_t { Poison, Pass, Readback };

/** One thing the plan does. `index` is the pass's, the readback's, or for a poisoning the resource's. */
struct Step {
    StepKind kind = StepKind::Pass;
    std::uint32_t index = none;
    std::vector<Use> uses;
    std::vector<Barrier> barriers;  ///< before the step
};

/** A stretch of memory that transients of one memory class share. */
struct Arena {
    std::uint32_t memoryClass = 0;
    std::uint64_t bytes = 0;
};

/** Where a live transient lives and when: steps first to last, both included. */
struct Placement {
    std::uint32_t resource = none;
    std::uint32_t arena = none;
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
    std::uint32_t first = 0;
    std::uint32_t last = 0;
};

struct CulledPass {
    std::uint32_t pass = none;
    std::string reason;
};

/** The compiled plan. */
struct Compiled {
    std::vector<Step> steps;
    std::vector<Barrier> entry;  ///< before the first step of every execution
    std::vector<Barrier> exit;   ///< after the last step: to the host first
    std::vector<Arena> arenas;
    std::vector<Placement> placements;
    std::vector<CulledPass> culledPasses;
    std::vector<std::uint32_t> unusedResources;  ///< that no live step touches
    AliasingStatistics aliasing;
};

}  // namespace helio::graph
