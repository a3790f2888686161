/** @file Row X4: mip levels against the 2:1 polyphase box in double, and their means against the base's. */
#include "passes/mip/mip_chain.hpp"
#include "tests/support/device.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/image.hpp>
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

namespace helio::test {
namespace {

constexpr std::uint32_t kFloatTexture = 1u << 5, kMipmapped = 1u << 6, kLinearTexture = 1u << 7,
                        kNormalTexture = 1u << 8;

struct Level {
    std::uint32_t width, height;
    std::vector<glm::dvec4> texels;
    glm::dvec4 mean() const {
        glm::dvec4 sum(0.0);
        for (const auto& t : texels) sum += t;
        return sum / double(texels.size());
    }
};

/** The mean of a level over the stretch of a coarser texel, by areas: another derivation than the kernel's
 * weights. */
Level halve(const Level& fine) {
    Level coarse{std::max(fine.width / 2, 1u), std::max(fine.height / 2, 1u), {}};
    const double stretchX = double(fine.width) / coarse.width, stretchY = double(fine.height) / coarse.height;
    const auto overlap = [](double a0, double a1, double b) {
        return std::max(0.0, std::min(a1, b + 1) - std::max(a0, b));
    };
    for (std::uint32_t y = 0; y < coarse.height; ++y)
        for (std::uint32_t x = 0; x < coarse.width; ++x) {
            glm::dvec4 sum(0.0);
            const double x0 = x * stretchX, y0 = y * stretchY;
            for (auto j = std::uint32_t(y0); j < std::min(fine.height, std::uint32_t(y0) + 4); ++j)
                for (auto i = std::uint32_t(x0); i < std::min(fine.width, std::uint32_t(x0) + 4); ++i)
                    sum += overlap(x0, x0 + stretchX, i) * overlap(y0, y0 + stretchY, j) *
                           fine.texels[j * fine.width + i];
            coarse.texels.push_back(sum / (stretchX * stretchY));
        }
    return coarse;
}

/** Textures as a packed scene holds them, and their base levels in linear light. */
struct Packed {
    std::vector<glm::uvec4> headers;
    std::vector<std::uint32_t> texels8;
    std::vector<glm::vec4> texelsFloat;
    std::vector<Level> bases;

