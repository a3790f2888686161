#include <gtest/gtest.h>

#include <heliograph/error.hpp>

namespace helio {
namespace {

TEST(InputError, NamesFilePlaceFaultAndRemedyOnOneLine) {
    const InputError error("scene.gltf", "accessor 3", "count is negative", "give a count of at least 1");
    EXPECT_STREQ(error.what(), "scene.gltf: accessor 3: count is negative; give a count of at least 1");
}

TEST(InputError, LeavesOutEmptyParts) {
    EXPECT_STREQ(InputError("a.obj", "", "cannot be opened", "").what(), "a.obj: cannot be opened");
}

TEST(OutOfDeviceMemory, NamesResourceAndSize) {
    const OutOfDeviceMemory error("film", 1024, "heap 0 is full");
    EXPECT_STREQ(error.what(), "out of device memory: 'film' needs 1024 bytes: heap 0 is full");
}

TEST(GraphError, ListsEveryProblem) {
    const GraphError error({{"trace", "uHdr", "hdr", "is never written; declare it with writes()"}, {"", "", "", "no roots"}});
    EXPECT_EQ(error.problems.size(), 2u);
    EXPECT_NE(std::string(error.what()).find("pass 'trace': binding 'uHdr': resource 'hdr'"), std::string::npos);
}

}  // namespace
}  // namespace helio
