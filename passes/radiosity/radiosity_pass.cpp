#include "passes/radiosity/radiosity_pass.hpp"

#include "engine/verify/radiosity.hpp"

#include <heliograph_kernels/radiosity.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace helio {
namespace {

/** Pairs of patches in a dispatch: a fraction of a second. */
constexpr std::uint32_t kPairsAtOnce = 1u << 17;
/** Unknowns up to which the system is also solved by elimination, which takes their cube. */
constexpr std::size_t kMostDense = 1024;
constexpr int kMostIterations = 5000;
/** Form factors as small as rounding leaves between patches of one plane: they light nothing of their own. */
constexpr float kNoise = 1e-6f;

}  // namespace

RadiosityPass::RadiosityPass(Device& device, DeviceScene& scene, PatchList list)
    : device_(device),
      list_(std::move(list)),
      environment_(scene.info().environment),
      rowsAtOnce_(std::max<std::uint32_t>(1, kPairsAtOnce / std::max<std::size_t>(1, list_.patches.size()))),
      places_(makeBuffer(device, "radiosity.places",
                         list_.places.empty() ? std::vector<glm::uvec4>(1) : list_.places)),
      slots_(makeBuffer(device, "radiosity.slots",
                        list_.slots.empty() ? std::vector<glm::uvec4>(1) : list_.slots)),
      radianceBuffer_(makeBuffer(device, "radiosity.radiance",
                                 std::vector<glm::vec4>(std::max<std::size_t>(1, list_.patches.size() * 6)))),
      factorBuffer_(
          device, "radiosity.factors",
          std::max<std::uint64_t>(1, std::uint64_t(rowsAtOnce_) * list_.patches.size()) * 6 * sizeof(float)),
      radiance_(list_.patches.size() * 2, glm::dvec3(0.0)),
      pointRadiance_(list_.patches.size() * 6, glm::dvec3(0.0)) {
    if (list_.patches.empty()) return;
    const PackedScene& info = scene.info();
    assert(info.nodeCount > 0);
    Graph graph(device);
    SpecConstants spec = scene.constants({"TRIANGLE_COUNT"});
    spec["STACK_SIZE"] = std::int32_t(info.treeDepth + 1);
    const bool bvh = info.accelerator == AcceleratorKind::Bvh;
    graph
        .compute("radiosity.factors",
                 bvh ? shaders::radiosityFactors
                     : compileVariant(shaders::radiosityFactors, acceleratorVariant(info.accelerator)),
                 {.spec = spec})
        .reads(scene.bindings(graph, {"uTriangles", "uNodes"}))
        .reads({{"uPatches", graph.import(places_)}})
        .writes({{"uFactors", graph.import(factorBuffer_)}})
        .record([this](Commands& commands) {
            commands.push(parameters_)
                .dispatchInvocations(std::uint64_t(parameters_.rows) * parameters_.count);
        });
    plan_ = graph.compile();
    runRows(0, 1);
    timings_.clear();
}

void RadiosityPass::runRows(std::uint32_t first, std::uint32_t rows) {
    parameters_ = {std::uint32_t(list_.patches.size()), first, rows};
    const Execution execution = plan_.execute();
    plan_.wait(execution);
    for (const PassTiming& timing : plan_.timings(execution)) {
        if (timings_.empty())
            timings_.push_back(timing);
        else
            timings_[0].milliseconds += timing.milliseconds;
    }
}

bool RadiosityPass::formFactors(const std::function<bool(double)>& goOn) {
    const std::size_t n = list_.patches.size();
    factors_.resize(n * n * 6);
    for (std::uint32_t row = 0; row < n; row += rowsAtOnce_) {
        if (!goOn(double(row) / double(n))) return false;
        const std::uint32_t rows = std::min<std::uint32_t>(rowsAtOnce_, std::uint32_t(n) - row);
        runRows(row, rows);
        factorBuffer_.download(&factors_[row * n * 6], std::uint64_t(rows) * n * 6 * sizeof(float));
    }
    return true;
}

std::vector<std::size_t> RadiosityPass::litSides() const {
    // Light spreads from what emits or sees the environment to whatever sees what is lit.
    const std::size_t n = list_.patches.size();
    std::vector<bool> lit(2 * n);
    std::vector<std::size_t> sides;
    const auto add = [&](std::size_t side) {
        if (lit[side]) return;
        lit[side] = true;
        sides.push_back(side);
    };
    for (std::size_t side = 0; side < 2 * n; ++side) {
        bool sky = false;
        for (std::size_t point = 0; point < 3; ++point) sky = sky || skyShare(side, point) > 1e-4;
        if (list_.patches[side / 2].emission[side % 2] != glm::dvec3(0.0) ||
            (sky && environment_ != glm::dvec3(0.0)))
            add(side);
    }
    for (std::size_t next = 0; next < sides.size(); ++next)
        for (std::size_t side = 0; side < 2 * n; ++side) {
            if (lit[side]) continue;
            for (std::size_t point = 0; point < 3; ++point) {
                const float factor = factors_[(side / 2 * n + sides[next] / 2) * 6 + point * 2 + side % 2];
                if (std::abs(factor) > kNoise && (factor < 0) == (sides[next] % 2 == 1)) add(side);
            }
        }
    std::ranges::sort(sides);
    return sides;
}

