#include "engine/scene/gltf/memory_budget.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

namespace helio::gltf {

void MemoryBudget::take(const std::string& place, std::size_t kept, std::size_t transient) {
    if (kept > most_ || transient > most_ || used_ + kept + transient > most_) {
        throw InputError(
            asset_.file(), place,
            fmt::format("unfolds the scene to more than {} MiB, for a file and buffers of {} bytes",
                        most_ >> 20, asset_.bytes()),
            "let fewer things share an accessor, and give accessors data");
    }
    used_ += kept;
}

}  // namespace helio::gltf
