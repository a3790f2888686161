#include "engine/graph/build.hpp"
#include "engine/graph/declaration.hpp"
#include "engine/shader/kernel_cache.hpp"

#include <atomic>
#include <cassert>

namespace helio {
namespace {

/** Serials tell graphs' handles apart; 0 is no graph's. */
std::uint32_t nextSerial() {
    static std::atomic<std::uint32_t> serial{0};
    return ++serial;
}

std::uint32_t add(Graph::Impl& impl, graph::DeclaredResource resource) {
    impl.resources.push_back(std::move(resource));
    return std::uint32_t(impl.resources.size() - 1);
}

}  // namespace

Graph::Graph(Device& device) : impl_(std::make_unique<Impl>()) {
    impl_->device = &device.impl();
    impl_->serial = nextSerial();
}
Graph::~Graph() = default;
Graph::Graph(Graph&&) noexcept = default;
Graph& Graph::operator=(Graph&&) noexcept = default;

Buffer Graph::buffer(std::string name, const BufferDescription& description) {
    graph::DeclaredResource resource;
    resource.input.name = std::move(name);
    resource.input.bytes = description.bytes;
    return {add(*impl_, std::move(resource)), impl_->serial};
}

Image Graph::image(std::string name, const ImageDescription& description) {
    graph::DeclaredResource resource;
    resource.input.name = std::move(name);
    resource.input.kind = graph::ResourceKind::Image;
    resource.input.size = description.size;
    resource.input.format = description.format;
    return {add(*impl_, std::move(resource)), impl_->serial};
}

Buffer Graph::import(DeviceBuffer& buffer) {
    assert(buffer && "an empty DeviceBuffer cannot be imported");
    for (std::uint32_t i = 0; i < impl_->resources.size(); ++i)
        if (impl_->resources[i].buffer == buffer.impl()) return {i, impl_->serial};
    graph::DeclaredResource resource;
    resource.input.name = buffer.name();
    resource.input.imported = true;
    resource.input.bytes = buffer.bytes();
    resource.buffer = buffer.impl();
    return {add(*impl_, std::move(resource)), impl_->serial};
}

Image Graph::import(DeviceImage& image) {
    assert(image.impl() && "an empty DeviceImage cannot be imported");
    for (std::uint32_t i = 0; i < impl_->resources.size(); ++i)
        if (impl_->resources[i].image == image.impl()) return {i, impl_->serial};
    graph::DeclaredResource resource;
    resource.input.name = image.name();
    resource.input.kind = graph::ResourceKind::Image;
    resource.input.imported = true;
    resource.input.size = {image.width(), image.height()};
    resource.input.format = image.format();
    resource.image = image.impl();
    return {add(*impl_, std::move(resource)), impl_->serial};
}

Pass Graph::compute(std::string name, const Kernel& kernel, const ComputeOptions& options) {
    graph::DeclaredPass pass;
    pass.name = std::move(name);
    pass.kernel = overlaid(kernel);
    pass.spec = options.spec;
    impl_->passes.push_back(std::move(pass));
    return {impl_.get(), std::uint32_t(impl_->passes.size() - 1)};
}

Pass Graph::fill(std::string name, Buffer buffer, std::uint32_t word) {
    graph::DeclaredPass pass;
    pass.name = std::move(name);
    pass.kind = graph::PassKind::Fill;
    pass.word = word;
    pass.bindings.push_back({Binding("buffer", buffer), graph::Mode::Overwrite});
    impl_->passes.push_back(std::move(pass));
    return {impl_.get(), std::uint32_t(impl_->passes.size() - 1)};
}

Pass Graph::copy(std::string name, Buffer from, Buffer to) {
    graph::DeclaredPass pass;
    pass.name = std::move(name);
    pass.kind = graph::PassKind::Copy;
    pass.bindings.push_back({Binding("from", from), graph::Mode::Read});
    pass.bindings.push_back({Binding("to", to), graph::Mode::Write});
    impl_->passes.push_back(std::move(pass));
    return {impl_.get(), std::uint32_t(impl_->passes.size() - 1)};
}

ReadbackBytes Graph::readbackBytes(std::uint32_t resource, std::uint32_t graph) {
    auto readback = std::make_shared<ReadbackBytes::Impl>();
    readback->index = std::uint32_t(impl_->readbacks.size());
    if (graph == impl_->serial && resource < impl_->resources.size())
        readback->resource = impl_->resources[resource].input.name;
    impl_->readbackInputs.push_back({resource, graph});
    impl_->readbacks.push_back(readback);
    return ReadbackBytes(readback);
}

Plan Graph::compile(const CompileOptions& options) {
    return graph::buildPlan(*impl_, options);
}

namespace {

template <typename Range>
void declare(graph::DeclaredPass& pass, const Range& bindings, graph::Mode mode) {
    assert(pass.kind == graph::PassKind::Compute && "a fill or copy declares its own accesses");
    for (const Binding& binding : bindings) pass.bindings.push_back({binding, mode});
}

}  // namespace

Pass& Pass::reads(std::initializer_list<Binding> bindings) {
    declare(graph_->passes[index_], bindings, graph::Mode::Read);
    return *this;
}
Pass& Pass::reads(const std::vector<Binding>& bindings) {
    declare(graph_->passes[index_], bindings, graph::Mode::Read);
    return *this;
}
Pass& Pass::writes(std::initializer_list<Binding> bindings) {
    declare(graph_->passes[index_], bindings, graph::Mode::Write);
    return *this;
}
Pass& Pass::writes(const std::vector<Binding>& bindings) {
    declare(graph_->passes[index_], bindings, graph::Mode::Write);
    return *this;
}
Pass& Pass::overwrites(std::initializer_list<Binding> bindings) {
    declare(graph_->passes[index_], bindings, graph::Mode::Overwrite);
    return *this;
}
Pass& Pass::overwrites(const std::vector<Binding>& bindings) {
    declare(graph_->passes[index_], bindings, graph::Mode::Overwrite);
    return *this;
}
Pass& Pass::modifies(std::initializer_list<Binding> bindings) {
    declare(graph_->passes[index_], bindings, graph::Mode::Modify);
    return *this;
}
Pass& Pass::modifies(const std::vector<Binding>& bindings) {
    declare(graph_->passes[index_], bindings, graph::Mode::Modify);
    return *this;
}

Pass& Pass::indirect(Buffer arguments) {
    graph_->passes[index_].indirect.push_back(arguments);
    return *this;
}

Pass& Pass::keep() {
    graph_->passes[index_].keep = true;
    return *this;
}

Pass& Pass::record(std::function<void(Commands&)> recorder) {
    assert(graph_->passes[index_].kind == graph::PassKind::Compute && "a fill or copy records itself");
    graph_->passes[index_].recorder = std::move(recorder);
    return *this;
}

}  // namespace helio
