#include "engine/scene/gltf/build.hpp"
#include "engine/scene/gltf/primitive.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <optional>
#include <utility>

namespace helio::gltf {
namespace {

using nlohmann::json;

void readVariantNames(const Asset& asset, MemoryBudget& memory, helio::Scene& scene) {
    const json* const extension = extensionOf(asset.document().root(), "KHR_materials_variants");
    if (extension == nullptr) return;
    const json& variants = (*extension)["variants"];
    memory.take("extensions.KHR_materials_variants.variants", variants.size() * sizeof(std::string), 0);
    scene.variants.reserve(variants.size());
    for (const json& variant : variants) scene.variants.push_back(variant["name"].get<std::string>());
}

/** KHR_materials_variants: a variant that no mapping names keeps the primitive's own material. */
void readVariants(const json& from, const std::string& place, const helio::Scene& scene, MemoryBudget& memory,
                  Primitive& primitive) {
    const json* const extension = extensionOf(from, "KHR_materials_variants");
    if (extension == nullptr) return;
    memory.take(place, scene.variants.size() * sizeof(int), 0);
    primitive.variantMaterials.assign(scene.variants.size(), primitive.material);
    for (const json& mapping : (*extension)["mappings"]) {
        for (const json& variant : mapping["variants"])
            primitive.variantMaterials[std::size_t(variant.get<int>())] = mapping["material"].get<int>();
    }
}

/** Meshes in their order. Small primitives are decoded some ahead, side by side; each is then taken in its
 * turn, so that notes, faults and what counts against the memory are those of one after the other. */
class MeshBuilder {
public:
    MeshBuilder(const Asset& asset, MemoryBudget& memory, LoadMonitor& monitor, helio::Scene& scene)
        : asset_(asset), memory_(memory), monitor_(monitor), scene_(scene) {}

    void build() {
        const Document& document = asset_.document();
        const std::size_t count = document.size("meshes");
        memory_.take("meshes", count * sizeof(Mesh), 0);
        scene_.meshes.reserve(count);
        while (scene_.meshes.size() < count) {
            first_ = scene_.meshes.size();
            std::size_t end = first_, text = 0;  // at least one, and as many as have little text
            do text += document.textBytes("meshes", end++);
            while (end < count && text + document.textBytes("meshes", end) <= aheadText);
            meshes_.assign(end - first_, {});
            tbb::parallel_for(std::size_t(0), meshes_.size(),
                              [&](std::size_t i) { meshes_[i] = document.element("meshes", first_ + i); });
            buildBatch(double(first_) / double(count), double(end) / double(count));
        }
    }

private:
    /** Of JSON, whose parsed form takes twelve times as much; and elements of accessors, each of 16 bytes at
     * most, three times while it is decoded. */
    static constexpr std::size_t aheadText = std::size_t(1) << 16, aheadElements = std::size_t(1) << 18,
                                 aheadCount = 1024, aheadBytes = aheadElements * 48;

    struct Unit {
        std::size_t mesh, primitive;
        Primitive built;
        helio::Scene notes;
        std::optional<MemoryBudget> taken;  ///< where it was decoded ahead
    };

    const json& from(const Unit& unit) const { return meshes_[unit.mesh]["primitives"][unit.primitive]; }
    std::string place(const Unit& unit) const {
        return fmt::format("meshes[{}].primitives[{}]", first_ + unit.mesh, unit.primitive);
    }
    bool isShown(const Unit& unit) const { return modeOf(from(unit)) >= Mode::Triangles; }

    void buildBatch(double done, double end) {
        std::size_t all = 0, at = 0;
        for (const json& mesh : meshes_) all += mesh["primitives"].size();
        Unit next{0, 0, {}, {}, {}};
        while (next.mesh < meshes_.size()) {
            monitor_.report("geometry", done + (end - done) * double(at) / double(all));
            std::vector<Unit> units;
            std::size_t elements = 0;
            for (; next.mesh < meshes_.size() && units.size() < aheadCount; advance(next)) {
                elements += isShown(next) ? elementsOf(asset_, from(next)) : 0;
                if (elements > aheadElements && !units.empty()) break;
                units.push_back({next.mesh, next.primitive, {}, {}, {}});
            }
            at += units.size();
            if (units.size() > 1 && memory_.left() >= aheadBytes) {
                tbb::parallel_for(tbb::blocked_range<std::size_t>(0, units.size(), 8),
                                  [&](const auto& range) {
                                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                                          decodeAhead(units[i]);
                                  });
            }
            for (Unit& unit : units) take(unit);
        }
    }

