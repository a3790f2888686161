
#include "engine/image/backend.hpp"
#include "engine/image/display.hpp"
#include "engine/image/read_file.hpp"

#include <heliograph/error.hpp>
#include <heliograph/file.hpp>
#include <heliograph/image.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace helio {
namespace {

std::array<std::size_t, 3> colorChannels(const std::string& file, const ImageF& image) {
    std::array<std::size_t, 3> channels{};
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string_view name("RGB" + c, 1);
        const int index = image.channel(name);
        if (index < 0)
            throw InputError(file, "", fmt::format("has no channel {}", name), "give an image with R, G, B");
        channels[c] = std::size_t(index);
    }
    return channels;
}

/** The nearest of 256 steps. NaN becomes 0, an infinity its end of the range. */
std::uint8_t encode8(float linear) {
    if (!(linear > 0)) return 0;
    return std::uint8_t(std::floor(srgbEncode(std::min(double(linear), 1.0)) * 255 + 0.5));
}

std::vector<std::uint8_t> encodeRgb8(const std::string& file, const ImageF& image, const Display& display) {
    const auto rgb = colorChannels(file, image);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(std::size_t(image.width) * image.height * 3);
    const bool asItIs = display.exposure == 0 && display.curve == ToneCurve::None;
    for (std::size_t i = 0; i < image.data.size(); i += image.channels.size()) {
        std::array<float, 3> color{image.data[i + rgb[0]], image.data[i + rgb[1]], image.data[i + rgb[2]]};
        if (!asItIs) color = displayed(color, display);
        for (const float value : color) pixels.push_back(encode8(value));
    }
    return pixels;
}

}  // namespace

int ImageF::channel(std::string_view name) const {
    const auto found = std::find(channels.begin(), channels.end(), name);
    return found == channels.end() ? -1 : int(found - channels.begin());
}

ImageF loadImage(const std::filesystem::path& file) {
    ImageF image;
    std::string fault = pngFault(readFile(file));
    if (fault.empty()) fault = imageBackend().read(file, image);
    if (!fault.empty())
        throw InputError(file.string(), "", fault, "give a whole image file of a known format");
    return image;
}

void saveImage(const std::filesystem::path& file, const ImageF& image, const Display& display) {
    assert(image.data.size() == std::size_t(image.width) * image.height * image.channels.size());
    const std::string name = file.string();
    if (image.width == 0 || image.height == 0 || image.channels.empty()) {
        throw InputError(name, "", "would have no pixels", "give at least one pixel and channel");
    }
    const std::string extension = lowerCaseExtension(file);
    std::vector<std::byte> content;
    std::string fault;
    if (extension == ".exr") {
        fault = imageBackend().encodeExr(image, content);
    } else if (extension == ".png" || extension == ".jpg" || extension == ".jpeg") {
        fault = imageBackend().encodeRgb8(encodeRgb8(name, image, display), image.width, image.height,
                                          extension == ".png" ? "png" : "jpg", content);
    } else {
        throw InputError(name, "", fmt::format("unknown image extension '{}'", extension),
                         "use .exr, .png, .jpg or .jpeg");
    }
    if (!fault.empty()) throw InputError(name, "", "cannot be encoded: " + fault, "");
    writeFileAtomically(file, content);
}

double srgbEncode(double linear) {
    const double x = std::abs(linear);
    return std::copysign(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055, linear);
}

double srgbDecode(double encoded) {
    const double x = std::abs(encoded);
    return std::copysign(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4), encoded);
}

ImageDifference compareImages(const ImageF& image, const ImageF& reference) {
    if (image.width != reference.width || image.height != reference.height) {
        throw InputError("image", "",
                         fmt::format("is {} x {}, the reference {} x {}", image.width, image.height,
                                     reference.width, reference.height),
                         "compare images of one size");
    }
    const auto ours = colorChannels("image", image);
    const auto theirs = colorChannels("reference", reference);
    ImageDifference result;
    double squares = 0, relativeSquares = 0, sum = 0, referenceSum = 0;
    std::uint64_t pixels = 0;
    for (std::uint32_t y = 0; y < image.height; ++y) {
        // Sums of one row at a time: the rounding error grows with the image's side, not its area.
        double rowSquares = 0, rowRelative = 0, rowSum = 0, rowReference = 0;
        for (std::uint32_t x = 0; x < image.width; ++x) {
            std::array<double, 3> a{}, b{};
            bool isNan = false, isInf = false;
            for (std::size_t c = 0; c < 3; ++c) {
                a[c] = image.at(x, y, ours[c]);
                b[c] = reference.at(x, y, theirs[c]);
                isNan |= std::isnan(a[c]) || std::isnan(b[c]);
                isInf |= std::isinf(a[c]) || std::isinf(b[c]);
            }
            if (isNan || isInf) {
                ++(isNan ? result.nan : result.inf);
                continue;
            }
            ++pixels;
            for (std::size_t c = 0; c < 3; ++c) {
                const double difference = a[c] - b[c];
                rowSquares += difference * difference;
                rowRelative += difference * difference / (b[c] * b[c] + 0.01);
                rowSum += a[c];
                rowReference += b[c];
                if (std::abs(difference) > result.worstError) {
                    result.worstError = std::abs(difference);
                    result.worstX = x;
                    result.worstY = y;
                }
            }
        }
        squares += rowSquares;
        relativeSquares += rowRelative;
        sum += rowSum;
        referenceSum += rowReference;
    }
    const double values = 3.0 * double(pixels);
    result.mse = squares / values;
    result.rmse = std::sqrt(result.mse);
    result.relmse = relativeSquares / values;
    result.meanRatio = sum == referenceSum && pixels > 0 ? 1 : sum / referenceSum;
    return result;
}

}  // namespace helio
