#pragma once
/** @file
 * Tools that judge a result: significance tests, intervals, distances in units in the last place, orders of
 * convergence, and closed forms of light transport to compare with. They never ask whether a number "looks
 * close": a Monte Carlo result is judged by its standard error.
 */
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace helio::verify {

// ---- Distributions ----------------------------------------------------------------------------------------

/** Probability that a standard normal variable is below z. Relative error near 1e-15 in both tails. */
double normalCdf(double z);
/** Inverse of normalCdf, p in (0, 1): |error| below 1e-12. */
double normalQuantile(double p);
/** Probability that a chi-squared variable of `degrees` degrees of freedom is at least `statistic`. */
double chiSquaredPValue(double statistic, double degrees);
/** Probability that |T| is at least |t| for Student's t of `degrees` degrees of freedom. */
double studentPValue(double t, double degrees);

// ---- Tests ------------------------------------------------------------------------------------------------

/** Significance level of each of `tests` independent tests so that all together have `level`:
 * 1 - (1 - level)^(1 / tests) (Sidak 1967). */
double sidakLevel(double level, std::size_t tests);

struct ChiSquaredResult {
    double statistic = 0;
    double degrees = 0;
    double pValue = 1;       ///< small: the counts do not follow the expectation
    std::size_t pooled = 0;  ///< cells of small expectation that were pooled
};
/** Pearson's test of counts against expected counts of the same total. Cells with an expectation below
 * `minimumExpected` are pooled, least first. A count where nothing is expected gives p = 0. Asserts equal
 * lengths. `constraints` is what the expectation took from the data, 1 for the total alone. */
ChiSquaredResult chiSquaredTest(std::span<const double> observed, std::span<const double> expected,
                                double minimumExpected = 5, std::size_t constraints = 1);

/** Mean and variance by Welford's recurrence, in double. */
class RunningStatistics {
public:
    void add(double x);
    std::size_t count() const { return count_; }
    double mean() const { return mean_; }
    double variance() const;       ///< of one sample, unbiased; 0 below two samples
    double standardError() const;  ///< of the mean

private:
    std::size_t count_ = 0;
    double mean_ = 0;
    double deviation_ = 0;
};

struct ZResult {
    double z = 0;       ///< (mean - truth) / standardError; infinite where the error is 0 and they differ
    double pValue = 1;  ///< two-sided
    double mean = 0;
    double standardError = 0;
};
/** Tests a mean with a known standard error against the truth. */
ZResult zTest(double mean, double standardError, double truth);
ZResult zTest(const RunningStatistics& samples, double truth);

/** Per-pixel test of an image against a reference, both with the variance of their values. */
struct ImageZResult {
    double worstZ = 0;            ///< of largest magnitude
    std::size_t worstIndex = 0;   ///< where
    double worstPValue = 1;       ///< of the worst value, corrected for the number of values (Sidak)
    double chiSquaredPValue = 1;  ///< of the sum of z^2: catches a small shift everywhere
    double meanZ = 0;             ///< z-score of the mean of all z: catches a common bias
    std::size_t values = 0;       ///< that had a variance above 0
};
/** `variance` is of the mean; `referenceVariance` may be empty for an exact reference. Values whose variances
 * are both 0 count as infinitely far unless equal. Asserts equal lengths. */
ImageZResult imageZTest(std::span<const float> image, std::span<const float> variance,
                        std::span<const float> reference, std::span<const float> referenceVariance = {});

// ---- Errors -----------------------------------------------------------------------------------------------

/** A number with an interval. */
struct Interval {
    double value = 0, low = 0, high = 0;
    bool contains(double x) const { return low <= x && x <= high; }
};
/** Relative mean squared error, mean((x - r)^2 / (r^2 + 0.01)), with the interval in which the mean over
 * infinitely many such values lies with `confidence`, taking values as independent. Values that are not
 * finite are left out. Asserts equal lengths. */
Interval relativeMeanSquaredError(std::span<const float> image, std::span<const float> reference,
                                  double confidence = 0.95);

/** Number of representable numbers between two, plus 1; 0 where equal (0 and -0 are). NaN with NaN is 0; NaN
 * with a number is the largest distance. */
std::uint64_t ulpDistance(float a, float b);
std::uint64_t ulpDistance(double a, double b);
/** |computed - exact| in units of the last place of the float nearest to `exact`, with fractions. */
double ulpError(float computed, double exact);

/** Least-squares line y = intercept + slope x. */
struct Line {
    double slope = 0, intercept = 0;
    double slopeError = 0;  ///< standard error of the slope from the residuals; 0 with two points
};
Line fitLine(std::span<const double> x, std::span<const double> y);
/** Slope of log(error) over log(step): the order of convergence; negative where `step` is a sample count. */
Line convergenceOrder(std::span<const double> step, std::span<const double> error);

// ---- Closed forms: form factors and irradiance ------------------------------------------------------------
// Distances share a unit. Irradiance is of a surface of radiance 1 that emits from the shown face.

using Vector = std::array<double, 3>;

/** Between two aligned parallel rectangles a x b at distance d (Howell, C-11). */
double formFactorParallelRectangles(double a, double b, double d);
/** From the rectangle w x l to the rectangle h x l that shares the edge l at a right angle (Howell, C-14). */
double formFactorPerpendicularRectangles(double l, double w, double h);
/** From a disk of radius r1 to a coaxial parallel disk of radius r2 at distance d (Howell, C-41). */
double formFactorCoaxialDisks(double r1, double r2, double d);
/** From a point of the floor to an infinitely long wall of height h at distance d. */
double formFactorInfiniteWall(double d, double h);
/** Irradiance at `point` with unit `normal` from a polygon wholly above the horizon (Lambert 1760): vertices
 * are counter-clockwise as seen from the point; the other order gives the negative. */
double irradiancePolygon(const Vector& point, const Vector& normal, std::span<const Vector> vertices);
/** Under the centre of a parallel rectangle a x b at height h. */
double irradianceCentredRectangle(double a, double b, double h);
/** Solid angle of a rectangle a x b from the point at height h over its centre. */
double solidAngleCentredRectangle(double a, double b, double h);
/** On the axis of a parallel disk of radius r at distance d: pi r^2 / (r^2 + d^2). */
double irradianceDisk(double r, double d);
/** From a sphere of radius r whose centre is d > r away, at angle theta from the normal; the part below the
 * horizon does not count (Howell, B-43). */
double irradianceSphere(double r, double d, double theta);

// ---- Closed forms: enclosures -----------------------------------------------------------------------------

/** Radiance inside a closed surface of uniform emission and reflectance, after at most `bounces` reflections;
 * negative: all of them, emission / (1 - reflectance). */
double furnaceRadiance(double emission, double reflectance, int bounces = -1);
/** Reflected radiance anywhere in a spherical cavity, a fraction of whose surface emits. */
double sphereCavityRadiance(double emission, double reflectance, double fraction);
/** Radiances leaving two infinite parallel plates, of which the first emits. */
std::array<double, 2> infinitePlatesRadiance(double emission, double reflectance1, double reflectance2);

// ---- Closed forms: smooth interfaces ----------------------------------------------------------------------

struct Reflectances {
    double s = 0, p = 0;
    double average() const { return 0.5 * (s + p); }
};
/** Fresnel's reflectances of a dielectric; `eta` is the index beyond over the index on the side of incidence,
 * `cosine` of the angle of incidence. 1 beyond the critical angle. */
Reflectances fresnelDielectric(double cosine, double eta);
/** Of a conductor with index n + ik seen from vacuum. */
Reflectances fresnelConductor(double cosine, double n, double k);
/** Cosine-weighted average of the dielectric's unpolarised reflectance over the hemisphere (Duntley 1942);
 * `eta` as above, either side. */
double fresnelDielectricAverage(double eta);

}  // namespace helio::verify
