#pragma once
/** @file
 * What a scene needs. Computed once from the scene; selects kernel variants, buffers and passes. Materials,
 * lights and passes register their own bits, each in its own file: no central list grows.
 */
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace helio {
struct Scene;

/** One thing a scene may need, e.g. "textures.baseColor". `needed` looks at the scene. */
struct FeatureRule {
    std::string name;
    std::string whenAbsent;  ///< what is left out without it, for the statistics
    std::function<bool(const Scene&)> needed;
};
/** Registers a rule at static initialisation: `static const RegisterFeature x{{...}};`. Names are unique. */
struct RegisterFeature {
    explicit RegisterFeature(FeatureRule rule);
};

/** The features a scene has and has not, in alphabetical order. */
class SceneFeatures {
public:
    explicit SceneFeatures(const Scene& scene);
    bool has(std::string_view name) const;  ///< asserts that the name is registered
    std::vector<std::string> present() const;
    struct Absent {
        std::string name, why;
    };
    std::vector<Absent> absent() const;

private:
    std::vector<std::pair<std::string, bool>> values_;
};
}  // namespace helio
