#include "engine/scene/image_decoding.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

namespace helio {

std::vector<DecodingResult> decodeImages(const std::vector<EncodedImage>& images, ImageBudget& budget,
                                         LoadMonitor& monitor) {
    std::vector<DecodingResult> results(images.size());
    if (!images.empty()) {
        imageBackend();  // its own failure is not an image's
        monitor.report("images", 0);
    }
    std::vector<std::uint8_t> isLarge(images.size(), 0);  // bytes: written side by side
    std::atomic<std::size_t> next{0};
    std::atomic<bool> isStopped{false};
    const auto decode = [&](std::size_t i, ImageBudget& from) {
        DecodedImage decoded;
        results[i].place = images[i].place;
        results[i].fault = decodeImage(images[i].bytes, from, decoded);
        results[i].image = {images[i].name, decoded.width, decoded.height, std::move(decoded.texels)};
        results[i].fileWidth = decoded.fileWidth;
        results[i].fileHeight = decoded.fileHeight;
    };
    const auto decodeInProportion = [&](std::size_t i) {
        ImageBudget none(0);
        decode(i, none);
        isLarge[i] = none.isExceeded();
    };
    const auto help = [&] {
        for (std::size_t i = next++; i < images.size() && !isStopped; i = next++) decodeInProportion(i);
    };
    std::vector<std::jthread> helpers;
    const std::size_t threads =
        std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), images.size());
    try {
        for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(help);
        for (std::size_t i = next++; i < images.size(); i = next++) {
            monitor.report("images", double(i) / double(images.size()));
            decodeInProportion(i);
        }
    } catch (...) {
        isStopped = true;
        throw;
    }
    helpers.clear();
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (isLarge[i] == 0) continue;
        monitor.report("images", 1);
        decode(i, budget);
    }
    return results;
}

}  // namespace helio
