#include "commands.hpp"
#include "console.hpp"
#include "interrupts.hpp"
#include "progress_display.hpp"
#include "scene_description.hpp"

#include <heliograph/device.hpp>
#include <heliograph/scene.hpp>
#include <heliograph/tree_access.hpp>
#include <heliograph/version.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <optional>

namespace helio::cli {
namespace {

/** Names come from files and may not be UTF-8. */
std::string dump(const Json& json, int indent = -1) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void printJson(const Json& json) {
    writeOutput(dump(json, 2) + "\n");
}

Json describeDevice(const DeviceInfo& device) {
    Json capabilities = Json::array();
    for (const Capability& capability : device.capabilities) {
        Json entry = {
            {"name", capability.name}, {"present", capability.present}, {"required", capability.required}};
        if (!capability.value.empty()) entry["value"] = capability.value;
        if (!capability.present) entry["switches_off"] = capability.whenMissing;
        capabilities.push_back(entry);
    }
    Json result = {{"name", device.name},
                   {"type", device.type},
                   {"driver", device.driver},
                   {"driver_version", device.driverVersion},
                   {"api_version", device.apiVersion},
                   {"usable", device.usable},
                   {"memory_bytes", device.memoryBytes},
                   {"subgroup_size", device.subgroupSize},
                   {"max_storage_buffer_range", device.maxStorageBufferRange},
                   {"max_texel_buffer_elements", device.maxTexelBufferElements},
                   {"capabilities", capabilities}};
    if (!device.usable) result["refusal"] = device.refusal;
    return result;
}

void printDevice(std::size_t index, const DeviceInfo& device) {
    printLine("[{}] {} ({}, {} {}, Vulkan {}){}", index, device.name, device.type, device.driver,
              device.driverVersion, device.apiVersion, device.usable ? "" : "  REFUSED: " + device.refusal);
    for (const Capability& capability : device.capabilities) {
        printLine("      {:<3} {:<34} {}", capability.present ? "yes" : "no", capability.name,
                  capability.present
                      ? capability.value
                      : (capability.required ? "required: " : "without it: ") + capability.whenMissing);
    }
}

int info(const std::string& source, bool json) {
    if (!source.empty()) {
        handleInterrupts();
        ProgressDisplay display(false);
        const std::optional<Scene> loaded = loadShowingProgress(source, display);
        if (!loaded) {
            say("interrupted while loading");
            return Interrupted;
        }
        const Json scene = describeScene(*loaded);
        if (json) {
            printJson(scene);
        } else {
            printScene(scene);
        }
        return Done;
    }
    const std::vector<DeviceInfo> devices = listDevices();
    if (json) {
        Json result = {
            {"version", std::string(version())}, {"devices", Json::array()}, {"samples", sampleNames()}};
        for (const DeviceInfo& device : devices) result["devices"].push_back(describeDevice(device));
        printJson(result);
        return Done;
    }
    printLine("Heliograph {}", version());
    for (std::size_t i = 0; i < devices.size(); ++i) printDevice(i, devices[i]);
    if (devices.empty()) printLine("no Vulkan device; install mesa-vulkan-drivers for a CPU device");
    printLine("samples: {}", fmt::join(sampleNames(), ", "));
    return Done;
}

int measure(const std::string& name) {
    Device device({.device = name});
    const std::vector<MeasuredAccess> measured = measureTreeAccess(device);
    const TreeAccess fastest = fastestAccess(measured);
    printLine("{}: how trees are read", device.info().name);
    for (const MeasuredAccess& way : measured)
        printLine("  {:<32} {:8.1f} ms{}", describe(way.access), 1e3 * way.seconds,
                  way.access == fastest ? "  taken from now on" : "");
    if (keepTreeAccess(device, fastest)) return Done;
    say("the choice could not be kept: the folder of the pipeline cache cannot be written");
    return Failed;
}

}  // namespace

void addInfoCommand(CLI::App& app, Command& run) {
    struct Arguments {
        std::string scene;
        bool json = false, measure = false;
        std::string device = "auto";
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        app.add_subcommand("info", "List the devices, or what a scene holds, needs and would skip");
    command->add_option("SCENE", arguments->scene, "A file or sample:NAME");
    command->add_flag("--json", arguments->json, "Print JSON");
    CLI::Option* measured = command->add_flag(
        "--measure", arguments->measure,
        "Measure in which way the device reads trees fastest, and keep it for all renders on it");
    command->add_option("--device", arguments->device, "Of --measure; default auto")->needs(measured);
    command->callback([arguments, &run] {
        run = [arguments] {
            return arguments->measure ? measure(arguments->device) : info(arguments->scene, arguments->json);
        };
    });
}

}  // namespace helio::cli
