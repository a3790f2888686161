#pragma once
/** @file A binary tree over lights, and what its nodes bring to a place. */
#include "passes/scene/light_tables.hpp"

namespace helio::pack {

/** Lights [first, end) of the tree's order, as one. */
struct LightNode {
    std::uint32_t first = 0, end = 0;
    std::int32_t left = -1, right = -1;  ///< -1 for a single light
    LightSource bound;  ///< sum of strengths; of several lights a Surface whose normal is the mean
};

/** Splits lights at the middle of the longest extent of their centres; those without a place come first, as
 * leaves of their own. */
class LightTree {
public:
    explicit LightTree(std::span<const LightSource> lights);
    const std::vector<std::uint32_t>& order() const { return order_; }
    const std::vector<LightNode>& nodes() const { return nodes_; }
    /** Nodes that cover all lights once: where a cut starts. */
    const std::vector<std::int32_t>& roots() const { return roots_; }

private:
    std::int32_t build(std::span<const LightSource> lights, std::uint32_t first, std::uint32_t end);
    std::int32_t leaf(std::span<const LightSource> lights, std::uint32_t place);
    std::vector<std::uint32_t> order_;
    std::vector<LightNode> nodes_;
    std::vector<std::int32_t> roots_;
};

/** Somewhere on a surface. */
struct SurfaceSample {
    glm::dvec3 position{0.0}, normal{0.0};
};

/** Unshadowed irradiance of a light at a place, roughly, plus a small part of what it would be without any
 * cosine: positive for every light, since surfaces nearby may face it. */
double estimatedIrradiance(const LightSource& light, const SurfaceSample& at,
                           const AxisIrradiance& environment);

}  // namespace helio::pack
