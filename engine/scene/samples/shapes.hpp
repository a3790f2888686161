#pragma once
/** @file Shapes and placements that the built-in samples are made of. */
#include <heliograph/scene.hpp>

#include <string>

namespace helio {

/** Unit sphere about the origin: an icosahedron's faces cut into frequency^2 triangles, smooth. */
Primitive sphereShape(int frequency, int material);
/** Upright prism of unit radius from y = 0 to 1 with a lid but no floor, flat-shaded. */
Primitive prismShape(int sides, int material);
/** Two pyramids base to base, of unit radius, from y = -1 to 1, flat-shaded. */
Primitive gemShape(int sides, int material);
/** Rectangle of a parallelogram's corner and sides; its front is where u x v points. UVs run 0..1 along u and
 * v. */
Primitive quadShape(glm::vec3 corner, glm::vec3 u, glm::vec3 v, int material);

int addMaterial(Scene& scene, Material material);
/** A material that scatters as Lambert says. */
Material diffuse(std::string name, glm::vec3 reflectance);
int addMesh(Scene& scene, std::string name, Primitive primitive);
/** Adds a root node. Returns its index. */
int addRoot(Scene& scene, Node node);
int addRoot(Scene& scene, std::string name, int mesh);
/** A root node at `eye` whose -Z looks at `target`, with +Y up. */
Node lookAtNode(std::string name, glm::vec3 eye, glm::vec3 target);
/** A directional light of this irradiance (W/m^2) that comes from where `towards` points. */
void addSun(Scene& scene, glm::vec3 irradiance, glm::vec3 towards);
/** A perspective camera; `yfov` in degrees. */
void addCamera(Scene& scene, glm::vec3 eye, glm::vec3 target, double yfovDegrees);

}  // namespace helio
