#include "engine/scene/samples/sample.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <map>

namespace helio {
namespace {

std::map<std::string, std::function<Scene()>>& registry() {
    static std::map<std::string, std::function<Scene()>> samples;
    return samples;
}

}  // namespace

RegisterSample::RegisterSample(std::string name, std::function<Scene()> make) {
    [[maybe_unused]] const bool isNew = registry().emplace(std::move(name), std::move(make)).second;
    assert(isNew && "two samples have the same name");
}

Scene makeSample(const std::string& name) {
    const auto found = registry().find(name);
    if (found == registry().end()) {
        throw InputError("sample:" + name, "", "is no built-in sample",
                         fmt::format("the samples are {}", fmt::join(sampleNames(), ", ")));
    }
    Scene scene = found->second();
    scene.name = "sample:" + name;
    return scene;
}

std::vector<std::string> sampleNames() {
    std::vector<std::string> names;
    for (const auto& [name, make] : registry()) names.push_back(name);
    return names;
}

}  // namespace helio
