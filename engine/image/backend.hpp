#pragma once
/** @file
 * The file formats, behind a module of their own. OpenImageIO loads some 260 shared objects, which takes 0.15
 * s: a program that touches no image file must not pay that. So OpenImageIO is linked to
 * libheliograph_image.so alone, which lies beside libheliograph.so and is loaded at the first image.
 * Everything crosses in memory; faults come back as text, so that no exception has to.
 */
#include <heliograph/image.hpp>

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
    std::uint32_t fileWidth = 0, fileHeight = 0;  ///< of the file: an image of one colour may be one texel
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> texels;
    std::string remark;  ///< on a file that is odd; empty for none
};

/** A few bytes can hold an image of any size. What images take that is out of all proportion to their files
 * comes from an allowance; an image of one colour, which is kept as one texel, needs none of it. */
class ImageBudget {
public:
    /** What a scene may unfold to beyond its files, with the rest of what it unfolds to: 256 MiB, less what
     * reading takes by itself. */
    static constexpr std::uint64_t standard = std::uint64_t(240) << 20;

    explicit ImageBudget(std::uint64_t allowance = standard) : left_(allowance) {}
    /** For an image that is decoded without being kept. */
    static ImageBudget trial() {
        ImageBudget budget;
        budget.isTrial_ = true;
        return budget;
    }
    bool isTrial() const { return isTrial_; }
    /** Whether an image that is decoded row by row is to be tried first: a damaged one must not take what a
     * whole one may. */
    static bool wantsTrial(std::uint64_t bytes, std::uint64_t encoded) {
        return bytes > 2 * encoded + (std::uint64_t(96) << 20);
    }

    /** To be said before each image. */
    void begin() { held_ = 0; }
    /** Whether the image, from a file of `encoded` bytes, may take so many, which stay. */
    bool take(std::uint64_t bytes, std::uint64_t encoded) {
        if (isInProportion(bytes, encoded)) return true;
        if (!fits(bytes)) return false;
        left_ -= bytes;
        return true;
    }
    /** The same of bytes that go again when the image is decoded. */
    bool hold(std::uint64_t bytes, std::uint64_t encoded) {
        if (isInProportion(bytes, encoded)) return true;
        if (!fits(bytes)) return false;
        held_ += bytes;
        return true;
    }
    /** Whether take() or hold() said no. */
    bool isExceeded() const { return isExceeded_; }
    std::uint64_t left() const { return left_; }

private:
    static bool isInProportion(std::uint64_t bytes, std::uint64_t encoded) { return bytes / 200 <= encoded; }
    bool fits(std::uint64_t bytes) {
        const bool fits = bytes <= left_ && held_ <= left_ - bytes;
        isExceeded_ = isExceeded_ || !fits;
        return fits;
    }

    std::uint64_t left_, held_ = 0;
    bool isExceeded_ = false, isTrial_ = false;
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

/** Whether a file's first bytes are those of a PNG, JPEG or WebP. */
bool isTextureFormat(std::span<const std::byte> file);

/** Decodes such a file held in memory. Returns the fault, empty for success. A large one is checked first,
 * unless that has been done. */
std::string decodeImage(std::span<const std::byte> file, ImageBudget& budget, DecodedImage& image,
                        bool isChecked = false);
/** What is wrong with such a file, found in little memory: nothing is kept. */
std::string checkImage(std::span<const std::byte> file);

/** What is said of an image that the budget is not for. */
inline std::string unfoldsTo(std::uint64_t width, std::uint64_t height, std::uint64_t encoded) {
    return "unfolds to " + std::to_string(width) + " x " + std::to_string(height) + " from " +
           std::to_string(encoded) + " bytes";
}

}  // namespace helio
