#pragma once
/** @file What lights a scene that is rendered. */
#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace helio {

/** Whether anything placed in the scene gives light: an emissive surface, a punctual light with some
 * intensity, or an environment that is not black. */
bool hasLight(const Scene& scene, const std::optional<Environment>& environment);

/** The scene for Integrator::AmbientOcclusion: white Lambertian opaque surfaces, no lights. */
Scene whiteScene(const Scene& scene);

/** The environment to render with: the options' where they give one, else the scene's; for a scene in which
 * nothing gives light, radiance 1 from everywhere. Says so in `warnings`, as it does where the picture stays
 * black because the options ask for a black environment. */
std::optional<Environment> chooseEnvironment(const Scene& scene, const RenderOptions& options,
                                             std::vector<std::string>& warnings);

}  // namespace helio
