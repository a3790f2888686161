#include "passes/shade/shade.hpp"

#include "passes/raster/push.hpp"

#include <heliograph_kernels/shade.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace helio {
namespace {

/** Lights of one pass: some drivers end loops silently after 65,535 iterations. */
constexpr std::uint32_t kLightsPerPass = 8192;

}  // namespace

ShadePipeline::ShadePipeline(Device& device, DeviceScene& scene)
    : scene_(scene),
      mips_(device, scene.info().textures),
      environment_(
          makeBuffer(device, "shade.environment", std::array{glm::vec4(scene.info().environment, 0.0f)})),
      maxStorageBufferRange_(device.info().maxStorageBufferRange) {}

void ShadePipeline::declareMips(Graph& graph) {
    mips_.declare(graph, scene_.bindings(graph, {"uTextures", "uTexels8", "uTexelsFloat"}),
                  scene_.constants({"HAS_FLOAT_TEXTURES"}));
}

RasterTriangles ShadePipeline::triangles(Graph& graph) {
    const std::vector<Binding> bindings = scene_.bindings(graph, {"uTriangles"});
    return {Buffer{bindings[0].resource, bindings[0].graph}, scene_.info().triangleCount};
}

ShadeOutput ShadePipeline::declare(Graph& graph, const RasterOutput& raster,
                                   std::shared_ptr<const RasterView> view) {
    const std::uint64_t pixels = std::uint64_t(view->width) * view->height;
    const std::uint32_t triangleCount = scene_.info().triangleCount;
    const bool sceneOrder = scene_.info().nodeCount == 0;
    const Buffer environment = graph.import(environment_);

    // Keys hold ids in scene order; a tree keeps its triangles in its own.
    Buffer slots = environment;
    if (!sceneOrder) {
        slots = graph.buffer("shade.slots", {std::uint64_t(triangleCount) * 4});
        graph.compute("shade.slots", shaders::shadeSlots)
            .reads(scene_.bindings(graph, {"uTriangles"}))
            .overwrites({{"uSlots", slots}})
            .record([triangleCount](Commands& c) {
                constexpr std::uint32_t most = 1u << 21;
                for (std::uint32_t first = 0; first < triangleCount; first += most)
                    c.push(std::array{first, triangleCount})
                        .dispatchInvocations(std::min(most, triangleCount - first));
            });
    }

    SpecConstants spec = scene_.constants({"HAS_NORMALS", "HAS_COLORS", "HAS_BASE_TEXTURES", "HAS_EMISSION",
                                           "HAS_EMISSION_TEXTURES", "HAS_FLOAT_TEXTURES", "HAS_AREA_LIGHTS",
                                           "HAS_PUNCTUAL_LIGHTS", "HAS_TRIANGLE_LIGHTS"});
    spec["FILTER_MIPS"] = mips_.needed();
    spec["SCENE_ORDER"] = sceneOrder;
    spec["ORTHOGRAPHIC"] = view->orthographic;
    SpecConstants firstSpec = spec;
    firstSpec.merge(scene_.constants({"HAS_ENVIRONMENT"}));
    firstSpec.merge(scene_.environmentConstants());
    Kernel surfaceKernel = shaders::shadeSurface;
    std::vector<Binding> surroundings;
    if (scene_.hasEnvironmentImage()) {
        surfaceKernel =
            compileVariant(surfaceKernel, {.defines = {{"ENVIRONMENT_IMAGE", "1"}}, .generated = {}});
        surroundings = scene_.bindings(graph, {"uEnvironmentMap"});
    }

    ShadeOutput output;
    output.color = graph.buffer("shade.color", {pixels * 16});
    output.albedoDepth = graph.buffer("shade.albedoDepth", {pixels * 16});
    output.normal = graph.buffer("shade.normal", {pixels * 16});
    output.ids = graph.buffer("shade.ids", {pixels * 8});

    const std::uint32_t lights = scene_.info().lightCount;
    for (std::uint32_t first = 0; first == 0 || first < lights; first += kLightsPerPass) {
        const std::uint32_t count = std::min(kLightsPerPass, lights - first);
        Pass pass = first == 0 ? graph.compute("shade.surface", surfaceKernel, {.spec = firstSpec})
                               : graph.compute("shade.lights", shaders::shadeLights, {.spec = spec});
        pass.reads(scene_.bindings(
                       graph, {"uTriangles", "uNormals", "uTexcoords", "uColors", "uMaterials", "uLights",
                               "uTextures", "uTexels8", "uTexelsFloat", "uInstanceFirst"}))
            .reads(mips_.bindings(graph))
            .reads({{"uVisibility", raster.visibility}, {"uSlots", slots, Format::R32UI}})
            .record([view, first, count](Commands& c) {
                c.push(makeRasterPush(*view, 0, first, count)).dispatchOver(view->width, view->height);
            });
        if (first == 0)
            pass.reads({{"uEnvironment", environment, Format::RGBA32F}})
                .reads(surroundings)
                .overwrites({{"uColor", output.color},
                             {"uAlbedoDepth", output.albedoDepth},
                             {"uNormal", output.normal},
                             {"uIds", output.ids}});
        else
            pass.modifies({{"uColor", output.color}});
    }
    return output;
}

std::vector<std::pair<std::string, std::string>> ShadePipeline::skipped() const {
    std::vector<std::pair<std::string, std::string>> result;
    const PackedScene& info = scene_.info();
    const bool lit = info.lightCount > 0 || info.environment != glm::vec3(0.0f);
    if (lit) {
        result.emplace_back("shadows",
                            "the raster pipeline's lights are unoccluded; the path pipeline has shadows");
        result.emplace_back("indirect light",
                            "the raster pipeline shades direct light; the path pipeline has all");
        result.emplace_back("gloss and metal", "the raster pipeline shades every surface as Lambertian");
    }
    if (scene_.hasEnvironmentImage())
        result.emplace_back("light of the environment's image",
                            "the raster pipeline shows it behind the scene only");
    result.emplace_back("alpha", "the raster pipeline draws every surface as opaque");
    if (info.texturedEmission && info.areaLights)
        result.emplace_back("texture of emission over a light",
                            "the raster pipeline takes its mean over each triangle");
    return result;
}

}  // namespace helio
