#pragma once
/** @file How an importer says how far it is, and learns that it should stop. */
#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <mutex>
#include <string>

namespace helio {

class LoadMonitor {
public:
    explicit LoadMonitor(const LoadOptions& options) : progress_(options.progress) {}

    /** Throws Cancelled where the application asks to stop. Thread safe. */
    void report(const char* stage, double fraction) {
        if (!progress_) return;
        const std::scoped_lock lock(mutex_);
        if (!progress_({stage, fraction})) throw Cancelled("loading was cancelled");
    }

private:
    const std::function<bool(const LoadProgress&)>& progress_;
    std::mutex mutex_;
};

}  // namespace helio
