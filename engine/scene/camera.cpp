/** @file Which camera a render uses, and the frame around a scene that has none. */
#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace helio {
namespace {

constexpr const char* frameName = "heliograph.frame";

PlacedCamera frameAround(Scene& scene, double aspect) {
    const Scene::Bounds bounds = scene.bounds();
    glm::dvec3 centre(0.0), forward(0, -0.5, -1), right(1, 0, 0);
    double radius = 0;
    if (!bounds.empty()) {
        centre = 0.5 * bounds.lower + 0.5 * bounds.upper;
        radius = glm::length(0.5 * bounds.upper - 0.5 * bounds.lower);
        // A point, or what single precision cannot tell from one at this distance from the origin.
        radius = std::max(radius, std::ldexp(glm::length(centre), -22));
        // A picture that stands across the x axis would be seen from its edge.
        if (bounds.upper.x - bounds.lower.x <= radius / 1000) {
            forward = {-1, -0.5, 0};
            right = {0, 0, -1};
        }
    }
    if (!(radius > 0)) radius = 1;

    constexpr double yfov = 45 * 3.14159265358979323846 / 180;
    const double halfHeight = std::tan(yfov / 2);
    const double halfAngle = std::atan(halfHeight * std::min(aspect, 1.0));
    const double distance = radius / std::sin(halfAngle);

    forward = glm::normalize(forward);
    const glm::dvec3 up = glm::cross(right, forward);
    PlacedCamera placed;
    placed.transform = glm::dmat4(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(-forward, 0),
                                  glm::dvec4(centre - distance * forward, 1));
    Camera camera;
    camera.name = frameName;
    camera.yfov = float(yfov);
    camera.znear = float(std::clamp(distance / 100, double(std::numeric_limits<float>::min()),
                                    double(std::numeric_limits<float>::max())));
    const auto old = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                  [](const Camera& c) { return c.name == frameName; });
    placed.camera = int(old - scene.cameras.begin());
    if (old == scene.cameras.end()) {
        scene.cameras.push_back(camera);
    } else {
        *old = camera;
    }
    return placed;
}

}  // namespace

PlacedCamera chooseCamera(Scene& scene, const std::string& nameOrIndex, double aspect) {
    const std::vector<PlacedCamera> placed = scene.placedCameras();
    if (nameOrIndex.empty()) return placed.empty() ? frameAround(scene, aspect) : placed.front();
    std::vector<std::string> names;
    for (const PlacedCamera& candidate : placed) {
        const std::string& cameraName = scene.cameras[std::size_t(candidate.camera)].name;
        const std::string& nodeName = scene.nodes[std::size_t(candidate.node)].name;
        if (cameraName == nameOrIndex || nodeName == nameOrIndex) return candidate;
        const std::string& name = cameraName.empty() ? nodeName : cameraName;
        if (!name.empty()) names.push_back(name);
    }
    std::size_t index = 0;
    const char* end = nameOrIndex.data() + nameOrIndex.size();
    const auto parsed = std::from_chars(nameOrIndex.data(), end, index);
    if (parsed.ec == std::errc() && parsed.ptr == end && index < placed.size()) return placed[index];
    std::string remedy = "the scene has none; leave it out to frame the scene";
    if (!placed.empty()) {
        const std::string named =
            names.empty() ? "" : fmt::format("one of '{}' or ", fmt::join(names, "', '"));
        remedy = fmt::format("give {}an index from 0 to {}", named, placed.size() - 1);
    }
    throw InputError(scene.name, "camera", fmt::format("there is no camera '{}'", nameOrIndex), remedy);
}

}  // namespace helio
