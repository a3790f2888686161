#pragma once
/** @file Copies between the host and device buffers. */
#include "engine/gpu/queue.hpp"
#include "engine/gpu/resource.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace helio::gpu {

/** Uploads go through a ring of host memory whose parts are free again when the copy that reads them is done;
 * downloads through one host buffer. Both are made when first needed. Where device memory is mapped, and for
 * an upload no work is in flight, bytes are copied directly instead. Thread-safe. */
class Staging {
public:
    static constexpr std::uint64_t kRingBytes = 16ull << 20;

    explicit Staging(Device::Impl& gpu) : gpu_(gpu) {}

    /** Returns when `data` may be reused. Work submitted before sees the old bytes, work submitted later the
     * new. */
    void upload(const BufferResource& buffer, const void* data, std::uint64_t bytes, std::uint64_t offset);
    /** Submits the recording if there is one, waits for everything submitted, and makes it visible to the
     * host. */
    using WaitForHost = std::function<void(std::optional<Recording>)>;
    /** Waits for everything submitted and copies out. */
    void download(const BufferResource& buffer, void* data, std::uint64_t bytes, std::uint64_t offset,
                  const WaitForHost& waitForHost);

    /** Switches direct access to mapped device memory off (false), so that the ring is used. */
    void allowDirect(bool allow) { direct_ = allow; }

private:
    std::uint64_t reserve(std::uint64_t bytes);

    Device::Impl& gpu_;
    bool direct_ = true;
    std::mutex mutex_;
    std::optional<BufferResource> ring_;
    std::uint64_t head_ = 0;  // next byte to hand out; counts on, the ring's offset is head_ modulo its size
    std::uint64_t tail_ = 0;  // oldest byte in flight
    std::deque<std::pair<std::uint64_t, std::uint64_t>> inFlight_;  // (timeline value, head_ after its part)
    std::optional<BufferResource> readback_;
};

}  // namespace helio::gpu
