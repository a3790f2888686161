#include "passes/pathtrace/unrolled_scene.hpp"

#include "passes/scene/packed_scene.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace helio {
namespace {

/** A float by its bits: what the buffers hold, whatever the compiler's reading of decimals. */
std::string literal(float value) {
    return fmt::format("uintBitsToFloat(0x{:08x}u)", glm::floatBitsToUint(value));
}

struct Corners {
    std::array<glm::vec3, 3> at;
};

/** Triangle pairs as a quadrilateral: first is (0, 1, 3), second (2, 3, 1). */
struct Quad {
    std::array<glm::vec3, 4> corner;
};

/** Whether two triangles share an edge and make a flat convex quadrilateral whose diagonal splits it into
 * parts of comparable size. Flat: the corner across lies in the first's plane as far as floats can say. */
bool makesQuad(const Corners& a, const Corners& b, Quad& quad) {
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            if (a.at[(i + 1) % 3] != b.at[(k + 2) % 3] || a.at[(i + 2) % 3] != b.at[(k + 1) % 3]) continue;
            quad.corner = {a.at[i], a.at[(i + 1) % 3], b.at[k], a.at[(i + 2) % 3]};
            std::array<glm::dvec3, 4> q;
            glm::dvec3 size(0.0);
            for (std::size_t c = 0; c < 4; ++c) {
                q[c] = glm::dvec3(quad.corner[c]);
                size = glm::max(size, glm::abs(q[c]));
            }
            const glm::dvec3 across = glm::cross(q[1] - q[0], q[3] - q[0]);
            const double area = glm::length(across);
            if (!(area > 0.0)) continue;
            const glm::dvec3 normal = across / area;
            if (std::abs(glm::dot(normal, q[2] - q[0])) >
                2.0 * double(std::numeric_limits<float>::epsilon()) * glm::dot(glm::abs(normal), size))
                continue;
            bool convex = true;
            for (std::size_t c = 0; c < 4; ++c) {
                const glm::dvec3 turn = glm::cross(q[(c + 1) % 4] - q[c], q[(c + 2) % 4] - q[(c + 1) % 4]);
                convex = convex && glm::dot(turn, normal) > 0.05 * area;
            }
            if (convex) return true;
        }
    return false;
}

struct VecLess {
    bool operator()(const glm::vec3& a, const glm::vec3& b) const {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    }
};

/** One function over all triangles: the closest hit, or whether there is any. */
class Writer {
public:
    Writer(std::span<const glm::vec4> triangles, std::size_t firstSlot, std::set<std::size_t> lights,
           bool any)
        : triangles_(triangles), firstSlot_(firstSlot), lights_(std::move(lights)), any_(any) {}

    std::string write() {
        text_ = any_ ? "bool testAny(vec3 origin, vec3 direction, int source, int target, float nearest) {\n"
                       "    bool blocked = false;\n"
                     : "void testAll(vec3 origin, vec3 direction, int source, inout float nearest, out int "
                       "slot, out int g) {\n"
                       "    slot = g = -1;\n";
        text_ +=
            "    const RayShear ray = shearOf(origin, direction);\n"
            "    float t;\n"
            "    int half_;\n"
            "    bool hit;\n";
        const std::size_t count = triangles_.size() / 3;
        for (std::size_t i = 0; i < count; ++i) {
            Quad quad;
            if (i + 1 < count && g(i + 1) == g(i) + 1 && makesQuad(corners(i), corners(i + 1), quad)) {
                std::array<std::string, 4> q;
                for (std::size_t c = 0; c < 4; ++c) q[c] = name(quad.corner[c]);
                text_ += fmt::format("    hit = meetsQuad(ray, {}, {}, {}, {}, nearest, t, half_)", q[0],
                                     q[1], q[2], q[3]);
                finish(i, 2);
                ++i;
            } else {
                std::array<std::string, 3> p;
                for (std::size_t c = 0; c < 3; ++c) p[c] = name(corners(i).at[c]);
                text_ +=
                    fmt::format("    hit = meetsTriangle(ray, {}, {}, {}, nearest, t)", p[0], p[1], p[2]);
                finish(i, 1);
            }
        }
        text_ += any_ ? "    return blocked;\n}\n" : "}\n";
        return text_;
    }

private:
    Corners corners(std::size_t i) const {
        return {{glm::vec3(triangles_[i * 3]), glm::vec3(triangles_[i * 3 + 1]),
                 glm::vec3(triangles_[i * 3 + 2])}};
    }
    std::size_t g(std::size_t i) const { return glm::floatBitsToUint(triangles_[i * 3].w); }

    /** Name of a corner, declared when it is first used. */
    std::string name(const glm::vec3& p) {
        const auto [place, isNew] = index_.try_emplace(p, index_.size());
        if (isNew)
            text_ += fmt::format("    const vec3 p{} = sheared(ray, vec3({}, {}, {}));\n", place->second,
                                 literal(p.x), literal(p.y), literal(p.z));
        return fmt::format("p{}", place->second);
    }

    /** What comes of a hit of the `count` triangles from the i-th on, which are in one plane. */
    void finish(std::size_t i, std::size_t count) {
        const auto excluded = [&](const char* what, std::size_t number) {
            return count == 1 ? fmt::format(" && {} != {}", what, number)
                              : fmt::format(" && uint({} - {}) > 1u", what, number);
        };
        const std::size_t slot = firstSlot_ + i;
        text_ += excluded("source", slot);
        // Only lights are ever a shadow ray's target.
        if (any_ && (lights_.contains(g(i)) || (count == 2 && lights_.contains(g(i + 1)))))
            text_ += excluded("target", g(i));
        if (any_)
            text_ += ";\n    blocked = blocked || hit;\n";
        else
            text_ += fmt::format(
                ";\n    nearest = hit ? t : nearest;\n    slot = hit ? {0}{2} : slot;\n    g = hit ? {1}{2} "
                ": g;\n",
                slot, g(i), count == 2 ? " + half_" : "");
    }

    std::span<const glm::vec4> triangles_;
    std::size_t firstSlot_;
    std::set<std::size_t> lights_;
    bool any_;
    std::string text_;
    std::map<glm::vec3, std::size_t, VecLess> index_;
};

}  // namespace

std::string unrolledScene(const PackedScene& packed) {
    const std::vector<glm::vec4>& triangles = packed.writtenOut;
    const std::vector<glm::vec4>& lights = packed.lights;
    const std::size_t firstSlot = packed.firstWrittenOut;
    std::string text = firstSlot == 0 ? "#define UNROLLED_SCENE\n" : "#define UNROLLED_BESIDE_TREE\n";
    if (lights.size() == kLightTexels) {
        text += "#define UNROLLED_LIGHT uvec4[](";
        for (std::size_t i = 0; i < lights.size(); ++i)
            text += fmt::format("{}uvec4(0x{:08x}u, 0x{:08x}u, 0x{:08x}u, 0x{:08x}u)", i == 0 ? "" : ", ",
                                glm::floatBitsToUint(lights[i].x), glm::floatBitsToUint(lights[i].y),
                                glm::floatBitsToUint(lights[i].z), glm::floatBitsToUint(lights[i].w));
        text += ")\n";
    }
    const std::set<std::size_t> lightTriangles(packed.writtenOutEmitters.begin(),
                                               packed.writtenOutEmitters.end());
    text += "#ifdef HELIOGRAPH_INTERSECTION_SCENE_HIT\n";
    text += Writer(triangles, firstSlot, lightTriangles, false).write();
    text += Writer(triangles, firstSlot, lightTriangles, true).write();
    text += "#endif\n";
    return text;
}

}  // namespace helio
