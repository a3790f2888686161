#include "passes/shade/shade.hpp"

#include "passes/raster/push.hpp"
#include "passes/scene/material_layout.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/shade.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <span>
#include <string>

namespace helio {
namespace {

/** Lights up to which each has code of its own (addLights of shaders/raster/shading.glsl). */
constexpr std::uint32_t kFewLights = 4;

/** Lights of one pass: some drivers end loops silently after 65,535 iterations. */
constexpr std::uint32_t kLightsPerPass = 8192;

/** Lights are drawn where there are so many times as many as are drawn: near small ones a pixel's draw is
 * rough, and few cost little. */
constexpr std::uint32_t kManyLights = 16;

/** Lights for which there may be maps: none where the table is too long to be kept on the host. */
std::uint32_t shadowedLights(const PackedScene& scene) {
    const bool kept = scene.lights.size() >= std::size_t(scene.lightCount) * kLightTexels;
    return scene.punctualLights && kept ? scene.lightCount : 0;
}

/** Running sums of the surfaces' powers, `samples` strides of drawnIrradiance() in all; every light has some.
 */
std::vector<std::uint32_t> lightSums(std::span<const float> chances, std::uint32_t samples) {
    const std::size_t count = chances.size();
    const auto chance = [&](std::size_t light) { return std::max(double(chances[light]), 1e-30); };
    double total = 0;
    for (std::size_t i = 0; i < count; ++i) total += chance(i);
    const double all = double(0xffffffffu / samples) * samples;
    std::vector<std::uint32_t> sums{0};
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        sum += chance(i) / total;
        const double least = double(sums.back()) + 1, most = all - double(count - 1 - i);
        sums.push_back(std::uint32_t(std::clamp(std::round(sum * all), least, most)));
    }
    return sums;
}

/** uEnvironment of shaders/raster/shading.glsl. */
std::vector<glm::vec4> surroundings(const PackedScene& scene) {
    assert((scene.environmentSize[0] == 0 || !scene.diffuseEnvironment.empty()) &&
           "pack scenes for shading with PackOptions::diffuseEnvironment");
    std::vector<glm::vec4> texels{glm::vec4(scene.environment, 0.0f)};
    texels.insert(texels.end(), scene.diffuseEnvironment.begin(), scene.diffuseEnvironment.end());
    return texels;
}

}  // namespace

ShadePipeline::ShadePipeline(Device& device, DeviceScene& scene)
    : ShadePipeline(device, scene, {}, {.kind = Shadows::Kind::None}) {}

ShadePipeline::ShadePipeline(Device& device, DeviceScene& scene, const Scene::Bounds& bounds,
                             const Shadows& shadows, TextureFilter filter, std::uint32_t lightSamples,
                             Shading shading)
    : device_(device),
      scene_(scene),
      filter_(scene.info().textures.empty() ? TextureFilter::Bilinear : filter),
      shading_(shading),
      mips_(device,
            filter_ >= TextureFilter::Trilinear ? std::span<const glm::uvec4>(scene.info().textures)
                                                : std::span<const glm::uvec4>(),
            filter_ == TextureFilter::Ripmap),
      shadowKind_(shadows.kind),
      shadows_(device, scene.info().lights, shadowedLights(scene.info()), bounds, shadows),
      surfaceLights_(std::uint32_t(scene.info().surfaceLightChances.size())),
      lightSamples_(surfaceLights_ > kManyLights * lightSamples ? lightSamples : 0),
      lightSums_(makeBuffer(device, "shade.lightSums",
                            lightSamples_ > 0 ? lightSums(scene.info().surfaceLightChances, lightSamples_)
                                              : std::vector<std::uint32_t>{0})),
      environment_(makeBuffer(device, "shade.environment", surroundings(scene.info()))),
      hasSpecularEnvironment_(shading == Shading::Material && needsSpecularEnvironment(scene)),
      specularEnvironment_(makeSpecularEnvironment(device, scene, hasSpecularEnvironment_)),
      maxStorageBufferRange_(device.info().maxStorageBufferRange) {}

void ShadePipeline::declareMips(Graph& graph) {
    mips_.declare(graph, scene_.bindings(graph, {"uTextures", "uTexels8", "uTexelsFloat"}),
                  scene_.constants({"HAS_FLOAT_TEXTURES", "HAS_LINEAR_TEXTURES"}));
}

RasterTriangles ShadePipeline::triangles(Graph& graph) {
    const std::vector<Binding> bindings = scene_.bindings(graph, {"uTriangles"});
    return {Buffer{bindings[0].resource, bindings[0].graph}, scene_.info().triangleCount};
}

