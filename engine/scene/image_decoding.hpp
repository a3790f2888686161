#pragma once
/** @file Image files in memory, decoded side by side. */
#include "engine/image/backend.hpp"
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
    std::string fault;   ///< empty for success
    std::string remark;  ///< on an odd file; empty for none
    TextureImage image;
    std::uint32_t fileWidth = 0, fileHeight = 0;  ///< of the file: an image of one colour may be one texel
};

/** Whether images are decoded although another is damaged. */
enum class AtFault { GoOn, Stop };

/** One result per image, in their order. What would take more than a malformed file may is checked before any
 * of it is kept; to stop at a fault is to decode none of the images then. Those out of proportion to their
 * files are decoded one after the other at the end, so that which of them the budget is for does not depend
 * on threads. */
std::vector<DecodingResult> decodeImages(const std::vector<EncodedImage>& images, ImageBudget& budget,
                                         LoadMonitor& monitor, AtFault atFault = AtFault::GoOn);

/** The public loadTextureImage() with a budget. */
TextureImage loadTextureImage(const std::filesystem::path& file, ImageBudget& budget);

}  // namespace helio
