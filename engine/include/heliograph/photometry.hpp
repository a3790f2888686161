#pragma once
/** @file From radiometric to photometric quantities: what the eye makes of watts. */
#include <span>

namespace helio {

/** Luminous efficacy of monochromatic radiation at 540 THz (555 nm), lm/W: by the definition of the candela.
 */
inline constexpr double kLuminousEfficacy = 683.0;

/** V of the CIE 1931 standard photometric observer (CIE 018:2019), at a wavelength in nanometres: 1 at 555, 0
 * outside 360 to 830. Linear between the values every 5 nm. */
double luminousEfficiency(double nanometres);

/** Photometric from radiometric spectrum: lumens of W/nm, candela of W/(sr nm), lux of W/(m^2 nm), nits of
 * W/(sr m^2 nm). `values` belong to `wavelengths` (nm, ascending) and are linear between them; 0 outside. */
double photometric(std::span<const double> wavelengths, std::span<const double> values);

}  // namespace helio
