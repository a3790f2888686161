#pragma once
/** @file Cube maps as lat-long images. */
#include <heliograph/scene.hpp>

#include <array>

namespace helio::gltf {

/**
 * The lat-long image (see Environment::image) of a cube's faces +X, -X, +Y, -Y, +Z, -Z, as
 * EXT_lights_image_based stores them: OpenGL's faces, flipped left to right; 8 or 16 bits are sRGB-encoded
 * RGBD, whose colour is divided by its alpha. Faces are squares of one size, or one texel where they are of
 * one colour. The image is linear, 4 times as wide as a face and at most 4096, bilinear within faces.
 */
TextureImage latLongOf(const std::array<const TextureImage*, 6>& faces);

/** Texels of the image that faces of `size` become. */
std::size_t latLongTexels(std::uint32_t size);

}  // namespace helio::gltf
