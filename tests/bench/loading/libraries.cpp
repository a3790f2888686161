/**
 * @file
 * Loads one file with a library, in a process of its own, and prints triangles, seconds and MiB of peak
 * memory; or what the library says is wrong with the file, and exits with 1. bench_loading_libraries
 * tinyobjloader|tinyobjloader-callbacks|admesh FILE
 */
#include <admesh/stl.h>
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

/** Triangles, or a fault. */
using Loaded = std::pair<std::uint64_t, std::string>;

/** The library's own lists: what a scene would be made of after this. */
Loaded readObj(const std::string& file) {
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(file)) return {0, reader.Error() + " "};
    fmt::print(stderr, "{}", reader.Warning());
    std::uint64_t triangles = 0;
    for (const tinyobj::shape_t& shape : reader.GetShapes()) triangles += shape.mesh.num_face_vertices.size();
    return {triangles, {}};
}

/** Positions and the indices of positions, as they come. */
Loaded streamObj(const std::string& file) {
    struct Lists {
        std::vector<float> positions;
        std::vector<std::int32_t> indices;
    } lists;
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* to, float x, float y, float z, float) {
        auto& positions = static_cast<Lists*>(to)->positions;
        positions.insert(positions.end(), {x, y, z});
    };
    callbacks.index_cb = [](void* to, tinyobj::index_t* corners, int count) {
        auto& indices = static_cast<Lists*>(to)->indices;
        for (int k = 2; k < count; ++k) {
            for (const int corner : {0, k - 1, k}) indices.push_back(corners[corner].vertex_index);
        }
    };
    std::ifstream in(file);
    std::string warning, fault;
    if (!tinyobj::LoadObjWithCallback(in, callbacks, &lists, nullptr, &warning, &fault))
        return {0, fault + " "};
    fmt::print(stderr, "{}", warning);
    return {lists.indices.size() / 3, {}};
}

Loaded readStl(const std::string& file) {
    std::string name = file;  // which the library would change
    stl_file stl{};
    stl_open(&stl, name.data());
    if (stl_get_error(&stl) != 0) return {0, "an error without words"};
    const auto triangles = std::uint64_t(stl.stats.number_of_facets);
    stl_close(&stl);
    return {triangles, {}};
}

/** Of this program alone: rusage counts what it was before, a fork of a larger one. */
double peakMebibytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmHWM:", 0) == 0) return std::strtod(line.c_str() + 6, nullptr) / 1024;
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string library = argc == 3 ? argv[1] : "";
    const auto load = library == "tinyobjloader"             ? readObj
                      : library == "tinyobjloader-callbacks" ? streamObj
                      : library == "admesh"                  ? readStl
                                                             : nullptr;
    if (load == nullptr) return 2;
    const double before = peakMebibytes();
    const auto start = std::chrono::steady_clock::now();
    const auto [triangles, fault] = load(argv[2]);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!fault.empty()) {
        fmt::print(stderr, "{}\n", fault);
        return 1;
    }
    fmt::print("{} {:.3f} {:.1f} 0\n", triangles, seconds, peakMebibytes() - before);
    return 0;
}
