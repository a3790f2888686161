#pragma once
/** @file How much a glTF file may unfold to. */
#include "engine/scene/gltf/accessors.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

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

    /** One that refuses nothing and notes what is taken, until take() of the whole one gets the notes: for
     * what is decoded ahead of its turn. */
    static MemoryBudget notesOf(const Asset& asset) { return MemoryBudget(asset); }
    void take(const MemoryBudget& notes);

    /** What may still be taken. */
    std::size_t left() const { return most_ - std::min(used_, most_); }

private:
    struct Note {
        int accessor;  ///< -1 for none
        std::string place;
        std::size_t kept, transient;
    };

    explicit MemoryBudget(const Asset& asset) : asset_(asset), isNotes_(true) {}

    const Asset& asset_;
    bool isNotes_ = false;
    std::vector<Note> notes_;
    std::size_t most_ = 0;
    std::size_t used_ = 0;
    std::size_t read_ = 0;  ///< bytes of accessors with data, so far
};

}  // namespace helio::gltf
