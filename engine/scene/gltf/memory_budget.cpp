#include "engine/scene/gltf/memory_budget.hpp"

#include "engine/scene/gltf/json_reader.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace helio::gltf {

MemoryBudget::MemoryBudget(const Asset& asset, std::size_t largest)
    : asset_(asset),
      most_(std::max(maximumUnfolded(asset.bytes()), sceneProportion * asset.document().textBytes())),
      used_(asset.document().bytes() + largest + asset.listBytes()) {}

void MemoryBudget::take(const std::string& place, std::size_t kept, std::size_t transient) {
    if (isNotes_) {
        notes_.push_back({-1, place, kept, transient});
        return;
    }
    if (kept > most_ || transient > most_ || used_ + kept + transient > most_) {
        throw InputError(
            asset_.file(), place,
            fmt::format("unfolds the scene to more than {} MiB, for a file and buffers of {} bytes",
                        most_ >> 20, asset_.bytes()),
            "let fewer things share an accessor, and give accessors data");
    }
    used_ += kept;
}

void MemoryBudget::takeFor(int accessor, const std::string& place, std::size_t kept, std::size_t transient) {
    if (isNotes_) {
        notes_.push_back({accessor, place, kept, transient});
        return;
    }
    const std::size_t data = asset_.dataBytes(accessor);
    if (data > 0 && read_ + data <= asset_.bytes()) {
        read_ += data;
    } else {
        take(place, kept, transient);
    }
}

void MemoryBudget::take(const MemoryBudget& notes) {
    for (const Note& note : notes.notes_) {
        if (note.accessor < 0) {
            take(note.place, note.kept, note.transient);
        } else {
            takeFor(note.accessor, note.place, note.kept, note.transient);
        }
    }
}

}  // namespace helio::gltf
