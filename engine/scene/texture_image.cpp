#include "engine/image/decoder_memory.hpp"
#include "engine/image/read_file.hpp"
#include "engine/scene/image_decoding.hpp"

#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace helio {
namespace {

/** OpenEXR, Radiance, BMP and TIFF by their first bytes; TGA has none of its own. */
bool isOtherFormat(const std::filesystem::path& file, std::string_view text) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return text.starts_with("\x76\x2f\x31\x01") || text.starts_with("#?") || text.starts_with("BM") ||
           text.starts_with(std::string_view("II*\0", 4)) || text.starts_with(std::string_view("MM\0*", 4)) ||
           extension == ".tga";
}

}  // namespace

TextureImage loadTextureImage(const std::filesystem::path& file, ImageBudget& budget) {
    DecodedImage decoded;
    std::string fault;
    const std::vector<std::byte> bytes = readFile(file);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (isTextureFormat(bytes)) {
        fault = decodeImage(bytes, budget, decoded);
    } else if (isOtherFormat(file, text)) {
        budget.begin();
        const DecoderMemory memory = decoderMemory(bytes);
        if (budget.hold(memory.bytes, bytes.size()))
            fault = imageBackend().decodeFile(file, budget, decoded);
        else
            fault = unfoldsTo(memory.width, memory.height, bytes.size());
    } else {
        fault = "is no PNG, JPEG, WebP, OpenEXR, Radiance, TIFF, BMP or TGA image";
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
