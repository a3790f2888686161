/** @file
 * The spheres of sample:gallery with its first material on all of them, then with its first two, and so on:
 * size of the path tracer's kernel, CPU time to set up (compiling it twice over, to SPIR-V and to the
 * device's code), samples over CPU time. First row: diffuse surfaces alone.
 */
#include "passes/scene/material_layout.hpp"

#include <heliograph/kernel.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>

#include <cstdlib>

namespace {

using namespace helio;

/** All spheres of the gallery, and only they, have several hundred triangles. */
constexpr std::size_t kSphereCorners = 300;

/** The gallery's spheres with their first `count` materials, the last of which the rest take. Returns its
 * name. */
std::string limitMaterials(Scene& scene, std::size_t count) {
    std::size_t place = 0;
    int last = 0;
    for (Mesh& mesh : scene.meshes) {
        Primitive& primitive = mesh.primitives[0];
        if (primitive.positions.size() < kSphereCorners) continue;
        if (place++ < count) last = primitive.material;
        primitive.material = last;
    }
    return scene.materials[std::size_t(last)].name;
}

std::uint32_t featuresOf(const Scene& scene) {
    std::uint32_t features = 0;
    for (const Mesh& mesh : scene.meshes) {
        const std::uint32_t bits =
            pack::materialFeatures(scene.materials[std::size_t(mesh.primitives[0].material)]);
        features |= bits == 0 ? pack::kDiffuseFeatures : bits;
    }
    return features == pack::kDiffuseFeatures ? 0 : features;
}

std::size_t kernelBytes(std::uint32_t features) {
    KernelVariant variant;
    if (features != 0) variant.defines["SURFACE_MATERIALS"] = fmt::format("0x{:x}u", features);
    variant.defines["BENCHMARK"] = "1";
    return compileVariant({"pathtrace/trace", {}, "passes/pathtrace/trace.comp"}, variant).spirv.size_bytes();
}

}  // namespace

int main(int count, char** arguments) {
    const std::uint32_t samples = count > 1 ? std::uint32_t(std::atoi(arguments[1])) : 64;
    fmt::print(
        "| materials | the last | SPIR-V, kB | set-up, CPU s | Msamples / CPU s |\n|---|---|---|---|---|\n");
    for (std::size_t materials = 0; materials <= 15; ++materials) {
        Scene scene = load("sample:gallery");
        const std::string name = limitMaterials(scene, materials);
        Renderer renderer;
        RenderOptions options;
        options.size = {320, 180};
        options.samples = samples;
        options.auxiliary = false;
        double best = 0, setup = 0;
        for (int run = 0; run < 3; ++run) {
            const RenderResult result = renderer.render(scene, options);
            if (run == 0) setup = result.setupCpuSeconds;
            best = std::max(
                best, double(options.size[0]) * options.size[1] * samples / result.renderCpuSeconds * 1e-6);
        }
        fmt::print("| {} | {} | {:.0f} | {:.2f} | {:.3f} |\n", materials, name,
                   1e-3 * double(kernelBytes(featuresOf(scene))), setup, best);
        std::fflush(stdout);
    }
}
