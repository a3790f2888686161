#pragma once
/** @file The subcommands of the command line. Each adds its options and sets `run` when it is chosen. */
#include <CLI/CLI.hpp>

#include <functional>

namespace helio::cli {

/** Exit codes of the contract. */
enum ExitCode : int { Done = 0, Failed = 1, WrongUsage = 2, Interrupted = 130 };

using Command = std::function<int()>;

void addRenderCommand(CLI::App& app, Command& run);
void addCompareCommand(CLI::App& app, Command& run);
void addInfoCommand(CLI::App& app, Command& run);
void addBenchCommand(CLI::App& app, Command& run);
void addBakeCommand(CLI::App& app, Command& run);
void addConvertEnvironmentCommand(CLI::App& app, Command& run);

}  // namespace helio::cli
