#include "engine/image/backend.hpp"
#include "engine/scene/gltf/build.hpp"
#include "engine/scene/gltf/uri.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <thread>

namespace helio::gltf {

int ImageLoader::use(int image) {
    const nlohmann::json& images = asset_.document()["images"];
    known_.resize(images.size(), -1);
    int& known = known_[std::size_t(image)];
    if (known >= 0) return known;

    const nlohmann::json& json = images[std::size_t(image)];
    const std::string place = fmt::format("images[{}]", image);
    Source source;
    source.image = image;
    source.name = json.value("name", "");
    if (json.contains("uri")) {
        const auto& uri = json["uri"].get_ref<const std::string&>();
        if (source.name.empty() && !uri.starts_with("data:")) source.name = uri;
        source.owned = readUri(asset_.file(), place + ".uri", asset_.folder(), uri);
        source.bytes = source.owned;
    } else if (json.contains("bufferView")) {
        source.bytes = asset_.bufferView(json["bufferView"].get<int>());
    } else {
        throw InputError(asset_.file(), place, "has neither a uri nor a bufferView", "give it one of them");
    }
    const auto same = std::find_if(sources_.begin(), sources_.end(), [&](const Source& other) {
        return std::ranges::equal(other.bytes, source.bytes);
    });
    known = int(same - sources_.begin());
    if (same == sources_.end()) sources_.push_back(std::move(source));
    return known;
}

void ImageLoader::decodeAll(LoadMonitor& monitor, helio::Scene& scene) {
    std::vector<DecodedImage> decoded(sources_.size());
    std::vector<std::string> faults(sources_.size());
    if (!sources_.empty()) imageBackend();  // its own failure is not an image's
    std::atomic<std::size_t> next{0};
    std::atomic<bool> isStopped{false};
    const auto work = [&] {
        for (std::size_t i = next++; i < sources_.size() && !isStopped; i = next++) {
            faults[i] = decodeImage(sources_[i].bytes, decoded[i]);
        }
    };
    std::vector<std::jthread> helpers;
    const std::size_t threads =
        std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), sources_.size());
    try {
        for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(work);
        for (std::size_t i = next++; i < sources_.size(); i = next++) {
            monitor.report("images", double(i) / double(sources_.size()));
            faults[i] = decodeImage(sources_[i].bytes, decoded[i]);
        }
    } catch (...) {
        isStopped = true;
        throw;
    }
    helpers.clear();
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        if (!faults[i].empty()) {
            throw InputError(asset_.file(), fmt::format("images[{}]", sources_[i].image), faults[i],
                             "give a whole PNG or JPEG image");
        }
        scene.images.push_back(
            {sources_[i].name, decoded[i].width, decoded[i].height, std::move(decoded[i].texels)});
    }
}

}  // namespace helio::gltf
