#pragma once
/** @file
 * An oracle for compiled plans that shares no code with the compiler. It plays a sequence of executions
 * against Vulkan's rules, access by access:
 *  - every pair of accesses to the same memory of which one writes is ordered by a chain of barriers; a write
 *    is available before the memory is written again, and visible to each later reader's stage and access;
 *  - a layout change is a write to the image, and every use finds its image in the layout it expects;
 *  - every read finds, in each cell of the aliased memory, the value that running all declared passes in
 *    order on memory of their own would have left there.
 * Values are symbols: a hash of the pass and of everything it read.
 */
#include "engine/graph/types.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace helio::graph {

class HazardSimulator {
public:
    /** Plays one execution. Imported resources of the same `name` in several inputs are the same memory;
     * transients and arenas belong to `plan`, so executing a plan again reuses its memory. */
    void execute(const Input& input, const Compiled& compiled, std::uint32_t plan);

    /** What went wrong, in order; empty for a sound plan. */
    const std::vector<std::string>& faults() const { return faults_; }

private:
    /** A past access. `chained` holds the stages that surely run after it. */
    struct Past {
        std::string resource;
        std::string arena;
        std::uint64_t begin = 0, end = 0;
        Stages stage = stage::None;  ///< none for a layout change
        Accesses access = access::None;
        bool write = false;
        Stages chained = stage::None;
        bool available = false;
        std::map<Stages, Accesses> visible;
        std::uint64_t step = 0;
        std::string what;
    };
    struct Place {
        std::string resource;  ///< identity across plans
        std::string arena;
        std::uint64_t begin = 0, end = 0;
    };

    Place locate(const Input& input, const Compiled& compiled, std::uint32_t resource,
                 std::uint32_t plan) const;
    void barriers(const std::vector<Barrier>& list, const Input& input, const Compiled& compiled,
                  std::uint32_t plan);
    void command(const std::vector<const Barrier*>& batch, const Input& input, const Compiled& compiled,
                 std::uint32_t plan);
    void touch(const Place& place, Stages stage, Accesses access, const std::string& what);
    void checkContents(const Place& place, std::uint64_t expected, const std::string& what);
    void setContents(const Place& place, std::uint64_t value);

    static constexpr std::uint64_t cell = 64;  ///< bytes; placements in the tests are multiples of it
    std::vector<Past> past_;
    std::map<std::string, Layout> layouts_;
    std::map<std::string, std::vector<std::uint64_t>> memory_;  ///< symbol per cell, by arena
    std::map<std::string, std::uint64_t> importedReference_;    ///< symbol of each imported resource
    std::uint64_t step_ = 0;
    std::uint64_t execution_ = 0;
    std::vector<std::string> faults_;
};

}  // namespace helio::graph
