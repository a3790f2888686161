/** @file
 * The four scenes of the comparison with Cycles as glTF files, in world space: built-in samples, changed to
 * what both renderers can say exactly: bench_cycles_scenes FOLDER. Of a sample with spheres NAME.gltf has
 * exact ones, and NAME-triangles.gltf the sample's triangles, since Cycles has no others. Two are
 * scaled from millimetres to metres: Cycles' choice between sampling a light and its own rays takes distances
 * for metres, and darkens the Cornell box by percents at its native size.
 */
#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace {

using nlohmann::json;
using namespace helio;

/** Arrays of the file's one buffer. */
class Binary {
public:
    template <typename T>
    int add(const std::vector<T>& values, int componentType, const char* type) {
        document["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size() * sizeof(T)}});
        const std::size_t parts = std::string(type) == "SCALAR" ? 1 : 3;
        json accessor{{"bufferView", document["bufferViews"].size() - 1},
                      {"componentType", componentType},
                      {"count", values.size() * sizeof(T) / (4 * parts)},
                      {"type", type}};
        if constexpr (std::is_same_v<T, glm::vec3>) {
            glm::vec3 low = values.at(0), high = low;
            for (const glm::vec3& v : values) low = glm::min(low, v), high = glm::max(high, v);
            accessor["min"] = {low.x, low.y, low.z};
            accessor["max"] = {high.x, high.y, high.z};
        }
        document["accessors"].push_back(accessor);
        const auto* first = reinterpret_cast<const char*>(values.data());
        bytes_.insert(bytes_.end(), first, first + values.size() * sizeof(T));
        return int(document["accessors"].size()) - 1;
    }
    void save(const std::filesystem::path& file) {
        std::filesystem::path binary = file;
        binary.replace_extension(".bin");
        document["buffers"].push_back({{"uri", binary.filename()}, {"byteLength", bytes_.size()}});
        std::ofstream(binary, std::ios::binary).write(bytes_.data(), std::streamsize(bytes_.size()));
        std::ofstream(file) << document.dump(1);
    }
    json document;

private:
    std::vector<char> bytes_;
};

json triple(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

json materialJson(const Material& m) {
    json out{{"name", m.name},
             {"doubleSided", m.doubleSided},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {m.baseColor.r, m.baseColor.g, m.baseColor.b, 1.0}},
               {"metallicFactor", m.metallic},
               {"roughnessFactor", m.roughness}}},
             {"extensions", {{"KHR_materials_specular", {{"specularFactor", m.specular}}}}}};
    const float strongest = std::max({m.emission.r, m.emission.g, m.emission.b});
    if (strongest > 0) {
        out["emissiveFactor"] = triple(m.emission / strongest);
        out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strongest}};
    }
    if (m.scattering) {
        json& own = out["extras"]["heliograph"]["scattering"];
        switch (m.scattering->model) {
            case Scattering::Model::Mirror:
                own["model"] = "mirror";
                break;
            case Scattering::Model::Dielectric:
                own["model"] = "dielectric";
                break;
            default:
                own["model"] = "conductor";
        }
        own["n"] = triple(m.scattering->n);
        own["k"] = triple(m.scattering->k);
        own["alpha"] = {m.scattering->alpha.x, m.scattering->alpha.y};
    }
    return out;
}

/** A node that places an exact sphere of a sample. */
json shapeNode(const Instance& instance, const Primitive& primitive, float scale) {
    if (primitive.shape->kind != Shape::Kind::Sphere) throw std::runtime_error("only spheres are written");
    const glm::dvec3 centre = double(scale) * glm::dvec3(instance.transform[3]);
    const double radius =
        double(scale) * double(primitive.shape->radius) * glm::length(glm::dvec3(instance.transform[0]));
    return {{"translation", {centre.x, centre.y, centre.z}},
            {"extras",
             {{"heliograph",
               {{"shape", {{"kind", "sphere"}, {"radius", radius}, {"material", primitive.material}}}}}}}};
}

/** The same scene with exact spheres in place of smooth meshes about the origin of unit radius. */
Scene withExactSpheres(Scene scene) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            const bool isSphere = !primitive.normals.empty() && primitive.normals == primitive.positions;
            if (!isSphere) continue;
            Primitive exact;
            exact.shape = Shape{};
            exact.material = primitive.material;
            primitive = exact;
        }
    return scene;
}

