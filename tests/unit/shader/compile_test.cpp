#include "engine/shader/kernel_cache.hpp"
#include "engine/shader/reflection.hpp"
#include "engine/shader/spirv_trimmer.hpp"
#include "engine/shader/spirv_validator.hpp"

#include <heliograph/error.hpp>
#include <heliograph/kernel.hpp>

#include <gtest/gtest.h>
#include <heliograph_kernels/shader.hpp>

#include <algorithm>
#include <bit>
#include <string>
#include <thread>
#include <vector>

namespace helio {
namespace {

const std::string header = "#version 460\n#extension GL_GOOGLE_include_directive : require\n";

std::string messageOf(const std::string& name, const std::string& glsl, const KernelVariant& variant = {}) {
    try {
        compileKernel(name, glsl, variant);
    } catch (const ShaderError& error) {
        return error.what();
    }
    return "";
}

TEST(Variant, EmptyOneIsTheBuildsSpirvWordForWord) {
    for (const Kernel* kernel : {&shaders::scale_values, &shaders::interface}) {
        const Kernel again = compileVariant(*kernel, {});
        EXPECT_TRUE(std::ranges::equal(again.spirv, kernel->spirv)) << kernel->name;
        EXPECT_NE(again.spirv.data(), kernel->spirv.data());
        EXPECT_EQ(again.name, kernel->name);
        EXPECT_EQ(again.source, kernel->source);
    }
}

TEST(Variant, DefinesAndGeneratedTextReachTheKernel) {
    const Kernel defined =
        compileVariant(shaders::scale_values, {.defines = {{"FACTOR", "3.0"}}, .generated = ""});
    EXPECT_FALSE(std::ranges::equal(defined.spirv, shaders::scale_values.spirv));
    const Kernel generated =
        compileVariant(shaders::scale_values, {.defines = {}, .generated = "#define FACTOR 3.0\n"});
    EXPECT_TRUE(std::ranges::equal(generated.spirv, defined.spirv));
}

TEST(Variant, OfAKernelCompiledAtRunTime) {
    const Kernel kernel = compileKernel("runtime", header +
                                                       "#ifndef N\n#define N 1\n#endif\n"
                                                       "layout(local_size_x = N) in;\nvoid main() {}\n");
    const Kernel wide = compileVariant(kernel, {.defines = {{"N", "16"}}, .generated = ""});
    EXPECT_FALSE(std::ranges::equal(wide.spirv, kernel.spirv));
    EXPECT_EQ(wide.name, "runtime");
}

TEST(Variant, LosesWhatItsConstantsRuleOut) {
    const auto kernel = [](const std::string& name, const std::string& constant) {
        return compileKernel(name,
                             header +
                                 "layout(local_size_x = 1) in;\n"
                                 "layout(std430, binding = 0) buffer Values { float values[]; };\n"
                                 "float heavy(float x) {\n"
                                 "    for (int i = 0; i < 9; ++i) x = sin(x) + cos(2.0 * x) * sqrt(x);\n"
                                 "    return x;\n"
                                 "}\n"
                                 "void main() {\n"
                                 "    const bool WITH = " +
                                 constant +
                                 ";\n"
                                 "    float x = 1.0;\n"
                                 "    if (WITH) x = heavy(values[1]);\n"
                                 "    values[0] = x;\n"
                                 "}\n");
    };
    const Kernel with = kernel("with", "true"), without = kernel("without", "false");
    const auto trimmed = [](const Kernel& k) {
        return trimmedSpirv(std::vector(k.spirv.begin(), k.spirv.end()));
    };
    // The function is there, called or not, until what nothing calls is taken out.
    EXPECT_LT(trimmed(without).size(), without.spirv.size() * 3 / 4);
    EXPECT_GT(trimmed(with).size(), trimmed(without).size() * 3 / 2);
}

TEST(Compile, SpecializedKernelsHaveTheirConstantsWrittenIn) {
    const Kernel kernel = compileKernel("special",
                                        header +
                                            "layout(constant_id = 3) const bool WITH = true;\n"
                                            "layout(constant_id = 7) const int TURNS = 2;\n"
                                            "layout(constant_id = 9) const float SCALE = 0.5;\n"
                                            "layout(local_size_x = 1) in;\n"
                                            "layout(std430, binding = 0) buffer Values { float values[]; };\n"
                                            "float heavy(float x) {\n"
                                            "    for (int i = 0; i < TURNS; ++i) x = sin(x) + cos(2.0 * x);\n"
                                            "    return x;\n"
                                            "}\n"
                                            "void main() {\n"
                                            "    if (WITH) values[1] = heavy(values[0]);\n"
                                            "    values[2] = SCALE * float(2 * TURNS);\n"
                                            "}\n",
                                        {});
    const std::uint32_t threeQuarters = std::bit_cast<std::uint32_t>(0.75f);
    const std::pair<std::uint32_t, std::uint32_t> all[] = {{3, 0}, {7, 5}, {9, threeQuarters}};
    const std::vector<std::uint32_t> words = specializedSpirv(kernel.spirv, all);
    ASSERT_FALSE(words.empty());
    EXPECT_EQ(spirvFault(words), "");
    const KernelReflection reflection = reflectSpirv("special", words);
    EXPECT_TRUE(reflection.specConstants.empty());
    EXPECT_EQ(reflection.bindings.size(), reflect(kernel).bindings.size());
    EXPECT_LT(words.size(), kernel.spirv.size() * 3 / 4);  // without what nothing calls now
    // What is stored is 0.75 * 10, folded.
    const std::uint32_t folded = std::bit_cast<std::uint32_t>(7.5f);
    EXPECT_NE(std::find(words.begin(), words.end(), folded), words.end());
    // Constants that are not named keep their defaults; those named again come from the disk, the same.
    EXPECT_GT(specializedSpirv(kernel.spirv, {}).size(), words.size());
    EXPECT_EQ(specializedSpirv(kernel.spirv, all), words);
}

TEST(Compile, ErrorsNameFileAndLine) {
    EXPECT_EQ(messageOf("broken", header + "void main() {\n    float i = nothing;\n}\n"),
              "kernel 'broken' does not compile:\nbroken:4: 'nothing' : undeclared identifier");
    // Definitions and includes before the fault do not shift its line.
    EXPECT_EQ(messageOf("after_include",
                        header + "#include \"tests/unit/shader/scale_values.glsl\"\nvoid main() { x; }\n",
                        {.defines = {{"A", "1"}, {"B", "2"}}, .generated = ""}),
              "kernel 'after_include' does not compile:\nafter_include:4: 'x' : undeclared identifier");
}

TEST(Compile, ErrorsInsideAnIncludeNameTheIncludedFile) {
    const std::string text = header + "#include \"generated.glsl\"\nvoid main() {}\n";
    const std::string message =
        messageOf("includer", text, {.defines = {}, .generated = "\nint f() { return y; }\n"});
    EXPECT_NE(message.find("\ngenerated.glsl:2: 'y' : undeclared identifier"), std::string::npos) << message;
}

TEST(Compile, MissingIncludeIsNamed) {
    const std::string message =
        messageOf("lost", header + "#include \"shaders/none.glsl\"\nvoid main() {}\n");
    EXPECT_NE(message.find("lost:3: "), std::string::npos) << message;
    EXPECT_NE(message.find("shaders/none.glsl"), std::string::npos) << message;
}

TEST(Compile, EndlessIncludeIsAnError) {
    const std::string text = header + "#include \"generated.glsl\"\nvoid main() {}\n";
    EXPECT_NE(messageOf("endless", text, {.defines = {}, .generated = "#include \"generated.glsl\"\n"}), "");
}

TEST(Compile, NoMainIsAnError) {
    EXPECT_NE(messageOf("headless", header + "int f() { return 1; }\n"), "");
}

TEST(Compile, KernelWithoutSourceHasNoVariant) {
    EXPECT_THROW(compileVariant(Kernel{"x", {}, "passes/none.comp"}, {}), ShaderError);
}

TEST(Cache, SameSourceAndVariantCompileOnce) {
    const KernelVariant variant{.defines = {{"FACTOR", "5.0"}}, .generated = ""};
    const KernelCacheStatistics before = kernelCacheStatistics();
    const Kernel first = compileVariant(shaders::scale_values, variant);
    const Kernel second = compileVariant(shaders::scale_values, variant);
    const KernelCacheStatistics after = kernelCacheStatistics();
    EXPECT_EQ(first.spirv.data(), second.spirv.data());
    EXPECT_EQ(after.compiled - before.compiled, 1u);
    EXPECT_EQ(after.reused - before.reused, 1u);
    compileVariant(shaders::scale_values, {.defines = {{"FACTOR", "5.5"}}, .generated = ""});
    EXPECT_EQ(kernelCacheStatistics().compiled - before.compiled, 2u);
}

TEST(Cache, ManyThreadsShareOneCompilation) {
    constexpr int threads = 8;
    constexpr int variants = 6;
    const KernelCacheStatistics before = kernelCacheStatistics();
    std::vector<std::array<const std::uint32_t*, variants>> words(threads);
    {
        std::vector<std::jthread> workers;
        for (int t = 0; t < threads; ++t) {
            workers.emplace_back([t, &words] {
                for (int v = 0; v < variants; ++v) {
                    const int which = (v + t) % variants;
                    const std::string factor = std::to_string(100 + which) + ".0";
                    words[t][which] = compileVariant(shaders::scale_values,
                                                     {.defines = {{"FACTOR", factor}}, .generated = ""})
                                          .spirv.data();
                }
            });
        }
    }
    for (int t = 1; t < threads; ++t) EXPECT_EQ(words[t], words[0]);
    EXPECT_EQ(kernelCacheStatistics().compiled - before.compiled, std::uint64_t(variants));
    EXPECT_EQ(kernelCacheStatistics().reused - before.reused, std::uint64_t((threads - 1) * variants));
}

}  // namespace
}  // namespace helio
