#include "engine/scene/lens_table.hpp"

#include "engine/core/shared.hpp"

#include <algorithm>
#include <cmath>

namespace helio {
namespace {

using shared64::Vec3;
using shared64::Vec4;

double open(const LensTable& lens, const LensSurface& surface) {
    return 0.5 * double(surface.diameter) * (surface.radius == 0 ? double(lens.stop) : 1.0L);
}

/** The index in front of surface i. */
double indexBefore(const LensTable& lens, std::size_t i) {
    return i == 0 ? 1.0L : double(lens.surfaces[i - 1].ior);
}

/** Refraction at a surface: (height, angle) to (height, angle). */
glm::dmat2 refraction(const LensTable& lens, std::size_t i) {
    const double before = indexBefore(lens, i), behind = double(lens.surfaces[i].ior);
    const double radius = double(lens.surfaces[i].radius);
    const double power = radius == 0 ? 0.0L : (behind - before) / (behind * radius);
    return {1.0L, -power, 0.0L, before / behind};
}
glm::dmat2 transfer(double distance) {
    return {1.0L, 0.0L, distance, 1.0L};
}

}  // namespace

ParaxialLens paraxial(const LensTable& lens) {
    ParaxialLens result;
    double pupil = std::numeric_limits<double>::infinity();  // radius
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        // A ray along the axis of height 1 has this one here.
        const double height = std::abs(result.matrix[0][0]);
        pupil = std::min(pupil, open(lens, lens.surfaces[i]) / height);
        result.matrix = refraction(lens, i) * result.matrix;
        if (i + 1 < lens.surfaces.size())
            result.matrix = transfer(double(lens.surfaces[i].thickness)) * result.matrix;
    }
    const double a = result.matrix[0][0], b = result.matrix[1][0], c = result.matrix[0][1],
                 d = result.matrix[1][1];
    result.focalLength = -1.0L / c;
    result.fNumber = result.focalLength / (2.0L * pupil);
    const double focus = double(lens.focusDistance) / double(lens.scale);
    // Where all rays of the object point meet: the height no longer depends on the angle.
    result.filmDistance = std::isinf(focus) ? -a / c : -(a * focus + b) / (c * focus + d);
    return result;
}

std::vector<glm::dvec4> tracedSurfaces(const LensTable& lens) {
    std::vector<glm::dvec4> surfaces;
    double vertex = 0;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const LensSurface& s = lens.surfaces[i];
        surfaces.emplace_back(double(s.radius), vertex, double(s.ior) / indexBefore(lens, i), open(lens, s));
        vertex -= double(s.thickness);
    }
    std::reverse(surfaces.begin(), surfaces.end());
    return surfaces;
}

std::vector<ExitPupil> exitPupils(const LensTable& lens, double reach, int count) {
    constexpr int points = 4, side = 96;
    const std::vector<glm::dvec4> surfaces = tracedSurfaces(lens);
    const double rear = surfaces[0].y, film = rear - paraxial(lens).filmDistance;
    // No ray passes the last surface farther out than it is open, seen from the plane of its vertex.
    const double widest = 1.5L * surfaces[0].w, step = 2 * widest / side;
    std::vector<ExitPupil> pupils(std::size_t(count), ExitPupil{widest, -widest, 0});
    for (int ring = 0; ring < count; ++ring)
        for (int k = 0; k <= points; ++k) {
            const Vec3 from(reach * (ring + double(k) / points) / count, 0, film);
            for (int i = 0; i <= side; ++i)
                for (int j = 0; j <= side / 2; ++j) {
                    const double x = -widest + i * step, y = j * step;
                    Vec3 origin = from, direction = glm::normalize(Vec3(x, y, rear) - from);
                    bool passes = true;
                    for (const Vec4 surface : surfaces)
                        passes = passes && shared64::crossLensSurface(surface, origin, direction);
                    if (!passes) continue;
                    ExitPupil& pupil = pupils[std::size_t(ring)];
                    // What the grid steps over counts too.
                    pupil.low = std::min(pupil.low, x - step);
                    pupil.high = std::max(pupil.high, x + step);
                    pupil.side = std::max(pupil.side, y + step);
                }
        }
    return pupils;
}

}  // namespace helio
