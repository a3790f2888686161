/**
 * @file
 * Loads one file, in a process of its own, and prints seconds and peak memory, or with exit 1 what is wrong
 * with it; or writes a file to load.
 *   bench_loading write KIND TRIANGLES FILE      KIND: glb, obj, ply, stl
 *   bench_loading heliograph FILE | assimp FILE
 * The mesh is a square grid with hills: vertices are shared by six triangles, except in STL.
 */
#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

class Grid {
public:
    explicit Grid(std::uint64_t triangles)
        : side_(std::uint32_t(std::lround(std::sqrt(double(triangles) / 2)))) {}
    std::uint32_t vertices() const { return (side_ + 1) * (side_ + 1); }
    std::uint32_t triangles() const { return side_ * side_ * 2; }
    glm::vec3 vertex(std::uint32_t i) const {
        const double x = double(i % (side_ + 1)) / side_, z = double(i / (side_ + 1)) / side_;
        return {float(x), float(0.05 * std::sin(20 * x) * std::cos(15 * z)), float(z)};
    }
    glm::uvec3 triangle(std::uint32_t i) const {
        const std::uint32_t first = i / 2 / side_ * (side_ + 1) + i / 2 % side_, below = first + side_ + 1;
        return i % 2 == 0 ? glm::uvec3(first, below, first + 1) : glm::uvec3(first + 1, below, below + 1);
    }

private:
    std::uint32_t side_;
};

template <class T>
void put(std::ofstream& out, const T& value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

void writeObj(std::ofstream& out, const Grid& grid) {
    for (std::uint32_t i = 0; i < grid.vertices(); ++i) {
        const glm::vec3 p = grid.vertex(i);
        out << fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z);
    }
    for (std::uint32_t i = 0; i < grid.triangles(); ++i) {
        const glm::uvec3 t = grid.triangle(i) + 1u;
        out << fmt::format("f {} {} {}\n", t.x, t.y, t.z);
    }
}

void writePly(std::ofstream& out, const Grid& grid) {
    out << fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
        "y\nproperty "
        "float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        grid.vertices(), grid.triangles());
    for (std::uint32_t i = 0; i < grid.vertices(); ++i) put(out, grid.vertex(i));
    for (std::uint32_t i = 0; i < grid.triangles(); ++i) {
        put(out, std::uint8_t(3));
        put(out, grid.triangle(i));
    }
}

void writeStl(std::ofstream& out, const Grid& grid) {
    out << std::string(80, ' ');
    put(out, grid.triangles());
    for (std::uint32_t i = 0; i < grid.triangles(); ++i) {
        const glm::uvec3 t = grid.triangle(i);
        put(out, glm::vec3(0));
        for (int k = 0; k < 3; ++k) put(out, grid.vertex(t[k]));
        put(out, std::uint16_t(0));
    }
}

void writeGlb(std::ofstream& out, const Grid& grid) {
    const std::uint32_t positions = grid.vertices() * 12, indices = grid.triangles() * 12;
    std::string text = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":[0,-0.05,0],"max":[1,0.05,1]}},{{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],"bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],"buffers":[{{"byteLength":{}}}]}})",
        grid.vertices(), grid.triangles() * 3, positions, positions, indices, positions + indices);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    out << "glTF";
    put(out, std::uint32_t(2));
    put(out, std::uint32_t(12 + 8 + text.size() + 8 + positions + indices));
    put(out, std::uint32_t(text.size()));
    out << "JSON" << text;
    put(out, positions + indices);
    out.write("BIN\0", 4);
    for (std::uint32_t i = 0; i < grid.vertices(); ++i) put(out, grid.vertex(i));
    for (std::uint32_t i = 0; i < grid.triangles(); ++i) put(out, grid.triangle(i));
}

/** Of this program alone: rusage counts what it was before, a fork of a larger one. */
double peakMebibytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) / 1024;
    }
    return 0;
}

int load(const std::string& loader, const std::string& file) try {
    const double before = peakMebibytes();
    const auto start = std::chrono::steady_clock::now();
    std::uint64_t triangles = 0, bytes = 0;
    if (loader == "heliograph") {
        const helio::Scene scene = helio::load(file);
        for (const helio::Mesh& mesh : scene.meshes) {
            for (const helio::Primitive& primitive : mesh.primitives) {
                triangles += primitive.indices.size() / 3;
                bytes += primitive.indices.size() * 4 + primitive.positions.size() * 12;
            }
        }
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        for (const std::string& warning : scene.warnings) fmt::print(stderr, "{}\n", warning);
        for (const auto& [what, why] : scene.skipped) fmt::print(stderr, "{}: {}\n", what, why);
        fmt::print("{} {:.3f} {:.1f} {:.1f}\n", triangles, seconds, peakMebibytes() - before,
                   double(bytes) / (1 << 20));
        return 0;
    }
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(file, aiProcess_Triangulate);
    if (scene == nullptr) {
        fmt::print(stderr, "{}\n", importer.GetErrorString());
        return 1;
    }
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) triangles += scene->mMeshes[i]->mNumFaces;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{} {:.3f} {:.1f} 0\n", triangles, seconds, peakMebibytes() - before);
    return 0;
} catch (const helio::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string command = argc > 1 ? argv[1] : "";
    if (argc == 3 && (command == "heliograph" || command == "assimp")) return load(command, argv[2]);
    if (argc != 5 || command != "write") return 2;
    const std::string kind = argv[2];
    const Grid grid(std::strtoull(argv[3], nullptr, 10));
    std::vector<char> buffer(std::size_t(1) << 20);
    std::ofstream out;
    out.rdbuf()->pubsetbuf(buffer.data(), std::streamsize(buffer.size()));
    out.open(argv[4], std::ios::binary);
    if (kind == "obj") writeObj(out, grid);
    if (kind == "ply") writePly(out, grid);
    if (kind == "stl") writeStl(out, grid);
    if (kind == "glb") writeGlb(out, grid);
    return out.good() ? 0 : 1;
}
