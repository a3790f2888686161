#pragma once
/** @file Runs the rasterizer on lists of triangles, and compares what it leaves with the oracle. */
#include "passes/raster/raster_pipeline.hpp"
#include "tests/accuracy/raster_oracle.hpp"
#include "tests/support/device.hpp"

#include <heliograph/error.hpp>
#include <heliograph/graph.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace helio::test {

struct RasterResult {
    std::vector<std::uint64_t> keys;
    RasterCounters counters;
};

/** A plan for a fixed size and at most `capacity` triangles, run again and again. */
class RasterRunner {
public:
    RasterRunner(std::uint32_t width, std::uint32_t height, std::uint32_t capacity,
                 const RasterOptions& options = {.direct = true}, const CompileOptions& compile = {},
                 bool orthographic = false)
        : view_(std::make_shared<RasterView>()),
          capacity_(capacity),
          buffer_(device(), "triangles", std::uint64_t(capacity) * sizeof(RasterTriangle)) {
        view_->width = width;
        view_->height = height;
        view_->orthographic = orthographic;
        Graph graph(device());
        const RasterOutput output =
            RasterPipeline(device(), options).declare(graph, {graph.import(buffer_), capacity}, view_);
        keys_ = graph.readback<std::uint64_t>(output.visibility);
        counters_ = graph.readback<RasterCounters>(output.counters);
        plan_ = graph.compile(compile);
    }

    RasterResult run(const RasterView& view, std::vector<RasterTriangle> triangles) {
        EXPECT_LE(triangles.size(), capacity_);
        EXPECT_EQ(view.width, view_->width);
        EXPECT_EQ(view.height, view_->height);
        *view_ = view;
        triangles.resize(capacity_);  // the rest are points at the origin, of no area
        buffer_.upload(triangles.data(), triangles.size() * sizeof(RasterTriangle));
        const Execution done = plan_.execute();
        return {keys_.wait(done), counters_.wait(done).at(0)};
    }

private:
    std::shared_ptr<RasterView> view_;
    std::uint32_t capacity_;
    DeviceBuffer buffer_;
    Plan plan_;
    Readback<std::uint64_t> keys_;
    Readback<RasterCounters> counters_;
};

/** A view whose pixel coordinates are x/-z and -y/-z: at distance 1 a world unit is a pixel. */
inline RasterView pixelView(std::uint32_t width, std::uint32_t height) {
    RasterView view;
    view.rowX = {1, 0, 0};
    view.rowY = {0, -1, 0};
    view.rowW = {0, 0, -1};
    view.depthOffset = 1e-3;
    view.width = width;
    view.height = height;
    return view;
}

/** The world point that pixelView shows at pixel coordinates (x, y), at a distance. */
inline glm::vec3 atPixel(double x, double y, double distance) {
    return glm::vec3(glm::dvec3(x * distance, -y * distance, -distance));
}

struct Mismatch {
    std::uint64_t pixels = 0;     ///< compared
    std::uint64_t covered = 0;    ///< of these, covered in the oracle
    std::uint64_t different = 0;  ///< another id or none
    std::uint64_t close = 0;      ///< another id, but the two depths differ by less than `relative`
    double depthError = 0;        ///< largest relative error of depth where ids agree
    std::string first;            ///< where the first different pixel is

    void add(const Mismatch& other) {
        pixels += other.pixels;
        covered += other.covered;
        different += other.different;
        close += other.close;
        depthError = std::max(depthError, other.depthError);
        if (first.empty()) first = other.first;
    }
};

/** Ids must agree; where two depths differ by less than `relative`, either of the two is right. */
inline Mismatch compare(const RasterResult& result, const RasterView& view,
                        const std::vector<RasterTriangle>& triangles, double relative = 0.0) {
    RasterOracle oracle(view);
    for (const RasterTriangle& triangle : triangles) oracle.draw(triangle);
    Mismatch mismatch;
    const auto depthOf = [](std::uint64_t key) { return std::bit_cast<float>(std::uint32_t(key >> 32)); };
    for (std::size_t i = 0; i < result.keys.size(); ++i) {
        const OraclePixel& expected = oracle.pixels()[i];
        const std::uint64_t key = result.keys[i];
        ++mismatch.pixels;
        mismatch.covered += expected.key != 0;
        const float depth = depthOf(key), right = depthOf(expected.key);
        if (visibleTriangle(key) == visibleTriangle(expected.key)) {
            if (key != 0)
                mismatch.depthError = std::max(mismatch.depthError, std::abs(double(depth) / right - 1.0));
        } else if (key != 0 && expected.hits > 1 && std::abs(double(depth) / right - 1.0) <= relative &&
                   std::abs(double(expected.runnerUp) / right - 1.0) <= relative) {
            ++mismatch.close;
        } else {
            if (mismatch.first.empty())
                mismatch.first = "pixel " + std::to_string(i % view.width) + ", " +
                                 std::to_string(i / view.width) + ": device " +
                                 std::to_string(visibleTriangle(key)) + ", oracle " +
                                 std::to_string(visibleTriangle(expected.key));
            ++mismatch.different;
        }
    }
    return mismatch;
}

/** Uniform numbers, the same on every platform. */
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * (double(engine_()) / 4294967296.0);
    }
    std::uint32_t below(std::uint32_t n) { return std::uint32_t(std::uint64_t(engine_()) * n >> 32); }

private:
    std::mt19937 engine_;
};

/** How many times over a test's images are made: HELIOGRAPH_TEST_REPEAT=10 reaches 10^8 tested pixels. */
inline int repeats() {
    const char* text = std::getenv("HELIOGRAPH_TEST_REPEAT");
    return text ? std::max(1, std::atoi(text)) : 1;
}

}  // namespace helio::test
