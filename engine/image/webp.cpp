#include "engine/image/webp.hpp"

#include <webp/decode.h>

namespace helio {

std::string decodeWebp(std::span<const std::byte> file, std::uint64_t maximumTexels, ImageBudget& budget,
                       DecodedImage& image) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(file.data());
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes, file.size(), &features) != VP8_STATUS_OK) return "is no WebP, or cut off";
    if (features.has_animation != 0) return "is an animation";
    const auto width = std::uint32_t(features.width), height = std::uint32_t(features.height);
    if (std::uint64_t(width) * height > maximumTexels)
        return "is too large: " + std::to_string(width) + " x " + std::to_string(height);
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
