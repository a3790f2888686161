#pragma once
/** @file What the program prints. Nothing here throws: a terminal that went away does not cost a render. */
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace helio::cli {

/** Makes standard streams that fail harmless: a broken pipe is an error instead of a signal, and a closed one
 * is not given to the next file that is opened. To be called first. */
void prepareConsole();

/** Text without control characters, which could move a terminal's cursor: line ends and tabs become spaces,
 * the others question marks. */
std::string printable(std::string_view text);

/** Writes to standard error as it is, at once. */
void writeError(std::string_view text);
/** Writes to standard output as it is. */
void writeOutput(std::string_view text);
/** Whether everything written to standard output got there. Flushes. */
bool outputWritten();

/** A line "heliograph: ..." on standard error. */
template <typename... T>
void say(fmt::format_string<T...> format, T&&... arguments) {
    writeError("heliograph: " + printable(fmt::format(format, std::forward<T>(arguments)...)) + "\n");
}

/** A line on standard output. */
template <typename... T>
void printLine(fmt::format_string<T...> format, T&&... arguments) {
    writeOutput(printable(fmt::format(format, std::forward<T>(arguments)...)) + "\n");
}

}  // namespace helio::cli
