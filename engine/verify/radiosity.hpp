#pragma once
/** @file
 * Radiosity: the rendering equation L = E + K L of a convex diffuse enclosure over patches of constant
 * radiance, as a linear system. Its exact (dense) solution, its iterative one, and the terms E, K E, K^2 E,
 * ... of the Neumann series, for tests of light transport (Goral et al. 1984).
 */
#include <heliograph/verify.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace helio::verify {

/** A parallelogram that emits and reflects on the side to which u x v points. */
struct Patch {
    Vector corner{}, u{}, v{};
    double emission = 0, reflectance = 0;
};

/** Adds the parts of a patch that is cut into n x n. */
void subdivide(const Patch& patch, int n, std::vector<Patch>& parts);

/** The operator K over patches. */
class Radiosity {
public:
    /** Of patches that all see each other whole (the inside of a convex body). Form factors are the closed
     * form from a point to a polygon, averaged over 4 x 4 Gauss points of the patch. Asserts patches of
     * positive area. */
    explicit Radiosity(std::span<const Patch> patches);

    /** From form factors (row by row, from each patch to every other), emission and reflectance of each. */
    Radiosity(std::vector<double> factors, std::vector<double> emission, std::vector<double> reflectance);

    double formFactor(std::size_t from, std::size_t to) const { return factors_[from * size() + to]; }
    std::size_t size() const { return emission_.size(); }

    /** Radiance of each patch, by Gaussian elimination of I - K. */
    std::vector<double> solve() const;
    /** The same by L <- E + K L until no radiance changes by more than `tolerance`, or `most` times, or
     * `goOn`, asked each time, says no; `iterations` tells how often. */
    std::vector<double> iterate(
        double tolerance, int* iterations = nullptr, int most = 100000,
        const std::function<bool()>& goOn = [] { return true; }) const;
    /** K^n E: radiance after exactly n reflections. */
    std::vector<double> bounce(int n) const;

private:
    std::vector<double> apply(const std::vector<double>& radiance) const;
    std::vector<double> emission_, reflectance_, factors_;
};

}  // namespace helio::verify
