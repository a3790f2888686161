#pragma once
/** @file Random sound graphs over every mode and usage. */
#include "tests/graph/builder.hpp"

#include <algorithm>
#include <random>

namespace helio::graph {

/** A random graph: 1 to 16 passes over 1 to 16 resources of both kinds, imported and transient, with culled
 * and kept passes, fills, copies, indirect arguments, poison, two memory classes, and small arenas. In half
 * of the graphs a pass takes what few passes near it take, so that lives are short. */
inline Builder randomGraph(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t n) { return std::uint32_t(random() % n); };
    const auto chance = [&](std::uint32_t percent) { return below(100) < percent; };
    Builder g;
    g.input.alias = !chance(10);
    g.input.poison = chance(15);
    g.input.limits.bufferImageGranularity = chance(50) ? 1 : 1024;
    g.input.limits.maxArenaBytes = chance(80) ? ~std::uint64_t(0) : 16 * 1024;
    const bool local = chance(50);
    const std::uint32_t resourceCount = 1 + below(16);
    for (std::uint32_t i = 0; i < resourceCount; ++i) {
        const std::string name = "r" + std::to_string(i);
        std::uint32_t id = 0;
        if (chance(20)) {
            id = chance(70) ? g.importBuffer("shared " + name) : g.importImage("shared image " + name);
        } else if (chance(60)) {
            id = g.buffer(name, 64 * (1 + below(32)));
        } else {
            id = g.image(name, 4 * (1 + below(6)), 4 * (1 + below(6)));
        }
        ResourceInput& resource = g.input.resources[id];
        resource.alignment = 64u << below(4);
        resource.memoryClass = chance(85) ? 0 : 1;
    }
    std::vector<bool> written(resourceCount);
    for (std::uint32_t i = 0; i < resourceCount; ++i) written[i] = g.input.resources[i].imported;

    const std::uint32_t passCount = 1 + below(16);
    for (std::uint32_t p = 0; p < passCount; ++p) {
        auto pass = g.pass("p" + std::to_string(p));
        if (chance(10)) pass.keep();
        std::vector<std::uint32_t> order(resourceCount);
        for (std::uint32_t i = 0; i < resourceCount; ++i) order[i] = i;
        if (local) {
            std::rotate(order.begin(), order.begin() + p * resourceCount / passCount, order.end());
            std::shuffle(order.begin(), order.begin() + std::min(3u, resourceCount), random);
        } else {
            std::shuffle(order.begin(), order.end(), random);
        }
        const std::uint32_t count = 1 + below(std::min(4u, resourceCount));
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t r = order[k];
            const bool image = g.input.resources[r].kind == ResourceKind::Image;
            if (written[r] && chance(55)) {
                const Usage readOnly[] = {Usage::StorageBuffer, Usage::UniformBuffer,
                                          Usage::UniformTexelBuffer, Usage::IndirectArguments,
                                          Usage::CopySource};
                const Usage readImage[] = {Usage::StorageImage, Usage::SampledImage};
                const Usage usage = image ? readImage[below(2)] : readOnly[below(5)];
                pass.access(r, Mode::Read, usage);
                if (chance(20)) pass.reads(r);  // the same resource a second way
            } else {
                const Usage usage = image        ? Usage::StorageImage
                                    : chance(60) ? Usage::StorageBuffer
                                    : chance(50) ? Usage::StorageTexelBuffer
                                    : chance(50) ? Usage::Fill
                                                 : Usage::CopyDestination;
                const Mode modes[] = {Mode::Write, Mode::Overwrite, Mode::Modify};
                const bool shader = usage == Usage::StorageImage || usage == Usage::StorageBuffer ||
                                    usage == Usage::StorageTexelBuffer;
                pass.access(r, shader ? modes[below(written[r] ? 3 : 2)] : Mode::Overwrite, usage);
            }
        }
        for (const AccessInput& a : g.input.passes.back().accesses)
            if (a.mode != Mode::Read) written[a.resource] = true;
    }
    for (std::uint32_t r = 0; r < resourceCount; ++r)
        if (written[r] && chance(12)) g.readback(r);
    // Every graph has a root.
    if (!validate(g.input).empty()) {
        for (std::uint32_t r = 0; r < resourceCount; ++r)
            if (written[r] && g.input.readbacks.empty()) g.readback(r);
        if (g.input.readbacks.empty()) g.pass("root").keep();
    }
    return g;
}

}  // namespace helio::graph
