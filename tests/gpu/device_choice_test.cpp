// Which device is taken, which is refused and what is said about it, judged on made-up devices.
#include "engine/gpu/capabilities.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace helio::gpu {
namespace {

DeviceInfo device(const char* name, const char* type, const char* refusal = "") {
    DeviceInfo info;
    info.name = name;
    info.type = type;
    info.refusal = refusal;
    info.usable = info.refusal.empty();
    return info;
}

const std::vector<DeviceInfo> kMachine = {
    device("llvmpipe (LLVM 15)", "cpu"),
    device("Old Card 1", "discrete", "apiVersion is only 1.1.0 and 1.3 is needed"),
    device("Graphics 630", "integrated"), device("Big Card 7", "discrete"),
    device("Small Card 8", "discrete")};

std::string refusalOf(const std::vector<DeviceInfo>& devices, const std::string& request) {
    try {
        const std::size_t chosen = chooseDevice(devices, request, "--device");
        return "chose " + std::to_string(chosen);
    } catch (const DeviceError& error) {
        return error.what();
    }
}

TEST(ChooseDevice, AutomaticallyTakesTheUsableDeviceOfTheBestType) {
    EXPECT_EQ(chooseDevice(kMachine, "auto", ""), 3u);
    EXPECT_EQ(chooseDevice({kMachine[0], kMachine[1], kMachine[2]}, "auto", ""), 2u);
    EXPECT_EQ(chooseDevice({kMachine[0], kMachine[1]}, "auto", ""), 0u);
    EXPECT_EQ(chooseDevice({device("odd", "other"), kMachine[0]}, "auto", ""), 1u);
}

TEST(ChooseDevice, ByIndexOrPartOfTheNameInAnyCase) {
    EXPECT_EQ(chooseDevice(kMachine, "0", ""), 0u);
    EXPECT_EQ(chooseDevice(kMachine, "4", ""), 4u);
    EXPECT_EQ(chooseDevice(kMachine, "LLVMPIPE", ""), 0u);
    EXPECT_EQ(chooseDevice(kMachine, "small", ""), 4u);
    EXPECT_EQ(chooseDevice(kMachine, "card", ""), 3u) << "the first usable one";
}

TEST(ChooseDevice, NeverFallsBackFromANamedDevice) {
    const std::string all =
        "; the loader lists: 0 'llvmpipe (LLVM 15)' (usable); 1 'Old Card 1' (refused: apiVersion is only "
        "1.1.0 and "
        "1.3 is needed); 2 'Graphics 630' (usable); 3 'Big Card 7' (usable); 4 'Small Card 8' (usable)";
    EXPECT_EQ(refusalOf(kMachine, "old card"), "--device 'old card' names no usable device" + all);
    EXPECT_EQ(refusalOf(kMachine, "1"), "--device '1' names no usable device" + all);
    EXPECT_EQ(refusalOf(kMachine, "voodoo"), "--device 'voodoo' names no device" + all);
    EXPECT_EQ(refusalOf(kMachine, "5"), "--device '5' names no device" + all);
    EXPECT_EQ(refusalOf(kMachine, "99999999999999999999"),
              "--device '99999999999999999999' names no device" + all);
}

TEST(ChooseDevice, WithoutAUsableDeviceEveryRefusalIsNamed) {
    EXPECT_EQ(refusalOf({kMachine[1]}, "auto"),
              "no usable Vulkan device; the loader lists: 0 'Old Card 1' (refused: apiVersion is only 1.1.0 "
              "and 1.3 is "
              "needed)");
    EXPECT_NE(refusalOf({}, "auto").find("the loader lists none"), std::string::npos);
    EXPECT_NE(refusalOf({}, "llvmpipe").find("mesa-vulkan-drivers"), std::string::npos);
}

/** A device with everything. */
DeviceFacts goodFacts() {
    DeviceFacts facts;
    facts.properties.apiVersion = VK_API_VERSION_1_3;
    std::strcpy(facts.properties.deviceName.data(), "Made-up");
    facts.properties.limits.maxPushConstantsSize = 128;
    facts.properties.limits.maxStorageBufferRange = 1u << 27;
    facts.properties.limits.maxTexelBufferElements = 1u << 27;
    facts.properties.limits.maxComputeWorkGroupInvocations = 1024;
    facts.properties.limits.maxComputeSharedMemorySize = 32768;
    facts.properties13.maxBufferSize = 1ull << 32;
    facts.features12.timelineSemaphore = VK_TRUE;
    facts.features12.bufferDeviceAddress = VK_TRUE;
    facts.features13.synchronization2 = VK_TRUE;
    facts.features13.maintenance4 = VK_TRUE;
    facts.queues = {{.queueFlags = vk::QueueFlagBits::eTransfer, .queueCount = 1},
                    {.queueFlags = vk::QueueFlagBits::eCompute, .queueCount = 1, .timestampValidBits = 36}};
    return facts;
}

TEST(DescribeDevice, IsUsableWithWhatIsRequired) {
    const DeviceInfo info = describeDevice(goodFacts());
    EXPECT_TRUE(info.usable) << info.refusal;
    EXPECT_TRUE(info.has("timestamps"));
    EXPECT_FALSE(info.has("shaderInt64"));
    EXPECT_FALSE(info.has("graphicsQueue"));
    for (const Capability& capability : info.capabilities) {
        EXPECT_FALSE(capability.whenMissing.empty()) << capability.name;
        EXPECT_EQ(std::ranges::count(info.capabilities, capability.name, &Capability::name), 1)
            << capability.name;
    }
}

TEST(DescribeDevice, IsRefusedForEachRequiredCapabilityByName) {
    const auto refusal = [](void (*spoil)(DeviceFacts&)) {
        DeviceFacts facts = goodFacts();
        spoil(facts);
        const DeviceInfo info = describeDevice(facts);
        EXPECT_EQ(info.usable, info.refusal.empty());
        return info.refusal;
    };
    EXPECT_EQ(refusal([](DeviceFacts& f) { f.properties.apiVersion = VK_MAKE_API_VERSION(0, 1, 2, 131); }),
              "apiVersion is only 1.2.131 and 1.3 is needed");
    EXPECT_EQ(refusal([](DeviceFacts& f) { f.features13.synchronization2 = VK_FALSE; }),
              "synchronization2 is missing");
    EXPECT_EQ(refusal([](DeviceFacts& f) { f.features12.timelineSemaphore = VK_FALSE; }),
              "timelineSemaphore is missing");
    EXPECT_EQ(refusal([](DeviceFacts& f) {
                  f.features12.bufferDeviceAddress = VK_FALSE;
                  f.features13.maintenance4 = VK_FALSE;
              }),
              "bufferDeviceAddress is missing, maintenance4 is missing");
    EXPECT_EQ(refusal([](DeviceFacts& f) { f.queues.pop_back(); }), "computeQueue is missing");
    EXPECT_EQ(refusal([](DeviceFacts& f) { f.properties.limits.maxPushConstantsSize = 64; }),
              "maxPushConstantsSize is only 64 bytes");
}

TEST(DescribeDevice, PrefersAQueueThatAlsoDraws) {
    DeviceFacts facts = goodFacts();
    EXPECT_EQ(facts.computeFamily(), 1u);
    facts.queues.push_back(
        {.queueFlags = vk::QueueFlagBits::eCompute | vk::QueueFlagBits::eGraphics, .queueCount = 1});
    EXPECT_EQ(facts.computeFamily(), 2u);
    facts.queues.back().queueCount = 0;
    EXPECT_EQ(facts.computeFamily(), 1u);
}

}  // namespace
}  // namespace helio::gpu
