#include "engine/graph/plan_impl.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace helio {
namespace {

[[noreturn]] void refuse(const Commands::Impl& impl, std::string resource, std::string message) {
    throw GraphError({{impl.pass.name, "", std::move(resource), std::move(message)}});
}

/** Whether the pass has been given what its kernel reads. */
void checkPushed(const Commands::Impl& impl) {
    if (impl.pass.pushBytes > 0 && !impl.pushed)
        refuse(impl, "",
               fmt::format("dispatches without its {} bytes of push constants; push() them first",
                           impl.pass.pushBytes));
}

std::uint64_t roundedGroups(std::uint64_t invocations, std::uint32_t local) {
    return invocations / local + (invocations % local != 0 ? 1 : 0);
}

void dispatchGroups(const Commands::Impl& impl, std::array<std::uint64_t, 3> groups) {
    if (groups[0] == 0 || groups[1] == 0 || groups[2] == 0) return;
    const auto& limits = impl.plan.device->limits().maxComputeWorkGroupCount;
    for (std::size_t i = 0; i < 3; ++i)
        if (groups[i] > limits[i])
            refuse(
                impl, "",
                fmt::format(
                    "dispatches {} workgroups in dimension {} but the device takes {}; spread them over more "
                    "dimensions or dispatches",
                    groups[i], "xyz"[i], limits[i]));
    checkPushed(impl);
    impl.commands.dispatch(std::uint32_t(groups[0]), std::uint32_t(groups[1]), std::uint32_t(groups[2]));
}

}  // namespace

Commands& Commands::pushBytes(const void* data, std::uint32_t bytes) {
    if (bytes != impl_->pass.pushBytes)
        refuse(*impl_, "",
               fmt::format("pushes {} bytes but its kernel's push constants have {}; give the same struct",
                           bytes, impl_->pass.pushBytes));
    if (bytes == 0) return *this;
    impl_->commands.pushConstants<std::byte>(
        *impl_->pass.pipeline->layout, vk::ShaderStageFlagBits::eCompute, 0,
        vk::ArrayProxy<const std::byte>(bytes, static_cast<const std::byte*>(data)));
    impl_->pushed = true;
    return *this;
}

Commands& Commands::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    dispatchGroups(*impl_, {x, y, z});
    return *this;
}

Commands& Commands::dispatchInvocations(std::uint64_t invocations) {
    dispatchGroups(*impl_, {roundedGroups(invocations, impl_->pass.localSize[0]), 1, 1});
    return *this;
}

Commands& Commands::dispatchOver(Image image) {
    const graph::Input& input = impl_->plan.input;
    if (image.graph != impl_->plan.graph || image.id >= input.resources.size() ||
        input.resources[image.id].kind != graph::ResourceKind::Image)
        refuse(*impl_, "", "dispatches over an image of another graph; use this graph's handle");
    return dispatchOver(input.resources[image.id].size[0], input.resources[image.id].size[1]);
}

Commands& Commands::dispatchOver(std::uint32_t width, std::uint32_t height) {
    dispatchGroups(*impl_, {roundedGroups(width, impl_->pass.localSize[0]),
                            roundedGroups(height, impl_->pass.localSize[1]), 1});
    return *this;
}

Commands& Commands::dispatchIndirect(Buffer arguments, std::uint64_t offset) {
    const Plan::Impl& plan = impl_->plan;
    const std::vector<std::uint32_t>& declared = impl_->pass.indirect;
    if (arguments.graph != plan.graph ||
        std::find(declared.begin(), declared.end(), arguments.id) == declared.end())
        refuse(*impl_,
               arguments.graph == plan.graph && arguments.id < plan.input.resources.size()
                   ? plan.input.resources[arguments.id].name
                   : "",
               "is dispatched from but not declared; add indirect() to the pass");
    const graph::ResourceInput& resource = plan.input.resources[arguments.id];
    if (offset % 4 != 0 || resource.bytes < 12 || offset > resource.bytes - 12)
        refuse(*impl_, resource.name,
               fmt::format(
                   "holds no workgroup counts at byte {}; give a multiple of 4 with 12 bytes after it, of {}",
                   offset, resource.bytes));
    checkPushed(*impl_);
    impl_->commands.dispatchIndirect(plan.resources[arguments.id].buffer, offset);
    return *this;
}

}  // namespace helio
