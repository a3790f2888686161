#pragma once
/** @file
 * The compute device: one Vulkan 1.3 physical device and what the engine uses of it. No window-system
 * extension is ever enabled. Needs no Vulkan header; <heliograph/vulkan.hpp> gives the native handles.
 */
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace helio {

/** Something the engine can use of a device, and what happens without it. */
struct Capability {
    std::string name;         ///< Vulkan feature, extension or limit
    bool present = false;     ///< true where the device has it
    bool required = false;    ///< a device without it is refused
    std::string value;        ///< for a limit, its value; else empty
    std::string whenMissing;  ///< what a missing one switches off
};

/** A physical device as the loader lists it. */
struct DeviceInfo {
    std::string name;
    std::string type;  ///< "cpu", "discrete", "integrated", "virtual" or "other"
    std::string driver;
    std::string driverVersion;
    std::string apiVersion;  ///< "1.3.224"
    std::uint32_t vendorId = 0;
    std::uint32_t deviceId = 0;
    std::uint32_t subgroupSize = 0;            ///< invocations
    std::uint64_t maxStorageBufferRange = 0;   ///< bytes a storage-buffer binding may span
    std::uint64_t maxTexelBufferElements = 0;  ///< texels of a buffer view
    std::uint64_t maxBufferSize = 0;           ///< bytes of one buffer
    std::uint64_t memoryBytes = 0;             ///< of the largest device-local heap
    std::uint32_t maxWorkgroupInvocations = 0;
    std::uint32_t maxSharedMemoryBytes = 0;
    std::vector<Capability> capabilities;
    bool usable = false;
    std::string refusal;  ///< why it is not usable

    /** Whether the named capability is present. Asserts that the name is one the engine lists. */
    bool has(std::string_view capability) const;
};

/** Lists every physical device, usable or not. Throws DeviceError where Vulkan itself cannot start. */
std::vector<DeviceInfo> listDevices();

struct DeviceOptions {
    /** "auto" (a usable device: discrete, integrated, virtual, then CPU), an index into listDevices(), or a
     * part of a device's name, case-insensitive. HELIOGRAPH_DEVICE is taken where this is "auto". */
    std::string device = "auto";
    /** Load the Khronos validation layer with synchronization validation; messages are collected. Throws
     * DeviceError where the layer is not installed. */
    bool validation = false;
    /** Folder of the pipeline cache; empty takes $XDG_CACHE_HOME/heliograph or ~/.cache/heliograph. */
    std::filesystem::path pipelineCache = {};
};

/** Bytes of device memory. */
struct MemoryStatistics {
    std::uint64_t reservedBytes = 0;  ///< taken from the driver
    std::uint64_t usedBytes = 0;      ///< handed out to resources
    std::uint64_t peakUsedBytes = 0;
    std::uint32_t blocks = 0;       ///< driver allocations
    std::uint32_t allocations = 0;  ///< live resources
};

/** An open device with one compute queue. Move-only; must outlive everything made from it. */
class Device {
public:
    /** Opens the device. Throws DeviceError that names each refused device and its reason. */
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;

    const DeviceInfo& info() const;
    MemoryStatistics memory() const;
    /** Validation messages since the device was opened, in order; empty without validation. */
    std::vector<std::string> validationMessages() const;
    /** Blocks until the queue is idle. */
    void waitIdle() const;

    struct Impl;  ///< internal, see engine/gpu
    Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

/** Storage formats. Named channel order, bits, type. */
enum class Format : std::uint8_t {
    Undefined, R32UI, R32I, R32F, RG32UI, RG32F, RGBA32UI, RGBA32F, RGBA16F, RGBA8, R8
};
/** Bytes of a texel; 0 for Undefined. */
std::uint32_t formatBytes(Format format);
std::string_view formatName(Format format);

/** A buffer that outlives a plan: what a graph imports. Move-only. */
class DeviceBuffer {
public:
    DeviceBuffer() = default;
    /** Allocates `bytes` (at least 4 are taken). Usable as storage, texel, uniform, indirect and transfer
     * buffer. Contents are undefined. The name appears in messages. Throws OutOfDeviceMemory. */
    DeviceBuffer(Device& device, std::string name, std::uint64_t bytes);
    ~DeviceBuffer();
    DeviceBuffer(DeviceBuffer&&) noexcept;
    DeviceBuffer& operator=(DeviceBuffer&&) noexcept;

    const std::string& name() const;
    std::uint64_t bytes() const;
    explicit operator bool() const { return impl_ != nullptr; }
    /** Copies host bytes in; returns when the source may be reused. Plans executed before still see the old
     * bytes, plans executed later the new. The range must lie within the buffer. */
    void upload(const void* data, std::uint64_t bytes, std::uint64_t offset = 0);
    /** Waits for all work and copies out. */
    void download(void* data, std::uint64_t bytes, std::uint64_t offset = 0) const;

    struct Impl;
    Impl* impl() const { return impl_.get(); }

private:
    std::unique_ptr<Impl> impl_;
};

/** A buffer holding a copy of a contiguous range of trivially copyable values. */
template <typename Range>
DeviceBuffer makeBuffer(Device& device, std::string name, const Range& values) {
    const std::uint64_t bytes = std::uint64_t(std::size(values)) * sizeof(*std::data(values));
    DeviceBuffer buffer(device, std::move(name), bytes);
    if (bytes > 0) buffer.upload(std::data(values), bytes);
    return buffer;
}

/** A 2D storage image that outlives a plan. Move-only. */
class DeviceImage {
public:
    DeviceImage() = default;
    /** Every texel starts at zero. Throws OutOfDeviceMemory, or DeviceError where the device has no storage
     * images of the size or format. */
    DeviceImage(Device& device, std::string name, std::uint32_t width, std::uint32_t height, Format format);
    ~DeviceImage();
    DeviceImage(DeviceImage&&) noexcept;
    DeviceImage& operator=(DeviceImage&&) noexcept;

    const std::string& name() const;
    std::uint32_t width() const;
    std::uint32_t height() const;
    Format format() const;

    struct Impl;
    Impl* impl() const { return impl_.get(); }

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace helio
