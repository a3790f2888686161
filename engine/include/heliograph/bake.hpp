#pragma once
/** @file Light that is computed once and kept in a texture: ambient occlusion over a surface's own
 * coordinates. */
#include <heliograph/device.hpp>
#include <heliograph/image.hpp>
#include <heliograph/scene.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

namespace helio {

struct BakeOptions {
    std::string node = {};        ///< whose mesh is baked; empty: the first node with a mesh
    int texcoord = 0;             ///< set of texture coordinates that covers the image, each texel once
    std::uint32_t size = 256;     ///< texels each way
    std::uint32_t samples = 256;  ///< rays a texel
    double distance = std::numeric_limits<double>::infinity();  ///< what is farther away hides nothing
    /** Called with the share that is done; false stops. */
    std::function<bool(double)> progress = {};
};

/** Ambient occlusion of a node's mesh where it stands in the scene: for each texel the cosine-weighted share
 * of the sky over its middle that no triangle hides, by rays from the front face about the interpolated
 * normal; 1 sees all of it. Texels beside the surface take the mean of their neighbours, so that filters find
 * no seam. Channels R, G and B are equal; linear. Every surface hides, whatever its alpha. Throws InputError
 * where the node is not there, its coordinates are missing, lie outside of 0 to 1 or cover texels twice. An
 * empty image where it was stopped. */
ImageF bakeAmbientOcclusion(Device& device, const Scene& scene, const BakeOptions& options);

}  // namespace helio
