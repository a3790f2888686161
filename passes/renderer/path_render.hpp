#pragma once
/** @file The path pipeline of the renderer. */
#include "passes/pathtrace/path_tracer.hpp"
#include "passes/radiosity/patches.hpp"
#include "passes/renderer/film_target.hpp"
#include "passes/renderer/prepared_scene.hpp"
#include "passes/renderer/render_job.hpp"

#include <optional>

namespace helio {

/** Throws InputError for a size that the path pipeline cannot hold on the device, by itself, with so many
 * bounces or under its scheduler. */
void checkPathSize(const RenderOptions& options, const Device& device);
/** The path tracer's options for a render. */
PathTraceOptions pathTraceOptions(const RenderOptions& options, const ShutterTimes& shutter = {});

/** PathTraceOptions::lightSamples for an eye, about the same origin as the bounds. Surroundings light most of
 * what is seen of a scene from outside its box, and nearly all of its noise is of the direction asked there:
 * four directions take .4 to .9 of the time of one to equal error (eight .5 to 1.1). Within a room, where
 * most light comes by walls, they would take 1.8 of it. */
std::uint32_t lightSamples(const DeviceScene& scene, const Scene::Bounds& bounds, const glm::dvec3& eye);

/** Traces the scene into the film until the samples, the time or the error asked for are reached, or the
 * application cancels; fills in the job's result. The film holds the samples of all whole batches; after
 * a cancel, pixels that were through with the last batch hold that too, as the samples channel says. With
 * patches (Integrator::Radiosity) their light is solved first. */
void renderPaths(Device& device, PreparedScene& scene, const View& view, FilmTarget& target, RenderJob& job,
                 std::optional<PatchList> patches = std::nullopt);

}  // namespace helio
