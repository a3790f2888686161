#pragma once
/** @file
 * Images on the host: files, colour encoding, comparison. Rows run from the top; linear values are
 * Rec.709 radiance unless said otherwise.
 */
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace helio {

/** Float image with named channels, interleaved: value(x, y, c) = data[(y * width + x) * channels.size() + c]. */
struct ImageF {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::string> channels;  ///< e.g. {"R", "G", "B", "depth.Z"}
    std::vector<float> data;
    std::map<std::string, std::variant<std::string, double, std::int64_t>> metadata;

    float& at(std::uint32_t x, std::uint32_t y, std::size_t channel) {
        return data[(std::size_t(y) * width + x) * channels.size() + channel];
    }
    float at(std::uint32_t x, std::uint32_t y, std::size_t channel) const {
        return data[(std::size_t(y) * width + x) * channels.size() + channel];
    }
    /** Index of a channel, or -1. */
    int channel(std::string_view name) const;
};

/** Reads an image file, values as stored (no colour decoding), integers scaled to 0..1. Throws InputError
 * naming the file and the fault. */
ImageF loadImage(const std::filesystem::path& file);

/** How linear light becomes what a PNG or JPEG shows; shaders/shared/tone_curve.glsl says which curve is
 * whose. */
enum class ToneCurve : std::uint8_t { None, Reinhard, Filmic, Aces };
struct Display {
    double exposure = 0;  ///< stops: colour is multiplied by 2^exposure first
    ToneCurve curve = ToneCurve::None;
};

/** Writes an image, whole or not at all: a temporary ".NAME.PID-N.partial" beside it, synced, then renamed. The
 * extension chooses: .exr float32 with all channels and metadata (an integer beyond 32 bits as its digits); .png
 * 8-bit and .jpg or .jpeg (quality 95, no subsampling) take R, G, B, clamp to 0..1, NaN becoming 0, and
 * sRGB-encode, exposed and bent as `display` says; .exr stays as it is. The same image gives the same bytes. Throws InputError for an extension or folder that cannot be
 * written, or a missing channel. */
void saveImage(const std::filesystem::path& file, const ImageF& image, const Display& display = {});

/** Exact sRGB transfer curve (IEC 61966-2-1), scalar, any sign kept. */
double srgbEncode(double linear);
double srgbDecode(double encoded);

/** Difference of two images over R, G, B; pixels with a non-finite channel in either are counted, left out. The
 * means are NaN where no pixel remains. */
struct ImageDifference {
    double mse = 0;
    double rmse = 0;
    double relmse = 0;      ///< mean((x - r)^2 / (r^2 + 0.01))
    double meanRatio = 0;   ///< mean(x) / mean(r); 1 where both means are 0
    std::uint32_t worstX = 0;
    std::uint32_t worstY = 0;
    double worstError = 0;  ///< largest absolute channel difference
    std::uint64_t nan = 0;  ///< pixels with a NaN in either image
    std::uint64_t inf = 0;  ///< the others with an infinity in either
};
/** Compares an image with a reference of the same size. Throws InputError where sizes differ or R, G, B are
 * missing. */
ImageDifference compareImages(const ImageF& image, const ImageF& reference);

}  // namespace helio
