#include "engine/shader/source_tree.hpp"

#include <heliograph/kernel.hpp>

#include <gtest/gtest.h>
#include <heliograph_kernels/shader.hpp>

#include <algorithm>

namespace helio {
namespace {

TEST(EmbeddedKernel, HoldsSpirvNameAndSource) {
    const Kernel& kernel = shaders::scale_values;
    EXPECT_EQ(kernel.name, "shader/scale_values");
    EXPECT_EQ(kernel.source, "tests/unit/shader/scale_values.comp");
    ASSERT_GT(kernel.spirv.size(), 5u);
    EXPECT_EQ(kernel.spirv[0], 0x07230203u);  // the magic number of SPIR-V
    EXPECT_EQ(kernel.spirv[1], 0x00010600u);  // version 1.6
}

TEST(EmbeddedTree, HoldsWhatAKernelOutsideTheLibraryIsMadeOf) {
    const std::vector<ShaderSource> sources = embeddedShaderSources();
    EXPECT_TRUE(std::is_sorted(sources.begin(), sources.end(),
                               [](const ShaderSource& a, const ShaderSource& b) { return a.path < b.path; }));
    for (const char* path : {"tests/unit/shader/scale_values.comp", "tests/unit/shader/scale_values.glsl"}) {
        const auto text = readShaderSource(path);
        ASSERT_TRUE(text) << path;
        EXPECT_EQ(text->back(), '\n') << path;
        EXPECT_NE(text->find(path[26] == '.' ? "#version 460" : "scaled"), std::string::npos) << path;
    }
}

TEST(EmbeddedTree, FindsNothingOutsideOfItsRoot) {
    EXPECT_FALSE(readShaderSource("shaders/none.glsl"));
    EXPECT_FALSE(readShaderSource("/etc/passwd"));
    EXPECT_FALSE(readShaderSource("shaders/../../etc/passwd"));
    EXPECT_FALSE(readShaderSource(""));
}

}  // namespace
}  // namespace helio
