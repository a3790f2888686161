#pragma once
/** @file How a running render is shown: a line that is rewritten on a terminal, a few whole lines elsewhere.
 */
#include <heliograph/renderer.hpp>

#include <string>

namespace helio::cli {

class ProgressDisplay {
public:
    explicit ProgressDisplay(bool quiet);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void update(const Progress& progress);
    /** Clears the terminal line, so that ordinary output can follow. */
    void finish();

private:
    bool quiet_;
    bool terminal_;
    bool lineOpen_ = false;
    std::string lastStage_;
    double nextLineAt_ = 10;  ///< seconds of rendering until a non-terminal gets its next line
};

}  // namespace helio::cli
