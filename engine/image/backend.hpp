#pragma once
/** @file
 * The file formats, behind a module of their own. OpenImageIO loads some 260 shared objects, which takes 0.15
 * s: a program that touches no image file must not pay that. So OpenImageIO is linked to
 * libheliograph_image.so alone, which lies beside libheliograph.so and is loaded at the first image.
 * Everything crosses in memory; faults come back as text, so that no exception has to.
 */
#include <heliograph/image.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace helio {

/** Pixels as a file stores them: 8 or 16 bits still encoded, floats linear. 4 channels, rows from the top;
 * grey is spread to R, G, B, and a missing alpha is 1. Alpha is not premultiplied. */
struct DecodedImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> texels;
};

/** A few bytes can hold an image of any size. Those out of all proportion to their files share one allowance;
 * an image of one colour, which is kept as one texel, needs none of it. */
class ImageBudget {
public:
    /** Whether an image may take `bytes` in memory, from a file of `encoded` ones. Thread safe. */
    bool take(std::uint64_t bytes, std::uint64_t encoded) {
        constexpr std::uint64_t proportion = 200, allowance = std::uint64_t(112) << 20;
        return bytes / proportion <= encoded || (used_ += bytes) <= allowance;
    }

private:
    std::atomic<std::uint64_t> used_{0};
};

/** What the module exports. Every function returns what went wrong, empty for success. */
class ImageBackend {
public:
    virtual ~ImageBackend() = default;
    virtual std::string read(const std::filesystem::path& file, ImageF& image) const = 0;
    /** `format` is a file extension without its dot. */
    virtual std::string decode(std::span<const std::byte> file, const std::string& format,
                               ImageBudget& budget, DecodedImage& image) const = 0;
    /** The same of a file of any format that the module knows. */
    virtual std::string decodeFile(const std::filesystem::path& file, ImageBudget& budget,
                                   DecodedImage& image) const = 0;
    /** float32, all channels and the metadata. */
    virtual std::string encodeExr(const ImageF& image, std::vector<std::byte>& file) const = 0;
    /** 8-bit R, G, B, already encoded. `format` is png or jpg. */
    virtual std::string encodeRgb8(std::span<const std::uint8_t> pixels, std::uint32_t width,
                                   std::uint32_t height, const std::string& format,
                                   std::vector<std::byte>& file) const = 0;
};

/** Loads the module on first use; thread safe. Throws Error, naming the file, where it is missing or of
 * another version. */
const ImageBackend& imageBackend();

/** What is wrong with a PNG's chunks: cut off, or a checksum that does not hold; empty for none, and for
 * other files. Asked first, since libpng reports such faults on standard error by itself. */
std::string pngFault(std::span<const std::byte> file);

/** Decodes an image file held in memory, PNG, JPEG or WebP by its first bytes. Returns the fault, empty for
 * success. */
std::string decodeImage(std::span<const std::byte> file, ImageBudget& budget, DecodedImage& image);

}  // namespace helio
