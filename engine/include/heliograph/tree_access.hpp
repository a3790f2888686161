#pragma once
/** @file
 * How kernels read the tree over triangles and keep their way through it. Which of the ways is fastest is the
 * device's matter: it is measured when asked for (`heliograph info --measure`), never by a render, kept in
 * the folder of the pipeline cache, one file per device and driver build, and found there by later processes.
 * Pictures are the same.
 *
 *     keepTreeAccess(device, fastestAccess(measureTreeAccess(device)));
 */
#include <heliograph/device.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace helio {

struct TreeAccess {
    bool nodesInStorage = false;  ///< storage buffer; else texel buffer
    bool addressedStack = false;  ///< entries in an indexed array; else moved through registers, where few
    bool operator==(const TreeAccess&) const = default;
};

/** As users read it: "texel buffer, moved stack". */
std::string describe(const TreeAccess& access);

/** The way kept for this device, or texel buffer and moved stack: the fastest on lavapipe. Costs a look for a
 * file. An empty folder is the pipeline cache's. Never throws. */
TreeAccess keptTreeAccess(const Device& device, const std::filesystem::path& folder = {});
/** Returns whether it could be written. */
bool keepTreeAccess(const Device& device, const TreeAccess& access, const std::filesystem::path& folder = {});

struct MeasuredAccess {
    TreeAccess access;
    double seconds = 0;  ///< median, for the rays of a run
};

/** Sends rays through a tree of some 130,000 triangles in every way, in turns, `runs` times each. The first
 * is the way that is taken without a measurement. */
std::vector<MeasuredAccess> measureTreeAccess(Device& device, int runs = 9);

/** The fastest, where it is faster than the first by more than such measurements differ; else the first. Not
 * of none. */
TreeAccess fastestAccess(const std::vector<MeasuredAccess>& measured);

}  // namespace helio
