#include "passes/renderer/raster_samples.hpp"

#include "engine/scene/photography.hpp"

#include <glm/glm.hpp>

namespace helio {
namespace {

/** Point k of Halton's sequence in bases 3 and 5, which the sets of positions in a pixel do not use. */
glm::dvec2 haltonPoint(std::size_t k) {
    const auto inverse = [](std::size_t base, std::size_t n) {
        double scale = 1, sum = 0;
        for (; n > 0; n /= base) sum += (scale /= double(base)) * double(n % base);
        return sum;
    };
    return {inverse(3, k + 1), inverse(5, k + 1)};
}

}  // namespace

RasterView sampleView(const RasterView& view, const std::optional<ThinLens>& lens, std::size_t k) {
    return lens ? lensView(view, *lens, lensPoint(*lens, haltonPoint(k))) : view;
}

bool notifySample(RenderJob& job, std::size_t done, std::size_t all) {
    const double fraction = double(done) / double(all);
    return job.notify({.stage = "render",
                       .fraction = fraction,
                       .samples = std::uint32_t(done),
                       .seconds = job.seconds(),
                       .secondsLeft = job.seconds() * (1 - fraction) / fraction}) ||
           done == all;
}

}  // namespace helio
