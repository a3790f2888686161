#include "engine/image/read_file.hpp"
#include "engine/scene/degenerate.hpp"
#include "engine/scene/gltf/gltf.hpp"
#include "engine/scene/load_monitor.hpp"
#include "engine/scene/mesh/mesh.hpp"
#include "engine/scene/samples/sample.hpp"

#include <heliograph/error.hpp>
#include <heliograph/file.hpp>
#include <heliograph/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <span>
#include <string_view>

namespace helio {
namespace {

using MeshImporter = Scene (*)(const ByteSource&, const std::string&, LoadMonitor&);

Scene loadMeshFile(MeshImporter importer, const std::string& file, const LoadOptions& options,
                   LoadMonitor& monitor) try {
    Scene scene = importer(FileSource(file), file, monitor);
    if (!options.variant.empty()) chooseVariant(scene, options.variant);
    return scene;
} catch (const std::bad_alloc&) {
    throw InputError(file, "", "does not fit in memory", "give a smaller file");
}

/** A file by another format's name is refused with its own: what its importer would say of it helps no one.
 */
void checkName(const std::string& file, const std::string& extension) {
    const FileSource source(file);
    std::array<char, 5> start{};
    source.read(0, std::as_writable_bytes(
                       std::span(start).first(std::min(start.size(), std::size_t(source.size())))));
    const std::string_view text(start.data(), start.size());
    const bool isGltfName = extension == ".gltf" || extension == ".glb";
    const char* is = nullptr;
    if (text.starts_with("glTF") && !isGltfName) is = ".glb";
    if ((text.starts_with("ply\n") || text.starts_with("ply\r")) && extension != ".ply") is = ".ply";
    if (is != nullptr)
        throw InputError(file, "first bytes", fmt::format("are those of a {} file", is),
                         fmt::format("name it {}", is));
}

Scene loadFile(const std::string& file, const LoadOptions& options, LoadMonitor& monitor) {
    const std::string extension = lowerCaseExtension(file);
    if (extension == ".gltf" || extension == ".glb" || extension == ".obj" || extension == ".ply" ||
        extension == ".stl")
        checkName(file, extension);
    if (extension == ".gltf" || extension == ".glb") return loadGltf(file, options, monitor);
    if (extension == ".obj") return loadMeshFile(loadObj, file, options, monitor);
    if (extension == ".ply") return loadMeshFile(loadPly, file, options, monitor);
    if (extension == ".stl") return loadMeshFile(loadStl, file, options, monitor);
    throw InputError(file, "", "is no scene that can be read",
                     "give a .gltf, .glb, .obj, .ply or .stl file, or sample:NAME");
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
    Scene scene = loadFile(source, options, monitor);
    warnOfDegenerates(scene);
    return scene;
}

}  // namespace helio
