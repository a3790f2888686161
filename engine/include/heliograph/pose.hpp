#pragma once
/** @file Skins, morph targets and animations, evaluated at a time. */
#include <heliograph/scene.hpp>

#include <string>
#include <vector>

namespace helio {

/** Whether animations, skins or morph targets say how the scene stands, so that it must be posed before
 * anything is computed from it. */
bool needsPose(const Scene& scene);

/**
 * The scene as it stands at `time`, in seconds: a still one, without animations, skins and morph targets. Its
 * instances, triangles, cameras and lights are the given scene's, in the same order.
 *
 * `animation` is the name of one of Scene::animations, else an index into them, else "none" for the pose that
 * the nodes describe; "" takes the first, all of its channels. Before a channel's first time its first value
 * holds, after its last the last. Morph targets add up before the skin moves the result; weights of joints
 * are divided by their sum, and a vertex that has none follows its first joint. Normals turn by the inverse
 * transpose; triangles that a skin mirrors keep their front. Everything is computed in double and rounded
 * once; skinned vertices are stored relative to Node::meshOrigin. Sources: glTF 2.0, sections 3.7.2.2, 3.7.3
 * and 3.11 and appendix C.
 *
 * Validates the scene. Throws InputError, also for a pose whose numbers leave the range of float.
 */
Scene posed(Scene scene, double time = 0, const std::string& animation = "");

/** The value of a channel, of as many numbers as its path has; a quaternion is unit. The channel is that of a
 * valid scene. */
std::vector<double> valueAt(const AnimationChannel& channel, double time);

}  // namespace helio
