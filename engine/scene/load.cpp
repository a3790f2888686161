#include "engine/scene/gltf/gltf.hpp"
#include "engine/scene/load_monitor.hpp"
#include "engine/scene/mesh/mesh.hpp"
#include "engine/scene/samples/sample.hpp"

#include <heliograph/error.hpp>
#include <heliograph/file.hpp>
#include <heliograph/scene.hpp>

#include <new>

namespace helio {
namespace {

Scene loadMeshFile(Scene (*importer)(const ByteSource&, const std::string&, LoadMonitor&),
                   const std::string& file, LoadMonitor& monitor) try {
    return importer(FileSource(file), file, monitor);
} catch (const std::bad_alloc&) {
    throw InputError(file, "", "does not fit in memory", "give a smaller file");
}

}  // namespace

Scene load(const std::string& source, const LoadOptions& options) {
    constexpr std::string_view samplePrefix = "sample:";
    if (source.starts_with(samplePrefix)) {
        Scene scene = makeSample(source.substr(samplePrefix.size()));
        if (!options.variant.empty()) chooseVariant(scene, options.variant);
        return scene;
    }
    LoadMonitor monitor(options);
    monitor.report("file", 0);
    const std::string extension = lowerCaseExtension(source);
    if (extension == ".gltf" || extension == ".glb") return loadGltf(source, options, monitor);
    if (extension == ".obj") return loadMeshFile(loadObj, source, monitor);
    throw InputError(source, "", "is no scene that can be read",
                     "give a .gltf, .glb or .obj file, or sample:NAME");
}

}  // namespace helio
