#pragma once
/** @file What the importers of meshes do to vertices. */
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <string>

namespace helio::mesh {

/** A colour as mesh files hold it, 0..1 in sRGB, in linear. What lies outside 0..1 is brought there. */
glm::vec3 linearFromSrgb(glm::vec3 color);

/** Whether a normal says where it points. */
bool isNormal(const glm::vec3& normal);
/** A unit vector for a normal that is one. */
glm::vec3 unit(const glm::vec3& normal);
/** Unit normal of a triangle; 0 0 1 for one without area. */
glm::vec3 faceNormal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/** Lambert, without colour of its own. For vertices with colours it is white, else of albedo 0.8. */
Material neutralMaterial(bool hasColors);

/** A scene of one mesh on one node, named after the file. */
Scene sceneOf(const std::string& file);

}  // namespace helio::mesh
