#include "passes/scene/material_layout.hpp"
#include "passes/scene/packed_scene.hpp"
#include "passes/scene/placed_meshes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace helio::pack {
namespace {

/** Whether any primitive that an instance uses satisfies a condition. */
template <typename Condition>
bool anyPrimitive(const Scene& scene, const std::vector<Instance>& instances, Condition condition) {
    for (const Instance& instance : instances)
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives)
            if (condition(primitive)) return true;
    return false;
}

/** The material of a primitive; glTF's default where it names none. */
const Material& materialOf(const Scene& scene, const Primitive& primitive) {
    static const Material standard;
    return primitive.material < 0 ? standard : scene.materials[std::size_t(primitive.material)];
}

/** Texture coordinates of a vertex in a set; 0 where the primitive has no such set. */
glm::vec2 texcoord(const Primitive& primitive, int set, std::uint32_t vertex) {
    if (set < 0 || std::size_t(set) >= primitive.texcoords.size()) return glm::vec2(0.0f);
    return primitive.texcoords[std::size_t(set)][vertex];
}

/** Directions that are normal to a surface transform by the cofactor matrix: it is det(M) M^-T, and stays
 * finite where M is singular. The sign of det(M) is taken out, so that a mirrored object's normals still
 * point outwards. */
glm::dmat3 normalMatrix(const glm::dmat3& m) {
    const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::determinant(m) < 0.0 ? -cofactor : cofactor;
}

/** The permutation that Perlin published with "Improving noise", 2002. */
constexpr std::array<std::uint8_t, 256> kNoisePermutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,
    69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,
    94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136,
    171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161,
    1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,
    164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126,
    255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
    19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,  242, 193,
    238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

glm::vec3 unitOr(const glm::dvec3& v, const glm::dvec3& fallback) {
    const double length = glm::length(v);
    if (length > 0.0 && std::isfinite(length)) return glm::vec3(v / length);
    const double other = glm::length(fallback);
    return other > 0.0 ? glm::vec3(fallback / other) : glm::vec3(0.0f, 0.0f, 1.0f);
}

/** An instance that is flattened, or a mesh that is placed, in its own space. */
struct Part {
    std::uint32_t index;  ///< the instance's
    Instance instance;
    glm::dmat4 transform;  ///< to the world about the origin
    bool mirrored;
    bool inOwnSpace;
};

/** Attributes that some surface has, and that all therefore get. */
struct Attributes {
    bool normals = false, colors = false, texcoords = false, tangents = false;
};

/** Appends a shape in place of a triangle: its vectors, and in place of corners' attributes what kernels find
 * those of its points by. */
void addShape(const Scene& scene, const Instance& instance, const Primitive& primitive,
              const glm::dvec3& origin, const Attributes& any, PackedScene& packed,
              std::vector<glm::vec3>& positions) {
    const PlacedShape shape = placeShape(scene, instance, *primitive.shape);
    const glm::vec3 centre(shape.centre - origin);
    if (!std::isfinite(centre.x) || !std::isfinite(centre.y) || !std::isfinite(centre.z))
        throw InputError(scene.name, fmt::format("node {}", instance.node),
                         "its shape is not finite in world space", "correct the node's transform");
    positions.insert(positions.end(), {centre, glm::vec3(shape.a), glm::vec3(shape.b)});
    const bool isSphere = shape.kind == Shape::Kind::Sphere;
    const bool isTorus = shape.kind == Shape::Kind::Torus;
    (isSphere ? packed.spheres : isTorus ? packed.tori : packed.flatShapes) = true;
    if (any.normals)
        packed.normals.insert(packed.normals.end(), 3,
                              {unitOr(glm::cross(shape.a, shape.b), glm::dvec3(0, 0, 1)), 0.0f});
    if (any.colors) packed.colors.insert(packed.colors.end(), 3, glm::vec4(1.0f));
    if (any.texcoords)
        for (const glm::vec2& uv : shapeTexcoords(shape)) packed.texcoords.emplace_back(uv, uv);
    const float scale = float(std::cbrt(std::abs(glm::determinant(glm::dmat3(instance.transform)))));
    if (any.tangents)
        packed.tangents.insert(packed.tangents.end(), 3,
                               {unitOr(shape.a, glm::dvec3(1, 0, 0)), shape.isMirrored ? -scale : scale});
    if (packed.solidTextures) {
        for (const glm::vec2& point : shapePoints(*primitive.shape, shape.isMirrored))
            packed.solidPoints.emplace_back(point, 0.0f, 0.0f);
        if ((isSphere || isTorus) && materialOf(scene, primitive).solid)
            packed.skipped.emplace_back("solid textures of round shapes",
                                        "they show that of their centre; give a mesh");
    }
}

}  // namespace

