#include "engine/core/log.hpp"

#include <spdlog/sinks/stdout_sinks.h>

namespace helio {

spdlog::logger& log() {
    static const std::shared_ptr<spdlog::logger> logger = [] {
        if (auto existing = spdlog::get("heliograph")) return existing;
        auto created = spdlog::stderr_logger_mt("heliograph");
        created->set_level(spdlog::level::warn);
        created->set_pattern("heliograph: %l: %v");
        return created;
    }();
    return *logger;
}

}  // namespace helio
