#include <heliograph/features.hpp>

#include <algorithm>
#include <cassert>
#include <map>

namespace helio {
namespace {

std::map<std::string, FeatureRule, std::less<>>& registry() {
    static std::map<std::string, FeatureRule, std::less<>> rules;
    return rules;
}

}  // namespace

RegisterFeature::RegisterFeature(FeatureRule rule) {
    std::string name = rule.name;
    [[maybe_unused]] const bool isNew = registry().emplace(std::move(name), std::move(rule)).second;
    assert(isNew && "two features have the same name");
}

SceneFeatures::SceneFeatures(const Scene& scene) {
    for (const auto& [name, rule] : registry()) values_.emplace_back(name, rule.needed(scene));
}

bool SceneFeatures::has(std::string_view name) const {
    const auto found =
        std::lower_bound(values_.begin(), values_.end(), name,
                         [](const auto& value, std::string_view n) { return value.first < n; });
    assert(found != values_.end() && found->first == name && "no such feature is registered");
    return found != values_.end() && found->first == name && found->second;
}

std::vector<std::string> SceneFeatures::present() const {
    std::vector<std::string> names;
    for (const auto& [name, isPresent] : values_) {
        if (isPresent) names.push_back(name);
    }
    return names;
}

std::vector<SceneFeatures::Absent> SceneFeatures::absent() const {
    std::vector<Absent> list;
    for (const auto& [name, isPresent] : values_) {
        if (!isPresent) list.push_back({name, registry().find(name)->second.whenAbsent});
    }
    return list;
}

}  // namespace helio
