// PNGs of every kind that ISO 15948 allows, written by libpng, against what its section 13 says they hold.
#include "engine/image/backend.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace helio {
namespace {

struct Kind {
    int color, depth, interlace;
    bool transparent;  ///< a colour that is, by tRNS
};

/** Samples of each pixel as stored: indices for palettes. */
struct Picture {
    std::uint32_t width, height;
    std::vector<std::uint16_t> samples;
};

constexpr std::size_t kColors =
    2;  // of a palette, and values of a pixel, so that some are the transparent one
constexpr std::array<png_color, kColors> kPalette{{{10, 20, 30}, {250, 130, 70}}};

std::size_t channelsOf(int color) {
    return color == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
           : color == PNG_COLOR_TYPE_RGB      ? 3
           : color == PNG_COLOR_TYPE_RGBA     ? 4
                                              : 1;
}

std::vector<std::byte> encode(const Picture& picture, const Kind& kind) {
    std::vector<std::byte> file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    const auto write = [](png_structp to, png_bytep data, png_size_t size) {
        auto& bytes = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(to));
        bytes.insert(bytes.end(), reinterpret_cast<std::byte*>(data),
                     reinterpret_cast<std::byte*>(data) + size);
    };
    png_set_write_fn(png, &file, write, nullptr);
    png_set_IHDR(png, info, picture.width, picture.height, kind.depth, kind.color, kind.interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (kind.color == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, kPalette.data(), kColors);
    if (kind.transparent) {
        const std::array<png_byte, kColors> alpha{255, 77};
        png_color_16 color{0, picture.samples[0], picture.samples[1], picture.samples[2], picture.samples[0]};
        png_set_tRNS(png, info, alpha.data(), kColors, &color);
    }
    png_write_info(png, info);
    const std::size_t row = picture.width * channelsOf(kind.color);
    std::vector<std::vector<png_byte>> rows(picture.height);
    std::vector<png_bytep> pointers;
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        rows[y].resize((row * std::size_t(kind.depth) + 7) / 8);
        for (std::size_t i = 0; i < row; ++i) {
            const unsigned value = picture.samples[y * row + i];
            if (kind.depth == 16) {
                rows[y][2 * i] = png_byte(value >> 8);
                rows[y][2 * i + 1] = png_byte(value);
            } else {
                const std::size_t bit = i * std::size_t(kind.depth);
                rows[y][bit / 8] |= png_byte(value << (8 - std::size_t(kind.depth) - bit % 8));
            }
        }
        pointers.push_back(rows[y].data());
    }
    png_write_image(png, pointers.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

/** R G B A of a pixel, 0 to `largest`. */
std::array<std::uint32_t, 4> expected(const std::uint16_t* pixel, const Kind& kind, const Picture& picture) {
    const std::uint32_t largest = kind.depth == 16 ? 65535 : 255;
    if (kind.color == PNG_COLOR_TYPE_PALETTE) {
        const png_color& c = kPalette[pixel[0]];
        return {c.red, c.green, c.blue, kind.transparent && pixel[0] == 1 ? 77u : 255u};
    }
    const std::size_t channels = channelsOf(kind.color);
    const bool isGray = channels <= 2;
    const std::uint32_t scale = kind.depth < 8 ? 255 / ((1u << kind.depth) - 1) : 1;
    std::array<std::uint32_t, 4> result{};
    for (std::size_t c = 0; c < 3; ++c) result[c] = pixel[isGray ? 0 : c] * scale;
    result[3] = channels == 2 ? pixel[1] : channels == 4 ? pixel[3] : largest;
    if (kind.transparent && std::equal(pixel, pixel + channels, picture.samples.begin())) result[3] = 0;
    return result;
}

void check(const Kind& kind) {
    SCOPED_TRACE(testing::Message() << "colour type " << kind.color << ", " << kind.depth
                                    << " bits, interlace " << kind.interlace << ", transparent "
                                    << kind.transparent);
    Picture picture{13, 9, {}};
    const std::size_t channels = channelsOf(kind.color);
    std::mt19937 random(7);
    std::array<std::uint16_t, 8> values{};
    for (std::uint16_t& value : values) value = std::uint16_t(random() & ((1u << kind.depth) - 1));
    for (std::size_t i = 0; i < 13 * 9 * channels; ++i)
        picture.samples.push_back(kind.color == PNG_COLOR_TYPE_PALETTE
                                      ? std::uint16_t(random() % kColors)
                                      : values[random() % (channels == 1 ? 4 : 8)]);
    const std::vector<std::byte> file = encode(picture, kind);
    ImageBudget budget;
    DecodedImage image;
    ASSERT_EQ(decodeImage(file, budget, image), "");
    ASSERT_EQ(image.width, 13u);
    ASSERT_EQ(image.height, 9u);
    EXPECT_EQ(checkImage(file), "");
    std::vector<std::byte> higher =
        file;  // than its rows: the header's length, name, width and height come first
    higher[23] = std::byte{10};
    const auto crc = std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(&higher[12]), 17));
    for (std::size_t k = 0; k < 4; ++k) higher[29 + k] = std::byte(crc >> (24 - 8 * k) & 255);
    EXPECT_NE(decodeImage(higher, budget, image), "");
    EXPECT_NE(checkImage(higher), "");
    ASSERT_EQ(decodeImage(file, budget, image), "");
    for (std::size_t i = 0; i < 13 * 9; ++i) {
        const auto truth = expected(&picture.samples[i * channels], kind, picture);
        for (std::size_t c = 0; c < 4; ++c) {
            const std::uint32_t value = kind.depth == 16
                                            ? std::get<std::vector<std::uint16_t>>(image.texels)[4 * i + c]
                                            : std::get<std::vector<std::uint8_t>>(image.texels)[4 * i + c];
            ASSERT_EQ(value, truth[c]) << "pixel " << i << " channel " << c;
        }
    }
}

TEST(Png, EveryKindHoldsWhatTheStandardSays) {
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7})
        for (const bool transparent : {false, true}) {
            for (const int depth : {1, 2, 4, 8, 16})
                check({PNG_COLOR_TYPE_GRAY, depth, interlace, transparent});
            for (const int depth : {1, 2, 4, 8})
                check({PNG_COLOR_TYPE_PALETTE, depth, interlace, transparent});
            for (const int depth : {8, 16}) check({PNG_COLOR_TYPE_RGB, depth, interlace, transparent});
            if (transparent) continue;  // these have alpha of their own
            for (const int depth : {8, 16}) check({PNG_COLOR_TYPE_GRAY_ALPHA, depth, interlace, false});
            for (const int depth : {8, 16}) check({PNG_COLOR_TYPE_RGBA, depth, interlace, false});
        }
}

}  // namespace
}  // namespace helio
