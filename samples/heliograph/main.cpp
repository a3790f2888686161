/** @file The program `heliograph`: see the contract in docs and `heliograph --help`. */
#include "commands.hpp"

#include <heliograph/error.hpp>
#include <heliograph/version.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

namespace {

/** Every failure is one line on standard error. */
int fail(helio::cli::ExitCode code, std::string message) {
    for (char& c : message) {
        if (c == '\n') c = ' ';
    }
    fmt::print(stderr, "heliograph: error: {}\n", message);
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace helio::cli;
    CLI::App app{"Heliograph: a Vulkan compute renderer that reports its error with its time"};
    app.name("heliograph");
    app.set_version_flag("--version", std::string(helio::version()));
    app.require_subcommand(1);
    Command run;
    addRenderCommand(app, run);
    addCompareCommand(app, run);
    addInfoCommand(app, run);
    try {
        app.parse(argc, argv);
        return run();
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return fail(WrongUsage, fmt::format("{}; see heliograph {}--help", error.what(),
                                            app.get_subcommands().empty()
                                                ? ""
                                                : app.get_subcommands().front()->get_name() + " "));
    } catch (const helio::Error& error) {
        return fail(Failed, error.what());
    } catch (const std::bad_alloc&) {
        return fail(Failed, "out of memory; use a smaller image or scene");
    } catch (const std::exception& error) {
        return fail(Failed, fmt::format("unexpected failure: {}; please report it", error.what()));
    }
}
