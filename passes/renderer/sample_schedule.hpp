#pragma once
/** @file At which sample counts the film is brought up to date. */
#include <heliograph/renderer.hpp>

#include <cstdint>

namespace helio {

/** Batches of samples. Every end of a batch costs the lanes that wait for the longest paths, so there are
 * few: the first is small where the picture is large, so that something is there soon, and later ones grow.
 * With an error limit, a batch ends a little before the estimate is expected to reach it. The ends are a
 * function of the options and of the errors at earlier ends alone, so that a render's bits never depend on
 * its speed, unless a time limit is set: then batches are also kept to half of the time that is left. */
class SampleSchedule {
public:
    explicit SampleSchedule(const RenderOptions& options);

    /** Tells the error at the end of a batch, which an error limit is held against. */
    void judged(std::uint32_t reached, const ErrorEstimate& error);
    /** The next end after `reached` samples per pixel in `seconds` of rendering; `reached` where time or
     * samples are used up. */
    std::uint32_t next(std::uint32_t reached, double seconds) const;

private:
    std::uint64_t untilErrorLimit(std::uint32_t reached) const;

    std::uint32_t samples_, first_, limit_;
    double growth_, maxSeconds_, maxError_;
    std::uint32_t judgedAt_ = 0;  ///< samples, 0 before the first judgement
    double highest_ = 0;          ///< upper bound of the error there
};

/** Loop turns of a dispatch, so that one takes long enough for its fixed costs and short enough for progress,
 * cancelling, and the watchdogs of devices that draw a desktop. Where paths pause does not change a render's
 * bits, so that this may depend on speed. */
class TurnBudget {
public:
    explicit TurnBudget(const RenderOptions& options);
    std::uint32_t turns() const { return std::uint32_t(turns_); }
    /** Tells how long a dispatch of turns() took. */
    void took(double seconds);

private:
    double turns_, target_;  ///< seconds
};

}  // namespace helio
