#pragma once
/** @file From a declaration to a plan ready to execute. */
#include "engine/graph/declaration.hpp"

namespace helio::graph {

/** Checks against reflection and device, compiles, allocates, makes pipelines and descriptors. Throws
 * GraphError with every problem, OutOfDeviceMemory, DeviceError. */
Plan buildPlan(Graph::Impl& graph, const CompileOptions& options);

}  // namespace helio::graph
