#include "passes/renderer/scene_warnings.hpp"

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

}  // namespace

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

}  // namespace helio
