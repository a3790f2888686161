#pragma once
/** @file
 * The render graph: declare passes and what they read and write, compile once to an immutable plan, run it
 * many times. Culls what no root needs, aliases transient memory, derives every barrier. Declaration order
 * per resource defines versions, so a cycle cannot be written: a pass reads what the last earlier writer
 * left. Roots are readbacks, writes to imported resources, and passes marked keep().
 */
#include <heliograph/device.hpp>
#include <heliograph/kernel.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace helio {

/** Handle of a buffer declared in a graph. */
struct Buffer {
    std::uint32_t id = ~0u;
    std::uint32_t graph = 0;  ///< serial of the graph it belongs to; a foreign handle is refused
};
/** Handle of an image declared in a graph. */
struct Image {
    std::uint32_t id = ~0u;
    std::uint32_t graph = 0;  ///< serial of the graph it belongs to; a foreign handle is refused
};

struct BufferDescription {
    std::uint64_t bytes = 0;
};
struct ImageDescription {
    std::array<std::uint32_t, 2> size = {0, 0};  ///< width, height in texels
    Format format = Format::RGBA32F;
};

/** Part of a buffer, in bytes. `bytes` 0 reaches to the buffer's end. */
struct Window {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
};

/** How a sampler2D binding filters; coordinates clamp to the edge. */
enum class Sampling : std::uint8_t { Nearest, Linear };

/** One declared access: the shader's name for the binding (of a block its instance name, or its block name
 * where it has none), and the resource. For a texel buffer, the view's format; Undefined takes RGBA32F or
 * RGBA32UI after the shader's sampler type, or the format qualifier of an imageBuffer. A window binds a part
 * of a buffer, for data larger than DeviceInfo::maxStorageBufferRange. */
struct Binding {
    Binding(std::string bindingName, Buffer buffer, Format viewFormat = Format::Undefined)
        : name(std::move(bindingName)), resource(buffer.id), graph(buffer.graph), view(viewFormat) {}
    Binding(std::string bindingName, Buffer buffer, Window part, Format viewFormat = Format::Undefined)
        : name(std::move(bindingName)),
          resource(buffer.id),
          graph(buffer.graph),
          view(viewFormat),
          window(part) {}
    Binding(std::string bindingName, Image image, Sampling filter = Sampling::Nearest)
        : name(std::move(bindingName)), resource(image.id), graph(image.graph), sampling(filter) {}
    std::string name;
    std::uint32_t resource;
    std::uint32_t graph;
    Format view = Format::Undefined;
    Window window = {};
    Sampling sampling = Sampling::Nearest;
};

/** What a pass records with while a plan executes. The dispatches of one pass are not ordered among one
 * another: what one writes and another reads belongs in two passes. */
class Commands {
public:
    /** Push constants of the pass's kernel; T's size must equal the kernel's block. They hold until pushed
     * anew. What does not fit the kernel or the device throws a GraphError that names the pass, here and in
     * every function below. */
    template <typename T>
    Commands& push(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        return pushBytes(&value, sizeof(T));
    }
    Commands& pushBytes(const void* data, std::uint32_t bytes);
    /** Workgroups in x, y, z; a count above the device's limit is an error, zero does nothing. */
    Commands& dispatch(std::uint32_t x, std::uint32_t y = 1, std::uint32_t z = 1);
    /** At least `invocations` in x, rounded up to whole workgroups of the kernel's local size. */
    Commands& dispatchInvocations(std::uint64_t invocations);
    /** At least width x height invocations, rounded up to whole workgroups. */
    Commands& dispatchOver(Image image);
    Commands& dispatchOver(std::uint32_t width, std::uint32_t height);
    /** Workgroup counts from three uint32 at `offset` of a buffer the pass declared with indirect(). */
    Commands& dispatchIndirect(Buffer arguments, std::uint64_t offset = 0);

    struct Impl;
    explicit Commands(Impl& impl) : impl_(&impl) {}

private:
    Impl* impl_;
};

struct ComputeOptions {
    SpecConstants spec = {};
};

/** One finished or running execution of a plan. Copyable token. */
struct Execution {
    std::uint64_t value = 0;   ///< timeline semaphore value
    std::uint64_t serial = 0;  ///< count of executions of its plan, from 1
    std::uint64_t plan = 0;    ///< serial of its plan; a token of another plan is refused
};

struct PassTiming {
    std::string name;
    double milliseconds = 0;  ///< on the device, from timestamps
};

/** Bytes a plan would hold with and without aliasing. */
struct AliasingStatistics {
    std::uint64_t transientBytes = 0;  ///< sum of the transients' sizes
    std::uint64_t allocatedBytes = 0;  ///< memory they share
};

struct CompileOptions {
    /** Fills transient memory with NaN (0x7fc0dead words) before each resource's first use. */
    bool poison = false;
    /** Switches aliasing off, to compare. */
    bool alias = true;
    /** Executions that may be in flight at once. A further execute() first waits for the oldest. Readbacks of
     * this many executions stay readable; each holds its own host-visible memory. */
    std::uint32_t executionsInFlight = 2;
};

/** An immutable compiled graph. Move-only. Imported resources must outlive it. */
class Plan {
public:
    Plan();
    ~Plan();
    Plan(Plan&&) noexcept;
    Plan& operator=(Plan&&) noexcept;

