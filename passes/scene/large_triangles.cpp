#include "passes/scene/large_triangles.hpp"

#include <algorithm>
#include <utility>

namespace helio::pack {
namespace {

double boxArea(const glm::dvec3& size) {
    return 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

}  // namespace

std::vector<std::uint32_t> largeTriangles(std::span<const glm::vec3> positions, std::size_t most) {
    std::vector<std::uint32_t> large;
    if (positions.empty() || most == 0) return large;
    glm::vec3 low = positions[0], high = low;
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const double least = 0.03 * boxArea(glm::dvec3(high) - glm::dvec3(low));
    std::vector<std::pair<double, std::uint32_t>> found;
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
        const glm::vec3 lower = glm::min(glm::min(positions[i], positions[i + 1]), positions[i + 2]);
        const glm::vec3 upper = glm::max(glm::max(positions[i], positions[i + 1]), positions[i + 2]);
        const double area = boxArea(glm::dvec3(upper) - glm::dvec3(lower));
        if (area > 0.0 && area >= least) found.emplace_back(-area, std::uint32_t(i / 3));
    }
    std::sort(found.begin(), found.end());
    if (found.size() > most) found.resize(most);
    for (const auto& [area, triangle] : found) large.push_back(triangle);
    std::sort(large.begin(), large.end());
    return large;
}

}  // namespace helio::pack
