#include "passes/radiosity/patches.hpp"

#include "passes/scene/material_layout.hpp"

#include <heliograph/error.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace helio {
namespace {

void refuse(bool refused, const char* fault, const char* remedy) {
    if (refused) throw InputError("", "radiosity", fault, remedy);
}

void check(const PackedScene& packed) {
    refuse(packed.materialFeatures != 0, "the scene has materials that are not Lambertian",
           "give them metallic 0 and a specular factor of 0, or render by paths");
    refuse(
        packed.baseColorTextures || packed.solidTextures || packed.texturedEmission || !packed.colors.empty(),
        "the scene has textures or vertex colours, and a patch has one colour",
        "take them away, or render by paths");
    refuse(packed.punctualLights, "the scene has punctual lights, and patches are lit by each other",
           "use emissive surfaces, or render by paths");
    refuse(packed.environmentSize[0] > 0, "the environment is an image",
           "give a constant one, or render by paths");
}

double areaOf(const std::array<glm::dvec3, 3>& c) {
    return 0.5 * glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
}

}  // namespace

PatchList cutIntoPatches(const PackedScene& packed, std::uint32_t count) {
    assert(packed.triangleCount <= kMostPatches);
    check(packed);
    PatchList list;
    std::vector<std::array<glm::dvec3, 3>> triangles(packed.triangleCount);
    std::vector<double> roots(packed.triangleCount);
    double largest = 0;
    for (std::size_t slot = 0; slot < triangles.size(); ++slot) {
        for (std::size_t c = 0; c < 3; ++c) triangles[slot][c] = glm::dvec3(packed.triangles[3 * slot + c]);
        roots[slot] = std::sqrt(areaOf(triangles[slot]));
        largest = std::max(largest, roots[slot]);
    }
    // What has no area is no patch.
    const auto divisions = [&](std::size_t slot, double step) {
        return roots[slot] > 0 ? std::uint32_t(std::max(1.0, std::round(roots[slot] / step))) : 0u;
    };
    const auto total = [&](double step) {
        std::uint64_t sum = 0;
        for (std::size_t slot = 0; slot < roots.size(); ++slot)
            sum += std::uint64_t(divisions(slot, step)) * divisions(slot, step);
        return sum;
    };
    const std::uint64_t wanted = std::min(count, kMostPatches);
    double fine = largest / 64, coarse = 2 * largest;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (fine + coarse);
        (total(middle) <= wanted ? coarse : fine) = middle;
    }
    for (std::size_t slot = 0; slot < triangles.size(); ++slot) {
        const std::uint32_t n = divisions(slot, coarse);
        list.slots.emplace_back(list.patches.size(), n, 0, 0);
        const auto& t = triangles[slot];
        const auto material = std::size_t(std::bit_cast<std::uint32_t>(packed.triangles[3 * slot + 2].w));
        const glm::vec4* texels = &packed.materials[material * kMaterialTexels];
        const glm::dvec3 emission(texels[1]);
        const bool bothSides = (std::bit_cast<std::uint32_t>(texels[1].w) & 1u) != 0;
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; i + j < n; ++j)
                for (std::uint32_t upper = 0; upper < 2 && i + j + upper < n; ++upper) {
                    const double step = upper == 0 ? 1.0 : -1.0;
                    const auto corner = [&](double a, double b) {
                        const double u = (i + upper + a * step) / n, v = (j + upper + b * step) / n;
                        return (1 - u - v) * t[0] + u * t[1] + v * t[2];
                    };
                    list.places.emplace_back(slot, 2 * n + upper, i, j);
                    list.patches.push_back({{corner(0, 0), corner(1, 0), corner(0, 1)},
                                            glm::dvec3(texels[0]),
                                            {emission, bothSides ? emission : glm::dvec3(0.0)}});
                }
    }
    return list;
}

}  // namespace helio
