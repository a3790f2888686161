#pragma once
/** @file How much a glTF file may unfold to. */
#include "engine/scene/gltf/accessors.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace helio::gltf {

/** Primitives may share an accessor, accessors a buffer view, and an accessor need have no data, so that a
 * small file unfolds to any size. What is unfolded beyond each byte's first use stays within
 * maximumUnfolded(). */
class MemoryBudget {
public:
    /** `largest`: what the document's largest object takes while it is looked at. */
    MemoryBudget(const Asset& asset, std::size_t largest);

    /** Takes memory that stays, and asks for some that goes again. Refuses before either is there. */
    void take(const std::string& place, std::size_t kept, std::size_t transient);
    /** The same for what comes of an accessor's data: free until accessors have read as many bytes as there
     * are. */
    void takeFor(int accessor, const std::string& place, std::size_t kept, std::size_t transient);

    /** What may still be taken. */
    std::size_t left() const { return most_ - std::min(used_, most_); }

private:
    const Asset& asset_;
    std::size_t most_;
    std::size_t used_;
    std::size_t read_ = 0;  ///< bytes of accessors with data, so far
};

}  // namespace helio::gltf
