#include "engine/scene/gltf/build.hpp"
#include "engine/scene/gltf/uri.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace helio::gltf {

int ImageLoader::use(int image) {
    const nlohmann::json& images = asset_.document()["images"];
    known_.resize(images.size(), -1);
    int& known = known_[std::size_t(image)];
    if (known >= 0) return known;

    const nlohmann::json& json = images[std::size_t(image)];
    const std::string place = fmt::format("images[{}]", image);
    EncodedImage source;
    source.place = place;
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
    const auto same = std::find_if(sources_.begin(), sources_.end(), [&](const EncodedImage& other) {
        return std::ranges::equal(other.bytes, source.bytes);
    });
    known = int(same - sources_.begin());
    if (same == sources_.end()) sources_.push_back(std::move(source));
    return known;
}

void ImageLoader::decodeAll(LoadMonitor& monitor, helio::Scene& scene) {
    for (DecodingResult& image : decodeImages(sources_, monitor)) {
        if (!image.fault.empty())
            throw InputError(asset_.file(), image.place, image.fault, "give a whole PNG, JPEG or WebP image");
        scene.images.push_back(std::move(image.image));
    }
}

}  // namespace helio::gltf
