#include "passes/renderer/scene_warnings.hpp"

#include "engine/scene/parallel.hpp"
#include "passes/scene/material_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace helio {
namespace {

/** The first set that a texture which is sampled names and the primitive lacks; -1 where there is none. */
int missingSet(const Material& material, const Primitive& primitive) {
    for (const pack::SampledTexture& texture : pack::sampledTextures(material)) {
        const int set = texture.use->texcoord;
        if (std::size_t(set) >= primitive.texcoords.size()) return set;
    }
    return -1;
}

/** One warning for many places of a scene: what is said of the first, and how many further ones there are. */
class FirstOfMany {
public:
    template <class Say>
    void add(Say&& say) {
        if (count_++ == 0) first_ = say();
    }
    void addTo(std::vector<std::string>& warnings, const char* places) {
        if (count_ > 1) first_ += fmt::format(" ({} further {} likewise)", count_ - 1, places);
        if (count_ > 0) warnings.push_back(std::move(first_));
    }

private:
    std::string first_;
    std::size_t count_ = 0;
};

std::vector<bool> shownMeshes(const Scene& scene) {
    std::vector<bool> shown(scene.meshes.size(), false);
    for (const Instance& instance : scene.instances()) shown[std::size_t(instance.mesh)] = true;
    return shown;
}

/** Longest edge over the height upon it is more than kLargestAspect; not those without any area. */
bool isSliver(const Primitive& primitive, std::size_t triangle) {
    const std::uint32_t* const corner = &primitive.indices[3 * triangle];
    const glm::dvec3 a(primitive.positions[corner[0]]), b(primitive.positions[corner[1]]),
        c(primitive.positions[corner[2]]);
    const glm::dvec3 u = b - a, v = c - a, w = c - b;
    const double twiceArea = glm::length(glm::cross(u, v));
    const double longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(w, w)});
    return twiceArea > 0 && longest > kLargestAspect * twiceArea;
}

std::size_t sliversOf(const Primitive& primitive) {
    return countWhere(primitive.indices.size() / 3, [&](std::size_t t) { return isSliver(primitive, t); });
}

/** Largest extent of a mesh along an axis, shapes left out. */
double extentOf(const Mesh& mesh) {
    glm::vec3 lower(std::numeric_limits<float>::infinity()), upper = -lower;
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.shape) continue;
        for (const glm::vec3& p : primitive.positions) {
            lower = glm::min(lower, p);
            upper = glm::max(upper, p);
        }
    }
    const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
    return std::max({size.x, size.y, size.z, 0.0});
}

/** Squared distance of p from a triangle: to its nearest corner, edge or face (Ericson, "Real-Time Collision
 * Detection", 2005, 5.1.5). */
double squaredDistance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const auto toEdge = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const glm::dvec3 along = to - from, off = p - from;
        const double squared = glm::dot(along, along);
        const double t = squared > 0 ? std::clamp(glm::dot(off, along) / squared, 0.0, 1.0) : 0.0;
        const glm::dvec3 left = off - t * along;
        return glm::dot(left, left);
    };
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double squared = glm::dot(normal, normal);
    const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return glm::dot(glm::cross(to - from, p - from), normal) >= 0;
    };
    if (squared > 0 && inside(a, b) && inside(b, c) && inside(c, a)) {
        const double height = glm::dot(p - a, normal);
        return height * height / squared;
    }
    return std::min({toEdge(a, b), toEdge(b, c), toEdge(c, a)});
}

double largestOf(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/** Distance of the first triangle of an instance that is nearer to the eye than kNearestEye allows; infinite
 * for none. */
double tooNear(const Primitive& primitive, const glm::dmat4& transform, const glm::dvec3& origin,
               const glm::dvec3& eye) {
    const auto corner = [&](std::size_t i) {
        return glm::dvec3(transform * glm::dvec4(primitive.positions[primitive.indices[i]], 1.0)) - origin;
    };
    constexpr double none = std::numeric_limits<double>::infinity();
    const double eyeReach = largestOf(eye);
    const auto distance = [&](std::size_t t) {
        const glm::dvec3 a = corner(3 * t), b = corner(3 * t + 1), c = corner(3 * t + 2);
        const double near = kNearestEye * std::max({largestOf(a), largestOf(b), largestOf(c), eyeReach});
        if (glm::any(glm::lessThan(eye, glm::min(a, glm::min(b, c)) - near)) ||
            glm::any(glm::greaterThan(eye, glm::max(a, glm::max(b, c)) + near)))
            return none;
        const double squared = squaredDistance(eye, a, b, c);
        return squared < near * near ? std::sqrt(squared) : none;
    };
    const std::size_t count = primitive.indices.size() / 3;
    const std::size_t found = firstWhere(count, [&](std::size_t t) { return distance(t) < none; });
    return found < count ? distance(found) : none;
}

}  // namespace

void warnOfEye(const Scene& scene, const Scene::Bounds& bounds, const glm::dvec3& origin,
               const glm::dvec3& eye, std::vector<std::string>& warnings) {
    if (bounds.empty()) return;
    const double most =
        kNearestEye * std::max({largestOf(bounds.lower), largestOf(bounds.upper), largestOf(eye)});
    if (glm::any(glm::lessThan(eye, bounds.lower - most)) ||
        glm::any(glm::greaterThan(eye, bounds.upper + most)))
        return;
    for (const Instance& instance : scene.instances())
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives) {
            if (primitive.shape) continue;
            const double distance = tooNear(primitive, instance.transform, origin, eye);
            if (std::isinf(distance)) continue;
            warnings.push_back(
                fmt::format("the camera is {:.2g} from a triangle of mesh {}, where steps of single "
                            "precision are as large: it "
                            "may count as behind it; move it off",
                            distance, instance.mesh));
            return;
        }
}

