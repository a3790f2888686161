#include "progress_display.hpp"

#include "console.hpp"
#include "interrupts.hpp"

#include <heliograph/error.hpp>

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
        show(describe(progress));
    } else if (progress.seconds >= nextLineAt_) {
        say("{}", describe(progress));
        nextLineAt_ = progress.seconds * 2;
    }
}

void ProgressDisplay::update(const LoadProgress& progress) {
    if (quiet_) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const std::string text = fmt::format("loading {} {:3.0f} %", progress.stage, progress.fraction * 100);
    if (terminal_) {
        if (elapsed.count() > 0.5) show(text);  // most scenes are there before anyone could read it
    } else if (elapsed.count() >= nextLoadLineAt_) {
        say("{}", text);
        nextLoadLineAt_ = elapsed.count() * 2;
    }
}

void ProgressDisplay::show(const std::string& line) {
    writeError("\r\x1b[K" + line);
    lineOpen_ = true;
}

void ProgressDisplay::finish() {
    if (lineOpen_) writeError("\r\x1b[K");
    lineOpen_ = false;
}

std::optional<Scene> loadShowingProgress(const std::string& source, ProgressDisplay& display,
                                         LoadOptions options) try {
    options.progress = [&](const LoadProgress& progress) {
        display.update(progress);
        return !interrupted();
    };
    Scene scene = load(source, options);
    display.finish();
    return scene;
} catch (const Cancelled&) {
    display.finish();
    return std::nullopt;
} catch (...) {
    display.finish();  // an error's line must not follow what is shown
    throw;
}

}  // namespace helio::cli
