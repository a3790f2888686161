#pragma once
/** @file Polygons with more than three corners. */
#include <glm/glm.hpp>

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace helio::mesh {

/** Above this many corners a polygon that is not convex is cut into a fan, as a convex one. */
constexpr std::size_t maximumEarClipping = 512;

/** A corner may be a byte in the file and takes twelve bytes as a triangle. A polygon has no more corners,
 * and where there are many triangles, vertices have no more of them on average than this: no mesh comes near.
 */
constexpr std::size_t maximumCorners = std::size_t(1) << 22;
constexpr std::size_t manyTriangles = std::size_t(1) << 23, maximumPerVertex = 8;
constexpr bool isTooMany(std::size_t triangles, std::size_t vertices) {
    return triangles > manyTriangles && triangles / maximumPerVertex > vertices;
}
/** What is wrong with it then, and what to do. */
std::string tooManyFault(std::size_t triangles, std::size_t vertices);
constexpr const char* tooManyRemedy = "give each triangle once";

/**
 * Cuts a polygon of n > 3 corners into n - 2 triangles by ear clipping (Meisters 1975), in the plane across
 * its vector area. False where the fan (0, k, k + 1) will do, for a convex polygon or one of no area;
 * `triangles` is left as it was then, else it has three corners for each triangle.
 */
bool triangulate(std::span<const glm::vec3> polygon, std::vector<std::uint32_t>& triangles);

/** A polygon that lies in a list of corners, three a triangle, as a fan. */
struct Fan {
    std::uint32_t triangle;  ///< the first
    std::uint32_t corners;   ///< of the polygon
};

/** Cuts polygons that are not convex anew, in all lists of corners; empty lists stay so. The first holds
 * indices of positions. Returns whether a polygon has more corners than can be cut. */
template <class Index>
bool cutFans(std::span<const glm::vec3> positions, std::span<const Fan> fans,
             std::initializer_list<std::vector<Index>*> lists) {
    bool hasLarge = false;
    std::vector<glm::vec3> polygon;
    std::vector<std::uint32_t> cut;
    std::vector<Index> corners;
    for (const Fan& fan : fans) {
        if (fan.corners > maximumEarClipping) {
            hasLarge = true;
            continue;
        }
        // The polygon's corner k: 0 and 1 are those of the first triangle, each other one ends a triangle.
        const auto place = [&fan](std::size_t k) {
            return std::size_t(fan.triangle) * 3 + (k < 2 ? k : (k - 2) * 3 + 2);
        };
        polygon.clear();
        for (std::size_t k = 0; k < fan.corners; ++k)
            polygon.push_back(positions[std::size_t((**lists.begin())[place(k)])]);
        cut.clear();
        if (!triangulate(polygon, cut)) continue;
        for (std::vector<Index>* const list : lists) {
            if (list->empty()) continue;
            corners.clear();
            for (std::size_t k = 0; k < fan.corners; ++k) corners.push_back((*list)[place(k)]);
            for (std::size_t k = 0; k < cut.size(); ++k)
                (*list)[std::size_t(fan.triangle) * 3 + k] = corners[cut[k]];
        }
    }
    return hasLarge;
}

/** What to say where cutFans() returns true. */
std::string largePolygonWarning();

}  // namespace helio::mesh
