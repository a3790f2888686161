#pragma once
/** @file Of what several kernels share, that which one of them has. */
#include "engine/shader/reflection.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/kernel.hpp>

#include <algorithm>
#include <iterator>
#include <vector>

namespace helio {

inline std::vector<Binding> bindingsOf(const KernelReflection& kernel, const std::vector<Binding>& bindings) {
    std::vector<Binding> found;
    std::ranges::copy_if(bindings, std::back_inserter(found),
                         [&](const Binding& b) { return kernel.binding(b.name) != nullptr; });
    return found;
}

inline SpecConstants constantsOf(const KernelReflection& kernel, SpecConstants constants) {
    std::erase_if(constants, [&](const auto& c) { return kernel.specConstant(c.first) == nullptr; });
    return constants;
}

}  // namespace helio
