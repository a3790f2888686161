#include "engine/image/backend.hpp"
#include "engine/scene/image_decoding.hpp"

#include <heliograph/error.hpp>
#include <heliograph/file.hpp>
#include <heliograph/image.hpp>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

namespace helio {
namespace {

namespace fs = std::filesystem;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

class Images : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("heliograph_image_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::vector<fs::path> partials() const {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder_)) {
            if (entry.path().extension() == ".partial") found.push_back(entry.path());
        }
        return found;
    }

    fs::path folder_;
};

ImageF makeImage(std::uint32_t width, std::uint32_t height, std::vector<std::string> channels) {
    ImageF image;
    image.width = width;
    image.height = height;
    image.channels = std::move(channels);
    image.data.resize(std::size_t(width) * height * image.channels.size());
    std::uint32_t state = 1;
    for (float& value : image.data) {
        state = state * 1664525u + 1013904223u;
        value = float(state) / 4294967296.0f;
    }
    return image;
}

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void expectSameBits(const ImageF& a, const ImageF& b) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (std::size_t c = 0; c < a.channels.size(); ++c) {
        const int other = b.channel(a.channels[c]);
        ASSERT_GE(other, 0) << a.channels[c];
        for (std::uint32_t y = 0; y < a.height; ++y) {
            for (std::uint32_t x = 0; x < a.width; ++x) {
                const float p = a.at(x, y, c), q = b.at(x, y, std::size_t(other));
                ASSERT_EQ(std::memcmp(&p, &q, 4), 0) << a.channels[c] << " at " << x << ", " << y;
            }
        }
    }
}

TEST_F(Images, ExrKeepsEveryChannelToTheBit) {
    ImageF image = makeImage(
        13, 7,
        {"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z",
         "depth.Z", "variance.R", "variance.G", "variance.B", "samples", "id.instance", "id.triangle"});
    image.at(0, 0, 0) = nan;
    image.at(1, 0, 0) = inf;
    image.at(2, 0, 0) = -inf;
    image.at(3, 0, 0) = -0.0f;
    image.at(4, 0, 0) = 1e-45f;
    image.at(5, 0, 0) = 3.4028235e38f;
    image.at(6, 0, 3) = 0;  // an alpha of 0 must not erase the colour
    saveImage(folder_ / "all.exr", image);
    expectSameBits(image, loadImage(folder_ / "all.exr"));
    EXPECT_TRUE(partials().empty());
}

TEST_F(Images, ExrKeepsOddSizesAndSingleChannels) {
    const std::pair<int, int> sizes[] = {{1, 1}, {1, 129}, {257, 1}, {16, 17}};
    for (const auto& [width, height] : sizes) {
        const ImageF image = makeImage(std::uint32_t(width), std::uint32_t(height), {"depth.Z"});
        saveImage(folder_ / "odd.exr", image);
        expectSameBits(image, loadImage(folder_ / "odd.exr"));
    }
}

TEST_F(Images, ExrKeepsTheContractsMetadata) {
    ImageF image = makeImage(4, 4, {"R", "G", "B"});
    image.metadata = {{"scene", "sample:cornell"},
                      {"seed", std::int64_t(-7)},
                      {"samples", std::int64_t(64)},
                      {"seconds", 1.0 / 3},
                      {"error", 1e-300},
                      {"device", "llvmpipe \"x\" é"},
                      {"version", "0.1.0"},
                      {"big", std::int64_t(1) << 40}};
    saveImage(folder_ / "meta.exr", image);
    const ImageF loaded = loadImage(folder_ / "meta.exr");
    image.metadata["big"] = "1099511627776";  // OpenEXR's integers have 32 bits
    for (const auto& [name, value] : image.metadata) {
        ASSERT_TRUE(loaded.metadata.contains(name)) << name;
        EXPECT_EQ(loaded.metadata.at(name), value) << name;
    }
}

TEST_F(Images, TheSameImageGivesTheSameBytes) {
    const ImageF image = makeImage(64, 48, {"R", "G", "B"});
    const char* const names[] = {"a.exr", "a.png", "a.jpg"};
    std::vector<std::string> first;
    for (const char* name : names) {
        saveImage(folder_ / name, image);
        first.push_back(bytesOf(folder_ / name));
    }
    ::usleep(1100000);  // a time stamp in a file would differ
    for (std::size_t i = 0; i < 3; ++i) {
        saveImage(folder_ / names[i], image);
        EXPECT_TRUE(first[i] == bytesOf(folder_ / names[i])) << names[i];
    }
}

