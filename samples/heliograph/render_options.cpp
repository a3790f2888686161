#include "render_options.hpp"

#include <utility>

namespace helio::cli {
namespace {

template <typename Enum>
CLI::Option* addChoice(CLI::App* command, const std::string& name, Enum& value,
                       const std::vector<std::pair<std::string, Enum>>& choices, const std::string& help) {
    return command->add_option_function<std::string>(
        name,
        [&value, choices, name](const std::string& text) {
            std::string known;
            for (const auto& [key, choice] : choices) {
                if (key == text) {
                    value = choice;
                    return;
                }
                known += (known.empty() ? "" : ", ") + key;
            }
            throw CLI::ValidationError(name, "'" + text + "' is not one of " + known);
        },
        help);
}

void addSceneOptions(CLI::App* command, RenderArguments& arguments) {
    RenderOptions& options = arguments.options;
    command->option_defaults()->group("What is seen");
    command
        ->add_option("SCENE", arguments.scene,
                     "A .gltf, .glb, .obj, .ply or .stl file, or sample:NAME (see heliograph info)")
        ->required();
    command->add_option("--camera", options.camera, "Name or index of the camera; default the first");
    command->add_option("--variant", arguments.load.variant,
                        "Name of the material variant to show (KHR_materials_variants)");
    command->add_option("--animation", options.animation,
                        "Name or index of the animation; default the first; none for the pose of the nodes");
    command
        ->add_option("--frame-time", options.frameTime,
                     "Seconds at which animations, skins and morph targets are evaluated")
        ->check(CLI::Number)
        ->capture_default_str();
    command->add_option("--shutter", arguments.shutter,
                        "OPEN,CLOSE in seconds from --frame-time on: what moves meanwhile is blurred (path)");
    command
        ->add_option("--motion-steps", options.motionSteps,
                     "Straight lines in which vertices go while the shutter is open")
        ->check(CLI::Range(1u, 64u))
        ->capture_default_str();
    command->add_option("--environment", arguments.environment,
                        "R,G,B: constant radiance from everywhere; or a lat-long image file, +Y up");
    command
        ->add_option(
            "--environment-map", arguments.environmentMap,
            "What the environment's image is: latlong (default), cube, sphere; see convert-environment")
        ->check(CLI::IsMember({"latlong", "cube", "sphere"}));
    addChoice<Normals>(command, "--normals", arguments.normals,
                       {{"file", Normals::File},
                        {"flat", Normals::Flat},
                        {"equal", Normals::Equal},
                        {"area", Normals::Area},
                        {"angle", Normals::Angle}},
                       "file (default): the scene's own; flat: none; or the mean of those of the triangles "
                       "around, equal, by area or by angle");
    command
        ->add_option(
            "--displace", arguments.displacement,
            "Cut each triangle that has a map of heights into N x N and move the corners by it; without "
            "this the map tilts normals")
        ->check(CLI::Range(1u, 1024u));
    command
        ->add_option("--lightmap", arguments.lightmaps,
                     "NODE=FILE: irradiance that bake --quantity irradiance found for the node's mesh, which "
                     "the raster pipeline shows in place of the diffuse light that it would find; may be "
                     "repeated")
        ->allow_extra_args(false);
    command
        ->add_option("--lightmap-texcoord", arguments.lightmapTexcoord,
                     "The lightmaps' set of texture coordinates")
        ->check(CLI::Range(0, 7))
        ->capture_default_str();
}

void addOutputOptions(CLI::App* command, RenderArguments& arguments) {
    RenderOptions& options = arguments.options;
    command->option_defaults()->group("What is written");
    command
        ->add_option("-o,--output", arguments.outputs,
                     "Image to write, may be repeated: .exr linear with every channel, .png or .jpg sRGB")
        ->allow_extra_args(false);
    command->add_option("--size", arguments.size, "Pixels, WxH; the vertical field of view is kept")
        ->capture_default_str();
    addChoice<ToneCurve>(command, "--tonemap", arguments.display.curve,
                         {{"none", ToneCurve::None},
                          {"reinhard", ToneCurve::Reinhard},
                          {"filmic", ToneCurve::Filmic},
                          {"aces", ToneCurve::Aces}},
                         "Tone curve of PNG and JPEG images: none (default), reinhard, filmic, aces");
    command
        ->add_option("--exposure", arguments.display.exposure,
                     "Stops by which PNG and JPEG images are brighter, on top of the camera's own exposure")
        ->check(CLI::Range(-100.0, 100.0))
        ->capture_default_str();
    command->add_flag("--denoise", options.denoise,
                      "Also write each image filtered, as NAME.denoised.EXT: smoother, and biased");
    command->add_option(
        "--error-map", arguments.errorMap,
        "Image of each pixel's relative standard error: .exr as numbers, .png or .jpg in colours");
    command
        ->add_option(
            "--bounces", options.bounces,
            "Also write the light that scattered 0, 1, ... N times and more often, apart, into .exr images")
        ->check(CLI::Range(0, 64));
    command->add_option("--stats", arguments.stats, "Write the statistics as JSON");
    command->add_option("--graph", arguments.graph, "Write the render graph for Graphviz");
}

void addRunOptions(CLI::App* command, RenderArguments& arguments) {
    RenderOptions& options = arguments.options;
    command->option_defaults()->group("How it runs");
    addChoice<Pipeline>(command, "--pipeline", options.pipeline,
                        {{"path", Pipeline::Path}, {"raster", Pipeline::Raster}},
                        "path (default): unbiased path tracing; raster: z-buffer, direct light, shadow maps");
    command->add_option("--spp", options.samples, "Samples per pixel")
        ->check(CLI::Range(1u, (1u << 24) - 1))
        ->capture_default_str();
    command->add_option("--time", options.maxSeconds, "Stop after so many seconds of rendering")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--max-error", options.maxError, "Stop when the upper bound of the relMSE is below this")
        ->check(CLI::PositiveNumber);
    command->add_option("--seed", options.seed, "Seed of the random numbers")->capture_default_str();
    command->add_option("--device", arguments.device, "auto, an index or part of a name from heliograph info")
        ->capture_default_str();
    command->add_option(
        "--checkpoint", options.checkpoint,
        "File in which the render's state is saved now and then, on interruption and at the end");
    command->add_flag("--resume", options.resume, "Go on from the --checkpoint file where it is there")
        ->needs("--checkpoint");
    command->add_flag("--validate", arguments.validate,
                      "Run under Vulkan validation; a message is a failure");
    command->add_flag("--quiet", arguments.quiet, "Print only warnings and errors");
}

void addPathOptions(CLI::App* command, RenderArguments& arguments) {
    RenderOptions& options = arguments.options;
    command->option_defaults()->group("Paths (--pipeline path)");
    command->add_flag("--adaptive", options.adaptive,
                      "Take more of the samples where the error is large, --spp on average; the mean stays "
                      "unbiased");
    command
        ->add_option("--max-depth", options.maxDepth,
                     "Scatterings at most: 0 emission only, 1 direct light; default unlimited (65536)")
        ->check(CLI::Range(0, 65536));
    addChoice<PixelFilter>(command, "--filter", options.filter,
                           {{"box", PixelFilter::Box},
                            {"tent", PixelFilter::Tent},
                            {"gaussian", PixelFilter::Gaussian},
                            {"blackman-harris", PixelFilter::BlackmanHarris}},
                           "Pixel filter: box (default), tent, gaussian, blackman-harris");
    addChoice<Integrator>(
        command, "--integrator", options.integrator,
        {{"path", Integrator::Path},
         {"direct", Integrator::Direct},
         {"whitted", Integrator::Whitted},
         {"ao", Integrator::AmbientOcclusion},
         {"hemisphere", Integrator::Hemisphere},
         {"radiosity", Integrator::Radiosity}},
        "path (default): all of light's ways; direct: one scattering; whitted: mirrors, then "
        "direct light; ao: ambient occlusion; hemisphere: direct light by uniform directions; radiosity: all "
        "of diffuse light, solved over patches");
    command
        ->add_option("--patches", options.radiosityPatches,
                     "Parts that --integrator radiosity cuts the surfaces into, about")
        ->check(CLI::Range(1u, 2048u))
        ->capture_default_str();
    addChoice<SamplerKind>(
        command, "--sampler", options.sampler,
        {{"sobol", SamplerKind::Sobol},
         {"sobol-blue", SamplerKind::SobolBlue},
         {"halton", SamplerKind::Halton},
         {"stratified", SamplerKind::Stratified},
         {"independent", SamplerKind::Independent}},
        "sobol (default): Owen-scrambled; sobol-blue: error as blue noise over the screen; "
        "halton; stratified; independent");
    addChoice<NormalMapping>(
        command, "--normal-mapping", options.normalMapping,
        {{"folded", NormalMapping::Folded}, {"facets", NormalMapping::Facets}},
        "Normals that maps tilt: folded (default), no light lost, fast; facets: reciprocal too, slower");
    addChoice<LightChoice>(command, "--lights", options.lights,
                           {{"adaptive", LightChoice::Adaptive},
                            {"power", LightChoice::Power},
                            {"uniform", LightChoice::Uniform}},
                           "Choice among lights: adaptive (default) by place and normal; power; uniform");
    command
        ->add_option("--roulette", options.roulette,
                     "Paths go on with the chance min(1, this times their throughput), default 3")
        ->check(CLI::Range(1e-3, 1e30));
    command->add_option("--survival", options.survival, "That chance itself, whatever the throughput")
        ->check(CLI::Range(1e-3, 1.0))
        ->excludes("--roulette");
    command->add_flag("--no-nee", arguments.noNextEvent, "Trace without next-event estimation");
    addChoice<AcceleratorKind>(command, "--accelerator", options.accelerator,
                               {{"auto", AcceleratorKind::Auto},
                                {"bvh", AcceleratorKind::Bvh},
                                {"sbvh", AcceleratorKind::SplitBvh},
                                {"lbvh", AcceleratorKind::DeviceBvh},
                                {"brute-force", AcceleratorKind::BruteForce},
                                {"grid", AcceleratorKind::Grid},
                                {"octree", AcceleratorKind::Octree},
                                {"kd-tree", AcceleratorKind::KdTree},
                                {"bsp", AcceleratorKind::Bsp}},
                               "auto (default); bvh, sbvh (with spatial splits), lbvh (built on the device), "
                               "brute-force, grid, octree, "
                               "kd-tree, bsp: same image, other times");
    addChoice<Guiding>(
        command, "--guiding", options.guiding,
        {{"auto", Guiding::Auto}, {"on", Guiding::On}, {"off", Guiding::Off}},
        "Photons show paths the way to caustics: auto (default), where that pays; on, wherever "
        "there are mirrors or glass, and lamps; off: same image, other noise");
    addChoice<Scheduler>(command, "--scheduler", options.scheduler,
                         {{"auto", Scheduler::Auto},
                          {"megakernel", Scheduler::Megakernel},
                          {"wavefront", Scheduler::Wavefront}},
                         "auto (default); megakernel, wavefront: same image, other times");
}

void addRasterOptions(CLI::App* command, RenderArguments& arguments) {
    RenderOptions& options = arguments.options;
    command->option_defaults()->group("Rasterization (--pipeline raster)");
    addChoice<bool>(command, "--cull", options.cullBackFaces, {{"none", false}, {"back", true}},
                    "none (default) or back: faces the raster pipeline leaves out");
    command->add_option(
        "--aa", arguments.antialiasing,
        "Antialiasing of the raster pipeline: none (default), fxaa, msaa2, msaa4, msaa8, msaa16; "
        "each sample shaded: ssaaN, gridN, jitterN (N x N), randomN; or a sample a frame, mixed over "
        "--frames: taa, and taau2, taau3, taau4 from frames of 1/2, 1/3, 1/4 the size each way");
    command
        ->add_option("--frames", arguments.frames,
                     "Frames that --aa taa draws; the picture is the last, at --frame-time")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    command->add_option("--frame-rate", arguments.frameRate, "Of those frames, a second")
        ->check(CLI::Range(1e-6, 1e6))
        ->capture_default_str();
    addChoice<TextureFilter>(command, "--texture-filter", options.textureFilter,
                             {{"nearest", TextureFilter::Nearest},
                              {"bilinear", TextureFilter::Bilinear},
                              {"bicubic", TextureFilter::CatmullRom},
                              {"bspline", TextureFilter::BSpline},
                              {"trilinear", TextureFilter::Trilinear},
                              {"anisotropic", TextureFilter::Anisotropic},
                              {"ewa", TextureFilter::Ewa},
                              {"ripmap", TextureFilter::Ripmap}},
                             "nearest, bilinear, bicubic, bspline, trilinear (default), "
                             "anisotropic, ewa, ripmap");
    addChoice<DepthFormat>(command, "--depth", options.depthFormat,
                           {{"reversed", DepthFormat::Reversed},
                            {"float", DepthFormat::Float},
                            {"unorm24", DepthFormat::Unorm24},
                            {"unorm16", DepthFormat::Unorm16}},
                           "reversed (default, float32 without a far plane); "
                           "to compare, over the camera's znear to zfar: float, unorm24, unorm16");
    addChoice<Shading>(command, "--shading", options.shading,
                       {{"material", Shading::Material},
                        {"flat", Shading::Flat},
                        {"gouraud", Shading::Gouraud},
                        {"phong", Shading::Phong}},
                       "material (default), each pixel by its material; flat, gouraud "
                       "or phong: Blinn and Phong's model once for each triangle, corner or pixel");
    command
        ->add_option("--light-samples", options.lightSamples,
                     "Emissive surfaces that a pixel of the raster pipeline draws where there are over 16 "
                     "times as many; "
                     "default 64, 0: all")
        ->check(CLI::Range(0u, 4096u));
    addChoice<Shadows::Kind>(
        command, "--shadows", options.shadows.kind,
        {{"none", Shadows::Kind::None},
         {"hard", Shadows::Kind::Hard},
         {"pcf", Shadows::Kind::Filtered},
         {"pcss", Shadows::Kind::Soft},
         {"variance", Shadows::Kind::Variance}},
        "Shadow maps of the raster pipeline's punctual lights: none, hard, pcf (default), pcss "
        "(of lights of --light-size), variance");
    command
        ->add_option("--shadow-resolution", options.shadows.resolution,
                     "Texels of a shadow map each way; default 2048, 1024 for faces of a point light's cube")
        ->check(CLI::Range(16u, 4096u));
    command
        ->add_option(
            "--light-size", options.shadows.lightSize,
            "Radius of punctual lights for pcss; of directional ones the tangent of their half angle")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
}

}  // namespace

void addRenderOptions(CLI::App& command, RenderArguments& arguments) {
    addSceneOptions(&command, arguments);
    addOutputOptions(&command, arguments);
    addRunOptions(&command, arguments);
    addPathOptions(&command, arguments);
    addRasterOptions(&command, arguments);
}

}  // namespace helio::cli
