// Opening devices: by name, index and environment; refusals and missing parts as a user meets them.
#include "tests/support/device.hpp"

#include "engine/gpu/device_impl.hpp"
#include "tests/gpu/run_program.hpp"

#include <heliograph/vulkan.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace helio {
namespace {

using test::runProgram;

const std::string kProbe = GPU_PROBE;

TEST(ListDevices, DescribesEachOnce) {
    const std::vector<DeviceInfo> devices = listDevices();
    ASSERT_FALSE(devices.empty());
    for (const DeviceInfo& info : devices) {
        EXPECT_FALSE(info.name.empty());
        static constexpr const char* kTypes[] = {"cpu", "discrete", "integrated", "virtual", "other"};
        EXPECT_EQ(std::ranges::count(kTypes, info.type), 1) << info.type;
        EXPECT_EQ(info.usable, info.refusal.empty());
        if (!info.usable) continue;
        EXPECT_GE(info.subgroupSize, 1u);
        EXPECT_GE(info.maxStorageBufferRange, 1u << 27);
        EXPECT_GE(info.maxBufferSize, info.maxStorageBufferRange);
        EXPECT_GT(info.memoryBytes, 0u);
        EXPECT_FALSE(info.driver.empty());
        EXPECT_FALSE(info.driverVersion.empty());
        for (const Capability& capability : info.capabilities) {
            EXPECT_TRUE(capability.present || !capability.required) << capability.name;
        }
    }
}

TEST(OpenDevice, ByNameIndexAndInAnyCase) {
    const std::vector<DeviceInfo> devices = listDevices();
    DeviceOptions options = test::deviceOptions();
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (!devices[i].usable) continue;
        options.device = std::to_string(i);
        EXPECT_EQ(Device(options).info().name, devices[i].name);
        std::string upper = devices[i].name;
        for (char& c : upper) c = char(std::toupper(static_cast<unsigned char>(c)));
        options.device = upper;
        EXPECT_EQ(Device(options).info().name, devices[i].name);
    }
}

TEST(OpenDevice, TheEnvironmentSpeaksWhereTheOptionIsAutomatic) {
    const std::string name = test::device().info().name;
    const std::string first = name.substr(0, name.find(' '));
    auto finished = runProgram("HELIOGRAPH_DEVICE=" + first, kProbe + " open auto");
    EXPECT_EQ(finished.output, "opened " + name + "\n");
    finished = runProgram("HELIOGRAPH_DEVICE=voodoo", kProbe + " open auto");
    EXPECT_EQ(finished.status, 1);
    EXPECT_EQ(finished.output.find(
                  "DeviceError: HELIOGRAPH_DEVICE 'voodoo' names no device; the loader lists: 0 '"),
              0u)
        << finished.output;
    finished = runProgram("HELIOGRAPH_DEVICE=voodoo", kProbe + " open " + first);
    EXPECT_EQ(finished.output, "opened " + name + "\n") << "an explicit choice stands above the environment";
    finished = runProgram("HELIOGRAPH_DEVICE=", kProbe + " open auto");
    EXPECT_EQ(finished.status, 0) << "an empty variable says nothing";
}

TEST(OpenDevice, PrintsNothingOfItsOwn) {
    // Several drivers may be installed that find no hardware; what they and the loader say about that is not
    // for the user.
    const auto finished =
        runProgram("-u HELIOGRAPH_DEVICE -u VK_LOADER_DEBUG -u DISPLAY", kProbe + " open auto");
    EXPECT_EQ(finished.status, 0);
    EXPECT_EQ(finished.output.find("opened "), 0u) << finished.output;
    EXPECT_EQ(std::ranges::count(finished.output, '\n'), 1) << finished.output;
}

/** Environment under which devices seem to lack something (see lesser_device_layer.cpp). */
std::string lacking(const std::string& what) {
    return "-u HELIOGRAPH_DEVICE VK_LAYER_PATH=" GPU_LAYER_FOLDER
           " VK_INSTANCE_LAYERS=VK_LAYER_HELIOGRAPH_lesser_device HELIOGRAPH_TEST_LACKS=" +
           what;
}

