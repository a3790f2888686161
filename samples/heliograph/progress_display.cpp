#include "progress_display.hpp"

#include "console.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace helio::cli {
namespace {

std::string describe(const Progress& progress) {
    std::string text = fmt::format("{:3.0f} %  {} spp  {:.1f} s  {:.2f} Mrays/s", progress.fraction * 100,
                                   progress.samples, progress.seconds, progress.raysPerSecond * 1e-6);
    if (progress.relmse >= 0) text += fmt::format("  relMSE {:.2e}", progress.relmse);
    if (progress.secondsLeft >= 0) text += fmt::format("  {:.0f} s left", progress.secondsLeft);
    return text;
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() {
    finish();
}

void ProgressDisplay::update(const Progress& progress) {
    if (quiet_) return;
    if (progress.stage != lastStage_) {
        lastStage_ = progress.stage;
        if (progress.stage == "compile") say("compiling kernels");
    }
    if (progress.stage != "render") return;
    if (terminal_) {
        writeError("\r\x1b[K" + describe(progress));
        lineOpen_ = true;
    } else if (progress.seconds >= nextLineAt_) {
        say("{}", describe(progress));
        nextLineAt_ = progress.seconds * 2;
    }
}

void ProgressDisplay::finish() {
    if (lineOpen_) writeError("\r\x1b[K");
    lineOpen_ = false;
}

}  // namespace helio::cli
