// The Cornell box against an independent program, at several scales, with and without next-event estimation.
#include "tests/accuracy/path_reference.hpp"
#include "tests/accuracy/path_render.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace helio::test {
namespace {

constexpr std::uint32_t kSize = 32, kDeviceSamples = 65536;

PathTraceOptions options() {
    PathTraceOptions o;
    o.size = {kSize, kSize};
    o.sampler = SamplerKind::Independent;
    return o;
}

/** The sample under a node that scales it. */
Scene cornell(double scale = 1.0) {
    Scene scene = load("sample:cornell");
    if (scale == 1.0) return scene;
    Node parent;
    parent.scale = glm::vec3(float(scale));
    parent.children = scene.roots;
    scene.nodes.push_back(parent);
    scene.roots = {int(scene.nodes.size()) - 1};
    return scene;
}

/** Pixels that show nothing but one instance: they and their neighbours see it at their centres. */
bool showsOnly(const ReferenceImage& image, std::size_t i, int region) {
    const int x = int(i % kSize), y = int(i / kSize);
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, int(kSize) - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, int(kSize) - 1); ++u)
            if (image.instance[std::size_t(v) * kSize + std::size_t(u)] != region) return false;
    return true;
}

const ReferenceImage& reference() {
    // Noise differs: the ceiling, and most of all the short block's side away from the light, need more.
    static const ReferenceImage image = traceReference(
        cornell(), {kSize, kSize}, [](const ReferenceImage& seen, std::size_t i) -> std::uint32_t {
            const int region = seen.instance[i];
            if (!showsOnly(seen, i, region)) return 0;
            return region == 6 ? 65536 : region == 1 ? 16384 : 8192;
        });
    return image;
}

/** The instances that fill some pixels. */
std::vector<int> regions() {
    std::vector<int> found;
    for (int region = 0; region <= *std::ranges::max_element(reference().instance); ++region) {
        std::size_t pixels = 0;
        for (std::size_t i = 0; i < reference().instance.size(); ++i)
            pixels += showsOnly(reference(), i, region) ? 1 : 0;
        if (pixels >= 8) found.push_back(region);
    }
    return found;
}

/** Mean of a region in both, and of the difference's error. Channel 3 is the mean of R, G and B. */
struct Pair {
    Estimate device, host;
    double error() const { return std::hypot(device.error, host.error); }
    double z() const { return (device.mean - host.mean) / error(); }
};
Pair compare(const Traced& image, int region, int channel) {
    const auto wanted = [&](std::size_t i) { return showsOnly(reference(), i, region); };
    Traced same;
    same.mean = reference().mean;
    same.variance = reference().variance;
    return {estimate(image, channel, wanted), estimate(same, channel, wanted)};
}

TEST(PathCornell, FirstHitsAreTheReferences) {
    const Traced image = trace(cornell(), options(), 1);
    const ReferenceImage& truth = reference();
    int different = 0;
    for (std::size_t i = 0; i < truth.instance.size(); ++i) {
        const bool same =
            image.hits.instance[i] == truth.instance[i] && image.hits.triangle[i] == truth.triangle[i];
        different += same ? 0 : 1;
        if (same) {
            EXPECT_NEAR(image.hits.depth[i], truth.depth[i], 1e-5 * truth.depth[i]) << i;
        }
    }
    // A pixel centre may lie on an edge to within rounding.
    EXPECT_LE(different, 2);
}

TEST(PathCornell, RegionsAgreeWithTheReference) {
    const Traced image = trace(cornell(), options(), kDeviceSamples, 1024);
    // Floor, ceiling, back, left and right wall, both blocks.
    EXPECT_GE(regions().size(), 7u);
    for (int region : regions()) {
        Pair gray{};  // the channels' paths are the same: their errors add up
        for (int c = 0; c < 3; ++c) {
            const Pair pair = compare(image, region, c);
            fmt::print(
                "instance {} channel {}: device {:.6f} +- {:.6f}, host {:.6f} +- {:.6f}, z {:+.2f}, {} "
                "pixels\n",
                region, c, pair.device.mean, pair.device.error, pair.host.mean, pair.host.error, pair.z(),
                pair.device.pixels);
            EXPECT_LT(std::abs(pair.z()), 3.0) << "instance " << region << " channel " << c;
            gray.device.mean += pair.device.mean;
            gray.device.error += pair.device.error;
            gray.host.mean += pair.host.mean;
            gray.host.error += pair.host.error;
        }
        EXPECT_LT(gray.device.error, 0.002 * gray.host.mean) << "instance " << region;
        EXPECT_LT(gray.host.error, 0.002 * gray.host.mean) << "instance " << region;
    }
    EXPECT_EQ(image.rejected, 0u);
}

TEST(PathCornell, ScaleDoesNotMatter) {
    const Traced one = trace(cornell(), options(), 1024);
    for (double scale : {1e-6, 1e-3, 1e3, 1e6}) {
        const Traced scaled = trace(cornell(scale), options(), 1024);
        // The same random numbers: what differs is rounding, which sends few paths another way.
        for (int region : regions()) {
            const auto wanted = [&](std::size_t i) { return showsOnly(reference(), i, region); };
            const Estimate a = estimate(one, 1, wanted), b = estimate(scaled, 1, wanted);
            EXPECT_NEAR(b.mean / a.mean, 1.0, 5e-4) << "scale " << scale << " instance " << region;
        }
        EXPECT_EQ(scaled.rejected, 0u);
    }
}

TEST(PathCornell, NextEventEstimationDoesNotMatter) {
    PathTraceOptions without = options();
    without.nextEventEstimation = false;
    const Traced a = trace(cornell(), options(), 512), b = trace(cornell(), without, 8192, 512);
    const auto everywhere = [&](std::size_t i) { return a.mean[i].x < 5.0; };  // not the light itself
    for (int c = 0; c < 3; ++c) {
        const Estimate with = estimate(a, c, everywhere), only = estimate(b, c, everywhere);
        const double error = std::hypot(with.error, only.error);
        fmt::print("channel {}: with {:.6f}, without {:.6f}, z {:+.2f}, error {:.2f} %\n", c, with.mean,
                   only.mean, (with.mean - only.mean) / error, 100 * error / with.mean);
        EXPECT_LT(std::abs(with.mean - only.mean), 4 * error);
        EXPECT_LT(error, 0.01 * with.mean);
    }
}

}  // namespace
}  // namespace helio::test
