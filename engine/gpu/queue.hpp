#pragma once
/** @file The compute queue: recording, submission in order, completion by one timeline semaphore. */
#include "engine/gpu/vk.hpp"

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

namespace helio::gpu {

class Queue;

/** A command buffer being recorded. Move-only; dropped without submit() it is recycled. */
class Recording {
public:
    Recording(Recording&& other) noexcept;
    Recording& operator=(Recording&&) = delete;
    ~Recording();
    const vk::raii::CommandBuffer& operator*() const;
    const vk::raii::CommandBuffer* operator->() const { return &**this; }

private:
    friend class Queue;
    struct Slot;
    Recording(Queue* queue, std::unique_ptr<Slot> slot);
    Queue* queue_;
    std::unique_ptr<Slot> slot_;
};

/** One queue. Every submission waits for the one before and signals the next value of a timeline semaphore,
 * so all writes of one submission are visible to the next without a barrier. What the host wrote to mapped
 * coherent memory before submit() is visible to the device (Vulkan 1.3, 7.9); the other way needs a
 * dependency to the host, which engine/graph records. Thread-safe; each Recording has a command pool of its
 * own, so threads may record at once. */
class Queue {
public:
    Queue(const vk::raii::Device& device, std::uint32_t family);
    ~Queue();

    /** A command buffer in the recording state; `name` is for messages and captures. */
    Recording begin(std::string_view name = {});
    /** Ends and submits; returns the timeline value that it signals. `forHost`: the recording ends with a
     * dependency of everything before to the host, so once its value is reached mapped memory shows all of
     * it. */
    std::uint64_t submit(Recording recording, bool forHost = false);

    std::uint64_t submitted() const { return submitted_; }  ///< value of the last submission, 0 for none
    bool done(std::uint64_t value) const;                   ///< does not block
    /** Everything submitted is done, and the host may read and write what it used in mapped memory. */
    bool hostMayAccess() const { return submitted_ == forHost_ && done(forHost_); }
    /** Blocks until the value is reached, then destroys what was retired before. */
    void wait(std::uint64_t value);
    void waitIdle() { wait(submitted_); }

    /** Keeps an object alive until everything submitted so far is done. */
    template <typename T>
    void retire(T object) {
        retireShared(std::make_shared<T>(std::move(object)));
    }

    vk::Queue handle() const { return *queue_; }
    std::uint32_t family() const { return family_; }
    vk::Semaphore timeline() const { return *timeline_; }

private:
    friend class Recording;
    void retireShared(std::shared_ptr<void> object);
    void collect();
    void recycle(std::unique_ptr<Recording::Slot> slot);

    const vk::raii::Device& device_;
    std::uint32_t family_;
    vk::raii::Queue queue_;
    vk::raii::Semaphore timeline_;
    std::atomic<std::uint64_t> submitted_{0};
    std::atomic<std::uint64_t> forHost_{0};  ///< last submission that ended with a dependency to the host
    mutable std::atomic<std::uint64_t> reached_{0};

    std::mutex mutex_;
    std::vector<std::unique_ptr<Recording::Slot>> idle_;
    std::deque<std::pair<std::uint64_t, std::unique_ptr<Recording::Slot>>> running_;
    std::deque<std::pair<std::uint64_t, std::shared_ptr<void>>> retired_;
};

}  // namespace helio::gpu
