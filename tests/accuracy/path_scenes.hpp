#pragma once
/** @file Scenes with known answers, built in code. Everything is Lambertian. */
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace helio::test {

/** A scene under construction: every mesh is an instance of its own, in order of calls. */
class SceneBuilder {
public:
    SceneBuilder();
    /** A Lambertian material; returns its index. */
    int material(const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0.0f),
                 bool doubleSided = false);
    /** Triangles, three corners each; returns the instance. */
    int triangles(const std::vector<glm::vec3>& corners, int material);
    /** Corners in order; the front is where they run counter-clockwise. */
    int quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d, int material);
    /** The six faces of a box seen from inside: x = lower, x = upper, y = lower, ... Six instances. */
    void room(const glm::vec3& lower, const glm::vec3& upper, const std::array<int, 6>& materials);
    /** A unit sphere's tessellation (icosahedron split `levels` times) scaled; faces outwards or inwards. */
    int sphere(const glm::vec3& centre, float radius, int levels, bool inwards, int material);
    /** A perspective camera at `eye` looking at `target`. */
    void camera(const glm::vec3& eye, const glm::vec3& target, float yfov, const glm::vec3& up = {0, 1, 0});
    /** Surroundings of 1 by an image, of 4 x 2 texels. */
    void whiteImageAround();
    void pointLight(const glm::vec3& position, const glm::vec3& intensity);
    Scene scene;

private:
    int node(Node node);
};

/** Corners of the tessellated unit sphere, three a triangle, facing outwards. */
std::vector<glm::vec3> unitSphere(int levels);

}  // namespace helio::test
