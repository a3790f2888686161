#include "interrupts.hpp"

#include <csignal>

namespace helio::cli {
namespace {

volatile std::sig_atomic_t received = 0;

}  // namespace

void handleInterrupts() {
    std::signal(SIGINT, [](int) { received = 1; });
    std::signal(SIGTERM, [](int) { received = 1; });
}

bool interrupted() {
    return received != 0;
}

}  // namespace helio::cli