/** What both ways of shading bind. */
struct ShadePipeline::Common {
    Buffer slots, environment;
    SpecConstants spec, firstSpec;
    std::vector<Binding>
        surroundings;  ///< the image behind the scene and what is glossy's of it, where needed
    bool hasImage = false, hasSpecular = false;
    std::map<std::string, std::string> materials;  ///< definitions for more than diffuse surfaces
    std::map<std::string, std::string> model;  ///< other definitions: Blinn and Phong's model, solid textures
    std::uint32_t firstLight = 0;              ///< of those that are taken one by one
    std::vector<Binding> drawnLights;          ///< where lights are drawn
    std::vector<Binding> corners;              ///< where light is found for corners
    /** A kernel for these materials; the one that shows the surroundings where there is an image of them. */
    Kernel kernel(const Kernel& plain, bool surroundingsToo = true) const {
        std::map<std::string, std::string> defines = materials;
        defines.insert(model.begin(), model.end());
        if (hasImage && surroundingsToo) defines["ENVIRONMENT_IMAGE"] = "1";
        if (hasSpecular && surroundingsToo) defines["SPECULAR_ENVIRONMENT"] = "1";
        if (!drawnLights.empty() && surroundingsToo) defines["DRAWN_LIGHTS"] = "1";
        if (defines.empty()) return plain;
        return compileVariant(plain, {.defines = defines, .generated = {}});
    }
};

std::uint64_t ShadePipeline::cornersShaded() const {
    const std::uint64_t each = shading_ == Shading::Flat ? 1 : shading_ == Shading::Gouraud ? 3 : 0;
    return each * scene_.info().triangleCount;
}

/** The light on every corner or triangle, which pixels interpolate. */
void ShadePipeline::declareCorners(Graph& graph, std::shared_ptr<const RasterView> view, Common& common) {
    const std::uint64_t corners = cornersShaded();
    if (corners == 0) return;
    if (corners * 32 > maxStorageBufferRange_)
        throw InputError("", "shading",
                         fmt::format("{} triangles have more corners than the device binds at once",
                                     scene_.info().triangleCount),
                         "shade each pixel: --shading phong");
    // Of the dispatch, which has at most 65,535 workgroups each way.
    auto width = std::uint32_t(1024);
    while (corners / width >= 65535) width *= 2;
    const auto height = std::uint32_t((corners + width - 1) / width);
    const Buffer light = graph.buffer("shade.cornerLight", {corners * 32});
    common.model["CORNERS"] = shading_ == Shading::Flat ? "1" : "3";
    const std::uint32_t lights = scene_.info().lightCount, begin = common.firstLight;
    for (std::uint32_t first = begin; first == begin || first < lights; first += kLightsPerPass) {
        const std::uint32_t count = std::min(kLightsPerPass, lights - first);
        SpecConstants spec = common.firstSpec;
        if (first != begin) spec["LIGHT_SAMPLES"] = 0;
        spec["FIRST_LIGHTS"] = first == begin;
        Pass pass = graph.compute("shade.corners", common.kernel(shaders::shadeCorners), {.spec = spec});
        bindScene(graph, pass, common);
        pass.reads({{"uEnvironment", common.environment, Format::RGBA32F}})
            .reads(common.surroundings)
            .reads(common.drawnLights)
            .record([view, first, count, width, height](Commands& c) {
                c.push(makeRasterPush(*view, 0, first, count)).dispatchOver(width, height);
            });
        if (first == begin)
            pass.overwrites({{"uLight", light}});
        else
            pass.modifies({{"uLight", light}});
    }
    common.corners = {{"uCornerLight", light, Format::RGBA32F}};
}

/** Places of triangles by their ids; anything where they lie in that order. */
Buffer ShadePipeline::declareSlots(Graph& graph) {
    // Keys hold ids in scene order; a tree keeps its triangles in its own.
    if (inSceneOrder()) return graph.import(environment_);
    const std::uint32_t triangleCount = scene_.info().triangleCount;
    const Buffer slots = graph.buffer("shade.slots", {std::uint64_t(triangleCount) * 4});
    graph.compute("shade.slots", shaders::shadeSlots)
        .reads(scene_.bindings(graph, {"uTriangles"}))
        .overwrites({{"uSlots", slots}})
        .record([triangleCount](Commands& c) {
            constexpr std::uint32_t most = 1u << 21;
            for (std::uint32_t first = 0; first < triangleCount; first += most)
                c.push(std::array{first, triangleCount})
                    .dispatchInvocations(std::min(most, triangleCount - first));
        });
    return slots;
}

