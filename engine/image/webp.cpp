#include "engine/image/webp.hpp"

#include <webp/decode.h>

#include <array>
#include <mutex>

namespace helio {
namespace {

/** Decodes to one texel: of a lossy image a few rows are held, of a lossless one all pixels, so one such at a
 * time. */
std::string check(std::span<const std::byte> file, const WebPBitstreamFeatures& features) {
    static std::mutex oneLossless;
    std::unique_lock lock(oneLossless, std::defer_lock);
    constexpr int lossy = 1;
    if (features.format != lossy) lock.lock();
    WebPDecoderConfig config;
    if (WebPInitDecoderConfig(&config) == 0) return "cannot be decoded by this version of libwebp";
    std::array<std::uint8_t, 4> texel{};
    config.options.use_scaling = 1;
    config.options.scaled_width = config.options.scaled_height = 1;
    config.output.colorspace = MODE_RGBA;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {texel.data(), 4, texel.size()};
    const VP8StatusCode status =
        WebPDecode(reinterpret_cast<const std::uint8_t*>(file.data()), file.size(), &config);
    return status == VP8_STATUS_OK ? std::string() : "is damaged or cut off";
}

}  // namespace

std::string decodeWebp(std::span<const std::byte> file, std::uint64_t maximumTexels, ImageBudget& budget,
                       DecodedImage& image) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(file.data());
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes, file.size(), &features) != VP8_STATUS_OK) return "is no WebP, or cut off";
    if (features.has_animation != 0) return "is an animation";
    const auto width = std::uint32_t(features.width), height = std::uint32_t(features.height);
    if (std::uint64_t(width) * height > maximumTexels)
        return "is too large: " + std::to_string(width) + " x " + std::to_string(height);
    if (budget.isTrial()) return check(file, features);
    if (!budget.take(std::uint64_t(width) * height * 4, file.size()))
        return unfoldsTo(width, height, file.size());
    std::vector<std::uint8_t> texels(std::size_t(width) * height * 4);
    if (WebPDecodeRGBAInto(bytes, file.size(), texels.data(), texels.size(), int(width) * 4) == nullptr)
        return "is damaged or cut off";
    image.width = image.fileWidth = width;
    image.height = image.fileHeight = height;
    image.texels = std::move(texels);
    return {};
}

}  // namespace helio
