#include "engine/scene/image_decoding.hpp"

#include "engine/image/backend.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

namespace helio {

std::vector<DecodingResult> decodeImages(const std::vector<EncodedImage>& images, LoadMonitor& monitor) {
    std::vector<DecodingResult> results(images.size());
    if (!images.empty()) {
        imageBackend();  // its own failure is not an image's
        monitor.report("images", 0);
    }
    ImageBudget budget;
    std::atomic<std::size_t> next{0};
    std::atomic<bool> isStopped{false};
    const auto decode = [&](std::size_t i) {
        DecodedImage decoded;
        results[i].place = images[i].place;
        results[i].fault = decodeImage(images[i].bytes, budget, decoded);
        results[i].image = {images[i].name, decoded.width, decoded.height, std::move(decoded.texels)};
    };
    const auto help = [&] {
        for (std::size_t i = next++; i < images.size() && !isStopped; i = next++) decode(i);
    };
    std::vector<std::jthread> helpers;
    const std::size_t threads =
        std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), images.size());
    try {
        for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(help);
        for (std::size_t i = next++; i < images.size(); i = next++) {
            monitor.report("images", double(i) / double(images.size()));
            decode(i);
        }
    } catch (...) {
        isStopped = true;
        throw;
    }
    helpers.clear();
    return results;
}

}  // namespace helio