std::vector<glm::vec3> geometry(const Scene& scene, const glm::dvec3& origin, PackedScene& packed,
                                std::vector<Surface>& surfaces, PlacedMeshes* placed) {
    const std::vector<Instance> instances = scene.instances();
    std::uint64_t total = 0;
    const auto count = [&](const Instance& instance) {
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives) {
            if (primitive.material >= int(scene.materials.size()))
                throw InputError(scene.name, fmt::format("mesh {}", instance.mesh),
                                 fmt::format("material {} does not exist", primitive.material),
                                 "name one of the scene's materials");
            total += primitive.shape ? 1 : primitive.indices.size() / 3;
        }
        // A node's index and a triangle's place in a leaf share a 32-bit stack entry with 8 bits of flags.
        if (total >= (1u << 24))
            throw InputError(scene.name, "", fmt::format("more than {} triangles", (1u << 24) - 1),
                             "reduce the meshes or the number of instances");
    };
    std::vector<Part> parts;
    auto next = placed != nullptr ? placed->placements.begin() : std::vector<MeshPlacement>::iterator();
    for (std::size_t i = 0; i < instances.size(); ++i) {
        packed.instanceFirst.push_back(std::uint32_t(total));
        if (placed != nullptr && next != placed->placements.end() && next->instance == i) {
            ++next;
            continue;
        }
        count(instances[i]);
        glm::dmat4 transform = instances[i].transform;
        transform[3] -= glm::dvec4(origin, 0.0);
        parts.push_back({std::uint32_t(i), instances[i], transform,
                         glm::determinant(glm::dmat3(transform)) < 0.0, false});
    }
    packed.triangleCount = std::uint32_t(total);
    if (placed != nullptr) {
        for (PlacedMesh& mesh : placed->meshes) {
            mesh.firstG = std::uint32_t(total);
            Instance own;
            own.mesh = int(mesh.mesh);
            count(own);
            parts.push_back({0, own, glm::dmat4(1.0), mesh.mirrored, true});
        }
        for (const MeshPlacement& p : placed->placements)
            packed.instanceFirst[p.instance] = placed->meshes[p.mesh].firstG;
    }
    packed.instanceFirst.push_back(std::uint32_t(total));

    const bool anyNormals =
        anyPrimitive(scene, instances, [](const Primitive& p) { return !p.normals.empty(); });
    const bool anyColors =
        anyPrimitive(scene, instances, [](const Primitive& p) { return !p.colors.empty(); });
    const bool anyTexcoords = anyPrimitive(scene, instances, [&](const Primitive& p) {
        return texcoordSets(materialOf(scene, p), packed.bakedTextures())[0] >= 0;
    });
    const bool anyTangents = anyPrimitive(
        scene, instances, [&](const Primitive& p) { return needsTangents(materialOf(scene, p)); });

    packed.solidTextures = anyPrimitive(
        scene, instances, [&](const Primitive& p) { return materialOf(scene, p).solid.has_value(); });

    const Attributes any{anyNormals, anyColors, anyTexcoords, anyTangents};
    std::vector<glm::vec3> positions;
    positions.reserve(total * 3);
    surfaces.reserve(total);
    if (anyNormals) packed.normals.reserve(total * 3);
    if (anyColors) packed.colors.reserve(total * 3);
    if (anyTexcoords) packed.texcoords.reserve(total * 3);
    if (anyTangents) packed.tangents.reserve(total * 3);
    if (packed.solidTextures) {
        packed.solidPoints.reserve(256 + total * 3);
        for (std::size_t i = 0; i < 256; ++i)
            packed.solidPoints.emplace_back(kNoisePermutation[i], kNoisePermutation[(i + 1) % 256], 0, 0);
    }

    for (const Part& part : parts) {
        const Instance& instance = part.instance;
        const glm::dmat4& transform = part.transform;
        const glm::dmat3 linear(transform);
        const glm::dmat3 forNormals = normalMatrix(linear);
        const bool mirrored = part.mirrored;
        // Kernels turn placed normals by normalMatrix(), which a mirror does not turn over, unlike a face.
        const double faceSign = part.inOwnSpace && mirrored ? -1.0 : 1.0;
        const float scale = float(std::cbrt(std::abs(glm::determinant(linear))));
        const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const Primitive& primitive = mesh.primitives[p];
            const std::uint32_t material = primitive.material < 0 ? std::uint32_t(scene.materials.size())
                                                                  : std::uint32_t(primitive.material);
            if (primitive.shape) {
                addShape(scene, instance, primitive, origin, any, packed, positions);
                surfaces.push_back({part.index, material, false, 1 + std::uint32_t(primitive.shape->kind)});
                continue;
            }
            const Material& look = materialOf(scene, primitive);
            packed.tiltedLobes |= !primitive.normals.empty() && hasWideLobes(look);
            const std::array<int, 2> sets = texcoordSets(look, packed.bakedTextures());
            const bool hasTangents = anyTangents && needsTangents(look);
            const std::vector<glm::vec4> cornerTangents =
                hasTangents ? tangents(primitive, tangentSet(look)) : std::vector<glm::vec4>();
            for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
                std::uint32_t index[3] = {primitive.indices[t], primitive.indices[t + 1],
                                          primitive.indices[t + 2]};
                // glTF: a transform with negative determinant reverses the winding, so that what was the
                // front stays the front.
                if (mirrored) std::swap(index[1], index[2]);
                glm::dvec3 corner[3];
                for (int k = 0; k < 3; ++k) {
                    if (index[k] >= primitive.positions.size())
                        throw InputError(scene.name, fmt::format("mesh {} primitive {}", instance.mesh, p),
                                         fmt::format("vertex {} does not exist", index[k]),
                                         fmt::format("there are {}", primitive.positions.size()));
                    const glm::dvec4 world = transform * glm::dvec4(primitive.positions[index[k]], 1.0);
                    const glm::vec3 rounded(world);
                    if (!std::isfinite(rounded.x) || !std::isfinite(rounded.y) || !std::isfinite(rounded.z))
                        throw InputError(scene.name, fmt::format("mesh {} primitive {}", instance.mesh, p),
                                         fmt::format("vertex {} is not finite in world space", index[k]),
                                         "correct the position or the node's transform");
                    corner[k] = glm::dvec3(rounded);
                    positions.push_back(rounded);
                }
                surfaces.push_back({part.index, material});
                if (anyNormals) {
                    const glm::dvec3 face =
                        faceSign * glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
                    for (std::uint32_t k : index)
                        packed.normals.push_back(
                            {primitive.normals.empty()
                                 ? unitOr(face, glm::dvec3(0, 0, 1))
                                 : unitOr(forNormals * glm::dvec3(primitive.normals[k]), face),
                             0.0f});
                }
                if (anyTexcoords)
                    for (std::uint32_t k : index) {
                        packed.texcoords.emplace_back(texcoord(primitive, sets[0], k),
                                                      texcoord(primitive, sets[1], k));
                    }
                if (anyTangents)
                    for (std::size_t k : {std::size_t(0), mirrored ? std::size_t(2) : std::size_t(1),
                                          mirrored ? std::size_t(1) : std::size_t(2)}) {
                        const glm::vec4 local =
                            hasTangents ? cornerTangents[t + k] : glm::vec4(1.0f, 0.0f, 0.0f, 1.0f);
                        // Tangents lie in the surface: the transform itself carries them. A mirror turns the
                        // bitangent over.
                        packed.tangents.emplace_back(unitOr(linear * glm::dvec3(local), glm::dvec3(1, 0, 0)),
                                                     std::copysign(scale, mirrored ? -local.w : local.w));
                    }
                if (packed.solidTextures)
                    for (std::uint32_t k : index)
                        packed.solidPoints.emplace_back(primitive.positions[k], 0.0f);
                if (anyColors)
                    for (std::uint32_t k : index)
                        packed.colors.push_back(primitive.colors.empty() ? glm::vec4(1.0f)
                                                                         : primitive.colors[k]);
            }
        }
    }
    return positions;
}

}  // namespace helio::pack
