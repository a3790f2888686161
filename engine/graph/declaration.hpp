#pragma once
/** @file What a graph holds while it is declared. */
#include "engine/gpu/device_impl.hpp"
#include "engine/graph/types.hpp"

#include <heliograph/graph.hpp>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace helio::graph {

enum class PassKind : std::uint8_t { Compute, Fill, Copy };

struct DeclaredBinding {
    Binding binding;
    Mode mode = Mode::Read;
};

struct DeclaredPass {
    std::string name;
    PassKind kind = PassKind::Compute;
    bool keep = false;
    std::vector<DeclaredBinding> bindings;  ///< of a fill the target, of a copy the source and the target
    std::vector<Buffer> indirect;
    Kernel kernel = {};
    SpecConstants spec = {};
    std::function<void(Commands&)> recorder = {};
    std::uint32_t word = 0;  ///< of a fill
};

/** A resource and, where imported, the object behind it. */
struct DeclaredResource {
    ResourceInput input;
    DeviceBuffer::Impl* buffer = nullptr;
    DeviceImage::Impl* image = nullptr;
};

}  // namespace helio::graph

namespace helio {

struct ReadbackBytes::Impl {
    std::uint32_t index = 0;  ///< among the graph's readbacks
    std::string resource;
    std::map<std::uint64_t, Plan::Impl*> plans;  ///< living plans of the graph, by serial
};

struct Graph::Impl {
    Device::Impl* device = nullptr;
    std::uint32_t serial = 0;
    std::vector<graph::DeclaredResource> resources;
    std::vector<graph::DeclaredPass> passes;
    std::vector<graph::ReadbackInput> readbackInputs;
    std::vector<std::shared_ptr<ReadbackBytes::Impl>> readbacks;
};

}  // namespace helio