TEST_F(Images, PngIsSrgbEncodedClampedAndFinite) {
    ImageF image = makeImage(8, 1, {"B", "G", "R", "depth.Z"});
    const float values[8] = {0, 0.5f, 0.18f, 1, 7, -1, nan, inf};
    const int expected[8] = {0, 188, 118, 255, 255, 0, 0, 255};
    for (std::uint32_t x = 0; x < 8; ++x) {
        image.at(x, 0, 2) = values[x];
        image.at(x, 0, 1) = x == 0 ? -inf : 0;
        image.at(x, 0, 0) = 1;
    }
    saveImage(folder_ / "a.PNG", image);
    const ImageF loaded = loadImage(folder_ / "a.PNG");
    ASSERT_EQ(loaded.channels, (std::vector<std::string>{"R", "G", "B"}));
    for (std::uint32_t x = 0; x < 8; ++x) {
        EXPECT_EQ(std::lround(loaded.at(x, 0, 0) * 255), expected[x]) << values[x];
        EXPECT_EQ(loaded.at(x, 0, 1), 0);
        EXPECT_EQ(loaded.at(x, 0, 2), 1);
    }
}

TEST_F(Images, JpegIsCloseToThePng) {
    ImageF image = makeImage(32, 32, {"R", "G", "B"});
    for (std::uint32_t y = 0; y < 32; ++y) {
        for (std::uint32_t x = 0; x < 32; ++x) {
            for (std::size_t c = 0; c < 3; ++c) image.at(x, y, c) = float(x + y * double(c)) / 100;
        }
    }
    saveImage(folder_ / "a.png", image);
    for (const char* name : {"a.jpg", "a.jpeg"}) {
        saveImage(folder_ / name, image);
        EXPECT_LT(compareImages(loadImage(folder_ / name), loadImage(folder_ / "a.png")).rmse, 0.02) << name;
    }
}

TEST_F(Images, WhatCannotBeWrittenIsRefused) {
    const ImageF image = makeImage(4, 4, {"R", "G", "B"});
    for (const char* name : {"a.tiff", "a", "a.exr.bak", ".exr", "nowhere/a.exr", "nowhere/a.png"}) {
        EXPECT_THROW(saveImage(folder_ / name, image), InputError) << name;
    }
    fs::create_directories(folder_ / "folder.exr" / "full");
    EXPECT_THROW(saveImage(folder_ / "folder.exr", image), InputError);
    EXPECT_THROW(saveImage("/proc/heliograph.exr", image), InputError);
    EXPECT_THROW(saveImage(folder_ / "a.png", makeImage(4, 4, {"R", "G"})), InputError);
    EXPECT_THROW(saveImage(folder_ / "a.exr", ImageF{}), InputError);
    EXPECT_TRUE(partials().empty());
    try {
        saveImage(folder_ / "nowhere" / "a.exr", image);
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("nowhere/a.exr"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos)
            << error.what();
    }
}

