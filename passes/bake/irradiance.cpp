#include "passes/bake/atlas.hpp"
#include "passes/film/film.hpp"
#include "passes/pathtrace/path_tracer.hpp"

#include <heliograph/bake.hpp>
#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace helio {
namespace {

/** Texels whose paths are traced at once: pixels of a film. */
constexpr std::uint32_t kFilmSide = 512;
/** Samples between two looks at whether the application stops. */
constexpr std::uint32_t kSamplesAtOnce = 64;

/** Mean radiance over pi of the paths of every point, two texels each; nothing where it was stopped. */
std::optional<std::vector<glm::vec4>> gathered(Device& device, DeviceScene& scene, PathTraceOptions trace,
                                               const std::function<bool(std::uint32_t)>& progress) {
    Film film(device, trace.size[0], trace.size[1]);
    {
        Graph graph(device);
        declareFilmClear(graph, film, film.import(graph));
        Plan plan = graph.compile();
        plan.wait(plan.execute());
    }
    PathTracer tracer(device, scene, Camera{}, glm::dmat4(1.0), trace, film);
    for (std::uint32_t end = 0; end < trace.samples;) {
        end = std::min(end + kSamplesAtOnce, trace.samples);
        while (!tracer.advance(end))
            if (!progress(end)) return {};
        if (!progress(end)) return {};
    }
    Graph graph(device);
    const ResolvedFilm resolved = declareFilmResolve(graph, film, film.import(graph));
    const auto mean = graph.readback<glm::vec4>(resolved.mean);
    Plan plan = graph.compile();
    return mean.wait(plan.execute());
}

}  // namespace

ImageF bakeIrradiance(Device& device, const Scene& scene, const BakeOptions& options) {
    scene.validate();
    bake::check(scene, options);
    const std::vector<Instance> instances = scene.instances();
    const std::vector<bake::AtlasTexel> texels =
        bake::atlasTexels(scene, instances[bake::chosenInstance(scene, instances, options.node)],
                          options.texcoord, options.size);

    PathTraceOptions trace;
    trace.maxDepth = options.maxDepth < 0 ? kUnlimitedDepth : std::uint32_t(options.maxDepth);
    trace.samples = options.samples;
    trace.seed = options.seed;
    trace.meter = Meter{};
    const PackOptions pack = PathTracer::packOptions(scene, trace);
    DeviceScene uploaded(device, scene, pack);
    // Paths leave from before the surface by the rounding of points in the scene, as those of meters do.
    const Scene::Bounds bounds = scene.bounds();
    const glm::dvec3 extent = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));

    const std::size_t all = std::size_t(options.size) * options.size;
    std::vector<float> values[3] = {std::vector<float>(all), std::vector<float>(all),
                                    std::vector<float>(all)};
    std::vector<bool> covered(all);
    constexpr std::size_t most = std::size_t(kFilmSide) * kFilmSide;
    for (std::size_t first = 0; first < texels.size(); first += most) {
        const std::size_t count = std::min(most, texels.size() - first);
        const auto width = std::uint32_t(std::min<std::size_t>(count, kFilmSide));
        trace.size = {width, std::uint32_t((count + width - 1) / width)};
        trace.meterPoints.clear();
        for (std::size_t i = 0; i < std::size_t(trace.size[0]) * trace.size[1]; ++i) {
            const bake::AtlasTexel& texel = texels[first + std::min(i, count - 1)];
            const double lift = 0x1.4p-21 * glm::dot(glm::abs(texel.face), extent);
            trace.meterPoints.emplace_back(glm::vec3(texel.position + lift * texel.face), 1.0f);
            trace.meterPoints.emplace_back(glm::vec3(texel.normal), 0.0f);
        }
        const auto mean = gathered(device, uploaded, trace, [&](std::uint32_t samples) {
            return !options.progress ||
                   options.progress((double(first) + double(count) * samples / options.samples) /
                                    double(texels.size()));
        });
        if (!mean) return {};
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t at = texels[first + i].texel;
            for (glm::length_t c = 0; c < 3; ++c)
                values[c][at] = float(std::numbers::pi * double((*mean)[i][c]));
            covered[at] = true;
        }
    }
    ImageF image{options.size, options.size, {"R", "G", "B"}, std::vector<float>(all * 3), {}};
    for (std::size_t c = 0; c < 3; ++c) {
        bake::fillGaps(values[c], covered, options.size);
        for (std::size_t i = 0; i < all; ++i) image.data[i * 3 + c] = values[c][i];
    }
    return image;
}

void setLightmap(Scene& scene, const std::string& node, int texcoord, const ImageF& image) {
    const int channels[3] = {image.channel("R"), image.channel("G"), image.channel("B")};
    const auto refuse = [&](const std::string& place, const std::string& fault, const std::string& remedy) {
        throw InputError(scene.name, place, fault, remedy);
    };
    TextureImage texels{"lightmap", image.width, image.height, std::vector<float>()};
    auto& values = std::get<std::vector<float>>(texels.texels);
    if (std::ranges::any_of(channels, [](int c) { return c < 0; }))
        refuse("lightmap", "the image has no R, G and B", "give one that was baked");
    for (std::size_t i = 0; i < std::size_t(image.width) * image.height; ++i) {
        for (const int c : channels) {
            values.push_back(image.data[i * image.channels.size() + std::size_t(c)]);
            if (!(std::isfinite(values.back()) && values.back() >= 0))
                refuse("lightmap", fmt::format("holds the value {}", values.back()),
                       "give one that was baked");
        }
        values.push_back(1.0f);
    }
    const auto shows = [&](const Node& n) { return n.mesh >= 0 && (node.empty() || n.name == node); };
    const auto found = std::ranges::find_if(scene.nodes, shows);
    if (found == scene.nodes.end())
        refuse("lightmap", fmt::format("no node '{}' has a mesh", node), "name one that has");
    Mesh mesh = scene.meshes[std::size_t(found->mesh)];
    Texture texture;
    texture.image = int(scene.images.size());
    texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    for (Primitive& p : mesh.primitives) {
        if (texcoord < 0 || std::size_t(texcoord) >= p.texcoords.size())
            refuse(fmt::format("mesh {}", found->mesh),
                   fmt::format("has no texture coordinates {}", texcoord),
                   "unwrap it, or choose another set");
        Material material = p.material < 0 ? Material{} : scene.materials[std::size_t(p.material)];
        material.lightmapTexture.texture = int(scene.textures.size());
        material.lightmapTexture.texcoord = texcoord;
        p.material = int(scene.materials.size());
        scene.materials.push_back(std::move(material));
    }
    scene.images.push_back(std::move(texels));
    scene.textures.push_back(texture);
    found->mesh = int(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
}

}  // namespace helio
