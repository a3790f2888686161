#include "engine/image/read_file.hpp"
#include "engine/scene/image_decoding.hpp"

#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <string_view>

namespace helio {

TextureImage loadTextureImage(const std::filesystem::path& file, ImageBudget& budget) {
    DecodedImage decoded;
    std::string fault;
    const std::vector<std::byte> bytes = readFile(file);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (isTextureFormat(bytes)) {
        fault = decodeImage(bytes, budget, decoded);
    } else if (text.starts_with("\x76\x2f\x31\x01") || text.starts_with("#?")) {
        budget.begin();
        fault = imageBackend().decodeFile(file, budget, decoded);
    } else {
        fault = "is no PNG, JPEG, WebP, OpenEXR or Radiance image";
    }
    if (!fault.empty())
        throw InputError(file.string(), "", fault, "give a whole image file of a known format");
    return {file.filename().string(), decoded.width, decoded.height, std::move(decoded.texels)};
}

TextureImage loadTextureImage(const std::filesystem::path& file) {
    ImageBudget budget;
    return loadTextureImage(file, budget);
}

}  // namespace helio
