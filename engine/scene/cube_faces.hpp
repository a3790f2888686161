#pragma once
/** @file The faces of a cube in the order and orientation of EnvironmentMapping::Cube. */
#include <glm/glm.hpp>

namespace helio {

/** Axis a face looks along, and those to its right and down as the centre sees it. */
struct CubeFace {
    glm::dvec3 forward, right, down;
};
inline const CubeFace kCubeFaces[6] = {
    {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}};

}  // namespace helio
