#include "engine/scene/image_decoding.hpp"

#include "engine/image/decoder_memory.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

namespace helio {

namespace {

/** What images may take, beyond their files, before all that follow are known to be whole. */
constexpr std::uint64_t uncheckedBytes = std::uint64_t(144) << 20;

/** Calls work(i) for each image, side by side; the calling thread reports. */
template <class Work>
void forImages(std::size_t count, LoadMonitor& monitor, Work&& work) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> isStopped{false};
    const auto help = [&] {
        for (std::size_t i = next++; i < count && !isStopped; i = next++) work(i);
    };
    std::vector<std::jthread> helpers;
    const std::size_t threads =
        std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), count);
    try {
        for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(help);
        for (std::size_t i = next++; i < count; i = next++) {
            monitor.report("images", double(i) / double(count));
            work(i);
        }
    } catch (...) {
        isStopped = true;
        throw;
    }
}

/** Which images are to be checked before they are kept. */
std::vector<std::uint8_t> beyondUnchecked(const std::vector<EncodedImage>& images) {
    std::uint64_t room = uncheckedBytes;
    for (const EncodedImage& image : images) room += image.bytes.size();
    std::vector<std::uint8_t> isBeyond(images.size(), 0);  // bytes: read side by side
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::uint64_t bytes = decoderMemory(images[i].bytes).inAll();
        isBeyond[i] = bytes > room;
        if (isBeyond[i] == 0) room -= bytes;
    }
    return isBeyond;
}

}  // namespace

std::vector<DecodingResult> decodeImages(const std::vector<EncodedImage>& images, ImageBudget& budget,
                                         LoadMonitor& monitor, AtFault atFault) {
    std::vector<DecodingResult> results(images.size());
    if (images.empty()) return results;
    imageBackend();  // its own failure is not an image's
    monitor.report("images", 0);
    const std::vector<std::uint8_t> isBeyond = beyondUnchecked(images);
    forImages(images.size(), monitor, [&](std::size_t i) {
        results[i].place = images[i].place;
        if (isBeyond[i] != 0) results[i].fault = checkImage(images[i].bytes);
    });
    const auto isFaulty = [](const DecodingResult& result) { return !result.fault.empty(); };
    if (atFault == AtFault::Stop && std::ranges::any_of(results, isFaulty)) return results;
    const auto decode = [&](std::size_t i, ImageBudget& from) {
        DecodedImage decoded;
        results[i].fault = decodeImage(images[i].bytes, from, decoded, true);
        results[i].image = {images[i].name, decoded.width, decoded.height, std::move(decoded.texels)};
        results[i].remark = std::move(decoded.remark);
        results[i].fileWidth = decoded.fileWidth;
        results[i].fileHeight = decoded.fileHeight;
    };
    std::vector<std::uint8_t> isLarge(images.size(), 0);
    forImages(images.size(), monitor, [&](std::size_t i) {
        if (isFaulty(results[i])) return;
        ImageBudget none(0);
        decode(i, none);
        isLarge[i] = none.isExceeded();
    });
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (isLarge[i] == 0) continue;
        monitor.report("images", 1);
        decode(i, budget);
    }
    return results;
}

}  // namespace helio
