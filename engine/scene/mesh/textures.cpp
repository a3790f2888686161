#include "engine/scene/mesh/textures.hpp"

#include "engine/image/read_file.hpp"
#include "engine/scene/folder.hpp"
#include "engine/scene/mesh/text.hpp"
#include "engine/scene/notes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace helio::mesh {

int TextureFiles::texture(const std::string& name, bool isClamped) {
    const auto [known, isNew] = textures_.try_emplace({name, isClamped}, -1);
    if (!isNew) return known->second;
    const int image = read(name);
    if (image < 0) return -1;
    Texture texture;
    texture.name = name;
    texture.image = image;
    if (isClamped) texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    scene_.textures.push_back(std::move(texture));
    return known->second = int(scene_.textures.size()) - 1;
}

void TextureFiles::decode(LoadMonitor& monitor) {
    // A material takes some 2 KiB.
    ImageBudget budget(ImageBudget::standard -
                       std::min(scene_.materials.size() * 2048, std::size_t(ImageBudget::standard)));
    for (DecodingResult& result : decodeImages(images_, budget, monitor)) {
        if (!result.fault.empty()) {
            warn(scene_, fmt::format("texture {} {}; white is shown", shown(result.place), result.fault));
            result.image.width = result.image.height = 1;
            result.image.texels = std::vector<std::uint8_t>(4, 255);
        }
        if (!result.remark.empty())
            warn(scene_, fmt::format("texture {} {}", shown(result.place), result.remark));
        scene_.images.push_back(std::move(result.image));
    }
}

int TextureFiles::read(const std::string& name) {
    const auto [known, isNew] = files_.try_emplace(name, -1);
    if (!isNew) return known->second;
    const std::optional<std::filesystem::path> path = pathBelow(name);
    if (!path) {
        warn(scene_, fmt::format("texture {} leads out of the file's folder; left out", shown(name)));
        return -1;
    }
    EncodedImage image;
    image.place = image.name = name;
    try {
        image.owned = readFile(fileBelow(file_, *path));
    } catch (const InputError& error) {
        warn(scene_, fmt::format("texture {} {}; left out", shown(name), error.fault));
        return -1;
    }
    image.bytes = image.owned;
    const auto same = std::find_if(images_.begin(), images_.end(), [&](const EncodedImage& other) {
        return std::ranges::equal(other.bytes, image.bytes);
    });
    known->second = int(same - images_.begin());
    if (same == images_.end()) images_.push_back(std::move(image));
    return known->second;
}

}  // namespace helio::mesh
