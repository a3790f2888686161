#include "tests/support/struct_layout.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace helio::test {
namespace {

/** A block that only wraps the struct is looked through. */
std::string compareBlock(const StructLayout& host, const std::vector<ReflectedMember>& members,
                         std::size_t bytes) {
    if (members.size() == 1 && !members[0].members.empty()) {
        const ReflectedMember& inner = members[0];
        return layoutDifferences(host, inner.members,
                                 inner.arrayStride > 0 ? inner.arrayStride : inner.bytes);
    }
    return layoutDifferences(host, members, bytes);
}

}  // namespace

std::string layoutDifferences(const StructLayout& host, const std::vector<ReflectedMember>& device,
                              std::size_t bytes) {
    std::string text;
    const auto differ = [&](const std::string& line) { text += fmt::format("{}: {}\n", host.name, line); };
    for (std::size_t i = 0; i < std::max(host.members.size(), device.size()); ++i) {
        if (i >= host.members.size()) {
            differ(fmt::format("C++ lacks '{}'", device[i].name));
            continue;
        }
        const LayoutMember& member = host.members[i];
        if (i >= device.size()) {
            differ(fmt::format("GLSL lacks '{}'", member.name));
            continue;
        }
        const ReflectedMember& twin = device[i];
        if (member.name != twin.name)
            differ(fmt::format("member {} is '{}' in C++, '{}' in GLSL", i, member.name, twin.name));
        if (member.offset != twin.offset) {
            differ(fmt::format("'{}' is at byte {} in C++, {} in GLSL", member.name, member.offset,
                               twin.offset));
        }
        if (member.bytes != twin.bytes) {
            differ(fmt::format("'{}' has {} bytes in C++, {} in GLSL ({})", member.name, member.bytes,
                               twin.bytes, twin.type));
        }
    }
    if (host.bytes != bytes) differ(fmt::format("has {} bytes in C++, {} in GLSL", host.bytes, bytes));
    return text;
}

std::string layoutDifferences(const StructLayout& host, const ReflectedBinding& block) {
    return compareBlock(host, block.members, block.bytes);
}

std::string layoutDifferences(const StructLayout& host, const ReflectedPushConstants& block) {
    return compareBlock(host, block.members, block.bytes);
}

}  // namespace helio::test
