#include <heliograph/error.hpp>
#include <heliograph/fourier.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/fourier.hpp>

#include <algorithm>
#include <bit>
#include <string>

namespace helio {
namespace {

/** A dispatch has at most 65,535 workgroups of 64. */
constexpr std::uint32_t kMost = 1u << 21;

void check(std::array<std::uint32_t, 2> size) {
    if (std::has_single_bit(size[0]) && std::has_single_bit(size[1]) &&
        std::uint64_t(size[0]) * size[1] <= (1u << 24))
        return;
    throw InputError("", "Fourier transform", fmt::format("{}x{} values", size[0], size[1]),
                     "give powers of two, 2^24 values at most");
}

void checkCount(std::size_t count, std::array<std::uint32_t, 2> size) {
    check(size);
    if (count != std::size_t(size[0]) * size[1])
        throw InputError("", "Fourier transform", fmt::format("{} values for {}x{}", count, size[0], size[1]),
                         "give as many as the size says");
}

struct StagePush {
    std::uint32_t first, pairs, halfBits, spanBits, stride, lineStride;
    float sign, scale;
};

/** All stages along one axis. */
Buffer alongAxis(Graph& graph, Buffer values, std::array<std::uint32_t, 2> size, int axis, bool inverse) {
    const std::uint32_t length = size[std::size_t(axis)], count = size[0] * size[1];
    const std::uint32_t bits = std::uint32_t(std::bit_width(length)) - 1;
    for (std::uint32_t stage = 0; stage < bits; ++stage) {
        const Buffer next = graph.buffer("fourier.values", {std::uint64_t(count) * 8});
        StagePush push{0,
                       count / 2,
                       bits - 1,
                       stage,
                       axis == 0 ? 1 : size[0],
                       axis == 0 ? size[0] : 1,
                       inverse ? 1.0f : -1.0f,
                       inverse ? 0.5f : 1.0f};
        graph.compute(fmt::format("fourier.{}{}", axis == 0 ? "row" : "column", stage), shaders::fourierStage)
            .reads({{"uFrom", values}})
            .overwrites({{"uTo", next}})
            .record([push](Commands& c) mutable {
                for (push.first = 0; push.first < push.pairs; push.first += kMost)
                    c.push(push).dispatchInvocations(std::min(kMost, push.pairs - push.first));
            });
        values = next;
    }
    return values;
}

DeviceBuffer upload(Device& device, std::string name, std::span<const std::complex<float>> values) {
    return makeBuffer(device, std::move(name), values);
}

}  // namespace

Buffer declareFourier(Graph& graph, Buffer values, std::array<std::uint32_t, 2> size, bool inverse) {
    check(size);
    return alongAxis(graph, alongAxis(graph, values, size, 0, inverse), size, 1, inverse);
}

Buffer declareProduct(Graph& graph, Buffer a, Buffer b, std::uint64_t count) {
    const Buffer product = graph.buffer("fourier.product", {count * 8});
    graph.compute("fourier.product", shaders::fourierProduct)
        .reads({{"uA", a}, {"uB", b}})
        .overwrites({{"uTo", product}})
        .record([count](Commands& c) {
            for (std::uint64_t first = 0; first < count; first += kMost)
                c.push(std::array{std::uint32_t(first), std::uint32_t(count)})
                    .dispatchInvocations(std::min<std::uint64_t>(kMost, count - first));
        });
    return product;
}

std::vector<std::complex<float>> fourierTransform(Device& device, std::span<const std::complex<float>> values,
                                                  std::array<std::uint32_t, 2> size, bool inverse) {
    checkCount(values.size(), size);
    if (values.size() == 1) return {values.begin(), values.end()};
    DeviceBuffer input = upload(device, "fourier.input", values);
    Graph graph(device);
    const auto result =
        graph.readback<std::complex<float>>(declareFourier(graph, graph.import(input), size, inverse));
    Plan plan = graph.compile({.executionsInFlight = 1});
    return result.wait(plan.execute());
}

std::vector<std::complex<float>> convolve(Device& device, std::span<const std::complex<float>> a,
                                          std::span<const std::complex<float>> b,
                                          std::array<std::uint32_t, 2> size) {
    checkCount(a.size(), size);
    checkCount(b.size(), size);
    DeviceBuffer first = upload(device, "fourier.first", a), second = upload(device, "fourier.second", b);
    Graph graph(device);
    const Buffer product = declareProduct(graph, declareFourier(graph, graph.import(first), size),
                                          declareFourier(graph, graph.import(second), size), a.size());
    const auto result = graph.readback<std::complex<float>>(declareFourier(graph, product, size, true));
    Plan plan = graph.compile({.executionsInFlight = 1});
    return result.wait(plan.execute());
}

}  // namespace helio
