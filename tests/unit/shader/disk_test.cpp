#include "engine/shader/kernel_cache.hpp"
#include "engine/shader/spirv_files.hpp"

#include <gtest/gtest.h>
#include <heliograph_kernels/shader.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace helio {
namespace {

namespace fs = std::filesystem;

/** Keeps every test of this executable out of the user's cache folder. */
class OwnCacheFolder : public testing::Environment {
public:
    void SetUp() override {
        // The child process of a test below uses its parent's folder; its exit status says what it did.
        if (std::getenv("HELIOGRAPH_TEST_CHILD") != nullptr) {
            compileVariant(shaders::scale_values, {.defines = {{"FACTOR", "77.0"}}, .generated = ""});
            const KernelCacheStatistics statistics = kernelCacheStatistics();
            std::_Exit(static_cast<int>(10 + 2 * statistics.compiled + statistics.loaded));
        }
        folder_ = fs::temp_directory_path() / ("heliograph-spirv-" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        ::setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    }
    void TearDown() override {
        if (!folder_.empty()) fs::remove_all(folder_);
    }

private:
    fs::path folder_;
};
const auto* const environment = testing::AddGlobalTestEnvironment(new OwnCacheFolder);

const std::string path = "probe";
const std::string glsl =
    "#version 460\n#extension GL_GOOGLE_include_directive : require\n"
    "#include \"tests/unit/shader/scale_values.glsl\"\nlayout(local_size_x = N) in;\nvoid main() {}\n";

KernelVariant width(const std::string& n) {
    return {.defines = {{"N", n}}, .generated = ""};
}

class SpirvFiles : public testing::Test {
protected:
    void SetUp() override { fs::remove_all(spirvFolder()); }
    CompiledGlsl store() {
        CompiledGlsl compiled = compileGlsl(path, glsl, width("8"));
        EXPECT_TRUE(compiled.ok) << compiled.messages;
        storeSpirv(path, glsl, width("8"), compiled);
        return compiled;
    }
    fs::path onlyFile() {
        EXPECT_EQ(std::distance(fs::directory_iterator(spirvFolder()), fs::directory_iterator()), 1);
        return fs::directory_iterator(spirvFolder())->path();
    }
};

TEST_F(SpirvFiles, GiveBackWhatWasStored) {
    const CompiledGlsl compiled = store();
    const auto loaded = loadSpirv(path, glsl, width("8"));
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->spirv, compiled.spirv);
    EXPECT_EQ(loaded->includes, compiled.includes);
    EXPECT_EQ(loaded->includes.count("tests/unit/shader/scale_values.glsl"), 1u);
}

TEST_F(SpirvFiles, GiveNothingForAnythingElse) {
    store();
    EXPECT_FALSE(loadSpirv(path, glsl, width("16")));
    EXPECT_FALSE(loadSpirv(path, glsl + " ", width("8")));
    EXPECT_FALSE(loadSpirv("other", glsl, width("8")));
    EXPECT_FALSE(loadSpirv(path, glsl, {.defines = {{"N", "8"}}, .generated = "//"}));
    EXPECT_TRUE(loadSpirv(path, glsl, width("8")));
}

TEST_F(SpirvFiles, GiveNothingOnceAnIncludedFileIsAnother) {
    store();
    const fs::path overlay = fs::temp_directory_path() / ("heliograph-overlay-" + std::to_string(::getpid()));
    fs::create_directories(overlay / "tests/unit/shader");
    std::ofstream(overlay / "tests/unit/shader/scale_values.glsl") << "// nothing\n";
    ::setenv("HELIOGRAPH_SHADER_DIR", overlay.c_str(), 1);
    EXPECT_FALSE(loadSpirv(path, glsl, width("8")));
    ::unsetenv("HELIOGRAPH_SHADER_DIR");
    fs::remove_all(overlay);
    EXPECT_TRUE(loadSpirv(path, glsl, width("8")));
}

TEST_F(SpirvFiles, DamagedOnesArePassedOver) {
    store();
    const fs::path file = onlyFile();
    std::ifstream in(file, std::ios::binary);
    const std::string good(std::istreambuf_iterator<char>(in), {});
    in.close();
    for (const std::size_t at :
         {std::size_t(0), std::size_t(9), std::size_t(30), good.size() / 2, good.size() - 1}) {
        std::string bad = good;
        bad[at] = char(bad[at] ^ 1);
        std::ofstream(file, std::ios::binary) << bad;
        EXPECT_FALSE(loadSpirv(path, glsl, width("8"))) << "byte " << at;
        std::ofstream(file, std::ios::binary) << good.substr(0, at);
        EXPECT_FALSE(loadSpirv(path, glsl, width("8"))) << "cut at " << at;
    }
    std::ofstream(file, std::ios::binary) << good;
    EXPECT_TRUE(loadSpirv(path, glsl, width("8")));
}

TEST_F(SpirvFiles, OldOnesGo) {
    fs::create_directories(spirvFolder());
    for (std::size_t i = 0; i < maxSpirvFiles + 10; ++i) {
        const fs::path file = spirvFolder() / std::to_string(i);
        std::ofstream(file) << "x";
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1 + i));
    }
    store();
    EXPECT_EQ(std::distance(fs::directory_iterator(spirvFolder()), fs::directory_iterator()),
              std::ptrdiff_t(maxSpirvFiles));
    EXPECT_TRUE(loadSpirv(path, glsl, width("8")));
    EXPECT_FALSE(fs::exists(spirvFolder() / std::to_string(maxSpirvFiles + 9))) << "the oldest";
    EXPECT_TRUE(fs::exists(spirvFolder() / "0"));
}

TEST_F(SpirvFiles, ASecondProcessCompilesNothing) {
    const auto child = [] {
        const std::string command =
            "HELIOGRAPH_TEST_CHILD=1 '" + fs::read_symlink("/proc/self/exe").string() + "' > /dev/null";
        const int status = std::system(command.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    };
    EXPECT_EQ(child(), 12) << "the first compiles";
    EXPECT_EQ(child(), 11) << "the second loads";
}

}  // namespace
}  // namespace helio
