/** @file What a photographer sets, in terms of the scene's cameras. */
#include "engine/scene/photography.hpp"

#include "engine/core/shared.hpp"

#include <cmath>

namespace helio {

ThinLens thinLens(const Camera& camera, double fNumber, double focusDistance, double sensorHeight) {
    const double image = 0.5 * sensorHeight / std::tan(0.5 * double(camera.yfov));
    ThinLens lens;
    lens.apertureDiameter = float(shared64::focalLengthFor(image, focusDistance) / fNumber);
    lens.focusDistance = float(focusDistance);
    return lens;
}

glm::dvec2 lensPoint(const ThinLens& lens, const glm::dvec2& u) {
    return shared64::apertureSample(u, lens.blades, double(lens.bladeRotation));
}

double exposureValue(const Exposure& exposure) {
    return shared64::exposureValue100(double(exposure.fNumber), double(exposure.shutterSeconds),
                                      double(exposure.iso));
}

double exposureStops(const Exposure& exposure) {
    return -exposureValue(exposure) - std::log2(1.2L);
}

}  // namespace helio