/** TEXTURE_FILTER. */
std::int32_t ShadePipeline::filterConstant(TextureFilter filter) const {
    // Without any mip level the trilinear filter is the bilinear.
    const bool bilinear = filter == TextureFilter::Trilinear && !mips_.needed();
    return std::int32_t(bilinear ? TextureFilter::Bilinear : filter);
}

ShadePipeline::Common ShadePipeline::declareCommon(Graph& graph, std::shared_ptr<const RasterView> view) {
    Common common;
    common.environment = graph.import(environment_);
    common.slots = declareSlots(graph);
    common.spec = scene_.constants({"HAS_NORMALS", "HAS_COLORS", "HAS_BASE_TEXTURES", "HAS_EMISSION",
                                    "HAS_EMISSION_TEXTURES", "HAS_FLOAT_TEXTURES", "HAS_AREA_LIGHTS",
                                    "HAS_PUNCTUAL_LIGHTS", "HAS_TRIANGLE_LIGHTS"});
    if (scene_.info().materialFeatures != 0) {
        common.materials["SURFACE_MATERIALS"] = fmt::format("0x{:x}u", scene_.info().materialFeatures);
        common.spec.merge(scene_.constants(
            {"ALBEDO_TABLES", "HAS_ROUGH_FACETS", "HAS_TILTED_LOBES", "HAS_LINEAR_TEXTURES"}));
    }
    if (scene_.info().normalLevels && mips_.needed()) common.materials["FOOTPRINT_NORMALS"] = "1";
    if (scene_.info().occlusionTextures) {
        common.model["OCCLUSION"] = "1";
        common.spec.merge(scene_.constants({"HAS_LINEAR_TEXTURES"}));
    }
    if (scene_.info().lightmaps) {
        common.model["LIGHTMAPS"] = "1";
        common.spec.merge(scene_.constants({"HAS_LINEAR_TEXTURES"}));
    }
    common.spec["TEXTURE_FILTER"] = filterConstant(filter_);
    common.spec["SCENE_ORDER"] = inSceneOrder();
    common.spec["ORTHOGRAPHIC"] = view->orthographic;
    common.spec["SHADOWS"] = std::int32_t(shadows_.needed() ? shadowKind_ : Shadows::Kind::None);
    // Shadow maps' code is too long to be there several times.
    const std::uint32_t single = scene_.info().lightCount - (lightSamples_ > 0 ? surfaceLights_ : 0);
    common.spec["FEW_LIGHTS"] = std::int32_t(single <= (shadows_.needed() ? 1u : kFewLights) ? single : 0);
    common.firstSpec = common.spec;
    if (lightSamples_ > 0) {
        common.firstSpec["LIGHT_SAMPLES"] = std::int32_t(lightSamples_);
        common.firstSpec["AREA_LIGHTS"] = std::int32_t(surfaceLights_);
        common.firstLight = surfaceLights_;
        common.drawnLights = {{"uLightSums", graph.import(lightSums_), Format::R32UI}};
    }
    common.firstSpec.merge(scene_.constants({"HAS_ENVIRONMENT"}));
    common.firstSpec.merge(scene_.environmentConstants());
    common.hasImage = scene_.hasEnvironmentImage();
    if (common.hasImage) common.surroundings = scene_.bindings(graph, {"uEnvironmentMap"});
    common.hasSpecular = hasSpecularEnvironment_;
    if (common.hasSpecular)
        common.surroundings.emplace_back("uSpecularEnvironment", graph.import(specularEnvironment_),
                                         Format::RGBA32F);
    if (scene_.info().solidTextures) common.model["SOLID_TEXTURES"] = "1";
    if (shading_ != Shading::Material) common.model["BLINN_PHONG"] = "1";
    declareCorners(graph, std::move(view), common);
    return common;
}

void ShadePipeline::bindScene(Graph& graph, Pass& pass, const Common& common) {
    pass.reads(scene_.bindings(graph, {"uTriangles", "uNormals", "uTexcoords", "uColors", "uMaterials",
                                       "uLights", "uTextures", "uTexels8", "uTexelsFloat", "uInstanceFirst"}))
        .reads(mips_.bindings(graph))
        .reads(shadows_.bindings(graph))
        .reads({{"uSlots", common.slots, Format::R32UI}})
        .reads(common.corners);
    if (!common.materials.empty()) pass.reads(scene_.bindings(graph, {"uTangents"}));
    if (scene_.info().solidTextures) pass.reads(scene_.bindings(graph, {"uSolidPoints"}));
}