TEST_F(Images, AnUnwritableFolderKeepsItsFile) {
    if (::geteuid() == 0) {
        // The superuser writes anywhere; a limit on the size of files fails in the middle of writing instead.
        const ImageF old = makeImage(4, 4, {"R", "G", "B"});
        saveImage(folder_ / "a.exr", old);
        const pid_t child = ::fork();
        if (child == 0) {
            ::signal(SIGXFSZ, SIG_IGN);
            const rlimit limit{1000, 1000};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            try {
                saveImage(folder_ / "a.exr", makeImage(64, 64, {"R", "G", "B"}));
            } catch (const InputError&) {
                ::_exit(7);
            }
            ::_exit(0);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_EQ(WEXITSTATUS(status), 7);
        expectSameBits(old, loadImage(folder_ / "a.exr"));
    } else {
        saveImage(folder_ / "a.exr", makeImage(4, 4, {"R", "G", "B"}));
        fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
        EXPECT_THROW(saveImage(folder_ / "a.exr", makeImage(8, 8, {"R", "G", "B"})), InputError);
        fs::permissions(folder_, fs::perms::owner_all);
        EXPECT_EQ(loadImage(folder_ / "a.exr").width, 4u);
    }
    EXPECT_TRUE(partials().empty());
}

TEST_F(Images, AKilledProcessLeavesTheOldFileOrTheNew) {
    const fs::path file = folder_ / "killed.exr";
    ImageF images[2] = {makeImage(97, 61, {"R", "G", "B"}), makeImage(97, 61, {"R", "G", "B"})};
    for (float& value : images[1].data) value += 1;
    saveImage(file, images[0]);
    for (int round = 0; round < 25; ++round) {
        const pid_t child = ::fork();
        if (child == 0) {
            for (int i = 1;; ++i) saveImage(file, images[i % 2]);
        }
        ::usleep(useconds_t(3000 + 1777 * round));
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
        const ImageF loaded = loadImage(file);
        expectSameBits(images[loaded.data[0] > 1 ? 1 : 0], loaded);
    }
    for (const auto& entry : fs::directory_iterator(folder_)) {
        const std::string name = entry.path().filename().string();
        if (name == "killed.exr") continue;
        EXPECT_TRUE(name.starts_with(".killed.exr.") && name.ends_with(".partial")) << name;
    }
}

TEST_F(Images, ASymbolicLinkIsFollowed) {
    fs::create_directories(folder_ / "there");
    fs::create_symlink(folder_ / "there" / "real.exr", folder_ / "link.exr");
    saveImage(folder_ / "link.exr", makeImage(2, 2, {"R"}));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.exr"));
    EXPECT_TRUE(fs::is_regular_file(folder_ / "there" / "real.exr"));
}

TEST_F(Images, WhatCannotBeReadIsRefused) {
    saveImage(folder_ / "a.exr", makeImage(64, 64, {"R", "G", "B"}));
    saveImage(folder_ / "a.png", makeImage(64, 64, {"R", "G", "B"}));
    for (const char* name : {"a.exr", "a.png"}) {
        const std::string whole = bytesOf(folder_ / name);
        const fs::path cut = folder_ / (std::string("cut") + fs::path(name).extension().string());
        for (std::size_t length : {std::size_t(0), std::size_t(3), std::size_t(20), whole.size() / 2}) {
            std::ofstream(cut, std::ios::binary) << whole.substr(0, length);
            EXPECT_THROW(loadImage(cut), InputError) << name << " cut to " << length;
        }
    }
    std::ofstream(folder_ / "text.png") << "no image";
    EXPECT_THROW(loadImage(folder_ / "text.png"), InputError);
    EXPECT_THROW(loadImage(folder_ / "missing.exr"), InputError);
    EXPECT_THROW(loadImage(folder_), InputError);
}

TEST_F(Images, DecodingSpreadsToRgbaAsStored) {
    saveImage(folder_ / "a.png", makeImage(5, 3, {"R", "G", "B"}));
    const std::string file = bytesOf(folder_ / "a.png");
    DecodedImage decoded;
    ImageBudget budget;
    ASSERT_EQ(decodeImage(std::as_bytes(std::span(file)), budget, decoded), "");
    const auto& texels = std::get<std::vector<std::uint8_t>>(decoded.texels);
    ASSERT_EQ(texels.size(), 5u * 3 * 4);
    const ImageF loaded = loadImage(folder_ / "a.png");
    for (std::uint32_t i = 0; i < 15; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(texels[i * 4 + c], std::lround(loaded.at(i % 5, i / 5, c) * 255));
        }
        EXPECT_EQ(texels[i * 4 + 3], 255);
    }
    EXPECT_NE(decodeImage(std::as_bytes(std::span(file.data(), file.size() / 2)), budget, decoded), "");
    EXPECT_NE(decodeImage({}, budget, decoded), "");
}

