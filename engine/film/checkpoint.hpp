#pragma once
/** @file What a render that was stopped goes on from, as a file. */
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace helio {

/** The state of a render between two dispatches. Whoever goes on from it comes to the same bits as one that
 * was never stopped. */
struct Checkpoint {
    /** What decides the picture's bits, as name and value: a render goes on only where all of these are its
     * own. */
    std::vector<std::pair<std::string, std::string>> settings;
    std::uint32_t reached = 0;                ///< samples per pixel that the film holds
    std::uint32_t end = 0;                    ///< of the batch that was under way
    double seconds = 0, cpuSeconds = 0;       ///< of rendering so far
    std::array<std::uint64_t, 5> counters{};  ///< camera, bounce and shadow rays, cut paths, rays given up
    std::vector<float> shares;                ///< of adaptive sampling, by pixel; empty before there are any
    std::vector<float> film, state;           ///< texels of the film's and the tracer's images
};

/** Writes it, whole or not at all (writeFileAtomically). Throws InputError. */
void saveCheckpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/** Reads one. Throws InputError for a file that is none, is cut off or damaged, or whose settings are not the
 * given ones: it says which. */
Checkpoint loadCheckpoint(const std::filesystem::path& file,
                          const std::vector<std::pair<std::string, std::string>>& settings);

}  // namespace helio
