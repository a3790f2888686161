#pragma once
/** @file Image files in memory, decoded side by side. */
#include "engine/scene/load_monitor.hpp"

#include <heliograph/scene.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace helio {

struct EncodedImage {
    std::string place;  ///< for messages
    std::string name;
    std::vector<std::byte> owned;
    std::span<const std::byte> bytes;  ///< `owned` or others' bytes
};

struct DecodingResult {
    std::string place;
    std::string fault;  ///< empty for success
    TextureImage image;
};

/** One result per image, in their order. */
std::vector<DecodingResult> decodeImages(const std::vector<EncodedImage>& images, LoadMonitor& monitor);

}  // namespace helio
