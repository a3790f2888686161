/** @file
 * Long run of the scattering models at their extremes:
 *
 *     scattering_soak [--samples N] [--state FILE]
 *
 * N samples in all, 10^9 by default, shared by the models in turn. With a state file a later run goes on
 * where an earlier one was stopped. Ends with 1 where a number is not finite or negative.
 */
#include "tests/accuracy/scattering_extremes.hpp"
#include "tests/support/device.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string_view>

int main(int count, char** arguments) {
    using namespace helio::test;
    double wanted = 1e9;
    std::string state;
    for (int i = 1; i + 1 < count; i += 2) {
        if (std::string_view(arguments[i]) == "--samples") wanted = std::atof(arguments[i + 1]);
        if (std::string_view(arguments[i]) == "--state") state = arguments[i + 1];
    }
    std::uint64_t batch = 0, samples = 0, faults = 0;
    if (!state.empty()) std::ifstream(state) >> batch >> samples >> faults;
    const std::vector<std::string> names = extremeLobes();
    const auto begin = std::chrono::steady_clock::now();
    double shown = 0;
    for (; double(samples) < wanted; ++batch) {
        const std::string& name = names[batch % names.size()];
        const Extremes found = runExtremes(lobe(name), std::uint32_t(batch / names.size()), 1u << 18);
        samples += found.samples;
        faults += found.faults;
        if (found.faults > 0)
            std::printf("%llu faults, first: %s\n", (unsigned long long)(found.faults), found.first.c_str());
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        if (!state.empty()) std::ofstream(state) << batch + 1 << ' ' << samples << ' ' << faults << '\n';
        if (seconds - shown > 10) {
            shown = seconds;
            std::printf("%.3g of %.3g samples, %llu faults, %.0f s\n", double(samples), wanted,
                        (unsigned long long)(faults), seconds);
            std::fflush(stdout);
        }
    }
    closeDevice();
    std::printf("%llu samples, %llu faults\n", (unsigned long long)(samples), (unsigned long long)(faults));
    return faults > 0 ? 1 : 0;
}
