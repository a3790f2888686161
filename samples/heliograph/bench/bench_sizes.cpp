#include "bench_sizes.hpp"

#include "passes/intersect/ray_intersector.hpp"
#include "passes/mip/mip_chain.hpp"
#include "passes/renderer/process_clock.hpp"

#include <heliograph/graph.hpp>
#include <heliograph/image.hpp>
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

namespace helio::cli {
namespace {

// Flags of a packed texture, as shaders/scene/textures.glsl reads them.
constexpr std::uint32_t kFloatTexture = 1u << 5, kMipmapped = 1u << 6;
constexpr std::size_t kJudgedRays = 64;

/** Sums of errors. */
class Judge {
public:
    void add(double value, double truth) {
        const double squared = (value - truth) * (value - truth);
        mse_ += squared;
        relmse_ += squared / (truth * truth + 0.01);
        ++count_;
    }
    void store(SizeResult& result) const {
        result.mse = mse_ / double(count_);
        result.relmse = relmse_ / double(count_);
    }

private:
    double mse_ = 0, relmse_ = 0;
    std::uint64_t count_ = 0;
};

void time(SizeResult& result, const auto& work) {
    work();  // compiles, and touches the memory
    const auto start = std::chrono::steady_clock::now();
    const double cpu = processCpuSeconds();
    work();
    result.cpuSeconds = processCpuSeconds() - cpu;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

float uniform(std::mt19937& random) {
    return std::generate_canonical<float, 24>(random);
}

/** A square's next level: means over the areas that its texels cover of the finer one. */
std::vector<glm::dvec4> halved(const std::vector<glm::dvec4>& finer, std::uint32_t side) {
    const std::uint32_t half = std::max(side / 2, 1u);
    // Texel i covers the finer ones from i side / half to (i + 1) side / half: exact in integers of 1 / half.
    const auto share = [&](std::uint32_t i, std::uint32_t texel) {
        const std::uint32_t low = std::max(i * side, texel * half),
                            high = std::min((i + 1) * side, (texel + 1) * half);
        return high > low ? double(high - low) / side : 0.0;
    };
    std::vector<glm::dvec4> level(std::size_t(half) * half, glm::dvec4(0));
    for (std::uint32_t y = 0; y < half; ++y) {
        for (std::uint32_t x = 0; x < half; ++x) {
            glm::dvec4& sum = level[std::size_t(y) * half + x];
            for (std::uint32_t v = y * side / half; v * half < (y + 1) * side; ++v)
                for (std::uint32_t u = x * side / half; u * half < (x + 1) * side; ++u)
                    sum += share(x, u) * share(y, v) * finer[std::size_t(v) * side + u];
        }
    }
    return level;
}

/** A sphere of radius 1 with bumps, closed, of about so many triangles. */
Scene bumpyBall(std::uint32_t triangles) {
    const auto across = std::uint32_t(std::max(4.0, std::round(std::sqrt(double(triangles)))));
    const std::uint32_t down = std::max(across / 2, 2u);
    Primitive ball;
    for (std::uint32_t j = 0; j <= down; ++j) {
        const double polar = std::numbers::pi * j / down;
        for (std::uint32_t i = 0; i < across; ++i) {
            const double turn = 2 * std::numbers::pi * i / across;
            const double radius = 1 + 0.1 * std::sin(7 * turn) * std::sin(9 * polar) * std::sin(polar);
            ball.positions.emplace_back(radius * std::sin(polar) * std::cos(turn), radius * std::cos(polar),
                                        radius * std::sin(polar) * std::sin(turn));
        }
    }
    for (std::uint32_t j = 0; j < down; ++j) {
        for (std::uint32_t i = 0; i < across; ++i) {
            const std::uint32_t next = (i + 1) % across, a = j * across, b = (j + 1) * across;
            if (j > 0) ball.indices.insert(ball.indices.end(), {a + i, a + next, b + i});
            if (j + 1 < down) ball.indices.insert(ball.indices.end(), {a + next, b + next, b + i});
        }
    }
    Scene scene;
    scene.meshes.push_back({"", {ball}});
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    scene.roots.push_back(0);
    return scene;
}

std::vector<Ray> rays(const RayBundle& bundle, std::uint32_t seed) {
    std::mt19937 random(seed + 1);
    std::vector<Ray> all(bundle.count);
    const auto side = std::uint32_t(std::sqrt(double(bundle.count)));
    for (std::uint32_t k = 0; k < bundle.count; ++k) {
        Ray& ray = all[k];
        if (bundle.coherent) {
            const float x = (float(k % side) + uniform(random)) / float(side),
                        y = (float(k / side) + uniform(random)) / float(side);
            ray.origin = {0.3f, 0.4f, 2.6f};
            ray.direction = glm::normalize(glm::vec3(x - 0.5f, y - 0.5f, -1.0f) - glm::vec3(0.11f, 0.15f, 0));
        } else {
            const auto onSphere = [&] {
                const float z = 2 * uniform(random) - 1,
                            turn = 2 * std::numbers::pi_v<float> * uniform(random);
                const float s = std::sqrt(std::max(1 - z * z, 0.0f));
                return glm::vec3(s * std::cos(turn), s * std::sin(turn), z);
            };
            ray.origin = 1.5f * onSphere();
            ray.direction = glm::normalize(1.2f * onSphere() - ray.origin);
        }
    }
    return all;
}

/** Distance of the nearest of all triangles in double precision, nothing for none. */
std::optional<double> nearest(const Ray& ray, const Primitive& mesh) {
    const glm::dvec3 origin(ray.origin), direction(ray.direction);
    std::optional<double> result;
    for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[k]]),
            u = glm::dvec3(mesh.positions[mesh.indices[k + 1]]) - a,
            v = glm::dvec3(mesh.positions[mesh.indices[k + 2]]) - a;
        const glm::dvec3 normal = glm::cross(u, v), from = origin - a;
        const double determinant = -glm::dot(direction, normal);
        if (determinant == 0) continue;
        const glm::dvec3 across = glm::cross(from, direction);
        const double s = glm::dot(v, across) / determinant, t = -glm::dot(u, across) / determinant;
        const double distance = glm::dot(from, normal) / determinant;
        if (s < 0 || t < 0 || s + t > 1 || distance <= 0) continue;
        if (!result || distance < *result) result = distance;
    }
    return result;
}

}  // namespace

