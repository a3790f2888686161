#include "passes/bake/atlas.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace helio::bake {
namespace {

constexpr std::uint32_t kNone = ~0u;

[[noreturn]] void refuse(const Scene& scene, const std::string& place, const std::string& fault,
                         const std::string& remedy) {
    throw InputError(scene.name, place, fault, remedy);
}

/** Corners of a triangle of the instance, in the world, with the place in the image in texels. */
struct Corners {
    std::array<glm::dvec3, 3> position, normal;
    std::array<glm::dvec2, 3> at;
    glm::dvec3 face;
};

}  // namespace

std::size_t chosenInstance(const Scene& scene, const std::vector<Instance>& instances,
                           const std::string& node) {
    for (std::size_t i = 0; i < instances.size(); ++i)
        if (node.empty() || scene.nodes[std::size_t(instances[i].node)].name == node) return i;
    refuse(scene, "bake", fmt::format("no node '{}' has a mesh", node), "name one that has");
}

void check(const Scene& scene, const BakeOptions& options) {
    if (options.size < 1 || options.size > 8192 || options.samples < 1 || options.samples > (1u << 16))
        refuse(scene, "bake", fmt::format("{} texels with {} rays each", options.size, options.samples),
               "ask for 1 to 8192 texels and 1 to 65536 rays");
    if (!(options.distance > 0))
        refuse(scene, "bake", fmt::format("a distance of {}", options.distance), "give one above 0");
}

std::vector<AtlasTexel> atlasTexels(const Scene& scene, const Instance& instance, int texcoord,
                                    std::uint32_t size) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    const std::string place =
        fmt::format("mesh {}{}", instance.mesh, mesh.name.empty() ? "" : " '" + mesh.name + "'");
    const glm::dmat3 linear(instance.transform);
    const glm::dmat3 forNormals = glm::transpose(glm::inverse(linear));
    // As a transform turns the winding it turns the front.
    const double side = glm::determinant(linear) < 0 ? -1 : 1;
    std::vector<std::uint32_t> owner(std::size_t(size) * size, kNone);
    std::vector<AtlasTexel> texels;
    std::uint64_t doubled = 0;
    std::uint32_t triangle = 0;
    for (const Primitive& p : mesh.primitives) {
        if (p.shape) refuse(scene, place, "a shape has no texture coordinates", "bake a mesh of triangles");
        if (texcoord < 0 || std::size_t(texcoord) >= p.texcoords.size() ||
            p.texcoords[std::size_t(texcoord)].size() != p.positions.size())
            refuse(scene, place, fmt::format("has no texture coordinates {}", texcoord),
                   "unwrap it, or choose another set");
        const std::vector<glm::vec2>& uv = p.texcoords[std::size_t(texcoord)];
        for (std::size_t i = 0; i + 2 < p.indices.size(); i += 3, ++triangle) {
            Corners c;
            glm::dvec2 low(size), high(0);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t index = p.indices[i + k];
                c.position[k] =
                    glm::dvec3(instance.transform * glm::dvec4(glm::dvec3(p.positions[index]), 1.0));
                c.normal[k] = p.normals.empty() ? glm::dvec3(0.0) : forNormals * glm::dvec3(p.normals[index]);
                const glm::dvec2 t(uv[index]);
                if (!(t.x >= -1e-4 && t.y >= -1e-4 && t.x <= 1 + 1e-4 && t.y <= 1 + 1e-4))
                    refuse(scene, place,
                           fmt::format("texture coordinates ({}, {}) lie outside of the image", t.x, t.y),
                           "unwrap it into 0 to 1");
                c.at[k] = t * double(size);
                low = glm::min(low, c.at[k]);
                high = glm::max(high, c.at[k]);
            }
            const glm::dvec3 across =
                side * glm::cross(c.position[1] - c.position[0], c.position[2] - c.position[0]);
            const double area = glm::length(across);
            const glm::dvec2 e1 = c.at[1] - c.at[0], e2 = c.at[2] - c.at[0];
            const double turn = e1.x * e2.y - e1.y * e2.x;
            if (!(area > 0) || turn == 0) continue;
            c.face = across / area;
            const auto first = [](double v) { return std::uint32_t(std::max(0.0, std::ceil(v - 0.5))); };
            for (std::uint32_t y = first(low.y); y < size && y + 0.5 <= high.y; ++y)
                for (std::uint32_t x = first(low.x); x < size && x + 0.5 <= high.x; ++x) {
                    const glm::dvec2 d = glm::dvec2(x + 0.5, y + 0.5) - c.at[0];
                    const double b1 = (d.x * e2.y - d.y * e2.x) / turn, b2 = (e1.x * d.y - e1.y * d.x) / turn;
                    const double b0 = 1 - b1 - b2, least = std::min({b0, b1, b2});
                    if (least < -1e-9) continue;
                    std::uint32_t& has = owner[std::size_t(y) * size + x];
                    if (has != kNone) {
                        doubled += least > 1e-6;  // an edge may belong to two
                        continue;
                    }
                    has = triangle;
                    glm::dvec3 normal = b0 * c.normal[0] + b1 * c.normal[1] + b2 * c.normal[2];
                    if (!(glm::dot(normal, c.face) > 0)) normal = c.face;
                    texels.push_back(
                        {.texel = y * size + x,
                         .triangle = triangle,
                         .position = b0 * c.position[0] + b1 * c.position[1] + b2 * c.position[2],
                         .normal = glm::normalize(normal),
                         .face = c.face});
                }
        }
    }
    if (doubled > 0)
        refuse(scene, place, fmt::format("texture coordinates cover {} texels twice", doubled),
               "unwrap it so that every place has its own");
    if (texels.empty()) refuse(scene, place, "covers no texel", "bake a larger image");
    return texels;
}

void fillGaps(std::vector<float>& values, std::vector<bool> covered, std::uint32_t size) {
    const auto n = std::int64_t(size);
    for (bool open = true; open;) {
        open = false;
        std::vector<bool> next = covered;
        for (std::int64_t y = 0; y < n; ++y)
            for (std::int64_t x = 0; x < n; ++x) {
                if (covered[std::size_t(y * n + x)]) continue;
                double sum = 0;
                int count = 0;
                for (std::int64_t k = 0; k < 9; ++k) {
                    const std::int64_t i = x + k % 3 - 1, j = y + k / 3 - 1;
                    if (i < 0 || j < 0 || i >= n || j >= n || !covered[std::size_t(j * n + i)]) continue;
                    sum += double(values[std::size_t(j * n + i)]);
                    ++count;
                }
                if (count == 0) continue;
                values[std::size_t(y * n + x)] = float(sum / count);
                next[std::size_t(y * n + x)] = true;
                open = true;
            }
        covered = std::move(next);
    }
}

}  // namespace helio::bake
