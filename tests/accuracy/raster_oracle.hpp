#pragma once
/** @file
 * The rasterizer's oracle: its documented rules, written a second time on the host and pixel by pixel.
 * Transform and clip in double, snap to 1/256 pixel, coverage in 128-bit integers with the top-left rule,
 * depth from the plane in long double.
 */
#include "passes/raster/view.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace helio::test {

/** A triangle as the device reads it. */
struct RasterTriangle {
    glm::vec3 v0;
    std::uint32_t id = 0;
    glm::vec3 v1;
    std::uint32_t instance = 0;
    glm::vec3 v2;
    std::uint32_t material = 0;
};
static_assert(sizeof(RasterTriangle) == 48);

struct OraclePixel {
    std::uint64_t key = 0;
    std::uint32_t hits = 0;  ///< triangles that cover the centre
    float runnerUp = 0;      ///< depth of the second nearest
};

/** Calls `covered(x, y)` for every pixel whose centre a triangle of snapped corners (1/256 pixel) covers. */
template <typename Covered>
void coverExactly(std::array<std::array<std::int64_t, 2>, 3> p, int width, int height, Covered covered) {
    __extension__ typedef __int128 Int;
    const auto area =
        Int(p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - Int(p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    if (area == 0) return;
    if (area < 0) std::swap(p[1], p[2]);
    const auto [xLow, xHigh] = std::minmax({p[0][0], p[1][0], p[2][0]});
    const auto [yLow, yHigh] = std::minmax({p[0][1], p[1][1], p[2][1]});
    const auto cut = [](std::int64_t v, int most) { return int(std::clamp<std::int64_t>(v, 0, most)); };
    const int x0 = cut((xLow >> 8) - 1, width), x1 = cut((xHigh >> 8) + 2, width);
    const int y0 = cut((yLow >> 8) - 1, height), y1 = cut((yHigh >> 8) + 2, height);
    for (int y = y0; y < y1; ++y) {
        std::array<Int, 3> e, step;
        std::array<bool, 3> owns;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto &a = p[k], &b = p[(k + 1) % 3];
            const std::int64_t dx = b[0] - a[0], dy = b[1] - a[1];
            e[k] = Int(dx) * (256 * std::int64_t(y) + 128 - a[1]) -
                   Int(dy) * (256 * std::int64_t(x0) + 128 - a[0]);
            step[k] = -Int(dy) * 256;
            // y runs down: an edge going up is a left edge, a level one going right a top edge.
            owns[k] = dy < 0 || (dy == 0 && dx > 0);
        }
        for (int x = x0; x < x1; ++x) {
            bool inside = true;
            for (std::size_t k = 0; k < 3; ++k) {
                inside &= e[k] > 0 || (e[k] == 0 && owns[k]);
                e[k] += step[k];
            }
            if (inside) covered(x, y);
        }
    }
}

/** Draws triangles one by one. */
class RasterOracle {
public:
    explicit RasterOracle(const RasterView& view)
        : view_(view), pixels_(std::size_t(view.width) * view.height) {}

    void draw(const RasterTriangle& triangle) {
        const Corner p[3] = {project(triangle.v0), project(triangle.v1), project(triangle.v2)};
        std::vector<Corner> polygon(p, p + 3);
        for (int plane = 0; plane < 5; ++plane) polygon = clip(polygon, plane);
        if (polygon.size() < 3) return;
        std::vector<std::array<std::int64_t, 2>> snapped;
        for (const Corner& c : polygon)
            snapped.push_back({std::int64_t(std::floor(c.x / c.w * 256.0 + 0.5)),
                               std::int64_t(std::floor(c.y / c.w * 256.0 + 0.5))});
        const auto depth = depthFunction(p);
        ++drawn_;
        for (std::size_t k = 1; k + 1 < snapped.size(); ++k)
            coverExactly({snapped[0], snapped[k], snapped[k + 1]}, int(view_.width), int(view_.height),
                         [&](int x, int y) {
                             const std::size_t index = std::size_t(y) * view_.width + std::size_t(x);
                             // Parts of one triangle may share a pixel.
                             if (std::exchange(lastDrawn_[index], drawn_) == drawn_) return;
                             add(pixels_[index], depth(x, y), triangle.id);
                         });
    }

    const std::vector<OraclePixel>& pixels() const { return pixels_; }

private:
    struct Corner {
        double x, y, w, z, near;
    };

    static void add(OraclePixel& pixel, float depth, std::uint32_t id) {
        const std::uint64_t key =
            std::uint64_t(std::bit_cast<std::uint32_t>(depth)) << 32 | std::uint32_t(~id);
        const float nearest = std::bit_cast<float>(std::uint32_t(pixel.key >> 32));
        pixel.runnerUp = std::max(pixel.runnerUp, std::min(nearest, depth));
        pixel.key = std::max(pixel.key, key);
        ++pixel.hits;
    }

    Corner project(const glm::vec3& vertex) const {
        const glm::dvec3 d = glm::dvec3(vertex) - view_.eye;
        const auto along = [&](const glm::dvec3& row) { return row.x * d.x + row.y * d.y + row.z * d.z; };
        const double x = along(view_.rowX), y = along(view_.rowY), v = along(view_.rowW);
        if (!view_.orthographic) return {x, y, v, view_.depthOffset, v - view_.depthOffset};
        const double z = view_.depthOffset + view_.depthSlope * v;
        return {x + 0.5 * view_.width, y + 0.5 * view_.height, 1.0, z, 1.0 - z};
    }

    static double distance(const Corner& c, int plane) {
        const double reach = 32768.0 * c.w;
        switch (plane) {
            case 0:
                return c.near;
            case 1:
                return c.x + reach;
            case 2:
                return reach - c.x;
            case 3:
                return c.y + reach;
            default:
                return reach - c.y;
        }
    }

    static std::vector<Corner> clip(const std::vector<Corner>& polygon, int plane) {
        std::vector<Corner> kept;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Corner &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
            const double da = distance(a, plane), db = distance(b, plane);
            if (da >= 0) kept.push_back(a);
            if ((da >= 0) == (db >= 0)) continue;
            const Corner &in = da >= 0 ? a : b, &out = da >= 0 ? b : a;
            const double dIn = da >= 0 ? da : db, dOut = da >= 0 ? db : da;
            const double t = dIn / (dIn - dOut);
            kept.push_back({in.x + t * (out.x - in.x), in.y + t * (out.y - in.y), in.w + t * (out.w - in.w),
                            0.0, in.near + t * (out.near - in.near)});
        }
        return kept;
    }

    /** Depth at a pixel's centre, kept within the corners' range. */
    std::function<float(int, int)> depthFunction(const Corner* p) const {
        using Long = long double;
        // (a, b, c).(X, Y, w) = Z at the three corners, by Cramer's rule.
        const auto determinant = [](const std::array<std::array<Long, 3>, 3>& m) {
            return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                   m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                   m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        };
        std::array<std::array<Long, 3>, 3> rows;
        for (std::size_t k = 0; k < 3; ++k) rows[k] = {p[k].x, p[k].y, p[k].w};
        const Long whole = determinant(rows);
        std::array<Long, 3> plane;
        for (std::size_t column = 0; column < 3; ++column) {
            auto m = rows;
            for (std::size_t k = 0; k < 3; ++k) m[k][column] = p[k].z;
            plane[column] = determinant(m) / whole;
        }
        float low = 2.0f, high = 0.0f;
        for (int k = 0; k < 3; ++k) {
            const float d = p[k].near < 0 ? 1.0f : float(p[k].z / p[k].w);
            low = std::min(low, d);
            high = std::max(high, d);
        }
        return [=](int x, int y) {
            const float d = float(plane[0] * (x + 0.5L) + plane[1] * (y + 0.5L) + plane[2]);
            return d > low ? std::min(d, high) : low;
        };
    }

    RasterView view_;
    std::vector<OraclePixel> pixels_;
    std::vector<std::uint32_t> lastDrawn_ = std::vector<std::uint32_t>(pixels_.size());
    std::uint32_t drawn_ = 0;
};

}  // namespace helio::test
