#include <heliograph/error.hpp>

#include <fmt/format.h>

namespace helio {
namespace {

std::string joinNonEmpty(const std::string& file, const std::string& place, const std::string& fault,
                         const std::string& remedy) {
    std::string text;
    if (!file.empty()) text += file + ": ";
    if (!place.empty()) text += place + ": ";
    text += fault;
    if (!remedy.empty()) text += "; " + remedy;
    return text;
}

std::string describe(const std::vector<GraphProblem>& problems) {
    std::string text = fmt::format("{} problem{} in the graph", problems.size(), problems.size() == 1 ? "" : "s");
    for (const GraphProblem& problem : problems) {
        text += "\n  ";
        if (!problem.pass.empty()) text += fmt::format("pass '{}': ", problem.pass);
        if (!problem.binding.empty()) text += fmt::format("binding '{}': ", problem.binding);
        if (!problem.resource.empty()) text += fmt::format("resource '{}': ", problem.resource);
        text += problem.message;
    }
    return text;
}

}  // namespace

InputError::InputError(std::string file_, std::string place_, std::string fault_, std::string remedy_)
    : Error(joinNonEmpty(file_, place_, fault_, remedy_)),
      file(std::move(file_)),
      place(std::move(place_)),
      fault(std::move(fault_)),
      remedy(std::move(remedy_)) {}

OutOfDeviceMemory::OutOfDeviceMemory(std::string resource_, std::uint64_t bytes_, std::string detail)
    : DeviceError(fmt::format("out of device memory: '{}' needs {} bytes{}{}", resource_, bytes_,
                              detail.empty() ? "" : ": ", detail)),
      resource(std::move(resource_)),
      bytes(bytes_) {}

GraphError::GraphError(std::vector<GraphProblem> problems_)
    : Error(describe(problems_)), problems(std::move(problems_)) {}

}  // namespace helio
