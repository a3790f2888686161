#pragma once
/** @file The four kinds of rays that a path tracer sends, from one camera. */
#include "tests/support/embree_scene.hpp"

#include <string>
#include <vector>

namespace helio::bench {

struct RaySet {
    std::string name;
    RayQuestion question;
    std::vector<Ray> rays;
};

/** "primary": a pinhole camera's, neighbours together; "bounce 1" and "bounce 2": cosine-distributed from
 * where the set before arrives; "shadow": from the first hits to points of a small light above. */
std::vector<RaySet> raySets(const test::EmbreeScene& scene, std::span<const glm::vec3> corners,
                            std::uint32_t width, std::uint32_t height);

}  // namespace helio::bench
