#include "bench_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace helio::cli {
namespace {

constexpr double kSteady = 0.1;
/** relMSE by rounding, of levels and distances alike. */
constexpr double kRounding = 1e-9;

const char* said(bool holds) {
    return holds ? "holds" : "does not hold";
}

Verdict ofOrder(const BenchCase& measured, const SeriesFit& fit) {
    const bool holds = fit.order >= measured.order->low && fit.order <= measured.order->high;
    return {fmt::format("{}/{}: relMSE falls as samples^{:.3f} +- {:.3f}, by theory {} to {}: {}",
                        measured.scene, measured.method, fit.order, fit.orderError, measured.order->low,
                        measured.order->high, said(holds)),
            !holds};
}

/** Times of a machine that does other things too decide nothing. */
Verdict ofTime(const BenchCase& measured, const SeriesFit& fit) {
    const std::string what = fmt::format("{}/{}: RMSE x sqrt(CPU time)", measured.scene, measured.method);
    if (fit.steadyPoints < 2)
        return {what + ": fewer than two points of 0.02 s and 8 times the first, which say nothing"};
    return {fmt::format(
        "{} is constant within {:.1f} % over {} points of 0.02 s and 8 times the first, {:.0f} % asked: {}",
        what, 100 * fit.unsteadiness, fit.steadyPoints, 100 * kSteady, said(fit.unsteadiness <= kSteady))};
}

Verdict ofSizes(const BenchCase& measured, const std::vector<SeriesPoint>& series) {
    double worst = 0;
    for (const SeriesPoint& point : series) worst = std::max(worst, point.relmse);
    return {fmt::format("{} {}/{}: relMSE against double precision at most {:.1e}, {:.0e} asked: {}",
                        measured.group, measured.scene, measured.method, worst, kRounding,
                        said(worst <= kRounding)),
            worst > kRounding};
}

}  // namespace

std::vector<Verdict> verdicts(const BenchRecord& record, const std::vector<BenchCase>& cases) {
    std::vector<Verdict> all;
    for (const BenchCase& each : cases) {
        const std::vector<SeriesPoint> series = record.series(each);
        if (std::ranges::any_of(series,
                                [](const SeriesPoint& point) { return !std::isfinite(point.relmse); }))
            all.push_back({fmt::format("a picture of {}/{} is not finite", each.scene, each.method), true});
        if (!each.unit.empty()) all.push_back(ofSizes(each, series));
        if (!each.order) continue;
        const SeriesFit fit = fitSeries(series);
        all.push_back(ofOrder(each, fit));
        if (each.options.sampler == SamplerKind::Independent) all.push_back(ofTime(each, fit));
    }
    return all;
}

}  // namespace helio::cli