double RadiosityPass::skyShare(std::size_t side, std::size_t point) const {
    const std::size_t n = list_.patches.size();
    double covered = 0;
    for (std::size_t from = 0; from < n; ++from)
        covered += std::abs(double(factors_[(side / 2 * n + from) * 6 + point * 2 + side % 2]));
    return std::max(0.0, 1 - covered);
}

bool RadiosityPass::solveChannel(int channel, const std::vector<std::size_t>& lit,
                                 const std::function<bool(double)>& goOn, RenderResult::Radiosity& report) {
    const std::size_t n = list_.patches.size(), unknowns = lit.size();
    std::vector<double> matrix(unknowns * unknowns), emission(unknowns), reflectance(unknowns);
    const auto factor = [&](std::size_t to, std::size_t from, std::size_t point) {
        const double value = double(factors_[(to / 2 * n + from / 2) * 6 + point * 2 + to % 2]);
        return (value < 0) == (from % 2 == 1) ? std::abs(value) : 0.0;
    };
    const auto emitted = [&](std::size_t side) {
        return list_.patches[side / 2].emission[side % 2][channel];
    };
    double largest = 0;
    for (std::size_t row = 0; row < unknowns; ++row) {
        const std::size_t to = lit[row];
        reflectance[row] = list_.patches[to / 2].reflectance[channel];
        double sky = 0;
        if (environment_[channel] > 0)
            for (std::size_t point = 0; point < 3; ++point) sky += skyShare(to, point) / 3;
        emission[row] = emitted(to) + reflectance[row] * sky * environment_[channel];
        largest = std::max(largest, emission[row]);
        for (std::size_t column = 0; column < unknowns; ++column)
            matrix[row * unknowns + column] =
                (factor(to, lit[column], 0) + factor(to, lit[column], 1) + factor(to, lit[column], 2)) / 3;
    }
    const verify::Radiosity system(std::move(matrix), std::move(emission), std::move(reflectance));
    int iterations = 0;
    bool isCancelled = false;
    const std::vector<double> solution = system.iterate(1e-9 * largest, &iterations, kMostIterations, [&] {
        isCancelled = isCancelled || !goOn(1);
        return !isCancelled;
    });
    if (isCancelled) return false;
    report.iterations = std::max(report.iterations, std::uint32_t(iterations));
    report.converged = report.converged && iterations < kMostIterations;
    if (unknowns <= kMostDense) {
        const std::vector<double> dense = system.solve();
        double brightest = 0, difference = 0;
        for (std::size_t i = 0; i < unknowns; ++i) {
            brightest = std::max(brightest, std::abs(dense[i]));
            difference = std::max(difference, std::abs(dense[i] - solution[i]));
        }
        if (brightest > 0)
            report.denseDifference = std::max(report.denseDifference.value_or(0), difference / brightest);
    }
    for (std::size_t i = 0; i < unknowns; ++i) radiance_[lit[i]][channel] = solution[i];
    // Once more at the three points of each patch: light is linear over a patch then.
    for (std::size_t row = 0; row < unknowns; ++row)
        for (std::size_t point = 0; point < 3; ++point) {
            double sum = environment_[channel] > 0 ? skyShare(lit[row], point) * environment_[channel] : 0.0;
            for (std::size_t column = 0; column < unknowns; ++column)
                sum += factor(lit[row], lit[column], point) * solution[column];
            pointRadiance_[lit[row] * 3 + point][channel] =
                emitted(lit[row]) + list_.patches[lit[row] / 2].reflectance[channel] * sum;
        }
    return true;
}

void RadiosityPass::uploadRadiance() {
    std::vector<glm::vec4> texels(std::max<std::size_t>(1, pointRadiance_.size()));
    for (std::size_t side = 0; side * 3 < pointRadiance_.size(); ++side) {
        const glm::dvec3* points = &pointRadiance_[side * 3];
        // A point is halfway from the middle, whose value is the mean, to its corner.
        const glm::dvec3 middle = (points[0] + points[1] + points[2]) / 3.0;
        for (std::size_t corner = 0; corner < 3; ++corner)
            texels[side * 3 + corner] = glm::vec4(2.0 * points[corner] - middle, 0.0);
    }
    radianceBuffer_.upload(texels.data(), texels.size() * sizeof(glm::vec4));
}

bool RadiosityPass::solve(const std::function<bool(double)>& goOn, RenderResult::Radiosity& report) {
    report = {};
    report.patches = std::uint32_t(list_.patches.size());
    if (list_.patches.empty()) return true;
    if (!formFactors(goOn)) return false;
    const std::vector<std::size_t> lit = litSides();
    report.unknowns = std::uint32_t(lit.size());
    for (int channel = 0; channel < 3 && !lit.empty(); ++channel) {
        if (!goOn(1) || !solveChannel(channel, lit, goOn, report)) return false;
    }
    uploadRadiance();
    factors_ = {};
    return true;
}

std::vector<Binding> RadiosityPass::bindings(Graph& graph) {
    return {{"uPatchSlots", graph.import(slots_)}, {"uPatchRadiance", graph.import(radianceBuffer_)}};
}

}  // namespace helio
