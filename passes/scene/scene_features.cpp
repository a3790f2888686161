// The features the device scene and the path tracer choose by.
#include <heliograph/features.hpp>
#include <heliograph/scene.hpp>

#include <algorithm>

namespace helio {
namespace {

template <typename Condition>
bool anyPrimitive(const Scene& scene, Condition condition) {
    return std::ranges::any_of(
        scene.meshes, [&](const Mesh& mesh) { return std::ranges::any_of(mesh.primitives, condition); });
}
template <typename Condition>
bool anyMaterial(const Scene& scene, Condition condition) {
    return std::ranges::any_of(scene.materials, condition);
}

const RegisterFeature normals{
    {"geometry.normals", "surfaces are flat: no vertex normals are stored or read", [](const Scene& scene) {
         return anyPrimitive(scene, [](const Primitive& p) { return !p.normals.empty(); });
     }}};
const RegisterFeature shapes{
    {"geometry.shapes", "all surfaces are triangles: nothing else is intersected", [](const Scene& scene) {
         return anyPrimitive(scene, [](const Primitive& p) { return p.shape.has_value(); });
     }}};
const RegisterFeature colors{
    {"geometry.colors", "no vertex colours are stored or read", [](const Scene& scene) {
         return anyPrimitive(scene, [](const Primitive& p) { return !p.colors.empty(); });
     }}};
const RegisterFeature baseTextures{
    {"textures.baseColor", "base colours are constant: no texture is stored or filtered",
     [](const Scene& scene) {
         return anyMaterial(scene, [](const Material& m) { return bool(m.baseColorTexture); });
     }}};
const RegisterFeature emissiveTextures{
    {"textures.emissive", "emission is constant per material", [](const Scene& scene) {
         return anyMaterial(
             scene, [](const Material& m) { return m.emissiveTexture && m.emission != glm::vec3(0.0f); });
     }}};
const RegisterFeature areaLights{
    {"lights.area", "no surface emits: nothing is added at hits", [](const Scene& scene) {
         return anyMaterial(scene, [](const Material& m) { return m.emission != glm::vec3(0.0f); });
     }}};
const RegisterFeature punctual{
    {"lights.punctual", "no point, spot or directional light is sampled", [](const Scene& scene) {
         return std::ranges::any_of(scene.nodes, [](const Node& node) { return node.light >= 0; });
     }}};
const RegisterFeature environment{
    {"lights.environment", "rays that leave the scene bring nothing",
     [](const Scene& scene) { return scene.environment && scene.environment->radiance != glm::vec3(0.0f); }}};

}  // namespace
}  // namespace helio
