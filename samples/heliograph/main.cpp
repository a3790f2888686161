/** @file The program `heliograph`: see the README and `heliograph --help`. */
#include "commands.hpp"
#include "console.hpp"

#include <heliograph/error.hpp>
#include <heliograph/version.hpp>

#include <exception>
#include <new>

namespace {

using namespace helio::cli;

/** Every failure is one line on standard error. */
int fail(ExitCode code, const std::string& message) {
    say("error: {}", message);
    return code;
}

/** What is wrong with a command line; names what is not known in the order given. */
std::string describe(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<std::string> unknown = app.remaining(true);
    const bool hasCommand = !app.get_subcommands().empty();
    if (!unknown.empty() && (!hasCommand || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr)) {
        const std::string& first = unknown.front();
        if (first.rfind('-', 0) == 0) return first + " is not known here";
        if (hasCommand) return fmt::format("there is no use for '{}' here", first);
        return fmt::format(
            "there is no command '{}'; there are render, compare, info, bench, bake, convert-environment",
            first);
    }
    return error.what();
}

int runCommandLine(int argc, char** argv) {
    CLI::App app{"Heliograph: a Vulkan compute renderer that reports its error with its time"};
    app.name("heliograph");
    app.set_version_flag("--version", std::string(helio::version()));
    app.require_subcommand(1);
    Command run;
    addRenderCommand(app, run);
    addCompareCommand(app, run);
    addInfoCommand(app, run);
    addBenchCommand(app, run);
    addBakeCommand(app, run);
    addConvertEnvironmentCommand(app, run);
    try {
        app.parse(argc, argv);
        return run();
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        const std::vector<CLI::App*> commands = app.get_subcommands();
        return fail(WrongUsage, fmt::format("{}; see heliograph {}--help", describe(app, error),
                                            commands.empty() ? "" : commands.front()->get_name() + " "));
    } catch (const helio::Error& error) {
        return fail(Failed, error.what());
    } catch (const std::bad_alloc&) {
        return fail(Failed, "out of memory; use a smaller image or scene");
    } catch (const std::exception& error) {
        return fail(Failed, fmt::format("unexpected failure: {}; please report it", error.what()));
    }
}

}  // namespace

int main(int argc, char** argv) {
    prepareConsole();
    const int code = runCommandLine(argc, argv);
    if (outputWritten() || code != Done) return code;
    return fail(Failed, "standard output cannot be written");
}
