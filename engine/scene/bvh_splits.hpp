#pragma once
/** @file
 * Spatial splits: a plane cuts triangles, and both sides get the part of its box that the triangle fills
 * (Stich, Friedrich and Dietrich, "Spatial splits in bounding volume hierarchies", 2009). Boxes of neighbours
 * then overlap less, at the price of triangles that are in several leaves.
 */
#include "engine/scene/bvh_binary.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <span>

namespace helio::bvh {

struct SpatialSplit {
    int axis = -1;  ///< -1: none
    float plane = 0;
    double cost = std::numeric_limits<double>::infinity();  ///< as an object split's
    std::uint32_t left = 0, right = 0;                      ///< references, those that are cut on both sides
    Box leftBox, rightBox;
};

/** Boxes of a triangle's parts below and above a plane, within the reference's box; empty() where there is
 * none. They hold the exact parts: points on the plane are rounded outwards. Both keep the triangle's index.
 */
struct Parts {
    Reference below, above;
};
Parts cut(const Reference& reference, std::span<const glm::vec3> positions, int axis, float plane);

/** Whether a box holds no point. */
bool isEmpty(const Box& box);

/** The cheapest of evenly spaced planes through the references' box, their parts counted on either side. Same
 * input, same result, in parallel or not. */
SpatialSplit bestSpatialSplit(std::span<const Reference> references, std::span<const glm::vec3> positions,
                              const Box& box, double lengthWeight, bool parallel);

}  // namespace helio::bvh
