#pragma once
/** @file Scenes changed in ways whose effect on the picture is known. */
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>

namespace helio::test {

/** Everything, cameras and lights too, under one more transform. */
Scene transformed(Scene scene, const glm::mat4& transform);
/** All emission (materials, punctual lights, environment) times `factor`. */
Scene brightened(Scene scene, float factor);
/** Triangles of every primitive that does not emit in another order; corners keep theirs. */
Scene permuted(Scene scene, std::uint32_t seed);
/** Every triangle split into four at the middles of its edges. */
Scene refined(Scene scene);
/** Every mesh with its vertices in world space, placed without a transform; one mesh for every instance. */
Scene baked(const Scene& scene);
/** Every mesh twice in the same place. */
Scene doubled(Scene scene);
/** Only those emitters are left for which `kept(material index)` holds; the others reflect as before. */
Scene withEmitters(Scene scene, const std::function<bool(std::size_t)>& kept);

}  // namespace helio::test
