/**
 * @file
 * One fuzz target per FUZZ_* macro. What comes in is a file: it must load to a scene that is valid, or be
 * refused in one line that names the file, the fault and the remedy. Anything else ends the run.
 */
#include "engine/image/backend.hpp"
#include "engine/scene/mesh/mesh.hpp"

#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace {

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    std::abort();
}

/** A folder in memory with what the seeds refer to. */
class Folder {
public:
    Folder() {
        if (mkdtemp(path.data()) == nullptr) fail("no folder can be made in /dev/shm");
    }
    ~Folder() { std::filesystem::remove_all(path); }
    std::string path = "/dev/shm/heliograph_fuzz_XXXXXX";
};

const std::string& folder() {
    static const Folder made;
    return made.path;
}

std::string write(const std::string& name, std::span<const std::uint8_t> content) {
    const std::string file = folder() + "/" + name;
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(content.data()), std::streamsize(content.size()));
    return file;
}

/** Loads; looks at what comes of it as a renderer's first steps would. */
void load(const std::string& file) {
    try {
        const helio::Scene scene = helio::load(file);
        scene.validate();
        (void)scene.bounds();
        (void)scene.triangleCount();
        (void)scene.placedCameras();
    } catch (const helio::InputError& error) {
        const std::string text = error.what();
        if (text.find('\n') != std::string::npos) fail("more than one line: " + text);
        if (!text.starts_with(folder())) fail("does not begin with the file: " + text);
        if (error.fault.empty() || error.remedy.empty()) fail("names no fault or no remedy: " + text);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::uint8_t> input(data, size);
#if defined(FUZZ_IMAGE)
    const auto bytes = std::as_bytes(input);
    helio::DecodedImage image;
    helio::ImageBudget budget;
    const std::string fault = helio::decodeImage(bytes, budget, image);
    if (fault.find('\n') != std::string::npos) fail("more than one line: " + fault);
    if (fault.empty() && image.width == 0) fail("an image without texels");
#elif defined(FUZZ_MTL)
    static const std::string object = [] {
        const std::string text =
            "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl painted\nf 1/1 2/1 3/1\n"
            "usemtl lamp\nf 1 2 3\n";
        return write("scene.obj", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }();
    write("scene.mtl", input);
    load(object);
#elif defined(FUZZ_GLTF)
    load(write("scene.gltf", input));
#elif defined(FUZZ_GLB)
    load(write("scene.glb", input));
#elif defined(FUZZ_OBJ)
    load(write("scene.obj", input));
#elif defined(FUZZ_PLY)
    load(write("scene.ply", input));
#elif defined(FUZZ_STL)
    load(write("scene.stl", input));
#endif
    return 0;
}
