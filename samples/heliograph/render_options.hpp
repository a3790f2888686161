#pragma once
/** @file The options of `heliograph render`: what they are called, what they do, and which go together. */
#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace helio::cli {

/** Where vertex normals come from. */
enum class Normals { File, Flat, Equal, Area, Angle };

struct RenderArguments {
    std::string scene;
    std::vector<std::string> outputs;
    std::string size = "1280x720";
    std::string environment, environmentMap;
    bool hasEnvironmentImage = false;  ///< `environment` names a file
    std::string stats, graph, errorMap;
    std::string device = "auto";
    std::string antialiasing;
    std::uint32_t frames = 32;
    double frameRate = 60;
    std::string shutter;
    Display display;
    Normals normals = Normals::File;
    std::uint32_t displacement = 0;
    std::vector<std::string> lightmaps;  ///< NODE=FILE
    int lightmapTexcoord = 0;
    bool noNextEvent = false, validate = false, quiet = false;
    LoadOptions load;
    RenderOptions options;
};

/** Adds all of them to the command, in groups. */
void addRenderOptions(CLI::App& command, RenderArguments& arguments);

/** Reads the options that are texts into `arguments.options`, and refuses what would have no effect and
 * outputs that could not be written. Throws CLI::ValidationError. */
void finishRenderArguments(const CLI::App& command, RenderArguments& arguments);

}  // namespace helio::cli
