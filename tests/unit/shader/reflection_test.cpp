#include "engine/shader/reflection.hpp"

#include "engine/shader/kernel_cache.hpp"
#include "engine/shader/spirv_validator.hpp"

#include <heliograph/error.hpp>

#include <gtest/gtest.h>
#include <heliograph_kernels/shader.hpp>

#include <random>
#include <vector>

namespace helio {
namespace {

const KernelReflection& interface() {
    return reflect(shaders::interface);
}

struct Expected {
    const char* name;
    unsigned set, binding;
    BindingKind kind;
    bool readable, writable;
    Format format;
    TexelType texel;
    unsigned count;
};

TEST(Reflection, GivesEveryBinding) {
    using enum BindingKind;
    const Expected expected[] = {
        {"uItems", 0, 0, StorageBuffer, true, false, Format::Undefined, TexelType::None, 1},
        {"Nameless", 0, 1, StorageBuffer, false, true, Format::Undefined, TexelType::None, 1},
        {"uTotals", 0, 2, StorageBuffer, true, true, Format::Undefined, TexelType::None, 1},
        {"uSettings", 0, 3, UniformBuffer, true, false, Format::Undefined, TexelType::None, 1},
        {"uNodes", 0, 4, UniformTexelBuffer, true, false, Format::Undefined, TexelType::Float, 1},
        {"uIndices", 0, 5, UniformTexelBuffer, true, false, Format::Undefined, TexelType::Uint, 1},
        {"uCounters", 0, 6, StorageTexelBuffer, true, true, Format::R32UI, TexelType::Uint, 1},
        {"uHdr", 1, 0, StorageImage, false, true, Format::RGBA32F, TexelType::Float, 1},
        {"uLdr", 1, 1, StorageImage, true, false, Format::RGBA8, TexelType::Float, 1},
        {"uAlbedo", 1, 2, SampledImage, true, false, Format::Undefined, TexelType::Float, 1},
        {"uLayers", 1, 3, SampledImage, true, false, Format::Undefined, TexelType::Float, 4},
        {"uUnused", 2, 5, StorageBuffer, true, false, Format::Undefined, TexelType::None, 1},
    };
    ASSERT_EQ(interface().bindings.size(), std::size(expected));
    for (std::size_t i = 0; i < std::size(expected); ++i) {
        const ReflectedBinding& got = interface().bindings[i];
        const Expected& want = expected[i];
        EXPECT_EQ(got.name, want.name);
        EXPECT_EQ(got.set, want.set) << want.name;
        EXPECT_EQ(got.binding, want.binding) << want.name;
        EXPECT_EQ(got.kind, want.kind) << want.name << " is a " << bindingKindName(got.kind);
        EXPECT_EQ(got.readable, want.readable) << want.name;
        EXPECT_EQ(got.writable, want.writable) << want.name;
        EXPECT_EQ(got.format, want.format) << want.name;
        EXPECT_EQ(got.texel, want.texel) << want.name;
        EXPECT_EQ(got.count, want.count) << want.name;
        EXPECT_EQ(got.used, got.name != "uUnused") << want.name;
    }
    EXPECT_EQ(interface().binding("uHdr"), &interface().bindings[7]);
    EXPECT_EQ(interface().binding("Items"), nullptr) << "the instance name hides the block's";
}

/** Offsets worked out by hand from the std430 rules (GLSL 4.60, 7.6.2.2). */
TEST(Reflection, GivesMembersOffsets) {
    const ReflectedBinding& items = *interface().binding("uItems");
    ASSERT_EQ(items.members.size(), 2u);
    EXPECT_EQ(items.members[0].name, "count");
    EXPECT_EQ(items.members[1].offset, 16u);
    EXPECT_EQ(items.members[1].arrayStride, 80u);  // vec3+uint 16, mat3 48, float[3] 12, rounded up to 16
    const std::vector<ReflectedMember>& item = items.members[1].members;
    ASSERT_EQ(item.size(), 4u);
    EXPECT_EQ(items.members[1].type, "Item");
    EXPECT_EQ(item[0].type, "vec3");
    EXPECT_EQ(item[1].offset, 12u);
    EXPECT_EQ(item[2].type, "mat3");
    EXPECT_EQ(item[2].offset, 16u);
    EXPECT_EQ(item[2].matrixStride, 16u);
    EXPECT_EQ(item[3].offset, 64u);
    EXPECT_EQ(item[3].arrayStride, 4u);
    EXPECT_EQ(interface().binding("uTotals")->bytes, 12u);
    EXPECT_EQ(interface().binding("uSettings")->bytes, 20u);
}

TEST(Reflection, GivesPushConstants) {
    const ReflectedPushConstants& push = interface().pushConstants;
    EXPECT_EQ(push.name, "uPush");
    EXPECT_EQ(push.bytes, 88u);
    ASSERT_EQ(push.members.size(), 4u);
    EXPECT_EQ(push.members[1].offset, 64u);
    EXPECT_EQ(push.members[2].offset, 76u);
    EXPECT_EQ(push.members[3].offset, 80u);
    EXPECT_EQ(push.members[3].type, "uvec2");
    EXPECT_EQ(reflect(shaders::scale_values).pushConstants.bytes, 0u);
}

TEST(Reflection, GivesSpecializationConstantsAndLocalSize) {
    const std::vector<ReflectedSpecConstant>& constants = interface().specConstants;
    ASSERT_EQ(constants.size(), 5u);
    EXPECT_EQ(interface().specConstant("SCALE")->id, 1u);
    EXPECT_EQ(interface().specConstant("SCALE")->defaultValue, SpecValue(0.5f));
    EXPECT_EQ(interface().specConstant("FLIP")->defaultValue, SpecValue(true));
    EXPECT_EQ(interface().specConstant("BIAS")->defaultValue, SpecValue(std::int32_t(-3)));
    EXPECT_EQ(interface().specConstant("WORKGROUP")->defaultValue, SpecValue(32u));
    EXPECT_EQ(interface().localSize, (std::array<std::uint32_t, 3>{32, 1, 2}));
    EXPECT_EQ(interface().localSizeIds[0], 3u);
    EXPECT_EQ(interface().localSizeIds[1], 9u);
    EXPECT_FALSE(interface().localSizeIds[2]);
    EXPECT_EQ(interface().localSizeWith({{"WORKGROUP", 8u}, {"local_size_y", 4u}, {"SCALE", 2.0f}}),
              (std::array<std::uint32_t, 3>{8, 4, 2}));
    EXPECT_THROW(interface().localSizeWith({{"WORKGROUPS", 8u}}), ShaderError);
    EXPECT_THROW(interface().localSizeWith({{"WORKGROUP", 8.0f}}), ShaderError);
    EXPECT_EQ(reflect(shaders::scale_values).localSize, (std::array<std::uint32_t, 3>{64, 1, 1}));
}

TEST(Reflection, GivesCapabilities) {
    for (const char* name :
         {"Shader", "Int64", "Int64Atomics", "GroupNonUniformArithmetic", "SampledBuffer"}) {
        EXPECT_TRUE(interface().needs(name)) << name;
    }
    EXPECT_FALSE(interface().needs("Float64"));
    EXPECT_FALSE(reflect(shaders::scale_values).needs("Int64"));
}

TEST(Reflection, IsKeptPerKernel) {
    EXPECT_EQ(&reflect(shaders::interface), &reflect(shaders::interface));
    const std::vector<std::uint32_t> copy(shaders::interface.spirv.begin(), shaders::interface.spirv.end());
    EXPECT_EQ(&reflect(Kernel{"copy", copy, ""}), &interface());
    EXPECT_NE(&reflect(shaders::scale_values), &interface());
}

void expectRefused(std::vector<std::uint32_t> words, const std::string& part) {
    try {
        reflectSpirv("broken", words);
        FAIL() << "was accepted, wanted: " << part;
    } catch (const ShaderError& error) {
        EXPECT_NE(std::string(error.what()).find("kernel 'broken': "), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(Reflection, RefusesBrokenSpirv) {
    const std::vector<std::uint32_t> good(shaders::scale_values.spirv.begin(),
                                          shaders::scale_values.spirv.end());
    expectRefused({}, "its SPIR-V is broken: ");
    expectRefused({1, 2, 3, 4, 5, 6}, "magic number");
    const std::vector<std::uint32_t> cut(good.begin(),
                                         good.begin() + static_cast<std::ptrdiff_t>(good.size() / 2) + 1);
    EXPECT_THROW(reflectSpirv("broken", cut), ShaderError);
    std::vector<std::uint32_t> zero = good;
    zero[5] = 0;
    EXPECT_THROW(reflectSpirv("broken", zero), ShaderError);
    const std::vector<std::uint32_t> headerOnly(good.begin(), good.begin() + 5);
    EXPECT_THROW(reflectSpirv("broken", headerOnly), ShaderError);
}

/** One to three words changed at random: refused or, where it is still valid, read; never a crash. A fault
 * that validation let through crashed SPIRV-Cross in 9 of 10 of these. */
TEST(Reflection, SurvivesRandomDamage) {
    std::mt19937 random(1);
    int refused = 0;
    for (const Kernel* kernel : {&shaders::scale_values, &shaders::interface}) {
        for (int trial = 0; trial < 1000; ++trial) {
            std::vector<std::uint32_t> words(kernel->spirv.begin(), kernel->spirv.end());
            for (std::uint32_t changes = 1 + random() % 3; changes > 0; --changes) {
                std::uint32_t& word = words[random() % words.size()];
                switch (random() % 4) {
                    case 0:
                        word = static_cast<std::uint32_t>(random());
                        break;
                    case 1:
                        word ^= 1u << (random() % 32);
                        break;
                    case 2:
                        word = static_cast<std::uint32_t>(random() % (kernel->spirv[3] + 10));
                        break;
                    default:
                        word = 0;
                }
            }
            try {
                reflectSpirv("damaged", words);
            } catch (const ShaderError&) {
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 1000);
}

TEST(Reflection, ValidatesWordsOfUnknownOriginOnly) {
    std::vector<std::uint32_t> words(shaders::interface.spirv.begin(), shaders::interface.spirv.end());
    EXPECT_TRUE(isEmbedded(shaders::interface.spirv));
    EXPECT_FALSE(isEmbedded(words));
    EXPECT_FALSE(isCompiledHere(words));
    EXPECT_TRUE(isCompiledHere(compileVariant(shaders::interface, {}).spirv));
    words[40] = 0;
    EXPECT_THROW(reflect(Kernel{"own", words, ""}), ShaderError);
}

}  // namespace
}  // namespace helio
