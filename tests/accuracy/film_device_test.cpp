// The film, the filters and the sampler on the device, against the host. Literals here are floats.
#include "engine/core/shared.hpp"
#include "passes/film/film.hpp"
#include "tests/support/device.hpp"
#include "tests/support/shader_harness.hpp"

#include <heliograph/error.hpp>
#include <heliograph/verify.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace helio {
namespace {

using namespace shared32;

std::vector<uint> counting(uint count, uint step = 1, uint first = 0) {
    std::vector<uint> result(count);
    for (uint i = 0; i < count; ++i) result[i] = first + i * step;
    return result;
}

TEST(SamplerOnDevice, GivesTheHostsBits) {
    const std::vector<uint> pixels = counting(20000, 2654435761u), samples = counting(20000, 7),
                            dimensions = counting(20000, 3);
    const std::vector<std::string> names = {"SAMPLER_SOBOL", "SAMPLER_INDEPENDENT", "SAMPLER_HALTON",
                                            "SAMPLER_STRATIFIED", "SAMPLER_SOBOL_BLUE"};
    for (uint kind = 0; kind < names.size(); ++kind) {
        const std::string& name = names[kind];
        const std::vector<glm::vec2> got = test::runOnDevice<glm::vec2>(
            "shaders/sampling/sampler.glsl",
            "sample2D(" + name + ", startSample(" + name + ", a, b, 9u, 5u), c % 20u)", pixels, samples,
            dimensions);
        for (std::size_t i = 0; i < got.size(); ++i) {
            const Vec2 wanted =
                sample2D(kind, startSample(kind, pixels[i], samples[i], 9, 5), dimensions[i] % 20u);
            ASSERT_EQ(got[i], wanted) << name << " pixel " << pixels[i] << " sample " << samples[i];
        }
    }
}

TEST(FilterOnDevice, MomentsMatchTheClosedForm) {
    const std::vector<float> u = test::floatsSpaced(0, 1 - 0x1p-24f, 1 << 18);
    const std::vector<double> variances = {1 / 12.0L, 1 / 6.0L, 0.25, 0.17265848L};
    for (uint kind = 0; kind < 4; ++kind) {
        const std::vector<float> x = test::runOnDevice<float>(
            "shaders/film/filter.glsl", "filterOffset1D(" + std::to_string(kind) + "u, a)", u);
        double first = 0, second = 0, worst = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            first += double(x[i]) / double(x.size());
            second += double(x[i]) * x[i] / double(x.size());
            worst = std::max(worst, std::abs(double(x[i]) - filterOffset1D(kind, u[i])));
        }
        EXPECT_NEAR(first, 0, 1e-5) << kind;
        EXPECT_NEAR(second, variances[kind], 2e-4 * variances[kind]) << kind;
        EXPECT_LT(worst, 1e-5) << kind;
    }
}

/// Adds `count` samples from `first` on to every pixel: values by a hash, so that the host knows them
/// exactly. The x channel is constant, y uniform, z a bright speck in 1 of 4096.
constexpr const char* fillFilm = R"(
#version 460
#extension GL_GOOGLE_include_directive : require
#define FILM_BINDING 0
#include "shaders/film/film.glsl"
#include "shaders/sampling/hash.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Parameters { uint width, height, first, count; };
void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= width || pixel.y >= height) return;
    FilmPixel stored = loadFilm(ivec2(pixel));
    FilmBatch batch = startFilmBatch(stored);
    for (uint i = first; i < first + count; ++i) {
        uvec3 bits = pcg3d(uvec3(pixel.x, pixel.y, i));
        addFilmSample(batch, i, vec3(0.1, 1000.0 + unitFloat(bits.x), (bits.y & 4095u) == 0u ? 300.0 : unitFloat(bits.z)));
    }
    storeFilm(ivec2(pixel), mergeFilmBatch(stored, batch));
}
)";

struct Parameters {
    uint width, height, first, count;
};

TEST(FilmOnDevice, MeanAndVarianceAreExactAfterAMillionSamples) {
    Device& device = test::device();
    const uint width = 5, height = 3, total = 1000000, batch = 100;
    Film film(device, width, height);
    const Kernel kernel = compileKernel("fillFilm", fillFilm);
    {
        Graph graph(device);
        declareFilmClear(graph, film, film.import(graph));
        Plan plan = graph.compile();
        plan.wait(plan.execute());
    }
    Parameters parameters{width, height, 0, batch};
    {
        Graph graph(device);
        graph.compute("fill", kernel).modifies({{"uFilm", film.import(graph)}}).record([&](Commands& c) {
            c.push(parameters).dispatchOver(width, height);
        });
        Plan plan = graph.compile();
        for (; parameters.first < total; parameters.first += batch) plan.execute();
    }
    Graph graph(device);
    const ResolvedFilm resolved = declareFilmResolve(graph, film, film.import(graph));
    const auto readMean = graph.readback<glm::vec4>(resolved.mean);
    const auto readVariance = graph.readback<glm::vec4>(resolved.variance);
    const auto readDifference = graph.readback<glm::vec4>(resolved.difference);
    Plan plan = graph.compile();
    const Execution done = plan.execute();
    const auto mean = readMean.wait(done), variance = readVariance.wait(done),
               difference = readDifference.wait(done);

    for (uint y = 0; y < height; ++y) {
        for (uint x = 0; x < width; ++x) {
            long double sum[3] = {}, alternating[3] = {}, deviation[3] = {};
            std::vector<Vec3> values(total);
            for (uint i = 0; i < total; ++i) {
                const uvec3 bits = pcg3d(uvec3(x, y, i));
                values[i] = Vec3(0.1f, 1000.0f + unitFloat(bits.x),
                                 (bits.y & 4095u) == 0u ? 300.0f : unitFloat(bits.z));
                for (int c = 0; c < 3; ++c) {
                    sum[c] += values[i][c];
                    alternating[c] += i % 2 == 0 ? values[i][c] : -values[i][c];
                }
            }
            const std::size_t pixel = y * width + x;
            for (int c = 0; c < 3; ++c) {
                const long double exact = sum[c] / total;
                for (const Vec3& v : values) deviation[c] += (v[c] - exact) * (v[c] - exact);
                const long double exactVariance = deviation[c] / total / (total - 1);
                // Half an ulp of rounding to float, and what the low words leave.
                EXPECT_NEAR(mean[pixel][c], double(exact), 6.1e-8L * double(exact)) << "channel " << c;
                EXPECT_NEAR(variance[pixel][c], double(exactVariance), 3e-7L * double(exactVariance)) << c;
                EXPECT_NEAR(difference[pixel][c], double(alternating[c] / total), 5e-9L * double(exact)) << c;
            }
            EXPECT_EQ(mean[pixel].w, float(total));
            EXPECT_EQ(variance[pixel].w, 0);
            EXPECT_EQ(difference[pixel].w, 1);
        }
    }
}

TEST(FilmOnDevice, RefusesSizesItCannotHold) {
    EXPECT_THROW(Film(test::device(), 0, 4), InputError);
    EXPECT_THROW(Film(test::device(), 4, kMaxFilmHeight + 1), InputError);
}

}  // namespace
}  // namespace helio