SizeResult measureMips(Device& device, bool isFloat, std::uint32_t side, std::uint32_t seed) {
    std::mt19937 random(seed + 1);
    const std::size_t count = std::size_t(side) * side;
    std::vector<std::uint32_t> words(isFloat ? 4 : count);
    std::vector<glm::vec4> floats(isFloat ? count : 1);
    std::vector<glm::dvec4> truth(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (isFloat) {
            floats[i] = {uniform(random), uniform(random), uniform(random), uniform(random)};
            truth[i] = glm::dvec4(floats[i]);
        } else {
            words[i] = std::uint32_t(random());
            for (int c = 0; c < 4; ++c) {
                const double code = double(words[i] >> (8 * c) & 255) / 255;
                truth[i][c] = c < 3 ? srgbDecode(code) : code;
            }
        }
    }
    const std::vector<glm::uvec4> headers = {{0, side, side, kMipmapped | (isFloat ? kFloatTexture : 0)}};
    DeviceBuffer table = makeBuffer(device, "bench.textures", headers);
    DeviceBuffer texels8 = makeBuffer(device, "bench.texels8", words);
    DeviceBuffer texelsFloat = makeBuffer(device, "bench.texelsFloat", floats);
    MipChains chains(device, headers);
    Graph graph(device);
    chains.declare(graph,
                   {{"uTextures", graph.import(table)},
                    {"uTexels8", graph.import(texels8), Format::R32UI},
                    {"uTexelsFloat", graph.import(texelsFloat)}},
                   {{"HAS_FLOAT_TEXTURES", isFloat}});
    Plan plan = graph.compile({.executionsInFlight = 1});
    SizeResult result;
    time(result, [&] { plan.wait(plan.execute()); });
    result.items = chains.layout().texels;

    Graph reading(device);
    const std::vector<Binding> bindings = chains.bindings(reading);
    const auto levels = reading.readback<glm::vec4>(Buffer{bindings[1].resource, bindings[1].graph});
    Plan readPlan = reading.compile({.executionsInFlight = 1});
    const std::vector<glm::vec4> made = levels.wait(readPlan.execute());
    Judge judge;
    std::size_t at = 0;
    for (std::uint32_t size = side; size > 1; size = std::max(size / 2, 1u)) {
        truth = halved(truth, size);
        for (const glm::dvec4& texel : truth) {
            for (int c = 0; c < 4; ++c) judge.add(double(made[at][c]), texel[c]);
            ++at;
        }
    }
    judge.store(result);
    return result;
}

SizeResult measureTraversal(Device& device, const RayBundle& bundle, std::uint32_t triangles,
                            std::uint32_t seed) {
    const Scene scene = bumpyBall(triangles);
    const PackedScene packed = packScene(scene);
    const std::vector<Ray> sent = rays(bundle, seed);
    RayIntersector intersector(device, packed, bundle.closest ? RayQuestion::Closest : RayQuestion::Any,
                               sent.size());
    intersector.upload(sent);
    SizeResult result;
    time(result, [&] { intersector.run(); });
    result.items = sent.size();
    const std::vector<RayHit> hits = intersector.hits();
    Judge judge;
    for (std::size_t k = 0; k < kJudgedRays; ++k) {
        const std::size_t i = (k * 2654435761u + seed) % sent.size();
        const std::optional<double> truth = nearest(sent[i], scene.meshes[0].primitives[0]);
        const bool isHit = hits[i].slot >= 0;
        if (bundle.closest)
            judge.add(isHit ? double(hits[i].distance) : 0.0, truth.value_or(0.0));
        else
            judge.add(isHit, truth.has_value());
    }
    judge.store(result);
    return result;
}

}  // namespace helio::cli