ShadeOutput ShadePipeline::declare(Graph& graph, const RasterOutput& raster,
                                   std::shared_ptr<const RasterView> view) {
    const std::uint64_t pixels = std::uint64_t(view->width) * view->height;
    const Common common = declareCommon(graph, view);
    ShadeOutput output;
    output.color = graph.buffer("shade.color", {pixels * 16});
    output.albedoDepth = graph.buffer("shade.albedoDepth", {pixels * 16});
    output.normal = graph.buffer("shade.normal", {pixels * 16});
    output.ids = graph.buffer("shade.ids", {pixels * 8});

    const std::uint32_t begin = common.firstLight;
    const std::uint32_t lights = common.corners.empty() ? scene_.info().lightCount : begin;
    for (std::uint32_t first = begin; first == begin || first < lights; first += kLightsPerPass) {
        const std::uint32_t count = std::min(kLightsPerPass, lights - std::min(lights, first));
        Pass pass = first == begin ? graph.compute("shade.surface", common.kernel(shaders::shadeSurface),
                                                   {.spec = common.firstSpec})
                                   : graph.compute("shade.lights", common.kernel(shaders::shadeLights, false),
                                                   {.spec = common.spec});
        bindScene(graph, pass, common);
        pass.reads({{"uVisibility", raster.visibility}}).record([view, first, count](Commands& c) {
            c.push(makeRasterPush(*view, 0, first, count)).dispatchOver(view->width, view->height);
        });
        if (first == begin)
            pass.reads({{"uEnvironment", common.environment, Format::RGBA32F}})
                .reads(common.surroundings)
                .reads(common.drawnLights)
                .overwrites({{"uColor", output.color},
                             {"uAlbedoDepth", output.albedoDepth},
                             {"uNormal", output.normal},
                             {"uIds", output.ids}});
        else
            pass.modifies({{"uColor", output.color}});
    }
    return output;
}

MultisampleOutput ShadePipeline::declareMultisample(Graph& graph, Buffer visibility, std::uint32_t samples,
                                                    std::shared_ptr<const RasterView> view) {
    const std::uint64_t pixels = std::uint64_t(view->width) * view->height;
    const Common common = declareCommon(graph, view);
    MultisampleOutput output;
    output.color = graph.buffer("shade.color", {pixels * 16});
    output.shadings = graph.buffer("shade.shadings", {pixels * 4});
    const std::uint32_t begin = common.firstLight;
    const std::uint32_t lights = common.corners.empty() ? scene_.info().lightCount : begin;
    for (std::uint32_t first = begin; first == begin || first < lights; first += kLightsPerPass) {
        const std::uint32_t count = std::min(kLightsPerPass, lights - first);
        SpecConstants spec = common.firstSpec;
        if (first != begin) spec["LIGHT_SAMPLES"] = 0;
        spec["SAMPLES"] = std::int32_t(samples);
        spec["SAMPLE_KEYS"] = std::int32_t(rasterStride(view->width, view->height) / 8);
        spec["FIRST_LIGHTS"] = first == begin;
        Pass pass =
            graph.compute("shade.multisample", common.kernel(shaders::shadeMultisample), {.spec = spec});
        bindScene(graph, pass, common);
        pass.reads({{"uVisibility", visibility}, {"uEnvironment", common.environment, Format::RGBA32F}})
            .reads(common.surroundings)
            .reads(common.drawnLights)
            .record([view, first, count](Commands& c) {
                c.push(makeRasterPush(*view, 0, first, count)).dispatchOver(view->width, view->height);
            });
        if (first == begin)
            pass.overwrites({{"uColor", output.color}, {"uShadings", output.shadings}});
        else
            pass.modifies({{"uColor", output.color}, {"uShadings", output.shadings}});
    }
    return output;
}

std::pair<Kernel, SpecConstants> ShadePipeline::surfaceKernel(const RasterView& view) {
    Graph graph(device_);  // never compiled
    const Common common = declareCommon(graph, std::make_shared<const RasterView>(view));
    return {common.kernel(shaders::shadeSurface), common.firstSpec};
}

bool ShadePipeline::seesThrough() const {
    return (scene_.info().materialFeatures & pack::kAlphaFeature) != 0 || transmits();
}

bool ShadePipeline::transmits() const {
    return scene_.info().transmits() && shading_ == Shading::Material;
}

