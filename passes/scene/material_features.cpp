// The features of materials that kernels are compiled for.
#include "passes/scene/material_layout.hpp"

#include <heliograph/features.hpp>

#include <algorithm>

namespace helio {
namespace {

FeatureRule rule(const char* name, const char* whenAbsent, std::uint32_t bits) {
    return {name, whenAbsent, [bits](const Scene& scene) {
                return std::ranges::any_of(scene.materials, [&](const Material& m) {
                    return (pack::materialFeatures(m) & bits) != 0;
                });
            }};
}

const RegisterFeature specular{rule("materials.specular", "surfaces are diffuse", pack::kSpecularFeature)};
const RegisterFeature transmission{
    rule("materials.transmission", "no light goes through surfaces", pack::kTransmissionFeature)};
const RegisterFeature layers{rule("materials.layers", "no clear coat, sheen or thin film is shaded",
                                  pack::kClearcoatFeature | pack::kSheenFeature | pack::kIridescenceFeature)};
const RegisterFeature normalMaps{
    rule("materials.normalMaps", "normals are those of the vertices",
         pack::kNormalMapFeature | pack::kBumpFeature)};
const RegisterFeature alpha{rule("materials.alpha", "every surface stops light", pack::kAlphaFeature)};
const RegisterFeature models{rule("materials.models", "surfaces scatter as glTF says", pack::kModelFeatures)};

}  // namespace
}  // namespace helio