void warnOfTexcoords(const Scene& scene, std::vector<std::string>& warnings) {
    const std::vector<bool> shown = shownMeshes(scene);
    FirstOfMany primitivesWithout;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const auto& primitives = scene.meshes[m].primitives;
        for (std::size_t p = 0; shown[m] && p < primitives.size(); ++p) {
            if (primitives[p].material < 0 || primitives[p].shape) continue;
            const int set = missingSet(scene.materials[std::size_t(primitives[p].material)], primitives[p]);
            if (set < 0) continue;
            primitivesWithout.add([&] {
                return fmt::format(
                    "mesh {} primitive {} has no texture coordinate set {}, which material {} names: it is "
                    "taken as 0, 0",
                    m, p, set, primitives[p].material);
            });
        }
    }
    primitivesWithout.addTo(warnings, "primitives");
}

void warnOfExtent(const Scene::Bounds& bounds, const glm::dvec3& eye, std::vector<std::string>& warnings) {
    if (bounds.empty()) return;
    double reach = 0;
    for (const glm::dvec3& point : {bounds.lower, bounds.upper, eye})
        reach = std::max({reach, std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    if (!(reach <= kLargestCoordinate)) {
        warnings.push_back(fmt::format(
            "the scene or its camera reaches to {:.3g} from the origin: above {:g} products of "
            "coordinates leave the range of single precision and surfaces may be missing; scale the "
            "scene down",
            reach, kLargestCoordinate));
    }
    const glm::dvec3 size = bounds.upper - bounds.lower;
    const double extent = std::max({size.x, size.y, size.z});
    if (extent < kSmallestExtent) {
        warnings.push_back(fmt::format(
            "the scene is {:.3g} across: below {:g} products of its edges leave the range of single "
            "precision and surfaces may be missing; scale the scene up",
            extent, kSmallestExtent));
    }
}

void warnOfPrecision(const Scene& scene, std::vector<std::string>& warnings) {
    const std::vector<bool> shown = shownMeshes(scene);
    FirstOfMany farMeshes;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        if (!shown[m]) continue;
        glm::vec3 lower(std::numeric_limits<float>::infinity()), upper = -lower;
        for (const Primitive& primitive : scene.meshes[m].primitives)
            for (const glm::vec3& p : primitive.positions) {
                lower = glm::min(lower, p);
                upper = glm::max(upper, p);
            }
        const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
        const glm::dvec3 reach = glm::max(glm::abs(glm::dvec3(lower)), glm::abs(glm::dvec3(upper)));
        const double extent = std::max({size.x, size.y, size.z}),
                     distance = std::max({reach.x, reach.y, reach.z});
        if (!(extent > 0) || distance <= kFarthestVertices * extent) continue;
        farMeshes.add([&] {
            return fmt::format(
                "mesh {}: its vertices lie {:.2g} of its sizes from their origin, where single precision "
                "leaves "
                "steps of {:.1g} of its size; give positions about the mesh and move it by its node",
                m, distance / extent, distance / extent * double(std::numeric_limits<float>::epsilon()));
        });
    }
    farMeshes.addTo(warnings, "meshes");
}

void warnOfProportions(const Scene& scene, std::vector<std::string>& warnings) {
    const std::vector<bool> shown = shownMeshes(scene);
    std::size_t slivers = 0;
    std::vector<double> extents;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        extents.push_back(shown[m] ? extentOf(scene.meshes[m]) : 0);
        for (const Primitive& primitive : scene.meshes[m].primitives)
            if (shown[m] && !primitive.shape) slivers += sliversOf(primitive);
    }
    if (slivers > 0) {
        warnings.push_back(
            fmt::format("{} triangle{} more than {:g} times as long as wide: rays that leave {} may start in "
                        "a neighbour, "
                        "and light be off by a percent; cut {} across",
                        slivers, slivers == 1 ? " is" : "s are", kLargestAspect, slivers == 1 ? "it" : "them",
                        slivers == 1 ? "it" : "them"));
    }
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    int largestMesh = -1;
    for (const Instance& instance : scene.instances()) {
        double scale = 0;
        for (int axis = 0; axis < 3; ++axis)
            scale = std::max(scale, glm::length(glm::dvec3(instance.transform[axis])));
        const double extent = extents[std::size_t(instance.mesh)] * scale;
        if (!(extent > 0)) continue;
        smallest = std::min(smallest, extent);
        if (extent > largest) largestMesh = instance.mesh;
        largest = std::max(largest, extent);
    }
    if (largest > kLargestContrast * smallest) {
        warnings.push_back(fmt::format(
            "mesh {} is {:.2g} times as large as the smallest mesh: single precision places points on it by "
            "steps of {:.1g} of that one's size; use a smaller one, or an environment in its place",
            largestMesh, largest / smallest,
            largest / smallest * double(std::numeric_limits<float>::epsilon())));
    }
}

}  // namespace helio
