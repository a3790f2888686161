#include "passes/pathtrace/caustic_guide.hpp"

#include <heliograph_kernels/pathtrace.hpp>

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

namespace helio {
namespace {

/** Photons: a row for every 32 * 512 of a picture's paths, between both. */
constexpr std::uint32_t kPhotonColumns = 512, kLeastPhotonRows = 32, kMostPhotonRows = 512;
/** Of directions that are drawn from a table, at most. */
constexpr float kGuideShare = 0.6f;

std::uint32_t photonRows(const PathTraceOptions& options) {
    const double paths = double(options.size[0]) * options.size[1] * options.samples;
    return std::uint32_t(
        std::clamp(paths / 32 / kPhotonColumns, double(kLeastPhotonRows), double(kMostPhotonRows)));
}

/** Those of the paths, for what photons go by. */
PathTraceOptions photonOptions(const PathTraceOptions& paths) {
    PathTraceOptions options = paths;
    options.size = {kPhotonColumns, photonRows(paths)};
    options.scheduler = Scheduler::Megakernel;
    options.kernel = &shaders::photons;
    options.photons = true;
    options.sampler = SamplerKind::Sobol;
    options.filter = PixelFilter::Box;
    options.samples = 1;
    options.adaptive = false;
    options.bounces = -1;
    options.cameraPoses = {};
    options.guide = nullptr;
    options.seed ^= 0x9e3779b9u;                         // no pixel has the photons' numbers
    options.turnBudget = PathTraceOptions{}.turnBudget;  // tables go by it
    return options;
}

}  // namespace

struct CausticGuide::Impl {
    Impl(Device& device, DeviceScene& scene, const PathTraceOptions& paths)
        : device_(device),
          options_(photonOptions(paths)),
          film_(device, options_.size[0], options_.size[1]),
          size_(scene.info().photonTargets.extent),
          tracer_(device, scene, Camera{}, glm::dmat4(1.0), options_, film_) {
        tracer_.advance(0);
        Graph graph(device_);
        found_ = graph.readback<glm::vec4>(tracer_.importState(graph));
        reading_ = graph.compile({.executionsInFlight = 1});
    }

    void trace() {
        const bool done = tracer_.advance(1);
        assert(done);
        (void)done;
        const std::vector<glm::vec4> texels = found_.wait(reading_.execute());
        const std::size_t row = std::size_t(options_.size[0]) * 4;
        std::vector<PhotonRecord> records;
        for (std::size_t y = 0; y < options_.size[1]; ++y)
            for (std::size_t x = 0; x < options_.size[0]; ++x) {
                const glm::vec4* at = texels.data() + y * 2 * row + x * 4;
                if (at[0].w > 0.0f)
                    records.push_back({at[0], at[0].w, at[1], at[1].w, at[2], at[2].w, at[3].x});
            }
        tables_ = guideTables(records, kGuideShare);
        tables_.gain = causticVariance(records, 0.5 * double(size_));
        if (tables_.empty()) return;
        cells_.emplace(makeBuffer(device_, "guide.cells", tables_.cells));
        texels_.emplace(makeBuffer(device_, "guide.tables", tables_.texels));
        tables_.cells = {};
        tables_.texels = {};
    }

    Device& device_;
    PathTraceOptions options_;
    Film film_;
    float size_;  ///< PhotonTargets::extent
    PathTracer tracer_;
    Readback<glm::vec4> found_;
    Plan reading_;
    GuideTables tables_;
    std::optional<DeviceBuffer> cells_, texels_;
};

bool CausticGuide::possible(const DeviceScene& scene, const PathTraceOptions& options) {
    return !scene.info().photonTargets.slots.empty() && options.nextEventEstimation && !options.whitted &&
           !options.hemisphere && !options.radiosity && options.normalMapping == NormalMapping::Folded &&
           options.maxDepth >= 2;
}

CausticGuide::CausticGuide(Device& device, DeviceScene& scene, const PathTraceOptions& options)
    : impl_(std::make_unique<Impl>(device, scene, options)) {}
CausticGuide::~CausticGuide() = default;
CausticGuide::CausticGuide(CausticGuide&&) noexcept = default;
CausticGuide& CausticGuide::operator=(CausticGuide&&) noexcept = default;

void CausticGuide::trace() {
    impl_->trace();
}

std::uint64_t CausticGuide::photons() const {
    return std::uint64_t(impl_->options_.size[0]) * impl_->options_.size[1];
}

const GuideTables& CausticGuide::found() const {
    return impl_->tables_;
}

std::uint64_t CausticGuide::bytes() const {
    return (impl_->cells_ ? impl_->cells_->bytes() : 0) + (impl_->texels_ ? impl_->texels_->bytes() : 0);
}

std::vector<Binding> CausticGuide::bindings(Graph& graph) const {
    assert(impl_->cells_ && "no tables");
    return {{"uGuideCells", graph.import(*impl_->cells_)}, {"uGuideTables", graph.import(*impl_->texels_)}};
}

SpecConstants CausticGuide::constants() const {
    const GuideTables& t = impl_->tables_;
    return {{"GUIDE_X", t.size.x},          {"GUIDE_Y", t.size.y},          {"GUIDE_Z", t.size.z},
            {"GUIDE_ORIGIN_X", t.origin.x}, {"GUIDE_ORIGIN_Y", t.origin.y}, {"GUIDE_ORIGIN_Z", t.origin.z},
            {"GUIDE_SCALE", t.scale}};
}

std::vector<PassTiming> CausticGuide::timings() const {
    return impl_->tracer_.timings();
}

}  // namespace helio
