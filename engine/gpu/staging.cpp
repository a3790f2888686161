#include "engine/gpu/staging.hpp"

#include "engine/gpu/device_impl.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace helio::gpu {

namespace {

// Half a ring: one part is filled while the part before is copied.
constexpr std::uint64_t kPartBytes = Staging::kRingBytes / 2;

}  // namespace

void Staging::upload(const BufferResource& buffer, const void* data, std::uint64_t bytes,
                     std::uint64_t offset) {
    assert(offset <= buffer.bytes && bytes <= buffer.bytes - offset);
    if (bytes == 0) return;
    const std::lock_guard lock(mutex_);
    if (direct_ && buffer.mapped && gpu_.queue.hostMayAccess()) {
        std::memcpy(buffer.mapped + offset, data, bytes);
        return;
    }
    if (!ring_) {
        ring_ = createBuffer(gpu_, "staging ring", kRingBytes, MemoryUse::Upload,
                             vk::BufferUsageFlagBits::eTransferSrc);
    }
    const auto* source = static_cast<const std::byte*>(data);
    for (std::uint64_t done = 0; done < bytes;) {
        const std::uint64_t part = std::min(bytes - done, kPartBytes);
        const std::uint64_t at = reserve(part);
        std::memcpy(ring_->mapped + at, source + done, part);
        Recording commands = gpu_.queue.begin("upload");
        commands->copyBuffer(*ring_->buffer, *buffer.buffer,
                             vk::BufferCopy{.srcOffset = at, .dstOffset = offset + done, .size = part});
        inFlight_.emplace_back(gpu_.queue.submit(std::move(commands)), head_);
        done += part;
    }
}

std::uint64_t Staging::reserve(std::uint64_t bytes) {
    std::uint64_t at = head_ % kRingBytes;
    // A part is contiguous: the rest of the ring is passed over where it does not fit.
    const std::uint64_t skipped = at + bytes > kRingBytes ? kRingBytes - at : 0;
    const std::uint64_t newHead = head_ + skipped + bytes;
    while (newHead - tail_ > kRingBytes) {
        if (inFlight_.empty()) {
            tail_ = head_;
            break;
        }
        gpu_.queue.wait(inFlight_.front().first);
        tail_ = inFlight_.front().second;
        inFlight_.pop_front();
    }
    head_ = newHead;
    return skipped > 0 ? 0 : at;
}

void Staging::download(const BufferResource& buffer, void* data, std::uint64_t bytes, std::uint64_t offset,
                       const WaitForHost& waitForHost) {
    assert(offset <= buffer.bytes && bytes <= buffer.bytes - offset);
    if (bytes == 0) return;
    const std::lock_guard lock(mutex_);
    if (direct_ && buffer.mapped) {
        waitForHost(std::nullopt);
        std::memcpy(data, buffer.mapped + offset, bytes);
        return;
    }
    if (!readback_) {
        readback_ = createBuffer(gpu_, "readback staging", kPartBytes, MemoryUse::Readback,
                                 vk::BufferUsageFlagBits::eTransferDst);
    }
    auto* target = static_cast<std::byte*>(data);
    for (std::uint64_t done = 0; done < bytes;) {
        const std::uint64_t part = std::min(bytes - done, kPartBytes);
        Recording commands = gpu_.queue.begin("download");
        commands->copyBuffer(*buffer.buffer, *readback_->buffer,
                             vk::BufferCopy{.srcOffset = offset + done, .dstOffset = 0, .size = part});
        waitForHost(std::move(commands));
        std::memcpy(target + done, readback_->mapped, part);
        done += part;
    }
}

}  // namespace helio::gpu
