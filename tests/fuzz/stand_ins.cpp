/** @file
 * Stands in for the module that decodes images (a fuzzer's images are one texel), and for what is written in
 * the functions shared with kernels, which Clang 14 does not compile.
 */
#include "engine/image/backend.hpp"
#include "engine/image/display.hpp"
#include "engine/scene/lens_table.hpp"

#include <heliograph/camera.hpp>

namespace helio {
namespace {

class StandIn final : public ImageBackend {
public:
    std::string read(const std::filesystem::path&, ImageF&) const override { return "is not read here"; }
    std::string decode(std::span<const std::byte> file, const std::string&, ImageBudget&,
                       DecodedImage& image) const override {
        if (file.size() % 16 == 0) return "is not decoded here";
        image.width = image.height = 1;
        image.texels = std::vector<std::uint8_t>(4, 255);
        return {};
    }
    std::string decodeFile(const std::filesystem::path&, ImageBudget&, DecodedImage&) const override {
        return "is not decoded here";
    }
    std::string encodeExr(const ImageF&, std::vector<std::byte>&) const override {
        return "is not written here";
    }
    std::string encodeRgb8(std::span<const std::uint8_t>, std::uint32_t, std::uint32_t, const std::string&,
                           std::vector<std::byte>&) const override {
        return "is not written here";
    }
};

}  // namespace

const ImageBackend& imageBackend() {
    static const StandIn standIn;
    return standIn;
}

ThinLens thinLens(const Camera&, double fNumber, double focusDistance, double) {
    ThinLens lens;
    lens.apertureDiameter = float(1 / fNumber);
    lens.focusDistance = float(focusDistance);
    return lens;
}

ParaxialLens paraxial(const LensTable&) {
    ParaxialLens lens;
    lens.focalLength = lens.filmDistance = 1;
    return lens;
}

std::array<float, 3> displayed(const std::array<float, 3>& linear, const Display&) {
    return linear;
}

}  // namespace helio
