// Validation messages are seen: by the device, by the listener of the GPU tests, and at teardown.
#include "engine/gpu/device_impl.hpp"
#include "tests/gpu/run_program.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

namespace helio {
namespace {

using test::runProgram;

TEST(Validation, CollectsErrorsWithTheNamesOfResources) {
    Device device(test::deviceOptions());
    EXPECT_TRUE(device.validationMessages().empty());
    const DeviceBuffer buffer(device, "the named buffer", 1024);
    {
        gpu::Recording commands = device.impl().queue.begin("wrong");
        commands->fillBuffer(*buffer.impl()->resource.buffer, 2, 4, 0);
    }
    const std::vector<std::string> messages = device.validationMessages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages, test::takeValidationMessages()) << "what the device has, the listener has";
    EXPECT_NE(messages[0].find("VUID-vkCmdFillBuffer-dstOffset-00025"), std::string::npos) << messages[0];
    EXPECT_EQ(messages[0].find("error: "), 0u) << messages[0];
}

TEST(Validation, SynchronizationIsCheckedToo) {
    Device device(test::deviceOptions());
    const DeviceBuffer buffer(device, "the raced buffer", 1024);
    gpu::Recording commands = device.impl().queue.begin("race");
    commands->fillBuffer(*buffer.impl()->resource.buffer, 0, 1024, 1);
    commands->fillBuffer(*buffer.impl()->resource.buffer, 0, 1024, 2);
    device.impl().queue.submit(std::move(commands));
    const std::vector<std::string> messages = test::takeValidationMessages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("SYNC-HAZARD-WRITE-AFTER-WRITE"), std::string::npos) << messages[0];
    EXPECT_NE(messages[0].find("the raced buffer"), std::string::npos) << messages[0];
}

TEST(Validation, IsSilentAndEmptyWhereNotAskedFor) {
    const Device device({.pipelineCache = test::scratchFolder() / "pipelines"});
    EXPECT_TRUE(device.validationMessages().empty());
    EXPECT_FALSE(device.impl().instance.validated());
}

struct Culprit {
    const char* test;
    int status;
    const char* says;
};

TEST(Listener, FailsTheTestDuringWhichAMessageCame) {
    const Culprit culprits[] = {
        {"Innocent", 0, "[  PASSED  ] 1 test."},
        {"WrongCommand", 1, "[  FAILED  ] Culprit.WrongCommand"},
        {"MissingBarrier", 1, "[  FAILED  ] Culprit.MissingBarrier"},
        {"MissingSemaphore", 1, "vkQueueSubmit2: Hazard WRITE_AFTER_WRITE"},
        {"LeaksUntilTheDeviceIsClosed", 1, "[  FAILED  ] Vulkan validation outside of a test: error: "},
        {"Confesses", 0, "[  PASSED  ] 1 test."},
    };
    for (const Culprit& culprit : culprits) {
        SCOPED_TRACE(culprit.test);
        const test::Finished finished =
            runProgram("", std::string(GPU_CULPRIT) + " --gtest_filter=Culprit." + culprit.test);
        EXPECT_EQ(finished.status, culprit.status) << finished.output;
        EXPECT_NE(finished.output.find(culprit.says), std::string::npos) << finished.output;
    }
}

TEST(Listener, BlamesOnlyTheCulprit) {
    const test::Finished finished = runProgram("", GPU_CULPRIT);
    EXPECT_EQ(finished.status, 1);
    EXPECT_NE(finished.output.find("[       OK ] Culprit.Innocent"), std::string::npos) << finished.output;
    EXPECT_NE(finished.output.find("[       OK ] Culprit.Confesses"), std::string::npos) << finished.output;
    EXPECT_NE(finished.output.find(" 3 FAILED TESTS"), std::string::npos) << finished.output;
}

}  // namespace
}  // namespace helio
