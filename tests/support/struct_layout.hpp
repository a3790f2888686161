#pragma once
/** @file
 * Compares a C++ struct's layout with what a kernel's reflection says of its GLSL twin.
 *
 *     EXPECT_EQ(layoutDifferences(HELIO_LAYOUT(Light, position, power), *reflect(kernel).binding("uLights")),
 * "");
 */
#include "engine/shader/reflection.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace helio::test {

struct LayoutMember {
    std::string name;
    std::size_t offset;
    std::size_t bytes;
};
struct StructLayout {
    std::string name;
    std::size_t bytes;
    std::vector<LayoutMember> members;
};

/** What differs, one line each; empty where every member has the same name, offset and size, in the same
 * order. `bytes` is the struct's size on the device: an array's stride or a block's size. */
std::string layoutDifferences(const StructLayout& host, const std::vector<ReflectedMember>& device,
                              std::size_t bytes);
/** Of a block whose members are the struct's, or that holds one member: the struct or an array of it. */
std::string layoutDifferences(const StructLayout& host, const ReflectedBinding& block);
std::string layoutDifferences(const StructLayout& host, const ReflectedPushConstants& block);

}  // namespace helio::test

/** StructLayout of a standard-layout type and all of its members, in order. */
#define HELIO_LAYOUT(Type, ...) \
    (::helio::test::StructLayout{#Type, sizeof(Type), {HELIO_LAYOUT_EACH(Type, __VA_ARGS__)}})
#define HELIO_LAYOUT_MEMBER(Type, member) {#member, offsetof(Type, member), sizeof(Type::member)},
// Recursive expansion by __VA_OPT__: enough rescans for 64 members.
#define HELIO_LAYOUT_PARENS ()
#define HELIO_LAYOUT_EXPAND(...) HELIO_LAYOUT_EXPAND3(HELIO_LAYOUT_EXPAND3(HELIO_LAYOUT_EXPAND3(__VA_ARGS__)))
#define HELIO_LAYOUT_EXPAND3(...) \
    HELIO_LAYOUT_EXPAND2(HELIO_LAYOUT_EXPAND2(HELIO_LAYOUT_EXPAND2(__VA_ARGS__)))
#define HELIO_LAYOUT_EXPAND2(...) \
    HELIO_LAYOUT_EXPAND1(HELIO_LAYOUT_EXPAND1(HELIO_LAYOUT_EXPAND1(__VA_ARGS__)))
#define HELIO_LAYOUT_EXPAND1(...) \
    HELIO_LAYOUT_EXPAND0(HELIO_LAYOUT_EXPAND0(HELIO_LAYOUT_EXPAND0(__VA_ARGS__)))
#define HELIO_LAYOUT_EXPAND0(...) __VA_ARGS__
#define HELIO_LAYOUT_EACH(Type, ...) __VA_OPT__(HELIO_LAYOUT_EXPAND(HELIO_LAYOUT_STEP(Type, __VA_ARGS__)))
#define HELIO_LAYOUT_STEP(Type, member, ...) \
    HELIO_LAYOUT_MEMBER(Type, member) __VA_OPT__(HELIO_LAYOUT_AGAIN HELIO_LAYOUT_PARENS(Type, __VA_ARGS__))
#define HELIO_LAYOUT_AGAIN() HELIO_LAYOUT_STEP
