#include "tests/support/device.hpp"

#include "engine/gpu/instance.hpp"
#include "tests/support/validation_listener.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>

namespace helio::test {

namespace {

std::mutex mutex;
std::vector<std::string> pending;
std::unique_ptr<Device> shared;

class ValidationListener : public testing::EmptyTestEventListener {
    void OnTestEnd(const testing::TestInfo&) override {
        for (const std::string& message : takeValidationMessages()) {
            ADD_FAILURE() << "Vulkan validation " << message;
        }
    }
};

}  // namespace

DeviceOptions deviceOptions() {
    return {.validation = true, .pipelineCache = scratchFolder() / "pipelines"};
}

Device& device() {
    if (!shared) shared = std::make_unique<Device>(deviceOptions());
    return *shared;
}

void closeDevice() {
    shared.reset();
}

std::vector<std::string> takeValidationMessages() {
    const std::lock_guard lock(mutex);
    return std::exchange(pending, {});
}

const std::filesystem::path& scratchFolder() {
    struct Folder {
        std::filesystem::path path =
            std::filesystem::temp_directory_path() / ("heliograph-test-" + std::to_string(::getpid()));
        Folder() { std::filesystem::create_directories(path); }
        ~Folder() {
            std::error_code ignored;
            std::filesystem::remove_all(path, ignored);
        }
    };
    static const Folder folder;
    return folder.path;
}

int runAllWithDevice() {
    scratchFolder();
    // The layer also follows accesses from one submission to the next, over semaphores, when told so; Debian
    // 12's has no other way to tell it. Read when an instance is made.
    ::setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT", 1);
    gpu::observeValidation([](const std::string& message) {
        const std::lock_guard lock(mutex);
        pending.push_back(message);
    });
    // Appended after the printer, and OnTestEnd runs in reverse order: the printer sees the failure.
    testing::UnitTest::GetInstance()->listeners().Append(new ValidationListener);
    int result = RUN_ALL_TESTS();
    closeDevice();
    for (const std::string& message : takeValidationMessages()) {
        std::printf("[  FAILED  ] Vulkan validation outside of a test: %s\n", message.c_str());
        result = 1;
    }
    gpu::observeValidation({});
    return result;
}

}  // namespace helio::test
