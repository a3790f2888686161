#pragma once
/** @file
 * The device of GPU tests. Validation and synchronization validation are on, and any message of any device
 * made in the process fails the test that was running; one that comes later fails the run.
 */
#include <heliograph/device.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace helio::test {

/** Options of a validated device with a pipeline cache of the process's own. HELIOGRAPH_DEVICE is honoured.
 */
DeviceOptions deviceOptions();

/** One device shared by the tests of an executable, opened at the first call, closed after the last test. A
 * missing device throws, so that the test fails. */
Device& device();

/** Closes it. Only for programs without tests, before main() ends: afterwards the driver is gone. */
void closeDevice();

/** The messages since the last call, taken away: a test that provokes some takes them, so that it does not
 * fail. */
std::vector<std::string> takeValidationMessages();

/** A folder of the process's own, removed when it ends. */
const std::filesystem::path& scratchFolder();

}  // namespace helio::test
