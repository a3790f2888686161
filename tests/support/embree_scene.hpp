#pragma once
/** @file Embree, the yardstick: single rays, threads of our own. */
#include "passes/intersect/ray_intersector.hpp"

#include <embree3/rtcore.h>

#include <span>
#include <vector>

namespace helio::test {

class EmbreeScene {
public:
    /** Builds over triangles whose corners are given in threes; the hit's slot is the triangle's index.
     * `robust`: no misses along edges, at some cost. */
    EmbreeScene(std::span<const glm::vec3> corners, unsigned threads, bool robust = false);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    double buildSeconds() const { return buildSeconds_; }
    std::size_t bytes() const { return bytes_; }
    /** rtcIntersect1 or rtcOccluded1 (slot 0 for a hit) for every ray. Ray::source is not looked at. */
    void run(std::span<const Ray> rays, RayQuestion question, std::span<RayHit> hits) const;

private:
    RTCDevice device_;
    RTCScene scene_;
    unsigned threads_;
    double buildSeconds_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace helio::test
