#pragma once
/** @file
 * Intersection of many rays with packed triangles, for benchmarks, tests and schedulers that keep rays in
 * buffers: rays go in, hits come out, lanes of the device stay busy however long single rays take.
 *
 *     RayIntersector intersector(device, packed, RayQuestion::Closest, rays.size());
 *     intersector.upload(rays);
 *     intersector.run();
 *     std::vector<RayHit> hits = intersector.hits();
 */
#include "passes/scene/packed_scene.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/tree_access.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace helio {

/** A ray from `origin` along `direction` (any length but 0; distances are in units of it). */
struct Ray {
    glm::vec3 origin;
    float limit = std::numeric_limits<float>::infinity();  ///< hits lie within (0, limit)
    glm::vec3 direction;
    std::int32_t source = -1;  ///< slot of the triangle that the ray leaves and cannot meet; -1 for none
};
static_assert(sizeof(Ray) == 32);

struct RayHit {
    float distance;     ///< the limit for a miss
    std::int32_t slot;  ///< into PackedScene::triangles, -1 for a miss; of "any hit" the one found first
};
static_assert(sizeof(RayHit) == 8);

enum class RayQuestion : std::uint8_t { Closest, Any };

/** The device must outlive it. */
class RayIntersector {
public:
    RayIntersector(const RayIntersector&) = delete;
    RayIntersector& operator=(const RayIntersector&) = delete;
    /** Uploads triangles and tree. `capacity`: rays at most, up to 2^23. `packed` must have a tree, which is
     * read as is kept for the device where no `access` says how. */
    RayIntersector(Device& device, const PackedScene& packed, RayQuestion question, std::size_t capacity,
                   const std::optional<TreeAccess>& access = {});

    /** The rays of the next runs. */
    void upload(std::span<const Ray> rays);
    /** Intersects all rays; returns when done. */
    void run();
    /** Of the last run. */
    std::vector<RayHit> hits() const;
    /** Rays given up in the tree in the last run; 0 unless thousands of triangles coincide. */
    std::uint32_t abandoned() const { return abandoned_; }

private:
    struct Parameters {
        std::uint32_t count, raysPerGroup, budget, begin;
    };
    struct Counters {
        std::uint32_t open, abandoned;
    };
    DeviceBuffer triangles_, nodes_, rays_, hits_, cursors_, counters_;
    std::optional<DeviceBuffer> placed_;
    std::size_t capacity_;
    Parameters parameters_{};
    Plan plan_;
    Readback<Counters> counted_;
    std::uint32_t abandoned_ = 0;
};

}  // namespace helio
