#include "engine/scene/gltf/build.hpp"
#include "engine/scene/gltf/uri.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace helio::gltf {

int ImageLoader::use(int image) {
    known_.resize(asset_.document().size("images"), -1);
    int& known = known_[std::size_t(image)];
    if (known >= 0) return known;

    const nlohmann::json json = asset_.document().element("images", std::size_t(image));
    const std::string place = fmt::format("images[{}]", image);
    EncodedImage source;
    source.place = place;
    source.name = json.value("name", "");
    if (json.contains("uri")) {
        const std::string_view uri = asset_.uri(json["uri"].get_ref<const std::string&>());
        if (source.name.empty() && !uri.starts_with("data:")) source.name = uri;
        source.owned = readUri(asset_.file(), place + ".uri", uri);
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

namespace {

/** What an image's first bytes say it is; empty for none of glTF's. */
std::string_view mimeTypeOf(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG")) return "image/png";
    if (text.starts_with("\xff\xd8")) return "image/jpeg";
    return text.starts_with("RIFF") ? "image/webp" : "";
}

}  // namespace

void ImageLoader::decodeAll(LoadMonitor& monitor, helio::Scene& scene) {
    for (std::size_t i = 0; i < known_.size(); ++i) {
        if (known_[i] < 0) continue;
        const nlohmann::json json = asset_.document().element("images", i);
        const std::string said = json.value("mimeType", "");
        const std::string_view type = mimeTypeOf(sources_[std::size_t(known_[i])].bytes);
        if (!said.empty() && !type.empty() && said != type)
            warn(scene, fmt::format("images[{}] is {}, whatever its mimeType", i, type));
        if (json.contains("uri") && json.contains("bufferView"))
            warn(scene, fmt::format("images[{}] has a uri and a bufferView; the uri counts", i));
    }
    ImageBudget budget(memory_.left());
    std::vector<DecodingResult> results = decodeImages(sources_, budget, monitor, AtFault::Stop);
    memory_.take("images", memory_.left() - std::size_t(budget.left()), 0);
    for (DecodingResult& image : results) {
        sizes_.emplace_back(image.fileWidth, image.fileHeight);
        if (!image.fault.empty())
            throw InputError(asset_.file(), image.place, image.fault, "give a whole PNG, JPEG or WebP image");
        if (!image.remark.empty()) warn(scene, image.place + " " + image.remark);
        scene.images.push_back(std::move(image.image));
    }
}

}  // namespace helio::gltf
