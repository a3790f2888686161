#pragma once
/** @file What tests of intersection share: how many rays, and sending them in parts. */
#include "passes/intersect/ray_intersector.hpp"
#include "tests/support/device.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <vector>

namespace helio::test {

/** Rays of a test: HELIOGRAPH_RAYS where it is set ("1e9"), which makes the long run, else `usual`. */
inline double rayCount(double usual) {
    const char* text = std::getenv("HELIOGRAPH_RAYS");
    return text != nullptr ? std::strtod(text, nullptr) : usual;
}

/** Sends `count` rays that `next` makes, a part at a time; `check` gets each part's rays and hits. */
inline void sendRays(const PackedScene& packed, RayQuestion question, double count,
                     const std::function<Ray()>& next,
                     const std::function<void(const std::vector<Ray>&, const std::vector<RayHit>&)>& check) {
    constexpr double part = 1 << 20;
    RayIntersector intersector(device(), packed, question, std::size_t(std::min(count, part)));
    for (double sent = 0; sent < count; sent += part) {
        std::vector<Ray> rays(std::size_t(std::min(part, count - sent)));
        for (Ray& ray : rays) ray = next();
        intersector.upload(rays);
        intersector.run();
        check(rays, intersector.hits());
    }
}

}  // namespace helio::test
