#pragma once
/** @file The engine's log: one spdlog logger on standard error, quiet (warnings and worse) by default. */
#include <spdlog/spdlog.h>

namespace helio {

/** The logger "heliograph". Applications set its level or replace its sinks through spdlog's registry. */
spdlog::logger& log();

}  // namespace helio
