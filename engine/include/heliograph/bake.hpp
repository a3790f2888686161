#pragma once
/** @file Light that is computed once and kept in a texture over a surface's own coordinates: ambient
 * occlusion and irradiance. */
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
    std::uint32_t samples = 256;  ///< rays or paths a texel
    double distance = std::numeric_limits<double>::infinity();  ///< what is farther away hides nothing
    int maxDepth = -1;  ///< of irradiance: reflections before the light arrives; -1: all, 0: what lights send
    std::uint32_t seed = 0;  ///< of irradiance
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

/** Irradiance (W/m^2) on the front of a node's mesh where it stands in the scene, about the interpolated
 * normal: all light, by paths that start at each texel's middle as a meter's do, with light sampling.
 * Channels R, G, B, linear, without bounds. Texels beside the surface, refusals and stopping as of
 * bakeAmbientOcclusion(); `distance` does not count. */
ImageF bakeIrradiance(Device& device, const Scene& scene, const BakeOptions& options);

/** Makes an image of bakeIrradiance() the lightmap of a node's mesh: of copies of its materials, and of the
 * mesh where other nodes show it too. Empty `node` and `texcoord` as in BakeOptions. Throws InputError where
 * the node or the coordinates are not there, or the image has no R, G and B of finite numbers from 0. */
void setLightmap(Scene& scene, const std::string& node, int texcoord, const ImageF& image);

}  // namespace helio
