// Prints a checksum of each kernel's words, and of a variant compiled at run time.
#include <heliograph/kernel.hpp>

#include <heliograph_kernels/blur.hpp>

#include <cstdint>
#include <cstdio>

static void print(const char* name, const helio::Kernel& kernel) {
    std::uint32_t sum = 0;
    for (const std::uint32_t word : kernel.spirv) sum = sum * 31 + word;
    std::printf("%s=%08x\n", name, sum);
}

int main() {
    print("horizontal", helio::shaders::horizontal);
    print("vertical", helio::shaders::vertical);
    print("same", helio::compileVariant(helio::shaders::horizontal, {.defines = {{"UNUSED", "1"}}, .generated = ""}));
    print("variant", helio::compileVariant(helio::shaders::horizontal, {.defines = {{"RADIUS", "9"}}, .generated = ""}));
}
