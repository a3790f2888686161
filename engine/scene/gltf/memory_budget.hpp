#pragma once
/** @file How much a glTF file may unfold to. */
#include "engine/scene/gltf/accessors.hpp"

#include <cstddef>
#include <string>

#pragma GCC visibility push(hidden)  // as tinygltf's types, which these hold
namespace helio::gltf {

/** Primitives may share an accessor, and an accessor need have no data, so that a small file unfolds to any
 * size. What is unfolded stays in proportion to what was read: without sharing the factor is at most 12 (a
 * strip of one-byte indices); the constant leaves room for small files that share on purpose. */
class MemoryBudget {
public:
    explicit MemoryBudget(const Asset& asset)
        : asset_(asset), most_(asset.bytes() * 32 + (std::size_t(192) << 20)) {}

    /** Takes memory that stays, and asks for some that goes again. Refuses before either is there. */
    void take(const std::string& place, std::size_t kept, std::size_t transient);

private:
    const Asset& asset_;
    std::size_t most_;
    std::size_t used_ = 0;
};

}  // namespace helio::gltf
#pragma GCC visibility pop
