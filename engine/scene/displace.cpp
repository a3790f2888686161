#include "engine/scene/normals.hpp"

#include <heliograph/error.hpp>
#include <heliograph/surfaces.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <variant>

namespace helio {
namespace {

/** The red channel of a texture, bilinear between texels' centres, in double. */
class Heights {
public:
    Heights(const Scene& scene, const Material& material)
        : use_(material.heightTexture), scale_(double(material.heightScale)) {
        const Texture& texture = scene.textures.at(std::size_t(use_.texture));
        texture_ = &texture;
        image_ = &scene.images.at(std::size_t(texture.image));
    }

    double at(const glm::dvec2& uv) const {
        const glm::dvec3 p = glm::dmat3(use_.transform) * glm::dvec3(uv, 1.0);
        const double x = p.x * image_->width - 0.5, y = p.y * image_->height - 0.5;
        const double column = std::floor(x), row = std::floor(y);
        const double s = x - column, t = y - row;
        const auto between = [&](double r) { return (1 - s) * texel(column, r) + s * texel(column + 1, r); };
        return scale_ * ((1 - t) * between(row) + t * between(row + 1));
    }
    int texcoord() const { return use_.texcoord; }

private:
    static std::size_t wrapped(double i, std::uint32_t size, Wrap wrap) {
        const double n = size;
        if (wrap == Wrap::ClampToEdge) return std::size_t(std::clamp(i, 0.0, n - 1));
        const double period = wrap == Wrap::MirroredRepeat ? 2 * n : n;
        const double r = std::clamp(i - period * std::floor(i / period), 0.0, period - 1);
        return std::size_t(r < n ? r : period - 1 - r);
    }
    double texel(double column, double row) const {
        const std::size_t i = wrapped(row, image_->height, texture_->wrapV) * image_->width +
                              wrapped(column, image_->width, texture_->wrapU);
        if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&image_->texels))
            return (*bytes)[i * 4] / 255.0;
        if (const auto* words = std::get_if<std::vector<std::uint16_t>>(&image_->texels))
            return (*words)[i * 4] / 65535.0;
        // As the kernels take it: no heights below 0 nor above 1.
        const double value = double(std::get<std::vector<float>>(image_->texels)[i * 4]);
        return value > 0 ? std::min(value, 1.0) : 0.0;
    }

    TextureUse use_;
    double scale_;
    const Texture* texture_ = nullptr;
    const TextureImage* image_ = nullptr;
};

/** A point inside a triangle: integer weights of the corners, which add up to the number of cuts. */
struct Weights {
    std::array<std::uint32_t, 3> corner;
    std::array<double, 3> weight;
};

template <typename T>
glm::vec<T::length(), double> blend(const std::vector<T>& values, const Weights& w) {
    glm::vec<T::length(), double> sum(0.0);
    for (std::size_t k = 0; k < 3; ++k)
        if (w.weight[k] != 0) sum += w.weight[k] * glm::vec<T::length(), double>(values[w.corner[k]]);
    return sum;
}

/** Corners in an order that both triangles at an edge find alike, so that sums come out alike: by place. */
Weights sorted(Weights w, const std::vector<glm::vec3>& positions) {
    std::array<std::size_t, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const glm::vec3 &p = positions[w.corner[a]], &q = positions[w.corner[b]];
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    });
    Weights r;
    for (std::size_t k = 0; k < 3; ++k) {
        r.corner[k] = w.corner[order[k]];
        r.weight[k] = w.weight[order[k]];
    }
    return r;
}

Primitive displaced(const Primitive& from, const Heights& heights, std::uint32_t cuts) {
    Primitive to;
    to.material = from.material;
    to.variantMaterials = from.variantMaterials;
    to.texcoords.resize(from.texcoords.size());
    const std::vector<glm::vec2>& uvs = from.texcoords[std::size_t(heights.texcoord())];
    for (std::size_t t = 0; t + 2 < from.indices.size(); t += 3) {
        const auto first = std::uint32_t(to.positions.size());
        for (std::uint32_t i = 0; i <= cuts; ++i)
            for (std::uint32_t j = 0; j <= i; ++j) {
                const Weights w = sorted({{from.indices[t], from.indices[t + 1], from.indices[t + 2]},
                                          {double(cuts - i) / cuts, double(i - j) / cuts, double(j) / cuts}},
                                         from.positions);
                const glm::dvec3 normal = blend(from.normals, w);
                const double length = glm::length(normal);
                const glm::dvec3 unit = length > 0 ? normal / length : glm::dvec3(0);
                to.positions.emplace_back(blend(from.positions, w) + unit * heights.at(blend(uvs, w)));
                for (std::size_t set = 0; set < from.texcoords.size(); ++set)
                    to.texcoords[set].emplace_back(blend(from.texcoords[set], w));
                if (!from.colors.empty()) to.colors.emplace_back(blend(from.colors, w));
            }
        const auto at = [&](std::uint32_t i, std::uint32_t j) { return first + i * (i + 1) / 2 + j; };
        for (std::uint32_t i = 0; i < cuts; ++i)
            for (std::uint32_t j = 0; j <= i; ++j) {
                to.indices.insert(to.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                if (j < i) to.indices.insert(to.indices.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    }
    return to;
}

/** The material's height map where the primitive has one, with coordinates for it. */
const Material* raised(const Scene& scene, const Primitive& primitive) {
    if (primitive.material < 0) return nullptr;
    const Material& material = scene.materials.at(std::size_t(primitive.material));
    const bool has = material.heightTexture && material.heightScale != 0.0f &&
                     std::size_t(material.heightTexture.texcoord) < primitive.texcoords.size();
    return has ? &material : nullptr;
}

}  // namespace

void displace(Scene& scene, std::uint32_t cuts) {
    if (cuts < 1 || cuts > 1024)
        throw InputError(scene.name, "displacement", fmt::format("cuts triangles into {} parts a side", cuts),
                         "take 1 to 1024");
    scene.validate();
    std::uint64_t total = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives)
            total += p.indices.size() / 3 * (raised(scene, p) != nullptr ? std::uint64_t(cuts) * cuts : 1);
    if (total >= 1u << 24)
        throw InputError(scene.name, "displacement", fmt::format("makes {} triangles", total),
                         fmt::format("cut less; {} triangles is the most", (1u << 24) - 1));
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        std::vector<Primitive*> changed;
        for (Primitive& primitive : scene.meshes[m].primitives)
            if (raised(scene, primitive) != nullptr) changed.push_back(&primitive);
        for (const Primitive* p : changed)
            if (!p->targets.empty() || !p->joints.empty())
                throw InputError(scene.name, fmt::format("mesh {}", m), "bends, and has a map of heights",
                                 "pose the scene first");
        if (changed.empty()) continue;
        if (std::ranges::any_of(changed, [](const Primitive* p) { return p->normals.empty(); }))
            smoothNormals(changed, NormalWeight::Angle, scene.name, m);
        for (Primitive* p : changed) *p = displaced(*p, Heights(scene, *raised(scene, *p)), cuts);
        smoothNormals(changed, NormalWeight::Angle, scene.name, m);
    }
    for (Material& material : scene.materials) {
        material.heightTexture = {};
        material.heightScale = 0;
    }
}

}  // namespace helio
