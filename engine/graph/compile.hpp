#pragma once
/** @file The graph's compiler: plain data in, plain data out, in order validate, cull, version, place, sync.
 */
#include "engine/graph/types.hpp"

#include <heliograph/error.hpp>

namespace helio::graph {

/** Every problem of the declaration, empty for a sound one. */
std::vector<GraphProblem> validate(const Input& input);

/** Which passes a root needs, walking back from the roots. One entry per pass; an empty reason is a live one.
 */
std::vector<std::string> cull(const Input& input);

/** The steps of the live passes in order of declaration, readbacks last, without barriers. With
 * Input::poison, a poisoning step stands before each transient's first use. */
std::vector<Step> schedule(const Input& input, const std::vector<std::string>& cullReasons);

/** Places live transients: greedy first fit, by size or by length of life, whichever packs tighter. Fills
 * arenas, placements and aliasing; reads steps. Without Input::alias nothing overlaps. */
void place(const Input& input, Compiled& compiled);

/** Derives every barrier from steps and placements. */
void synchronize(const Input& input, Compiled& compiled);

/** Hands everything that the device has done to the host: what ends a submission whose results the host
 * reads, or whose memory it writes next. */
Barrier hostDependency();

/** All of the above. Throws GraphError with every problem. */
Compiled compile(const Input& input);

/** The compiled plan as a Graphviz digraph, and as JSON: steps with barriers, resources with memory and whom
 * they share it with, culled passes with reasons. */
std::string dumpGraphviz(const Input& input, const Compiled& compiled);
std::string dumpJson(const Input& input, const Compiled& compiled);

/** Names for messages and dumps, e.g. "compute|copy". */
std::string stageNames(Stages stages);
std::string accessNames(Accesses accesses);
const char* layoutName(Layout layout);
const char* causeName(Cause cause);

}  // namespace helio::graph
