#pragma once
/** @file What the benchmark makes of pictures and series of them. */
#include <heliograph/image.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace helio::cli {

/** What a picture should be: R G B per pixel, rows from the top. */
struct Truth {
    std::vector<double> rgb;
    /** Mean squared error of `rgb` itself, absolute and as relMSE counts: what it adds to errors that are
     * measured against it. 0 of closed forms. */
    double residualMse = 0, residual = 0;
};

/** The mean of two pictures made independently of each other. A quarter of their squared difference is, in
 * the mean, the error of that. */
Truth truthFromHalves(const ImageF& first, const ImageF& second);

struct PictureError {
    double mse = 0;
    double relmse = 0;  ///< mean((x - r)^2 / (r^2 + 0.01))
};
/** Against the truth, the truth's own error subtracted: may come out negative where it is about as large. */
PictureError pictureError(const ImageF& image, const Truth& truth);

/** |x - r| / sqrt(r^2 + 0.01), R G B: white is an error of 100 %. */
ImageF differencePicture(const ImageF& image, const Truth& truth);
ImageF truthPicture(const Truth& truth, std::uint32_t width, std::uint32_t height);

/** Shows pictures of bright scenes darker: their mean as half of white. */
Display displayOf(const Truth& truth);

/** A point of a series: all renders of one number of samples. */
struct SeriesPoint {
    std::uint32_t samples = 0;
    double relmse = 0;      ///< mean over the renders
    double cpuSeconds = 0;  ///< least of the renders: what other processes add is no part of the method
};
struct SeriesFit {
    double order = 0, orderError = 0;  ///< exponent of relMSE over samples, and its standard error
    /** Largest deviation of sqrt(relMSE x CPU time) from its mean over the steady points, relative: 0 for a
     * method whose error falls as one over the root of the time, and where there is no such point. */
    double unsteadiness = 0;
    std::size_t steadyPoints = 0;  ///< of 0.02 s and 8 times the first point's time
    double efficiency = 0;         ///< 1 / (relMSE x CPU s) at the last point
};
/** Points whose error is not positive are left out; a fit of fewer than three is all zero. */
SeriesFit fitSeries(std::span<const SeriesPoint> points);

}  // namespace helio::cli
