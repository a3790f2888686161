#pragma once
/**
 * @file
 * MTL, the materials of OBJ files (Wavefront, appendix B, and the PBR extension of exocortex), in terms of
 * the scene's material:
 *
 * | MTL | Material |
 * |---|---|
 * | Kd, map_Kd | base colour; albedo 0.8 where neither is given, white under a map alone |
 * | d or 1 - Tr; map_d that is map_Kd | alpha, BLEND |
 * | Ke, map_Ke | emission in W/(sr m^2), from the front face |
 * | Ks, Ns (not illum 0 or 1) | a dielectric's GGX lobe: reflectance Ks at normal incidence, alpha^2 = 2 /
 * (Ns + 2), which has the width of the Phong lobe (Walter et al. 2007, section 5) | | Ks above Kd, illum 3,
 * 5, 8 | a metal of colour Ks, smooth unless illum is 8 | | illum 4, 6, 7, 9 | glass: transmission 1 of
 * colour Tf, index Ni, smooth | | Pr, Pm, Ps, Pc, Pcr, aniso, anisor, norm; map_Pr, map_Pm | roughness,
 * metallic, sheen, clearcoat, anisotropy, normal map |
 *
 * Lost, and named in Scene::skipped: Ka (light from nowhere), bump without -bm, disp, decal, refl, map_Ns,
 * a map_d of its own, options of textures other than -o, -s, -clamp and -bm. A Phong lobe keeps its width and
 * its strength at normal incidence, not its shape.
 */
#include "engine/scene/load_monitor.hpp"

#include <heliograph/scene.hpp>

#include <set>
#include <string>
#include <vector>

namespace helio::mesh {

/**
 * Appends to scene.materials one material for each name, in their order, from the libraries that an OBJ file
 * names; `hasColors` for the ones that no library has. Files are looked for beside `file`; one that is
 * missing is a warning. Throws InputError with file and line for a number that is none.
 */
void loadMaterials(const std::string& file, const std::vector<std::string>& libraries,
                   const std::vector<std::string>& names, bool hasColors, LoadMonitor& monitor, Scene& scene);

}  // namespace helio::mesh
