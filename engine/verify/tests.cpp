#include <heliograph/verify.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace helio::verify {

double sidakLevel(double level, std::size_t tests) {
    assert(level >= 0 && level < 1 && tests > 0);
    return -std::expm1(std::log1p(-level) / double(tests));
}

ChiSquaredResult chiSquaredTest(std::span<const double> observed, std::span<const double> expected,
                                double minimumExpected, std::size_t constraints) {
    assert(observed.size() == expected.size());
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    ChiSquaredResult result;
    double pooledObserved = 0, pooledExpected = 0;
    std::size_t cells = 0;
    const auto addCell = [&](double o, double e) {
        result.statistic += (o - e) * (o - e) / e;
        ++cells;
    };
    for (const std::size_t i : order) {
        if (expected[i] <= 0 && observed[i] > 0) {
            result.statistic = std::numeric_limits<double>::infinity();
            result.pValue = 0;
            return result;
        }
        if (expected[i] <= 0) continue;
        if (expected[i] < minimumExpected || (pooledExpected > 0 && pooledExpected < minimumExpected)) {
            pooledObserved += observed[i];
            pooledExpected += expected[i];
            ++result.pooled;
        } else {
            addCell(observed[i], expected[i]);
        }
    }
    if (pooledExpected > 0) addCell(pooledObserved, pooledExpected);
    if (cells <= constraints) return result;
    result.degrees = double(cells - constraints);
    result.pValue = chiSquaredPValue(result.statistic, result.degrees);
    return result;
}

void RunningStatistics::add(double x) {
    ++count_;
    const double delta = x - mean_;
    mean_ += delta / double(count_);
    deviation_ += delta * (x - mean_);
}

double RunningStatistics::variance() const {
    return count_ < 2 ? 0 : deviation_ / double(count_ - 1);
}

double RunningStatistics::standardError() const {
    return count_ == 0 ? 0 : std::sqrt(variance() / double(count_));
}

ZResult zTest(double mean, double standardError, double truth) {
    ZResult result;
    result.mean = mean;
    result.standardError = standardError;
    const double difference = mean - truth;
    result.z = difference == 0 ? 0 : difference / standardError;
    result.pValue = std::isnan(result.z) ? 0 : 2 * normalCdf(-std::abs(result.z));
    return result;
}

ZResult zTest(const RunningStatistics& samples, double truth) {
    return zTest(samples.mean(), samples.standardError(), truth);
}

ImageZResult imageZTest(std::span<const float> image, std::span<const float> variance,
                        std::span<const float> reference, std::span<const float> referenceVariance) {
    assert(image.size() == reference.size() && image.size() == variance.size());
    assert(referenceVariance.empty() || referenceVariance.size() == image.size());
    ImageZResult result;
    double sum = 0, sumOfSquares = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const double v =
            double(variance[i]) + (referenceVariance.empty() ? 0.0 : double(referenceVariance[i]));
        const double difference = double(image[i]) - double(reference[i]);
        if (v == 0 && difference == 0) continue;
        const double z = difference / std::sqrt(v);
        ++result.values;
        sum += z;
        sumOfSquares += z * z;
        if (!std::isnan(result.worstZ) && !(std::abs(z) <= std::abs(result.worstZ))) {
            result.worstZ = z;
            result.worstIndex = i;
        }
    }
    if (result.values == 0) return result;
    const double n = double(result.values);
    const double worst = std::isnan(result.worstZ) ? 0 : 2 * normalCdf(-std::abs(result.worstZ));
    result.worstPValue = -std::expm1(n * std::log1p(-std::min(worst, 1.0)));
    result.chiSquaredPValue = std::isfinite(sumOfSquares) ? verify::chiSquaredPValue(sumOfSquares, n) : 0;
    result.meanZ = sum / std::sqrt(n);
    return result;
}

}  // namespace helio::verify