TEST_F(Images, LargeImagesOfOneColorAreOneTexel) {
    ImageF image = makeImage(1000, 1000, {"R", "G", "B"});
    std::fill(image.data.begin(), image.data.end(), 0.5f);
    saveImage(folder_ / "plain.png", image);
    image.at(999, 999, 0) = 0.25f;
    saveImage(folder_ / "spot.png", image);
    ImageBudget budget;
    DecodedImage plain, spot;
    const std::string plainFile = bytesOf(folder_ / "plain.png"), spotFile = bytesOf(folder_ / "spot.png");
    ASSERT_EQ(decodeImage(std::as_bytes(std::span(plainFile)), budget, plain), "");
    ASSERT_EQ(decodeImage(std::as_bytes(std::span(spotFile)), budget, spot), "");
    EXPECT_EQ(plain.width * plain.height, 1u);
    ASSERT_EQ(spot.width * spot.height, 1000000u);
    const auto &one = std::get<std::vector<std::uint8_t>>(plain.texels),
               &all = std::get<std::vector<std::uint8_t>>(spot.texels);
    ASSERT_EQ(one.size(), 4u);
    const std::vector<std::uint8_t> expected(one);
    EXPECT_NE(all[3999996], expected[0]);
    for (std::size_t i = 0; i < 3999996; ++i) ASSERT_EQ(all[i], expected[i % 4]) << i;
}

TEST(ImageBudget, ImagesOutOfProportionShareAnAllowance) {
    constexpr std::uint64_t mebibyte = 1 << 20;
    ImageBudget budget(112 * mebibyte);
    EXPECT_TRUE(budget.take(1000 * mebibyte, 10 * mebibyte));  // a file of its size
    EXPECT_TRUE(budget.take(60 * mebibyte, 1000));
    EXPECT_FALSE(budget.isExceeded());
    budget.begin();
    EXPECT_TRUE(budget.hold(40 * mebibyte, 1000));
    EXPECT_FALSE(budget.take(40 * mebibyte, 1000));  // both at once
    EXPECT_TRUE(budget.isExceeded());
    budget.begin();
    EXPECT_TRUE(budget.take(40 * mebibyte, 1000));
    EXPECT_EQ(budget.left(), 12 * mebibyte);
    EXPECT_FALSE(budget.take(std::uint64_t(1) << 40, 1000));
    EXPECT_FALSE(budget.hold(~std::uint64_t(0), 1000));
}

TEST_F(Images, TheAllowanceIsForTheFirstOfThem) {
    std::vector<EncodedImage> images(5);
    ImageF image = makeImage(600, 600, {"R", "G", "B"});
    std::fill(image.data.begin(), image.data.end(), 0.5f);
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (i == 1) image = makeImage(600, 600, {"R", "G", "B"});  // of many colours: in proportion
        if (i == 2) std::fill(image.data.begin(), image.data.end(), 0.5f);
        (i == 0 ? image.data.back() : image.data.front()) = 0.25f;  // the first is large at its end
        saveImage(folder_ / "a.png", image);
        const std::string file = bytesOf(folder_ / "a.png");
        const auto* const first = reinterpret_cast<const std::byte*>(file.data());
        images[i].owned.assign(first, first + file.size());
        images[i].bytes = images[i].owned;
        EXPECT_EQ(file.size() * 200 < 600 * 600 * 4, i != 1) << file.size();
    }
    const LoadOptions options;
    LoadMonitor monitor(options);
    for (int run = 0; run < 10; ++run) {
        ImageBudget budget(2 * 600 * 600 * 4 + 1000);  // for two of them
        const std::vector<DecodingResult> results = decodeImages(images, budget, monitor);
        for (std::size_t i = 0; i < images.size(); ++i) EXPECT_EQ(results[i].fault.empty(), i < 3) << i;
        EXPECT_EQ(budget.left(), 1000u);
    }
}

TEST_F(Images, DoNotReplaceWhatIsNoRegularFile) {
    const fs::path pipe = folder_ / "pipe.exr";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink(pipe, folder_ / "link.exr");
    for (const fs::path& file : {pipe, folder_ / "link.exr"}) {
        EXPECT_THROW(saveImage(file, {1, 1, {"R"}, {1}, {}}), InputError);
    }
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_TRUE(partials().empty());
}

TEST_F(Images, TextGoesIntoPipesAndReplacesFiles) {
    const fs::path pipe = folder_ / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    ASSERT_GE(reader, 0);
    writeTextFile(pipe, "through");
    std::array<char, 16> read{};
    EXPECT_EQ(::read(reader, read.data(), read.size()), 7);
    EXPECT_STREQ(read.data(), "through");
    ::close(reader);
    EXPECT_TRUE(fs::is_fifo(pipe));

    const fs::path file = folder_ / "text";
    for (const char* text : {"a longer text", "short"}) {
        writeTextFile(file, text);
        std::ifstream in(file);
        EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), text);
    }
    EXPECT_THROW(writeTextFile("/dev/full", "text"), InputError);
    EXPECT_THROW(writeTextFile(folder_, "text"), InputError);
    EXPECT_THROW(writeTextFile(folder_ / "absent" / "text", "text"), InputError);
    EXPECT_TRUE(partials().empty());
}

