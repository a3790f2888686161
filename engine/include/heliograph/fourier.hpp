#pragma once
/** @file
 * Discrete Fourier transforms on the device, in one and two dimensions: what a picture holds of each
 * frequency, and filters by it. Sizes are powers of two.
 */
#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

namespace helio {

/** Declares the transform of size[0] x size[1] complex floats, rows one after another, and returns the buffer
 * of the result: X[k] = sum over j of x[j] exp(-2 pi i (j0 k0 / size[0] + j1 k1 / size[1])), frequencies from
 * 0 upwards, those from half the size on being the negative ones. `inverse` turns the exponent's sign and
 * divides by the number of values. Its error is a few units in the last place of the largest value
 * (Stockham's algorithm of radix 2). Throws InputError where a size is no power of two or there are more than
 * 2^24 values. */
Buffer declareFourier(Graph& graph, Buffer values, std::array<std::uint32_t, 2> size, bool inverse = false);

/** Declares the products of two buffers of complex floats, one by one: of two spectra, that of their circular
 * convolution. */
Buffer declareProduct(Graph& graph, Buffer a, Buffer b, std::uint64_t count);

/** The transform of values on the host. */
std::vector<std::complex<float>> fourierTransform(Device& device, std::span<const std::complex<float>> values,
                                                  std::array<std::uint32_t, 2> size, bool inverse = false);

/** Circular convolution of two arrays of one size, by their spectra. */
std::vector<std::complex<float>> convolve(Device& device, std::span<const std::complex<float>> a,
                                          std::span<const std::complex<float>> b,
                                          std::array<std::uint32_t, 2> size);

}  // namespace helio
