/** @file libheliograph_image.so: the one place that sees OpenImageIO. */
#include "engine/image/backend.hpp"
#include "engine/image/jpeg.hpp"
#include "engine/image/png.hpp"
#include "engine/image/texel_reader.hpp"
#include "engine/image/webp.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <string_view>

namespace helio {
namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/** A header may claim any size in a few bytes; what is read must fit in memory with room to spare. */
constexpr std::uint64_t maximumTexels = std::uint64_t(1) << 28;
constexpr std::uint64_t maximumValues = std::uint64_t(1) << 33;

/** One line, whatever OpenImageIO says. */
std::string oneLine(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? "cannot be read" : text;
}

std::string checkSize(const ImageSpec& spec, std::uint64_t values, std::uint64_t limit) {
    if (spec.deep) return "is a deep image";
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1)
        return "has no flat pixels";
    if (values > limit)
        return "is too large: " + std::to_string(spec.width) + " x " + std::to_string(spec.height);
    return {};
}

/** OpenImageIO's own threads are not used (images are decoded side by side instead), and alpha stays as
 * stored. */
ImageSpec readHints() {
    ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    return hints;
}

/** Rows of an image that OpenImageIO has opened. */
template <class T>
std::string readTexels(ImageInput& input, const ImageSpec& spec, std::uint64_t encoded, ImageBudget& budget,
                       DecodedImage& image) {
    const bool isTiled = spec.tile_width != 0;
    const auto readRows = [&](std::uint32_t first, std::uint32_t rows, T* values) -> std::string {
        const auto type = OIIO::BaseTypeFromC<T>::value;
        const int y = spec.y + int(first), end = y + int(rows);
        const bool isRead = isTiled
                                ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, end, spec.z,
                                                   spec.z + 1, 0, spec.nchannels, type, values)
                                : input.read_scanlines(0, 0, y, end, spec.z, 0, spec.nchannels, type, values);
        return isRead ? std::string() : oneLine(input.geterror());
    };
    TexelReader<T> reader(std::uint32_t(spec.width), std::uint32_t(spec.height), std::size_t(spec.nchannels),
                          encoded, budget);
    return reader.read(isTiled ? std::uint32_t(spec.tile_height) : 0, readRows, image);
}

std::string readAnyTexels(ImageInput& input, const ImageSpec& spec, std::uint64_t encoded,
                          ImageBudget& budget, DecodedImage& image) {
    const std::uint64_t texels = std::uint64_t(spec.width) * std::uint64_t(spec.height);
    if (std::string fault = checkSize(spec, texels, maximumTexels); !fault.empty()) return fault;
    if (spec.format == TypeDesc::UINT8) return readTexels<std::uint8_t>(input, spec, encoded, budget, image);
    if (spec.format == TypeDesc::UINT16)
        return readTexels<std::uint16_t>(input, spec, encoded, budget, image);
    return readTexels<float>(input, spec, encoded, budget, image);
}

void readMetadata(const ImageSpec& spec, ImageF& image) {
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
        const TypeDesc type = attribute.type();
        const std::string name = attribute.name().string();
        if (type == TypeDesc::STRING) {
            image.metadata[name] = attribute.get_string();
        } else if (type == TypeDesc::FLOAT) {
            image.metadata[name] = double(attribute.get_float());
        } else if (type == TypeDesc::DOUBLE) {
            image.metadata[name] = *static_cast<const double*>(attribute.data());
        } else if (type == TypeDesc::INT || type == TypeDesc::UINT) {
            image.metadata[name] = std::int64_t(attribute.get_int());
        }
    }
}

