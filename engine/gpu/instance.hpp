#pragma once
/** @file The Vulkan instance, with or without the validation layer. */
#include "engine/gpu/vk.hpp"

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace helio::gpu {

/** Validation messages of one instance, in order. Thread-safe. */
class ValidationLog {
public:
    void add(std::string message);
    std::vector<std::string> messages() const;

private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

/** Called with each validation message of any instance of the process, also while it is being destroyed, from
 * the thread that caused it. One observer; an empty function removes it. For test harnesses. */
void observeValidation(std::function<void(const std::string&)> observer);

/** An instance for Vulkan 1.3. No window-system extension is enabled. */
class Instance {
public:
    /** Throws DeviceError where there is no loader, no driver, or (for `validation`) no validation layer. */
    explicit Instance(bool validation);

    const vk::raii::Instance& handle() const { return instance_; }
    bool validated() const { return log_ != nullptr; }
    /** The messages so far; empty without validation. */
    std::vector<std::string> messages() const;

private:
    // Declared before the instance: messages of its destruction still arrive.
    std::unique_ptr<ValidationLog> log_;
    vk::raii::Context context_;
    vk::raii::Instance instance_;
    vk::raii::DebugUtilsMessengerEXT messenger_;
};

}  // namespace helio::gpu
