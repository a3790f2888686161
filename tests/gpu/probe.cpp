// Does one thing with a device and prints what came of it on one line: for tests that need a process of their
// own, with an environment of its own. Usage: gpu_probe open DEVICE | lacking DEVICE | validate | list
#include <heliograph/device.hpp>
#include <heliograph/error.hpp>

#include <cstdio>
#include <cstring>

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    try {
        if (what == "list") {
            for (const helio::DeviceInfo& info : helio::listDevices()) {
                std::printf("%s|%s|%s\n", info.name.c_str(), info.apiVersion.c_str(), info.refusal.c_str());
            }
            return 0;
        }
        helio::DeviceOptions options;
        if (argc > 2) options.device = argv[2];
        options.validation = what == "validate";
        const helio::Device device(options);
        for (const helio::Capability& capability : device.info().capabilities) {
            if (what == "lacking" && !capability.present) std::printf("lacks %s\n", capability.name.c_str());
        }
        std::printf("opened %s\n", device.info().name.c_str());
        return 0;
    } catch (const helio::DeviceError& error) {
        std::printf("DeviceError: %s\n", error.what());
        return 1;
    }
}
