#pragma once
/** @file Numbers from pictures, and scenes whose picture is one known number. */
#include <heliograph/image.hpp>
#include <heliograph/renderer.hpp>

#include <cstdint>

namespace helio::test {

/** Independent samples, whose variance channel means what it says. */
RenderOptions independentSamples(std::uint32_t size, std::uint32_t samples,
                                 Pipeline pipeline = Pipeline::Path);

/** Mean over red, green and blue of all pixels, and its standard error. */
struct Mean {
    double value = 0, error = 0;
};
Mean meanOf(const ImageF& image);

/** The box sample's room with a patch at the origin that a square light of this side and radiance 1 (where it
 * is small: flux 1) one unit above lights: the picture's value is `truth`. */
struct KnownScene {
    Scene scene;
    double truth = 0;
};
KnownScene squareLight(float side);
/** A closed room that emits 1 and reflects `albedo`: 1 / (1 - albedo) everywhere. */
KnownScene furnace(float albedo);
/** A ball of smooth glass by Fresnel's equations under a sky of 1: 1 everywhere. */
KnownScene glassBall(float index);
/** A ball of white metal under a sky of 1, seen from near: 1 but for what single scattering loses. */
KnownScene metalBall(float roughness);
/** A plane of reflectance 1/2 at z = 0 under a sky of 1, of triangles `aspect` times as long as wide: 1/2. */
KnownScene slivers(double aspect);

}  // namespace helio::test
