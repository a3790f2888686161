// JPEGs written by libjpeg, whole and damaged: pixels as OpenImageIO reads them, and no damage that goes
// unseen.
#include "engine/image/backend.hpp"

#include <heliograph/image.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

// clang-format off
#include <cstdio>
#include <jpeglib.h>
// clang-format on

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

namespace helio {
namespace {

struct JpegKind {
    int components;
    bool isProgressive;
    int sampling;  ///< of the first component
};

constexpr JpegKind kJpegKinds[] = {{1, false, 1}, {3, false, 1}, {3, false, 2},
                                   {1, true, 1},  {3, true, 1},  {3, true, 2}};

std::vector<std::byte> jpegOf(JDIMENSION width, JDIMENSION height, const JpegKind& kind) {
    jpeg_compress_struct encoder;
    jpeg_error_mgr errors;
    encoder.err = jpeg_std_error(&errors);
    jpeg_create_compress(&encoder);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&encoder, &bytes, &size);
    encoder.image_width = width;
    encoder.image_height = height;
    encoder.input_components = kind.components;
    encoder.in_color_space = kind.components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&encoder);
    jpeg_set_quality(&encoder, 90, TRUE);
    encoder.comp_info[0].h_samp_factor = encoder.comp_info[0].v_samp_factor = kind.sampling;
    if (kind.isProgressive) jpeg_simple_progression(&encoder);
    jpeg_start_compress(&encoder, TRUE);
    std::mt19937 random(7);
    std::vector<JSAMPLE> row(std::size_t(width) * std::size_t(kind.components));
    for (JDIMENSION y = 0; y < height; ++y) {
        for (JSAMPLE& sample : row) sample = JSAMPLE(random() % 200 + y % 50);
        JSAMPROW place = row.data();
        jpeg_write_scanlines(&encoder, &place, 1);
    }
    jpeg_finish_compress(&encoder);
    jpeg_destroy_compress(&encoder);
    const auto* const first = reinterpret_cast<const std::byte*>(bytes);
    std::vector<std::byte> file(first, first + size);
    std::free(bytes);
    return file;
}

std::string decoded(std::span<const std::byte> file, DecodedImage& image) {
    ImageBudget budget;
    return decodeImage(file, budget, image);
}

TEST(Jpeg, EveryKindIsWhatOpenImageIoReads) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("heliograph_jpeg_" + std::to_string(::getpid()) + ".jpg");
    for (const JpegKind& kind : kJpegKinds) {
        const std::vector<std::byte> file = jpegOf(37, 51, kind);
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
        const ImageF expected = loadImage(path);
        DecodedImage image;
        ASSERT_EQ(decoded(file, image), "");
        EXPECT_EQ(image.remark, "");
        ASSERT_EQ(image.width, 37u);
        ASSERT_EQ(image.height, 51u);
        const auto& texels = std::get<std::vector<std::uint8_t>>(image.texels);
        std::size_t wrong = 0;
        for (std::uint32_t i = 0; i < 37 * 51; ++i) {
            for (std::size_t c = 0; c < 3; ++c)
                wrong += texels[i * 4 + c] !=
                         std::lround(expected.at(i % 37, i / 37, kind.components == 1 ? 0 : c) * 255);
            wrong += texels[i * 4 + 3] != 255;
        }
        EXPECT_EQ(wrong, 0u);
        EXPECT_EQ(checkImage(file), "");
    }
    std::filesystem::remove(path);
}

TEST(Jpeg, WhatIsCutOffIsRefusedWhereverItIs) {
    for (const JpegKind& kind : kJpegKinds) {
        const std::vector<std::byte> file = jpegOf(64, 48, kind);
        for (std::size_t size = 3; size < file.size(); size += 1 + file.size() / 97) {
            DecodedImage image;
            const std::span<const std::byte> cut(file.data(), size);
            EXPECT_NE(decoded(cut, image), "") << size << " of " << file.size();
            EXPECT_NE(checkImage(cut), "") << size;
        }
    }
}

TEST(Jpeg, DamageIsToldOrRemarkedOn) {
    for (const JpegKind& kind : kJpegKinds) {
        const std::vector<std::byte> file = jpegOf(64, 48, kind);
        std::size_t silent = 0, tried = 0;
        for (std::size_t at = file.size() / 2; at + 40 < file.size(); at += 41) {
            std::vector<std::byte> damaged = file;  // ones: no code of the standard is all of them
            for (std::size_t k = 0; k < 16; ++k)
                damaged[at + k] = k % 2 == 0 ? std::byte{0xff} : std::byte{0};
            DecodedImage image;
            const std::string fault = decoded(damaged, image);
            silent += fault.empty() && image.remark.empty();
            EXPECT_EQ(checkImage(damaged).empty(), fault.empty()) << at;
            ++tried;
        }
        EXPECT_EQ(silent, 0u) << "of " << tried << ", progressive " << kind.isProgressive;
    }
    std::vector<std::byte> odd = jpegOf(64, 48, kJpegKinds[1]);
    odd.insert(odd.end() - 2, 100, std::byte{0x55});
    DecodedImage image;
    EXPECT_EQ(decoded(odd, image), "");
    EXPECT_NE(image.remark, "");
}

TEST(Jpeg, MoreScansThanAnyoneWritesAreRefused) {
    const std::vector<std::byte> file = jpegOf(64, 48, {1, true, 1});
    // The last scan, from its marker to the end of the file, again and again.
    std::size_t scan = file.size() - 2;
    while (file[scan] != std::byte{0xff} || file[scan + 1] != std::byte{0xda}) --scan;
    std::vector<std::byte> many(file.begin(), file.end() - 2);
    for (int i = 0; i < 200; ++i)
        many.insert(many.end(), file.begin() + std::ptrdiff_t(scan), file.end() - 2);
    many.insert(many.end(), file.end() - 2, file.end());
    DecodedImage image;
    EXPECT_EQ(decoded(many, image), "has more than 100 scans");
    EXPECT_EQ(checkImage(many), "has more than 100 scans");
}

}  // namespace
}  // namespace helio
