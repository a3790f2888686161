#pragma once
/** @file Cameras: how directions map to the image, lenses, and what a photographer sets. */
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace helio {

/** How a camera maps directions to its image. */
enum class Projection : std::uint8_t {
    Plane,        ///< a plane before the eye: perspective or orthographic
    LatLong,      ///< all directions: longitude across, latitude down; the viewing axis in the middle
    Equidistant,  ///< fisheye: the distance from the image's centre is the angle from the axis, r = f a
    Equisolid     ///< fisheye: r = 2 f sin(a / 2), equal areas of the image are equal solid angles
};

/** A thin lens about the camera's position, for perspective cameras: what lies in the plane at
 * `focusDistance` is sharp; all else is spread over a disc, or a polygon of as many corners as there are
 * blades. The field of view is that of the sharp plane. */
struct ThinLens {
    float apertureDiameter = 0;                                    ///< scene units; 0: a pinhole
    float focusDistance = std::numeric_limits<float>::infinity();  ///< along the axis, scene units
    int blades = 0;           ///< 0: a round aperture; else 3 or more corners, on the circle of that diameter
    float bladeRotation = 0;  ///< radians, counter-clockwise as seen in the picture
    bool operator==(const ThinLens&) const = default;
};

/** A spherical surface of a lens, or its aperture stop. */
struct LensSurface {
    float radius = 0;     ///< of curvature; positive: its centre lies on the film's side; 0: flat, the stop
    float thickness = 0;  ///< to the next surface, towards the film; of the last one unused
    float ior = 1;        ///< of what lies behind it, towards the film
    float diameter = 0;   ///< of what of it is open
    bool operator==(const LensSurface&) const = default;
};

/** A lens as its maker describes it, for perspective cameras: rays are traced through every surface. The
 * camera's position is that of the front surface; the field of view is not used. */
struct LensTable {
    std::vector<LensSurface> surfaces;  ///< from the front to the film
    float scale = 0.001f;               ///< scene units of a unit of the table; 0.001: millimetres
    float filmHeight = 24;              ///< units of the table
    float focusDistance = std::numeric_limits<float>::infinity();  ///< from the front surface, scene units
    float stop = 1;  ///< how far the stop (the flat surface) is open, as part of its diameter
    bool operator==(const LensTable&) const = default;
};

/** What a photographer sets. Only what is displayed goes by it, see RenderResult::exposure. */
struct Exposure {
    float fNumber = 16;
    float shutterSeconds = 0.01f;
    float iso = 100;
    bool operator==(const Exposure&) const = default;
};

/** When light falls on the film, seconds from the frame's time on. */
struct Shutter {
    double open = 0, close = 0;
    /** Seconds from the first row to the last: each row opens (row + 1/2) / rows of it later than `open`,
     * from the top down. 0: all rows at once. */
    double rolling = 0;
    bool operator==(const Shutter&) const = default;
};

struct Camera {
    std::string name;
    bool perspective = true;
    float yfov = 0.6911112f;  ///< vertical field of view
    float aspectRatio = 0;    ///< 0: the image's
    float ymag = 1;           ///< orthographic half height
    float znear = 0.01f;
    float zfar = std::numeric_limits<float>::infinity();
    Projection projection = Projection::Plane;  ///< others take the place of perspective and yfov
    /** Of a fisheye: the angle, up to 2 pi, that its image circle spans; the circle touches the image's
     * nearer edges, and what lies outside of it is black. */
    float fieldOfView = 3.14159265f;
    std::optional<ThinLens> lens;
    std::optional<Exposure> exposure;
    std::optional<LensTable> lensTable;
    std::optional<Shutter> shutter;  ///< none: the scene stands still
};

/** The lens of this f-number before a sensor of this height (scene units; 24 mm where they are metres) that
 * shows the camera's vertical field of view when focused at a distance: with the image at
 * zi = height / (2 tan(yfov / 2)) its focal length is zi zo / (zi + zo). */
ThinLens thinLens(const Camera& camera, double fNumber, double focusDistance, double sensorHeight = 0.024);
/** Exposure value at ISO 100, log2(N^2 / t * 100 / S): equal ones give equally bright pictures. */
double exposureValue(const Exposure& exposure);
/** Stops (powers of two) from scene-referred radiance, taken as luminance in cd/m^2, to display values where
 * 1 is the luminance that saturates the film: 1.2 * 2^EV100 (ISO 12232's saturation-based speed with a lens
 * that passes 65 %; Lagarde and de Rousiers, "Moving Frostbite to physically based rendering", 2014). */
double exposureStops(const Exposure& exposure);

}  // namespace helio