TEST(Srgb, IsExactAndInverse) {
    EXPECT_NEAR(srgbEncode(0.5), 0.7353569831, 1e-10);
    EXPECT_NEAR(srgbDecode(0.5), 0.2140411405, 1e-10);
    EXPECT_NEAR(srgbEncode(0.18), 0.4613561295, 1e-10);
    EXPECT_EQ(srgbEncode(0), 0);
    EXPECT_NEAR(srgbEncode(1), 1, 1e-15);
    EXPECT_EQ(srgbEncode(-0.5), -srgbEncode(0.5));
    EXPECT_EQ(srgbDecode(-0.5), -srgbDecode(0.5));
    EXPECT_TRUE(std::isnan(srgbEncode(nan)));
    for (int i = 0; i <= 1000; ++i) {
        const double x = i / 1000.0;
        EXPECT_NEAR(srgbDecode(srgbEncode(x)), x, 3e-8);  // the curve's two parts miss each other by 2.9e-8
        EXPECT_NEAR(srgbEncode(srgbDecode(x)), x, 4e-8);
    }
}

TEST(CompareImages, AgreesWithClosedForms) {
    ImageF reference = makeImage(4, 2, {"R", "G", "B"});
    for (float& value : reference.data) value = 0.5f;
    ImageF image = reference;
    for (float& value : image.data) value = 0.75f;
    image.at(3, 1, 2) = 1.5f;
    const ImageDifference d = compareImages(image, reference);
    const double mse = (23 * 0.0625 + 1) / 24;
    EXPECT_NEAR(d.mse, mse, 1e-15);
    EXPECT_NEAR(d.rmse, std::sqrt(mse), 1e-15);
    EXPECT_NEAR(d.relmse, mse / 0.26, 1e-15);
    EXPECT_NEAR(d.meanRatio, (23 * 0.75 + 1.5) / 12, 1e-15);
    EXPECT_EQ(d.worstX, 3u);
    EXPECT_EQ(d.worstY, 1u);
    EXPECT_EQ(d.worstError, 1.0);
    EXPECT_EQ(d.nan + d.inf, 0u);
}

TEST(CompareImages, MatchesChannelsByNameAndLeavesOutTheNonFinite) {
    ImageF reference = makeImage(5, 1, {"R", "G", "B"});
    ImageF image = makeImage(5, 1, {"depth.Z", "B", "G", "R"});
    for (std::uint32_t x = 0; x < 5; ++x) {
        for (std::size_t c = 0; c < 3; ++c) image.at(x, 0, 3 - c) = reference.at(x, 0, c);
        image.at(x, 0, 0) = nan;  // not compared
    }
    image.at(0, 0, 1) = nan;
    image.at(0, 0, 2) = inf;
    image.at(1, 0, 3) = inf;
    reference.at(2, 0, 0) = -inf;
    const ImageDifference d = compareImages(image, reference);
    EXPECT_EQ(d.mse, 0);
    EXPECT_EQ(d.meanRatio, 1);
    EXPECT_EQ(d.nan, 1u);
    EXPECT_EQ(d.inf, 2u);
    EXPECT_TRUE(std::isnan(compareImages(makeImage(1, 1, {"R", "G", "B"}),
                                         [] {
                                             ImageF all = makeImage(1, 1, {"R", "G", "B"});
                                             all.data.assign(3, nan);
                                             return all;
                                         }())
                               .mse));
}

TEST(CompareImages, RefusesWhatCannotBeCompared) {
    const ImageF image = makeImage(4, 2, {"R", "G", "B"});
    EXPECT_THROW(compareImages(image, makeImage(2, 4, {"R", "G", "B"})), InputError);
    EXPECT_THROW(compareImages(image, makeImage(4, 2, {"R", "G"})), InputError);
    EXPECT_THROW(compareImages(makeImage(4, 2, {"Y"}), image), InputError);
}

}  // namespace
}  // namespace helio
