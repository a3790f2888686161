#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace helio {

void chooseVariant(Scene& scene, const std::string& name) {
    const auto found = std::find(scene.variants.begin(), scene.variants.end(), name);
    if (found == scene.variants.end()) {
        std::string known;
        for (const std::string& variant : scene.variants) known += (known.empty() ? "" : ", ") + variant;
        throw InputError(scene.name, "variant", fmt::format("there is no variant '{}'", name),
                         known.empty() ? "the scene has none" : "give one of " + known);
    }
    const auto index = std::size_t(found - scene.variants.begin());
    for (Mesh& mesh : scene.meshes) {
        for (Primitive& primitive : mesh.primitives) {
            if (index < primitive.variantMaterials.size())
                primitive.material = primitive.variantMaterials[index];
        }
    }
}

}  // namespace helio
