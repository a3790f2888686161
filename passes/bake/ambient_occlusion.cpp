#include "passes/bake/atlas.hpp"
#include "passes/intersect/ray_intersector.hpp"

#include <heliograph/bake.hpp>
#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace helio {
namespace {

constexpr std::size_t kRaysAtOnce = 1u << 19;

double fraction(std::uint32_t bits) {
    return (double(bits) + 0.5) * 0x1p-32;
}

std::uint32_t reversed(std::uint32_t v) {
    std::uint32_t result = 0;
    for (int i = 0; i < 32; ++i) result |= (v >> i & 1u) << (31 - i);
    return result;
}

std::uint32_t scrambled(std::uint32_t v) {
    v = (v ^ (v >> 16)) * 0x7feb352du;
    v = (v ^ (v >> 15)) * 0x846ca68bu;
    return v ^ (v >> 16);
}

/** Cosine-weighted direction k of `count` about the texel's normal; what is under the face is mirrored at it.
 */
glm::dvec3 directionOf(const bake::AtlasTexel& texel, std::uint32_t k, std::uint32_t count) {
    const std::uint32_t shift = scrambled(texel.texel + 1u);
    double u = (double(k) + fraction(scrambled(shift))) / count, v = fraction(reversed(k) + shift);
    u = std::min(u, 1 - 1e-12);
    const double radius = std::sqrt(u), turn = 2 * std::numbers::pi * v;
    const glm::dvec3 n = texel.normal;
    const glm::dvec3 x =
        glm::normalize(glm::cross(std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), n));
    glm::dvec3 d =
        radius * std::cos(turn) * x + radius * std::sin(turn) * glm::cross(n, x) + std::sqrt(1 - u) * n;
    const double height = glm::dot(d, texel.face);
    if (height < 0) d -= 2 * height * texel.face;
    return d;
}

}  // namespace

ImageF bakeAmbientOcclusion(Device& device, const Scene& scene, const BakeOptions& options) {
    scene.validate();
    bake::check(scene, options);
    const std::vector<Instance> instances = scene.instances();
    const std::size_t instance = bake::chosenInstance(scene, instances, options.node);
    const std::vector<bake::AtlasTexel> texels =
        bake::atlasTexels(scene, instances[instance], options.texcoord, options.size);

    PackOptions pack;
    pack.shapesAsTriangles = true;
    const PackedScene packed = packScene(scene, pack);
    std::vector<std::int32_t> slots(packed.triangleCount, -1);
    for (std::size_t slot = 0; slot * 3 + 2 < packed.triangles.size(); ++slot) {
        const auto g = std::bit_cast<std::uint32_t>(packed.triangles[slot * 3].w);
        if (g < slots.size()) slots[g] = std::int32_t(slot);
    }
    double farthest = 0;
    for (const bake::AtlasTexel& texel : texels)
        for (glm::length_t axis = 0; axis < 3; ++axis)
            farthest = std::max(farthest, std::abs(texel.position[axis]));
    // Above what the mesh's triangles in one plane may be off by rounding.
    const double lift = farthest * 0x1p-21;

    std::vector<std::uint32_t> open(texels.size());
    const std::size_t texelsAtOnce = std::max<std::size_t>(kRaysAtOnce / options.samples, 1);
    const std::size_t capacity = std::min(texelsAtOnce, texels.size()) * options.samples;
    RayIntersector intersector(device, packed, RayQuestion::Any, capacity);
    for (std::size_t first = 0; first < texels.size(); first += texelsAtOnce) {
        const std::size_t count = std::min(texelsAtOnce, texels.size() - first);
        std::vector<Ray> rays(count * options.samples);
        oneapi::tbb::parallel_for(std::size_t(0), count, [&](std::size_t t) {
            const bake::AtlasTexel& texel = texels[first + t];
            const glm::vec3 origin(texel.position + lift * texel.face);
            const std::int32_t source = slots[packed.instanceFirst[instance] + texel.triangle];
            for (std::uint32_t k = 0; k < options.samples; ++k)
                rays[t * options.samples + k] = {
                    .origin = origin,
                    .limit = float(options.distance),
                    .direction = glm::vec3(directionOf(texel, k, options.samples)),
                    .source = source};
        });
        intersector.upload(rays);
        intersector.run();
        const std::vector<RayHit> hits = intersector.hits();
        for (std::size_t i = 0; i < rays.size(); ++i) open[first + i / options.samples] += hits[i].slot < 0;
        if (options.progress && !options.progress(double(first + count) / double(texels.size()))) return {};
    }

    const std::size_t all = std::size_t(options.size) * options.size;
    std::vector<float> values(all);
    std::vector<bool> covered(all);
    for (std::size_t t = 0; t < texels.size(); ++t) {
        values[texels[t].texel] = float(double(open[t]) / options.samples);
        covered[texels[t].texel] = true;
    }
    bake::fillGaps(values, std::move(covered), options.size);
    ImageF image{options.size, options.size, {"R", "G", "B"}, {}, {}};
    for (const float value : values) image.data.insert(image.data.end(), 3, value);
    return image;
}

}  // namespace helio