    void add(std::uint32_t width, std::uint32_t height, bool floats, std::mt19937& random,
             bool linear = false, bool normals = false) {
        Level base{width, height, {}};
        const std::size_t offset = floats ? texelsFloat.size() : texels8.size();
        for (std::uint32_t i = 0; i < width * height; ++i) {
            if (floats) {
                texelsFloat.emplace_back(random() / 4294967296.0f * 10.0f, random() / 4294967296.0f, 1.0f,
                                         0.5f);
                base.texels.emplace_back(texelsFloat.back());
            } else {
                // Normals point outwards.
                const std::uint32_t word = std::uint32_t(random()) | (normals ? 0xc00000u : 0u);
                texels8.push_back(word);
                const auto channel = [&](int k) { return (word >> (8 * k) & 255u) / 255.0; };
                const auto color = [&](int k) { return linear ? channel(k) : srgbDecode(channel(k)); };
                base.texels.emplace_back(color(0), color(1), color(2), channel(3));
            }
        }
        if (normals)
            for (glm::dvec4& t : base.texels) {
                const glm::dvec3 n = glm::dvec3(t) * 2.0 - 1.0;
                t = glm::dvec4(0.5 * glm::normalize(n) + 0.5, t.w);
            }
        headers.emplace_back(std::uint32_t(offset), width, height,
                             kMipmapped | (floats ? kFloatTexture : 0u) | (linear ? kLinearTexture : 0u) |
                                 (normals ? kNormalTexture : 0u));
        bases.push_back(std::move(base));
    }
};

std::vector<glm::vec4> makeMips(const Packed& packed, MipChains& chains) {
    auto texels8 = packed.texels8;
    auto texelsFloat = packed.texelsFloat;
    texels8.resize(std::max<std::size_t>(texels8.size(), 4));
    texelsFloat.resize(std::max<std::size_t>(texelsFloat.size(), 1));
    DeviceBuffer headers = makeBuffer(device(), "textures", packed.headers);
    DeviceBuffer bytes = makeBuffer(device(), "texels8", texels8),
                 floats = makeBuffer(device(), "texelsFloat", texelsFloat);
    Graph graph(device());
    chains.declare(graph,
                   {{"uTextures", graph.import(headers)},
                    {"uTexels8", graph.import(bytes), Format::R32UI},
                    {"uTexelsFloat", graph.import(floats)}},
                   {{"HAS_LINEAR_TEXTURES", true}});
    const std::vector<Binding> bindings = chains.bindings(graph);
    const auto levels = graph.readback<glm::vec4>(Buffer{bindings[1].resource, bindings[1].graph});
    Plan plan = graph.compile();
    auto values = levels.wait(plan.execute());
    EXPECT_EQ(values.size(), std::max<std::uint64_t>(chains.layout().texels, 1));
    return values;
}

TEST(MipChain, NumberOfLevels) {
    EXPECT_EQ(mipLevelCount(1, 1), 1u);
    EXPECT_EQ(mipLevelCount(2, 1), 2u);
    EXPECT_EQ(mipLevelCount(3, 3), 2u);
    EXPECT_EQ(mipLevelCount(256, 256), 9u);
    EXPECT_EQ(mipLevelCount(255, 300), 9u);
    EXPECT_EQ(mipLevelCount(4096, 1), 13u);
}

TEST(MipChain, EveryTexelAndMeanOfEverySize) {
    std::mt19937 random(1);
    Packed packed;
    // The first two are read by fours: they begin at multiples of 4 texels.
    const std::array<std::uint32_t, 2> sizes[] = {
        {512, 256}, {516, 132}, {64, 64},   {1, 37}, {37, 1}, {17, 33},   {2, 5},     {3, 3},
        {1, 1},     {128, 7},   {255, 101}, {6, 10}, {1, 64}, {512, 256}, {300, 301}, {515, 258}};
    for (const auto& [width, height] : sizes) {
        packed.add(width, height, false, random);
        packed.add(width, height, true, random);
        packed.add(width, height, false, random, true);
        packed.add(width, height, false, random, true, true);
        packed.add(width, height, true, random, false, true);
    }
    MipChains chains(device(), packed.headers);
    const auto values = makeMips(packed, chains);
    const MipLayout& layout = chains.layout();
    double worstTexel = 0, worstMean = 0;
    for (std::size_t t = 0; t < packed.bases.size(); ++t) {
        Level level = packed.bases[t];
        const glm::dvec4 baseMean = level.mean();
        const std::uint32_t count = mipLevelCount(level.width, level.height);
        EXPECT_EQ(layout.table[t].y, count);
        for (std::uint32_t k = 1; k < count; ++k) {
            level = halve(level);
            const glm::uvec4 place = layout.table[layout.table[t].x + k - 1];
            ASSERT_EQ(place.y, level.width);
            ASSERT_EQ(place.z, level.height);
            Level made{level.width, level.height, {}};
            for (std::size_t i = 0; i < level.texels.size(); ++i) {
                made.texels.emplace_back(values[place.x + i]);
                for (int c = 0; c < 4; ++c) {
                    // A vector's error is relative to its length.
                    const bool vector = (packed.headers[t].w & kNormalTexture) != 0 && c < 3;
                    const double scale = std::max(vector ? 1.0 : 1e-3, level.texels[i][c]);
                    worstTexel =
                        std::max(worstTexel, std::abs(made.texels[i][c] - level.texels[i][c]) / scale / k);
                }
            }
            for (int c = 0; c < 4; ++c)
                worstMean = std::max(worstMean, std::abs(made.mean()[c] / baseMean[c] - 1.0) / k);
            EXPECT_EQ(k + 1 == count, level.texels.size() == 1);
        }
    }
    std::printf("             worst relative error over levels: texel %.2e, mean %.2e\n", worstTexel,
                worstMean);
    EXPECT_LT(worstTexel, 4e-7);
    EXPECT_LT(worstMean, 2e-7);
}

/** `halve` along one axis alone. */
Level halveAlong(const Level& fine, bool x) {
    Level strip{x ? fine.width : fine.height, x ? fine.height : fine.width, {}};
    const auto at = [&](const Level& level, std::uint32_t i, std::uint32_t j) {
        return level.texels[std::size_t(x ? j : i) * level.width + (x ? i : j)];
    };
    const std::uint32_t n = strip.width, half = n / 2;
    Level result{x ? half : fine.width, x ? fine.height : half, {}};
    result.texels.resize(std::size_t(result.width) * result.height);
    for (std::uint32_t j = 0; j < strip.height; ++j) {
        Level row{n, 1, {}};
        for (std::uint32_t i = 0; i < n; ++i) row.texels.push_back(at(fine, i, j));
        const Level halved = halve(row);
        for (std::uint32_t i = 0; i < half; ++i)
            result.texels[std::size_t(x ? j : i) * result.width + (x ? i : j)] = halved.texels[i];
    }
    return result;
}

TEST(MipChain, RipmapsHalveEveryAxisByItself) {
    std::mt19937 random(3);
    Packed packed;
    const std::array<std::uint32_t, 2> sizes[] = {{64, 32}, {37, 1}, {1, 6}, {17, 33}, {1, 1}, {255, 101}};
    for (const auto& [width, height] : sizes) {
        packed.add(width, height, false, random);
        packed.add(width, height, true, random);
    }
    MipChains chains(device(), packed.headers, true);
    const auto values = makeMips(packed, chains);
    const MipLayout& layout = chains.layout();
    double worst = 0;
    std::size_t compared = 0;
    for (std::size_t t = 0; t < packed.bases.size(); ++t) {
        Level wide = packed.bases[t];
        const std::uint32_t across = layout.table[t].w;
        if (wide.texels.size() == 1) {
            EXPECT_EQ(across, 0u);
            continue;
        }
        for (std::uint32_t i = 0; i < across; ++i) {
            if (i > 0) wide = halveAlong(wide, true);
            Level level = wide;
            for (std::uint32_t j = 0; level.height > 0; ++j) {
                if (i + j > 0) {
                    const glm::uvec4 place = layout.table[layout.table[t].z + j * across + i];
                    ASSERT_EQ(place.y, level.width);
                    ASSERT_EQ(place.z, level.height);
                    for (std::size_t k = 0; k < level.texels.size(); ++k, ++compared)
                        for (int c = 0; c < 4; ++c)
                            worst = std::max(worst, std::abs(values[place.x + k][c] - level.texels[k][c]) /
                                                        std::max(1e-3, level.texels[k][c]) / (i + j));
                    // A mip level is one of them.
                    if (i == j) {
                        EXPECT_EQ(layout.table[layout.table[t].x + i - 1], place);
                    }
                }
                if (level.height == 1) break;
                level = halveAlong(level, false);
            }
        }
    }
    std::printf("             %zu texels, worst relative error over halvings %.2e\n", compared, worst);
    EXPECT_LT(worst, 4e-7);
    EXPECT_GT(compared, 50000u);
}

TEST(MipChain, OnlyTexturesThatWantLevelsGetThemAndSharedTexelsShareThem) {
    const std::vector<glm::uvec4> headers = {{0, 8, 8, kMipmapped},
                                             {0, 8, 8, kMipmapped | 1u},
                                             {64, 8, 8, 0},
                                             {0, 4, 4, kMipmapped | kFloatTexture}};
    const MipLayout layout(headers);
    EXPECT_EQ(layout.table[1], layout.table[0]);
    EXPECT_EQ(layout.table[2].y, 1u);
    EXPECT_NE(layout.table[3].x, layout.table[0].x);
    EXPECT_EQ(layout.texels, 16u + 4 + 1 + 4 + 1);
    EXPECT_FALSE(MipChains(device(), std::vector<glm::uvec4>{{0, 8, 8, 0}}).needed());
    EXPECT_FALSE(MipChains(device(), {}).needed());
}

TEST(MipChain, MoreTexelsThanOneDispatchReaches) {
    // Level 1 has 2^21 + 2^10 texels: two dispatches.
    std::mt19937 random(2);
    Packed packed;
    packed.add(2048, 4098, false, random);
    MipChains chains(device(), packed.headers);
    const auto values = makeMips(packed, chains);
    const glm::dvec4 mean = packed.bases[0].mean();
    const glm::uvec4 last = chains.layout().table[chains.layout().table[0].x + mipLevelCount(2048, 4098) - 2];
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(values[last.x][c] / mean[c], 1.0, 2e-7 * 12);
}

}  // namespace
}  // namespace helio::test
