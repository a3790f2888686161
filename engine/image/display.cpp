#include "engine/image/display.hpp"

#include "engine/core/shared.hpp"

#include <algorithm>
#include <cmath>

namespace helio {

std::array<float, 3> displayed(const std::array<float, 3>& linear, const Display& display) {
    const double scale = std::exp2(display.exposure);
    shared64::Vec3 color(0);
    for (int c = 0; c < 3; ++c) {
        const double value = double(linear[std::size_t(c)]) * scale;
        color[c] = value > 0 ? std::min(value, double(std::numeric_limits<float>::max())) : 0;
    }
    const shared64::Vec3 shown = shared64::toneCurve(shared64::uint(display.curve), color);
    return {float(shown.x), float(shown.y), float(shown.z)};
}

}  // namespace helio
