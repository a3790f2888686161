#include "engine/scene/mesh/polygon.hpp"

#include <fmt/format.h>

namespace helio::mesh {
namespace {

using Points = std::vector<glm::dvec2>;

/** Twice the signed area. */
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/** Across the vector area (Newell), which is counter-clockwise then. Empty for a polygon of no area. */
Points flattened(std::span<const glm::vec3> polygon) {
    const glm::dvec3 origin = polygon[0];
    glm::dvec3 normal(0);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        normal += glm::cross(glm::dvec3(polygon[i]) - origin, glm::dvec3(polygon[i + 1]) - origin);
    }
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    Points points;
    if (!(size[axis] > 0)) return points;
    for (const glm::vec3& corner : polygon) {
        const glm::dvec3 p = glm::dvec3(corner) - origin;
        const glm::dvec2 flat(p[(axis + 1) % 3], p[(axis + 2) % 3]);
        points.push_back(normal[axis] > 0 ? flat : glm::dvec2(flat.y, flat.x));
    }
    return points;
}

class EarClipper {
public:
    explicit EarClipper(const Points& points) : points_(points) {
        for (std::size_t i = 0; i < points.size(); ++i) ring_.push_back(std::uint32_t(i));
    }

    bool isConvex() const {
        for (std::size_t i = 0; i < ring_.size(); ++i) {
            if (areaAt(i) < 0) return false;
        }
        return true;
    }

    void clip(std::vector<std::uint32_t>& triangles) {
        std::size_t at = 0;
        while (ring_.size() > 3) {
            std::size_t tries = 0;
            // A polygon that crosses itself may have no ear; any corner does then.
            while (!isEar(at) && ++tries < ring_.size()) at = (at + 1) % ring_.size();
            triangles.insert(triangles.end(), {before(at), ring_[at], after(at)});
            ring_.erase(ring_.begin() + std::ptrdiff_t(at));
            at %= ring_.size();
        }
        triangles.insert(triangles.end(), ring_.begin(), ring_.end());
    }

private:
    std::uint32_t before(std::size_t i) const { return ring_[(i + ring_.size() - 1) % ring_.size()]; }
    std::uint32_t after(std::size_t i) const { return ring_[(i + 1) % ring_.size()]; }
    double areaAt(std::size_t i) const {
        return area(points_[before(i)], points_[ring_[i]], points_[after(i)]);
    }

    bool isEar(std::size_t i) const {
        if (!(areaAt(i) > 0)) return false;
        const glm::dvec2 &a = points_[before(i)], &b = points_[ring_[i]], &c = points_[after(i)];
        for (const std::uint32_t other : ring_) {
            const glm::dvec2& p = points_[other];
            if (p == a || p == b || p == c) continue;
            if (area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0) return false;
        }
        return true;
    }

    const Points& points_;
    std::vector<std::uint32_t> ring_;  ///< corners not cut off yet
};

}  // namespace

bool triangulate(std::span<const glm::vec3> polygon, std::vector<std::uint32_t>& triangles) {
    const Points points = flattened(polygon);
    if (points.empty()) return false;
    EarClipper clipper(points);
    if (clipper.isConvex() || polygon.size() > maximumEarClipping) return false;
    clipper.clip(triangles);
    return true;
}

std::string tooManyFault(std::size_t triangles, std::size_t vertices) {
    return fmt::format("there are {} triangles for {} vertices", triangles, vertices);
}

std::string largePolygonWarning() {
    return fmt::format("polygons of more than {} corners are shown as if they were convex",
                       maximumEarClipping);
}

}  // namespace helio::mesh