    void advance(Unit& unit) const {
        if (++unit.primitive < meshes_[unit.mesh]["primitives"].size()) return;
        ++unit.mesh;
        unit.primitive = 0;
    }

    void decodeAhead(Unit& unit) const {
        if (!isShown(unit)) return;
        MemoryBudget taken = MemoryBudget::notesOf(asset_);
        try {
            unit.built = readPrimitive(asset_, from(unit), place(unit), taken, unit.notes);
            unit.taken.emplace(std::move(taken));
        } catch (const InputError&) {
            unit.built = {};  // told in its turn
        }
    }

    void take(Unit& unit) {
        const json& mesh = meshes_[unit.mesh];
        const json &primitives = mesh["primitives"], &primitive = from(unit);
        const std::size_t index = first_ + unit.mesh, targets = listOf(primitives[0], "targets").size();
        if (unit.primitive == 0) {
            memory_.take(fmt::format("meshes[{}].primitives", index), primitives.size() * sizeof(Primitive),
                         0);
            Mesh& made = scene_.meshes.emplace_back();
            made.primitives.reserve(primitives.size());
            made.name = mesh.value("name", "");
        }
        Mesh& made = scene_.meshes.back();
        if (const std::size_t own = listOf(primitive, "targets").size(); own != targets) {
            throw InputError(asset_.file(), place(unit) + ".targets",
                             fmt::format("has {} elements, the mesh's first primitive {}", own, targets),
                             "give every primitive of a mesh as many morph targets");
        }
        if (isShown(unit)) {
            for (const auto& [name, value] : extensionsOf(primitive).items()) {
                if (!isSupported(name)) skip(scene_, name, "is not supported");
            }
            decode(unit);
            readVariants(primitive, place(unit), scene_, memory_, unit.built);
            if (!unit.built.indices.empty()) made.primitives.push_back(std::move(unit.built));
        } else {
            skip(scene_, modeOf(primitive) == Mode::Points ? "points" : "lines", "only triangles are shown");
        }
        if (unit.primitive + 1 == primitives.size() && !made.primitives.empty())
            made.weights = morphWeights(asset_, mesh, targets, fmt::format("meshes[{}].weights", index));
    }

    void decode(Unit& unit) {
        if (unit.taken) {
            memory_.take(*unit.taken);
            for (const auto& [what, why] : unit.notes.skipped) skip(scene_, what, why);
            for (const std::string& warning : unit.notes.warnings) warn(scene_, warning);
        } else {
            unit.built = readPrimitive(asset_, from(unit), place(unit), memory_, scene_);
        }
    }

    const Asset& asset_;
    MemoryBudget& memory_;
    LoadMonitor& monitor_;
    helio::Scene& scene_;
    std::size_t first_ = 0;     ///< mesh of the batch
    std::vector<json> meshes_;  ///< of the batch
};

}  // namespace

std::vector<float> morphWeights(const Asset& asset, const json& object, std::size_t targets,
                                const std::string& place) {
    std::vector<float> weights;
    const json& from = listOf(object, "weights");
    if (from.empty()) return weights;
    if (from.size() != targets) {
        throw InputError(asset.file(), place,
                         fmt::format("has {} elements for {} morph targets", from.size(), targets),
                         "give one weight per morph target");
    }
    for (const json& weight : from) weights.push_back(weight.get<float>());
    return weights;
}

void buildMeshes(const Asset& asset, MemoryBudget& memory, LoadMonitor& monitor, helio::Scene& scene) {
    readVariantNames(asset, memory, scene);
    MeshBuilder(asset, memory, monitor, scene).build();
}

}  // namespace helio::gltf
