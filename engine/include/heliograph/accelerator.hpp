#pragma once
/** @file What finds the triangles along a ray. */
#include <cstdint>

namespace helio {

/** The values from BruteForce to Bsp are those of shaders/intersection/comparators.glsl. */
enum class AcceleratorKind : std::uint8_t {
    Auto,        ///< few triangles are written out as code, more get a Bvh
    Bvh,         ///< bounding volume hierarchy: the fastest
    BruteForce,  ///< every triangle is tested; to compare with, like all below
    Grid,
    Octree,
    KdTree,
    Bsp,
    SplitBvh,  ///< a Bvh with spatial splits: slower to build, more memory, fewer boxes on a ray's way
    DeviceBvh  ///< a Bvh built on the device: of poorer quality, soon made where the device is fast
};

}  // namespace helio
