#pragma once
/** @file Declared access against what the kernels' SPIR-V says. */
#include "engine/graph/declaration.hpp"
#include "engine/shader/reflection.hpp"

#include <heliograph/error.hpp>

#include <vector>

namespace helio::graph {

/** A declared binding matched with the kernel's. */
struct BoundResource {
    std::uint32_t resource = none;
    const ReflectedBinding* slot = nullptr;
    std::uint64_t offset = 0;  ///< of buffers
    std::uint64_t bytes = 0;   ///< of buffers; whole texels for texel buffers
    Format view = Format::Undefined;
    Sampling sampling = Sampling::Nearest;
};

/** A compute pass as it will run. */
struct PassInterface {
    const KernelReflection* reflection = nullptr;
    std::array<std::uint32_t, 3> localSize = {1, 1, 1};
    std::vector<BoundResource> bindings;
    std::vector<std::pair<std::uint32_t, SpecValue>> spec;  ///< by constant id
};

/** Checks one compute pass and appends its problems. What it returns is only good without any. `accesses`
 * takes the pass's accesses with their usages, also of bindings that are wrong. */
PassInterface checkInterface(const Graph::Impl& graph, const DeclaredPass& pass,
                             std::vector<AccessInput>& accesses, std::vector<GraphProblem>& problems);

}  // namespace helio::graph
