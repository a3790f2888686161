#include "engine/scene/gltf/gltf.hpp"
#include "engine/scene/load_monitor.hpp"
#include "engine/scene/samples/sample.hpp"

#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace helio {

Scene load(const std::string& source, const LoadOptions& options) {
    constexpr std::string_view samplePrefix = "sample:";
    if (source.starts_with(samplePrefix)) {
        Scene scene = makeSample(source.substr(samplePrefix.size()));
        if (!options.variant.empty()) chooseVariant(scene, options.variant);
        return scene;
    }
    LoadMonitor monitor(options);
    monitor.report("file", 0);
    std::string extension = std::filesystem::path(source).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".gltf" || extension == ".glb") return loadGltf(source, options, monitor);
    throw InputError(source, "", "is no scene that can be read", "give a .gltf or .glb file, or sample:NAME");
}

}  // namespace helio