TEST(OpenDevice, BelowVulkan13IsRefusedWithTheReasonAndLogged) {
    const std::string name = listDevices().front().name;
    auto finished = runProgram(lacking("vulkan13"), kProbe + " open auto");
    EXPECT_EQ(finished.status, 1);
    EXPECT_NE(finished.output.find("heliograph: warning: device 0 '" + name +
                                   "' is refused: apiVersion is only 1.2.0 and 1.3 is needed\n"),
              std::string::npos)
        << finished.output;
    EXPECT_NE(finished.output.find("DeviceError: no usable Vulkan device; the loader lists: 0 '" + name +
                                   "' (refused: apiVersion is only 1.2.0 and 1.3 is needed)"),
              std::string::npos)
        << finished.output;
    finished = runProgram(lacking("vulkan13"), kProbe + " open 0");
    EXPECT_EQ(finished.status, 1) << finished.output;
    EXPECT_NE(finished.output.find("DeviceError: device '0' names no usable device"), std::string::npos)
        << finished.output;
    finished = runProgram(lacking("vulkan13"), kProbe + " list");
    EXPECT_EQ(finished.output.find(name + "|1.2.0|apiVersion is only 1.2.0 and 1.3 is needed"), 0u)
        << finished.output;
}

TEST(OpenDevice, WithoutARequiredFeatureIsRefusedByTheFeaturesName) {
    for (const std::string feature : {"timelineSemaphore", "synchronization2"}) {
        const auto finished = runProgram(lacking(feature), kProbe + " open auto");
        EXPECT_EQ(finished.status, 1);
        EXPECT_NE(finished.output.find("(refused: " + feature + " is missing)"), std::string::npos)
            << finished.output;
    }
    const auto finished = runProgram(lacking("smallStorageRange"), kProbe + " open auto");
    EXPECT_NE(finished.output.find("(refused: maxStorageBufferRange is only 65536 bytes)"), std::string::npos)
        << finished.output;
}

TEST(OpenDevice, WithoutAnOptionalFeatureOpensAndSaysSo) {
    const auto finished =
        runProgram(lacking("shaderInt64,shaderBufferInt64Atomics,shaderFloat64"), kProbe + " lacking auto");
    EXPECT_EQ(finished.status, 0);
    for (const std::string feature : {"shaderInt64", "shaderBufferInt64Atomics", "shaderFloat64"}) {
        EXPECT_NE(finished.output.find("lacks " + feature + "\n"), std::string::npos) << finished.output;
    }
}

TEST(OpenDevice, WithoutAnyDriverSaysWhatToInstall) {
    const auto finished = runProgram("VK_ICD_FILENAMES=/nonexistent.json VK_DRIVER_FILES=/nonexistent.json",
                                     kProbe + " open auto");
    EXPECT_EQ(finished.status, 1);
    EXPECT_NE(
        finished.output.find("DeviceError: no Vulkan driver is installed (Debian: mesa-vulkan-drivers)"),
        std::string::npos)
        << finished.output;
}

TEST(OpenDevice, WithoutTheValidationLayerNamesItsPackage) {
    const auto finished = runProgram("VK_LAYER_PATH=/nonexistent", kProbe + " validate");
    EXPECT_EQ(finished.status, 1);
    EXPECT_NE(finished.output.find(
                  "VK_LAYER_KHRONOS_validation is not installed (Debian: vulkan-validationlayers)"),
              std::string::npos)
        << finished.output;
}

TEST(OpenDevice, GivesNativeHandles) {
    Device& device = test::device();
    const VulkanHandles handles = vulkanHandles(device);
    EXPECT_NE(handles.instance, VkInstance{});
    EXPECT_NE(handles.physicalDevice, VkPhysicalDevice{});
    EXPECT_NE(handles.device, VkDevice{});
    EXPECT_NE(handles.queue, VkQueue{});
    EXPECT_LT(handles.queueFamily, device.impl().facts.queues.size());
    const DeviceBuffer buffer(device, "b", 16);
    EXPECT_NE(vulkanBuffer(buffer), VkBuffer{});
    const DeviceImage image(device, "i", 4, 4, Format::R32F);
    EXPECT_NE(vulkanImage(image), VkImage{});
}

TEST(OpenDevice, MayBeMovedWhileBuffersRefToIt) {
    Device first(test::deviceOptions());
    DeviceBuffer buffer = makeBuffer(first, "kept", std::vector<int>{1, 2, 3});
    Device second = std::move(first);
    std::vector<int> out(3);
    buffer.download(out.data(), 12);
    EXPECT_EQ(out, (std::vector<int>{1, 2, 3}));
    buffer = DeviceBuffer();
}

}  // namespace
}  // namespace helio