    /** Records every live pass in order and submits; returns at once. Executions of one device run in
     * submission order. Not thread-safe. */
    Execution execute();
    /** Blocks until the execution is done. */
    void wait(const Execution& execution) const;
    /** Device times of an execution's passes and readbacks, in order, barriers included; waits for it. They
     * add up to the execution's whole time. One of the last 8 executions; empty on a device without
     * timestamps. */
    std::vector<PassTiming> timings(const Execution& execution) const;

    AliasingStatistics aliasing() const;
    /** Names of the passes that run, in order; readbacks are not among them. */
    std::vector<std::string> passes() const;
    /** Names of passes that no root needed, in order of declaration. */
    std::vector<std::string> culled() const;
    /** The compiled plan, with what was culled and what shares memory. */
    std::string graphviz() const;
    std::string json() const;

    struct Impl;
    Impl* impl() const { return impl_.get(); }
    explicit Plan(std::unique_ptr<Impl> impl);

private:
    std::unique_ptr<Impl> impl_;
};

/** Untyped readback: see Readback. */
class ReadbackBytes {
public:
    ReadbackBytes();
    /** Waits for the execution and returns the bytes it left. Throws GraphError where the plan was destroyed
     * or is another graph's, or CompileOptions::executionsInFlight later executions overwrote them. */
    std::vector<std::byte> wait(const Execution& execution) const;

    struct Impl;
    explicit ReadbackBytes(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}

private:
    std::shared_ptr<Impl> impl_;
};

/** What a root brings back to the host after each execution. */
template <typename T>
class Readback {
public:
    Readback() = default;
    explicit Readback(ReadbackBytes bytes) : bytes_(std::move(bytes)) {}
    std::vector<T> wait(const Execution& execution) const {
        const std::vector<std::byte> raw = bytes_.wait(execution);
        std::vector<T> values(raw.size() / sizeof(T));
        std::copy_n(raw.data(), values.size() * sizeof(T), reinterpret_cast<std::byte*>(values.data()));
        return values;
    }

private:
    ReadbackBytes bytes_;
};

class Pass;

/** A graph under declaration. */
class Graph {
public:
    explicit Graph(Device& device);
    ~Graph();
    Graph(Graph&&) noexcept;
    Graph& operator=(Graph&&) noexcept;

    /** Transients live only within an execution and may share memory. Names need not be unique. */
    Buffer buffer(std::string name, const BufferDescription& description);
    Image image(std::string name, const ImageDescription& description);
    /** Imports a resource that outlives the plan; writing it makes a root. The same object imported twice is
     * one resource with one handle. */
    Buffer import(DeviceBuffer& buffer);
    Image import(DeviceImage& image);

    Pass compute(std::string name, const Kernel& kernel, const ComputeOptions& options = {});
    /** Fills a whole buffer with a repeated 32-bit word. */
    Pass fill(std::string name, Buffer buffer, std::uint32_t word);
    /** Copies the leading bytes of one buffer to another of at least that size. */
    Pass copy(std::string name, Buffer from, Buffer to);

    /** Brings the resource's last version back to the host after each execution: a root. */
    template <typename T>
    Readback<T> readback(Buffer buffer) {
        return Readback<T>(readbackBytes(buffer.id, buffer.graph));
    }
    template <typename T>
    Readback<T> readback(Image image) {
        return Readback<T>(readbackBytes(image.id, image.graph));
    }

    /** Validates, culls, aliases, derives barriers, builds pipelines. Throws GraphError with every problem.
     * May be called again; readbacks serve every plan compiled from the graph, by the execution's token. */
    Plan compile(const CompileOptions& options = {});

    struct Impl;
    Impl& impl() const { return *impl_; }

private:
    ReadbackBytes readbackBytes(std::uint32_t resource, std::uint32_t graph);
    std::unique_ptr<Impl> impl_;
};

/** Fluent declaration of one pass. Valid until the graph is compiled or destroyed. */
class Pass {
public:
    Pass& reads(std::initializer_list<Binding> bindings);
    Pass& reads(const std::vector<Binding>& bindings);
    /** Written in whole or in part without reading what was there; parts not written hold the version
     * before, so its writers stay alive, and a first write to a transient must be whole (checked in the
     * NaN-poison mode). */
    Pass& writes(std::initializer_list<Binding> bindings);
    Pass& writes(const std::vector<Binding>& bindings);
    /** Every byte is written and none read: the version before is not needed, its writers may be culled. */
    Pass& overwrites(std::initializer_list<Binding> bindings);
    Pass& overwrites(const std::vector<Binding>& bindings);
    /** Read and written: atomics, accumulation in place. */
    Pass& modifies(std::initializer_list<Binding> bindings);
    Pass& modifies(const std::vector<Binding>& bindings);
    /** A buffer that dispatchIndirect reads. */
    Pass& indirect(Buffer arguments);
    /** The pass has an effect the graph cannot see; never culled. */
    Pass& keep();
    Pass& record(std::function<void(Commands&)> recorder);

private:
    friend class Graph;
    Pass(Graph::Impl* graph, std::uint32_t index) : graph_(graph), index_(index) {}
    Graph::Impl* graph_;
    std::uint32_t index_;
};

}  // namespace helio
