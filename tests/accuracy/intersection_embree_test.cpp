// The closest hit is Embree's triangle, and its distance lies within a proven bound of that triangle's hit in
// double precision. The long run:
//   HELIOGRAPH_RAYS=1e7 build/tests/accuracy/accuracy_intersection --gtest_filter='*Embree*'
#include "tests/accuracy/intersection_support.hpp"
#include "tests/support/embree_scene.hpp"
#include "tests/support/meshes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <thread>

namespace helio::test {
namespace {

/** A ray and a triangle in double, in the kernel's frame (shaders/intersection/triangle.glsl), with a bound
 * of the kernel's rounding in single precision. */
struct Reference {
    double t = 0;      ///< where the ray meets the triangle's plane
    double bound = 0;  ///< of the kernel's error in t, where it finds a hit
    double outside =
        0;  ///< how far the ray passes outside of the triangle, in units of what rounding can decide: edges'
            ///< functions over their bound; at most 1 where the kernel may count it in
    double inside = 0;  ///< the same inwards
    bool degenerate = false;
};

/**
 * u = 2^-24. The frame's axes are permuted so that d_z is the largest component; s = -d / d_z. A moved corner
 * is p = fl(v - o), |dp| <= u |p|. A sheared coordinate x = p_x + s_x p_z is off by at most u (3 |p_x| + 6
 * |s_x p_z|) to first order: s by 2u, its product and the two sums (one with an exact 0) by u each, and p. An
 * edge function e = c_x b_y - c_y b_x is off by 2u (|c_x b_y| + |c_y b_x|) and what the coordinates' errors
 * make of it. With e_i of one sign t = sum(e_i z_i) / sum(e_i) / d_z is a mean of the corners' distances: it
 * is off by sum(de_i |t_i - t|) / |sum(e_i)| and at most 9u max |t_i| for the two sums, products, quotient,
 * p_z and 1 / d_z. Second order is covered by a factor of 1.01 where the first-order terms are small, else
 * the triangle is degenerate.
 */
Reference referenceOf(const Ray& ray, const glm::vec3* corners) {
    constexpr double u = 0x1p-24;
    const glm::dvec3 d(ray.direction);
    const glm::dvec3 size = glm::abs(d);
    const int kz = size.z >= size.x && size.z >= size.y ? 2 : (size.x >= size.y ? 0 : 1);
    const int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
    const double sx = -d[kx] / d[kz], sy = -d[ky] / d[kz];
    std::array<double, 3> x, y, t, dx, dy;
    double farthest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 p = glm::dvec3(corners[i]) - glm::dvec3(ray.origin);
        x[i] = p[kx] + sx * p[kz];
        y[i] = p[ky] + sy * p[kz];
        t[i] = p[kz] / d[kz];
        dx[i] = u * (3 * std::abs(p[kx]) + 6 * std::abs(sx * p[kz]));
        dy[i] = u * (3 * std::abs(p[ky]) + 6 * std::abs(sy * p[kz]));
        farthest = std::max(farthest, std::abs(t[i]));
    }
    std::array<double, 3> e, de;
    double sum = 0, sumError = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t b = (i + 1) % 3, c = (i + 2) % 3;
        e[i] = x[c] * y[b] - y[c] * x[b];
        de[i] = 1.01 * (2 * u * (std::abs(x[c] * y[b]) + std::abs(y[c] * x[b])) + std::abs(x[c]) * dy[b] +
                        std::abs(y[b]) * dx[c] + std::abs(y[c]) * dx[b] + std::abs(x[b]) * dy[c] +
                        dx[c] * dy[b] + dx[b] * dy[c]);
        sum += e[i];
        sumError += de[i];
    }
    Reference result;
    const double sign = sum < 0 ? -1 : 1;
    result.degenerate = !(std::abs(sum) > 20 * sumError);
    result.t = (e[0] * t[0] + e[1] * t[1] + e[2] * t[2]) / sum;
    result.inside = std::numeric_limits<double>::infinity();
    double spread = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        spread += de[i] * std::abs(t[i] - result.t);
        result.outside = std::max(result.outside, -sign * e[i] / de[i]);
        result.inside = std::min(result.inside, sign * e[i] / de[i]);
    }
    result.bound = 1.07 * spread / std::abs(sum) + 9.1 * u * farthest;
    return result;
}