void save(const Scene& scene, float scale, const std::filesystem::path& file) {
    Binary binary;
    json& document = binary.document;
    document["asset"] = {{"version", "2.0"}};
    document["extensionsUsed"] = {"KHR_materials_specular", "KHR_materials_emissive_strength"};
    for (const Material& material : scene.materials) document["materials"].push_back(materialJson(material));
    json nodes = json::array();
    for (const Instance& instance : scene.instances()) {
        const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(instance.transform)));
        json primitives;
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives) {
            if (primitive.shape) {
                nodes.push_back(shapeNode(instance, primitive, scale));
                continue;
            }
            std::vector<glm::vec3> positions, normals;
            for (const glm::vec3& p : primitive.positions)
                positions.emplace_back(double(scale) * glm::dvec3(instance.transform * glm::dvec4(p, 1.0)));
            for (const glm::vec3& n : primitive.normals)
                normals.emplace_back(glm::normalize(normalMatrix * glm::dvec3(n)));
            json attributes{{"POSITION", binary.add(positions, 5126, "VEC3")}};
            if (!normals.empty()) attributes["NORMAL"] = binary.add(normals, 5126, "VEC3");
            primitives.push_back({{"attributes", attributes},
                                  {"indices", binary.add(primitive.indices, 5125, "SCALAR")},
                                  {"material", primitive.material}});
        }
        if (primitives.empty()) continue;
        document["meshes"].push_back({{"primitives", primitives}});
        nodes.push_back({{"mesh", document["meshes"].size() - 1}});
    }
    for (const PlacedCamera& placed : scene.placedCameras()) {
        glm::dmat4 m = placed.transform;
        m[3] = glm::dvec4(double(scale) * glm::dvec3(m[3]), 1.0);
        const Camera& camera = scene.cameras[std::size_t(placed.camera)];
        document["cameras"].push_back(
            {{"type", "perspective"},
             {"perspective", {{"yfov", camera.yfov}, {"znear", camera.znear * scale}}}});
        json matrix;
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) matrix.push_back(m[c][r]);
        nodes.push_back({{"camera", document["cameras"].size() - 1}, {"matrix", matrix}});
    }
    document["nodes"] = nodes;
    json roots;
    for (std::size_t i = 0; i < nodes.size(); ++i) roots.push_back(i);
    document["scenes"] = {{{"nodes", roots}}};
    document["scene"] = 0;
    binary.save(file);
}

/** Scattering that Cycles knows: no Fresnel term of metals, and that of glass without approximation. */
void simplify(Scene& scene) {
    for (Material& material : scene.materials) {
        if (material.metallic > 0 && !material.scattering) {
            Scattering metal;
            metal.model = Scattering::Model::Conductor;
            metal.alpha = glm::vec2(material.roughness * material.roughness);
            metal.n = glm::vec3(0.02f);  // reflects all but 8e-6, at every angle
            metal.k = glm::vec3(100.0f);
            material.scattering = metal;
        }
        if (material.transmission > 0) {
            Scattering glass;
            glass.model = Scattering::Model::Dielectric;
            glass.n = glm::vec3(material.ior);
            material.scattering = glass;
            material.transmission = material.thickness = 0;
        }
        // Cycles' lamps shine from both faces; asking it for one wastes half of its light samples.
        if (material.emission != glm::vec3(0.0f)) material.doubleSided = true;
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: bench_cycles_scenes FOLDER\n", stderr);
        return 2;
    }
    try {
        for (const auto& [name, scale] :
             {std::pair{"cornell", 1e-3f}, {"plates", 1.0f}, {"glass", 1e-3f}, {"lights500", 1.0f}}) {
            Scene scene = load(std::string("sample:") + name);
            simplify(scene);
            const Scene exact = withExactSpheres(scene);
            const auto path = [&](const char* ending) {
                return std::filesystem::path(argv[1]) / (std::string(name) + ending);
            };
            save(exact, scale, path(".gltf"));
            if (exact.shapeCount() > 0) save(scene, scale, path("-triangles.gltf"));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_cycles_scenes: %s\n", error.what());
        return 1;
    }
    return 0;
}