class OiioBackend final : public ImageBackend {
public:
    OiioBackend() {
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads",
                        -1);  // no pool: it would not survive a fork, and encodes no faster here
    }

    std::string read(const std::filesystem::path& file, ImageF& image) const override try {
        const ImageSpec hints = readHints();
        const std::unique_ptr<ImageInput> input = ImageInput::open(file.string(), &hints);
        if (!input) return oneLine(OIIO::geterror());
        const ImageSpec& spec = input->spec();
        const std::uint64_t values =
            std::uint64_t(spec.width) * std::uint64_t(spec.height) * std::uint64_t(spec.nchannels);
        if (std::string fault = checkSize(spec, values, maximumValues); !fault.empty()) return fault;
        image.width = std::uint32_t(spec.width);
        image.height = std::uint32_t(spec.height);
        image.channels = spec.channelnames;
        image.data.resize(values);
        if (!input->read_image(0, 0, 0, -1, TypeDesc::FLOAT, image.data.data()))
            return oneLine(input->geterror());
        readMetadata(spec, image);
        return {};
    } catch (const std::exception& error) {
        return oneLine(error.what());
    }

    std::string decode(std::span<const std::byte> file, const std::string& format, ImageBudget& budget,
                       DecodedImage& image) const override try {
        if (format == "webp") return decodeWebp(file, maximumTexels, budget, image);
        if (format == "png") return decodePng(file, maximumTexels, budget, image);
        if (format == "jpg") return decodeJpeg(file, maximumTexels, budget, image);
        OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(file.data()), file.size());
        const ImageSpec hints = readHints();
        const std::unique_ptr<ImageInput> input = ImageInput::create(format);
        ImageSpec spec;
        if (!input || !input->set_ioproxy(&memory)) return oneLine(OIIO::geterror());
        if (!input->open("texture." + format, spec, hints)) return oneLine(input->geterror());
        return readAnyTexels(*input, spec, file.size(), budget, image);
    } catch (const std::exception& error) {
        return oneLine(error.what());
    }

    std::string decodeFile(const std::filesystem::path& file, ImageBudget& budget,
                           DecodedImage& image) const override try {
        const ImageSpec hints = readHints();
        const std::unique_ptr<ImageInput> input = ImageInput::open(file.string(), &hints);
        if (!input) return oneLine(OIIO::geterror());
        const ImageSpec& spec = input->spec();
        const std::uint64_t encoded = std::filesystem::file_size(file);
        // Others keep the whole image, or strips as high as it, while they read it.
        const std::string_view format = input->format_name();
        const bool byRows = format == "openexr" || format == "hdr";
        if (!byRows && !budget.hold(spec.image_bytes(true), encoded))
            return unfoldsTo(std::uint32_t(spec.width), std::uint32_t(spec.height), encoded);
        const std::uint64_t texels = std::uint64_t(spec.width) * std::uint64_t(spec.height);
        if (byRows && !budget.isTrial() && ImageBudget::wantsTrial(texels * 4 * sizeof(float), encoded)) {
            ImageBudget trial = ImageBudget::trial();
            if (std::string fault = decodeFile(file, trial, image); !fault.empty()) return fault;
        }
        return readAnyTexels(*input, spec, encoded, budget, image);
    } catch (const std::exception& error) {
        return oneLine(error.what());
    }

    std::string encodeExr(const ImageF& image, std::vector<std::byte>& file) const override {
        ImageSpec spec(int(image.width), int(image.height), int(image.channels.size()), TypeDesc::FLOAT);
        spec.channelnames = image.channels;
        spec.alpha_channel = -1;  // values are written as they are, whatever a channel is called
        spec.attribute("oiio:ColorSpace", "Linear");
        spec.attribute("compression", "zip");
        spec.attribute("DateTime", "");  // else OpenImageIO writes the time, and equal images differ
        for (const auto& [name, value] : image.metadata) {
            if (const auto* text = std::get_if<std::string>(&value)) {
                spec.attribute(name, *text);
            } else if (const auto* number = std::get_if<double>(&value)) {
                spec.attribute(name, TypeDesc::DOUBLE, number);
            } else {
                // OpenEXR's integers have 32 bits; a longer one is kept as its digits.
                const std::int64_t integer = std::get<std::int64_t>(value);
                if (integer >= std::numeric_limits<int>::min() &&
                    integer <= std::numeric_limits<int>::max()) {
                    spec.attribute(name, int(integer));
                } else {
                    spec.attribute(name, std::to_string(integer));
                }
            }
        }
        return encode("exr", spec, TypeDesc::FLOAT, image.data.data(), file);
    }

    std::string encodeRgb8(std::span<const std::uint8_t> pixels, std::uint32_t width, std::uint32_t height,
                           const std::string& format, std::vector<std::byte>& file) const override {
        ImageSpec spec(int(width), int(height), 3, TypeDesc::UINT8);
        spec.attribute("oiio:ColorSpace", "sRGB");
        if (format == "jpg") {
            spec.attribute("compression", "jpeg:95");
            spec.attribute("jpeg:subsampling", "4:4:4");
        }
        return encode(format, spec, TypeDesc::UINT8, pixels.data(), file);
    }

private:
    static std::string encode(const std::string& format, ImageSpec& spec, TypeDesc type, const void* pixels,
                              std::vector<std::byte>& file) try {
        std::vector<unsigned char> bytes;
        OIIO::Filesystem::IOVecOutput memory(bytes);
        const std::unique_ptr<ImageOutput> output = ImageOutput::create(format, &memory);
        if (!output) return oneLine(OIIO::geterror());
        output->set_ioproxy(&memory);
        if (!output->open("image." + format, spec) || !output->write_image(type, pixels) ||
            !output->close()) {
            return oneLine(output->geterror());
        }
        const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
        file.assign(first, first + bytes.size());
        return {};
    } catch (const std::exception& error) {
        return oneLine(error.what());
    }
};

}  // namespace
}  // namespace helio

extern "C" {
[[gnu::visibility("default")]] const char* heliographImageVersion() {
    return HELIOGRAPH_VERSION;
}
[[gnu::visibility("default")]] const helio::ImageBackend* heliographImageBackend() {
    static const helio::OiioBackend backend;
    return &backend;
}
}
