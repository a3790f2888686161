#include "engine/shader/kernel_cache.hpp"
#include "engine/shader/source_tree.hpp"

#include <heliograph/error.hpp>
#include <heliograph/kernel.hpp>

#include <gtest/gtest.h>
#include <heliograph_kernels/shader.hpp>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace helio {
namespace {

namespace fs = std::filesystem;
const std::string headerPath = "tests/unit/shader/scale_values.glsl";
const std::string kernelPath = "tests/unit/shader/scale_values.comp";

/** A folder of edited shaders, in force while the test runs. */
class Reload : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("heliograph-reload-" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        ::setenv("HELIOGRAPH_SHADER_DIR", folder_.c_str(), 1);
    }
    void TearDown() override {
        ::unsetenv("HELIOGRAPH_SHADER_DIR");
        fs::remove_all(folder_);
    }
    void write(const std::string& path, const std::string& text) {
        fs::create_directories((folder_ / path).parent_path());
        std::ofstream(folder_ / path) << text;
    }
    fs::path folder_;
};

std::string scaledBy(const std::string& body) {
    return "float scaled(float value, float factor) {\n    return " + body + ";\n}\n";
}

TEST_F(Reload, AFileOfTheFolderTakesTheEmbeddedOnesPlace) {
    const std::string embedded = readShaderSource(headerPath).value();
    write(headerPath, scaledBy("value"));
    EXPECT_EQ(readShaderSource(headerPath), scaledBy("value"));
    EXPECT_NE(readShaderSource(kernelPath), std::nullopt) << "what the folder lacks is embedded";
    ::unsetenv("HELIOGRAPH_SHADER_DIR");
    EXPECT_EQ(readShaderSource(headerPath), embedded);
}

TEST_F(Reload, AnEditedIncludeIsCompiledAgainAndOnlyThen) {
    KernelWatcher watcher(shaders::scale_values);
    EXPECT_FALSE(watcher.poll()) << "the embedded files are what the build compiled";
    write(headerPath, scaledBy("value + factor"));
    EXPECT_TRUE(watcher.poll());
    EXPECT_FALSE(std::ranges::equal(watcher.kernel().spirv, shaders::scale_values.spirv));
    EXPECT_EQ(watcher.kernel().name, shaders::scale_values.name);
    const KernelCacheStatistics before = kernelCacheStatistics();
    EXPECT_FALSE(watcher.poll());
    EXPECT_EQ(kernelCacheStatistics().compiled, before.compiled);
    fs::remove(folder_ / headerPath);
    EXPECT_TRUE(watcher.poll()) << "back to the embedded text";
    EXPECT_TRUE(std::ranges::equal(watcher.kernel().spirv, shaders::scale_values.spirv));
}

TEST_F(Reload, ABrokenEditKeepsTheLastGoodKernelAndSaysWhy) {
    KernelWatcher watcher(shaders::scale_values);
    write(headerPath, scaledBy("value - factor"));
    ASSERT_TRUE(watcher.poll());
    const Kernel good = watcher.kernel();
    write(headerPath, scaledBy("valu - factor"));
    EXPECT_FALSE(watcher.poll());
    EXPECT_EQ(watcher.kernel().spirv.data(), good.spirv.data());
    EXPECT_EQ(watcher.problem().substr(0, watcher.problem().find('\n')),
              headerPath + ":2: 'valu' : undeclared identifier");
    write(headerPath, scaledBy("value - 2.0 * factor"));
    EXPECT_TRUE(watcher.poll());
    EXPECT_EQ(watcher.problem(), "");
}

TEST_F(Reload, AMissingIncludeIsFoundOnceItIsThere) {
    KernelWatcher watcher(shaders::scale_values);
    std::string text = readShaderSource(kernelPath).value();
    text.replace(text.find(headerPath), headerPath.size(), "shaders/new.glsl");
    write(kernelPath, text);
    EXPECT_FALSE(watcher.poll());
    EXPECT_NE(watcher.problem().find("shaders/new.glsl"), std::string::npos) << watcher.problem();
    write("shaders/new.glsl", scaledBy("factor"));
    EXPECT_TRUE(watcher.poll());
    EXPECT_EQ(watcher.problem(), "");
}

TEST_F(Reload, VariantsFollowEditedIncludes) {
    const KernelVariant variant{.defines = {{"FACTOR", "9.0"}}, .generated = ""};
    const Kernel first = compileVariant(shaders::scale_values, variant);
    const std::vector<std::uint32_t> words(first.spirv.begin(), first.spirv.end());
    write(headerPath, scaledBy("value / factor"));
    const Kernel second = compileVariant(shaders::scale_values, variant);
    EXPECT_FALSE(std::ranges::equal(second.spirv, first.spirv));
    EXPECT_TRUE(std::ranges::equal(first.spirv, words)) << "kernels made before stay valid";
    EXPECT_EQ(compileVariant(shaders::scale_values, variant).spirv.data(), second.spirv.data());
}

TEST_F(Reload, EmbeddedKernelsAreTheFoldersWhereItIs) {
    const auto words = [](const Kernel& kernel) {
        return std::vector<std::uint32_t>(kernel.spirv.begin(), kernel.spirv.end());
    };
    EXPECT_EQ(words(overlaid(shaders::scale_values)), words(shaders::scale_values)) << "nothing differs yet";
    write(headerPath, scaledBy("value / factor"));
    EXPECT_NE(words(overlaid(shaders::scale_values)), words(shaders::scale_values));
    const Kernel compiled =
        compileVariant(shaders::scale_values, {.defines = {{"FACTOR", "9.0"}}, .generated = ""});
    EXPECT_EQ(overlaid(compiled).spirv.data(), compiled.spirv.data())
        << "compiled here, from the folder already";
    ::unsetenv("HELIOGRAPH_SHADER_DIR");
    EXPECT_EQ(overlaid(shaders::scale_values).spirv.data(), shaders::scale_values.spirv.data());
}

TEST(Watcher, ChangesNothingWithoutAFolder) {
    KernelWatcher watcher(shaders::scale_values);
    EXPECT_FALSE(watcher.poll());
    EXPECT_EQ(watcher.kernel().spirv.data(), shaders::scale_values.spirv.data());
}

}  // namespace
}  // namespace helio