void ShadePipeline::declareLayer(Graph& graph, Buffer visibility, const LayerTarget& target,
                                 std::shared_ptr<const RasterView> view) {
    Common common = declareCommon(graph, view);
    if (transmits()) common.model["TRANSMISSION"] = scattersThrough() ? "2" : "1";
    const std::uint32_t first = common.firstLight;
    const std::uint32_t count = std::min(kLightsPerPass, scene_.info().lightCount - first);
    Pass pass = graph.compute("shade.layer", common.kernel(shaders::shadeLayer), {.spec = common.firstSpec});
    bindScene(graph, pass, common);
    pass.reads({{"uVisibility", visibility}, {"uEnvironment", common.environment, Format::RGBA32F}})
        .reads(common.surroundings)
        .reads(common.drawnLights)
        .modifies({{"uColor", target.color},
                   {"uAlbedoDepth", target.albedoDepth},
                   {"uNormal", target.normal},
                   {"uIds", target.ids},
                   {"uLimit", target.limit},
                   {"uOpen", target.open}})
        .record([view, first, count, leftOut = target.leftOut](Commands& c) {
            c.push(makeRasterPush(*view, leftOut ? *leftOut : 0, first, count))
                .dispatchOver(view->width, view->height);
        });
    if (transmits())
        pass.modifies({{"uPassed", target.passed}})
            .reads(target.behind)
            .reads(scene_.bindings(graph, {"uInstanceScales"}));
}

void ShadePipeline::declareMask(Graph& graph, Buffer visibility, const MaskTarget& target,
                                std::shared_ptr<const RasterView> view,
                                std::shared_ptr<const std::uint32_t> firstKey) {
    SpecConstants spec = scene_.constants({"HAS_COLORS", "HAS_BASE_TEXTURES", "HAS_FLOAT_TEXTURES"});
    spec["TEXTURE_FILTER"] = filterConstant(target.filter);
    spec["SCENE_ORDER"] = inSceneOrder();
    spec["ORTHOGRAPHIC"] = view->orthographic;
    graph.compute("shade.mask", shaders::shadeMask, {.spec = spec})
        .reads(scene_.bindings(graph, {"uTriangles", "uTexcoords", "uColors", "uMaterials", "uTextures",
                                       "uTexels8", "uTexelsFloat"}))
        .reads(mips_.bindings(graph))
        .reads({{"uVisibility", visibility}, {"uSlots", declareSlots(graph), Format::R32UI}})
        .modifies({{"uLimit", target.limit}, {"uOpen", target.open}})
        .writes({{"uKeys", target.keys}})
        .record([view, firstKey](Commands& c) {
            c.push(makeRasterPush(*view, 0, *firstKey, 0)).dispatchOver(view->width, view->height);
        });
}

std::vector<std::pair<std::string, std::string>> ShadePipeline::skipped() const {
    std::vector<std::pair<std::string, std::string>> result;
    const PackedScene& info = scene_.info();
    const bool lit = info.lightCount > 0 || info.environment != glm::vec3(0.0f);
    if (lit) {
        const bool areas =
            info.areaLights || scene_.hasEnvironmentImage() || info.environment != glm::vec3(0.0f);
        const bool without =
            info.punctualLights && (!shadows_.needed() || shadows_.layout().lightsWithout > 0);
        if (areas)
            result.emplace_back(
                "shadows",
                "the raster pipeline has shadows of punctual lights only; the path pipeline has all");
        if (without)
            result.emplace_back("shadows of punctual lights",
                                shadowKind_ == Shadows::Kind::None
                                    ? "--shadows none asked for that"
                                    : "there is no room for maps of so many lights");
        if (blends() && shadows_.needed())
            result.emplace_back("blending in shadows",
                                "shadow maps take blended surfaces as opaque; the path pipeline does not");
        if (seesThrough() && info.lightCount - (lightSamples_ > 0 ? surfaceLights_ : 0) > kLightsPerPass)
            result.emplace_back("lights", fmt::format("layers take the first {} lights", kLightsPerPass));
        result.emplace_back("indirect light",
                            "the raster pipeline shades direct light; the path pipeline has all");
    }
    if (info.transmits() && !transmits())
        result.emplace_back("transmission",
                            "Blinn and Phong's model has no light that goes through surfaces");
    if (info.occlusionTextures && cornersShaded() > 0)
        result.emplace_back("occlusion textures", "flat and Gouraud shading find all light at corners");
    for (const auto& skipped : info.rasterSkipped) result.push_back(skipped);
    if (lightSamples_ > 0)
        result.emplace_back("light of every emissive surface",
                            fmt::format("a pixel draws {} of {}; --light-samples 0 takes all", lightSamples_,
                                        surfaceLights_));
    if (info.texturedEmission && info.areaLights)
        result.emplace_back("texture of emission over a light",
                            "the raster pipeline takes its mean over each triangle");
    return result;
}

}  // namespace helio
