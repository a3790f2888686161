#pragma once
/** @file
 * The tree of engine/scene/bvh.hpp built on the device, for triangles that move: Morton codes, a radix sort,
 * the binary radix tree from its leaves up, and eight-wide nodes of it level by level. It is built sooner
 * than the host's where the device is faster, and costs rays more: nothing in it looks at surfaces but the
 * choice of a node's eight children.
 */
#include "engine/scene/bvh.hpp"

#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace helio {

class TreeBuilder {
public:
    /** Buffers and kernels for `capacity` triangles at most, some 260 bytes each. Throws InputError above
     * mostTriangles(). The device must outlive it. */
    TreeBuilder(Device& device, std::size_t capacity);
    TreeBuilder(const TreeBuilder&) = delete;
    TreeBuilder& operator=(const TreeBuilder&) = delete;

    static std::uint64_t mostTriangles(const Device& device);

    /** The tree of positions.size() / 3 triangles (corners in threes), whose `cost` is left 0. Same input,
     * same result on the same device. Throws InputError where a coordinate is not finite or beyond 1.7e38. */
    Bvh build(std::span<const glm::vec3> positions);

private:
    struct Push {
        std::uint32_t first = 0, count = 0, begin = 0, shift = 0;
        glm::vec3 lower{0.0f};
        float scale = 0;
        std::uint32_t triangles = 0;
    };
    void declareSort(Device& device);
    void declareLevel(Device& device);

    std::uint64_t capacity_;
    DeviceBuffer corners_, codes_, sorted_, table_, runs_, boxes_, children_, ranges_, items_, opened_,
        values_, nodes_, order_;
    Push push_;
    Plan sort_, level_;
};

}  // namespace helio
