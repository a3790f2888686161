#include "engine/image/backend.hpp"
#include "engine/image/read_file.hpp"

#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

namespace helio {

TextureImage loadTextureImage(const std::filesystem::path& file) {
    ImageBudget budget;
    DecodedImage decoded;
    std::string fault = pngFault(readFile(file));
    if (fault.empty()) fault = imageBackend().decodeFile(file, budget, decoded);
    if (!fault.empty())
        throw InputError(file.string(), "", fault, "give a whole image file of a known format");
    return {file.filename().string(), decoded.width, decoded.height, std::move(decoded.texels)};
}

}  // namespace helio
