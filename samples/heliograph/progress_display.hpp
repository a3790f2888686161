#pragma once
/** @file How a running render is shown: a line that is rewritten on a terminal, a few whole lines elsewhere.
 */
#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>

#include <chrono>
#include <optional>
#include <string>

namespace helio::cli {

class ProgressDisplay {
public:
    explicit ProgressDisplay(bool quiet);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void update(const Progress& progress);
    void update(const LoadProgress& progress);
    /** Clears the terminal line, so that ordinary output can follow. */
    void finish();

private:
    void show(const std::string& line);

    bool quiet_;
    bool terminal_;
    bool lineOpen_ = false;
    std::string lastStage_;
    double nextLineAt_ = 10;  ///< seconds of rendering until a non-terminal gets its next line
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double nextLoadLineAt_ = 5;  ///< the same for loading
};

/** Loads a scene, which a signal may stop: there is none then. `options` are those of load(), its progress
 * excepted. */
std::optional<Scene> loadShowingProgress(const std::string& source, ProgressDisplay& display,
                                         LoadOptions options = {});

}  // namespace helio::cli