/** What became of the rays. */
struct Tally {
    double rays = 0, same = 0, misses = 0, ties = 0, edges = 0, wrong = 0;
    double worst = 0;  ///< error of t over its bound
    double degenerate = 0;
};

void compare(const Ray& ray, std::int32_t ours, double distance, std::int32_t theirs, const Corners& corners,
             Tally& tally) {
    ++tally.rays;
    const auto referenced = [&](std::int32_t triangle) {
        return referenceOf(ray, &corners[std::size_t(triangle) * 3]);
    };
    if (ours >= 0) {
        const Reference r = referenced(ours);
        if (r.degenerate)
            ++tally.degenerate;
        else
            tally.worst = std::max(tally.worst, std::abs(distance - r.t) / r.bound);
        if (!r.degenerate && r.outside > 1) ++tally.wrong;
    }
    if (ours == theirs) return void(++(ours >= 0 ? tally.same : tally.misses));
    // Within rounding of an edge, of either triangle: that one sees the ray and the other does not, or both
    // do.
    const auto atEdge = [&](std::int32_t triangle) {
        if (triangle < 0) return false;
        const Reference r = referenced(triangle);
        return r.degenerate || (r.inside < 4 && r.outside < 4);
    };
    if (ours >= 0 && theirs >= 0) {
        const Reference a = referenced(ours), b = referenced(theirs);
        if (std::abs(a.t - b.t) <= a.bound + b.bound) return void(++tally.ties);
    }
    if (atEdge(ours) || atEdge(theirs)) return void(++tally.edges);
    ++tally.wrong;
}

TEST(Intersection, ClosestHitIsEmbrees) {
    struct Named {
        const char* name;
        Corners corners;
    };
    const std::vector<Named> meshes = {
        {"sphere", octasphere(5)}, {"knot", knot()}, {"landscape", landscape(200000)}};
    const double count = rayCount(1.2e6) / double(meshes.size());
    for (const Named& mesh : meshes) {
        const EmbreeScene embree(mesh.corners, std::max(1u, std::thread::hardware_concurrency()), true);
        const PackedScene packed = packScene(sceneOf(mesh.corners));
        glm::vec3 lower(1e30f), upper(-1e30f);
        for (const glm::vec3& p : mesh.corners) {
            lower = glm::min(lower, p);
            upper = glm::max(upper, p);
        }
        std::mt19937 random(17);
        const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
        const auto inBox = [&] {
            return lower + (upper - lower) * glm::vec3(uniform(), uniform(), uniform());
        };
        // From all over the box and from afar, to all over the box.
        const auto next = [&] {
            const glm::vec3 target = inBox(),
                            origin = (random() & 1) != 0 ? inBox() : 3.0f * inBox() - target;
            return Ray{.origin = origin, .direction = glm::normalize(target - origin)};
        };
        Tally tally;
        sendRays(packed, RayQuestion::Closest, count, next, [&](const auto& rays, const auto& hits) {
            std::vector<RayHit> theirs(rays.size());
            embree.run(rays, RayQuestion::Closest, theirs);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const std::int32_t g = hits[i].slot < 0
                                           ? -1
                                           : std::int32_t(glm::floatBitsToUint(
                                                 packed.triangles[std::size_t(hits[i].slot) * 3].w));
                compare(rays[i], g, double(hits[i].distance), theirs[i].slot, mesh.corners, tally);
            }
        });
        fmt::print(
            "{}: {:.0f} rays, {:.0f} the same triangle, {:.0f} both miss, {:.0f} ties in distance, {:.0f} at "
            "an "
            "edge, {:.0f} wrong; worst error of t {:.3f} of its bound ({:.0f} degenerate left out)\n",
            mesh.name, tally.rays, tally.same, tally.misses, tally.ties, tally.edges, tally.wrong,
            tally.worst, tally.degenerate);
        EXPECT_EQ(tally.wrong, 0);
        EXPECT_LE(tally.worst, 1.0);
        EXPECT_LT(tally.degenerate, 1e-4 * tally.rays);
        EXPECT_GT(tally.same, 0.2 * tally.rays);
        EXPECT_LT(tally.ties + tally.edges, 1e-3 * tally.rays);
    }
}

}  // namespace
}  // namespace helio::test
