#include "tests/support/scene_features.hpp"

namespace helio::test {

SceneBuilder plainRoom() {
    SceneBuilder b;
    const int grey = b.material(glm::vec3(0.5f));
    b.room({-1, -1, -1}, {1, 1, 1}, {grey, grey, grey, grey, grey, grey});
    b.camera({0, 0, 0.9f}, {0, 0, -1}, 1.0f);
    return b;
}

namespace {

/** Gives the room's material a texture of one texel. */
TextureUse addTexture(Scene& scene, bool floats) {
    TextureImage image;
    image.width = image.height = 1;
    if (floats)
        image.texels = std::vector<float>{0.5f, 0.25f, 0.75f, 1.0f};
    else
        image.texels = std::vector<std::uint8_t>{128, 64, 192, 255};
    scene.images.push_back(image);
    Texture texture;
    texture.image = int(scene.images.size()) - 1;
    scene.textures.push_back(texture);
    for (Mesh& mesh : scene.meshes)
        for (Primitive& p : mesh.primitives) p.texcoords = {std::vector<glm::vec2>(p.positions.size())};
    TextureUse use;
    use.texture = int(scene.textures.size()) - 1;
    return use;
}

void forAll(Scene& scene, const std::function<void(Primitive&)>& change) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& p : mesh.primitives) change(p);
}

/** A triangle of a material of its own; returns the material. */
int another(SceneBuilder& b) {
    const int material = b.material(glm::vec3(0.5f));
    b.triangles({{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}}, material);
    return material;
}

/** A material that glTF's model makes more than diffuse, to which `change` adds. */
std::function<void(SceneBuilder&)> glossy(const std::function<void(Material&)>& change) {
    return [change](SceneBuilder& b) {
        Material& m = b.scene.materials[0];
        m.specular = 1;
        m.roughness = 0.5f;
        change(m);
    };
}

}  // namespace

const std::vector<Feature>& features() {
    static const std::vector<Feature> list = {
        {"constant surroundings",
         [](SceneBuilder& b) { b.scene.environment = Environment{glm::vec3(1.0f)}; },
         {}},
        {"surroundings of an image", [](SceneBuilder& b) { b.whiteImageAround(); }, {"uEnvironmentMap"}},
        {"emissive triangles",
         [](SceneBuilder& b) {
             b.triangles({{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}},
                         b.material(glm::vec3(0.5f), glm::vec3(1.0f)));
         },
         {}},
        {"emission textures",
         [](SceneBuilder& b) {
             b.scene.materials[0].emission = glm::vec3(1.0f);
             b.scene.materials[0].emissiveTexture = addTexture(b.scene, false);
         },
         {"uLights", "uTexels8", "uTextures", "uTexcoords"}},
        {"a point light",
         [](SceneBuilder& b) {
             b.pointLight({0, 0, 0}, glm::vec3(1.0f));
         },
         {}},
        {"a choice among lights",
         [](SceneBuilder& b) {
             for (int i = 0; i < 3; ++i) b.pointLight({0.1f * float(i), 0, 0}, glm::vec3(1.0f + float(i)));
         },
         {"uLights", "uLightSlots"}},
        {"shapes",
         [](SceneBuilder& b) {
             Primitive ball;
             ball.shape = Shape{.radius = 0.25f};
             ball.material = 0;
             Node node;
             node.mesh = int(b.scene.meshes.size());
             b.scene.meshes.push_back({"ball", {ball}});
             b.scene.roots.push_back(int(b.scene.nodes.size()));
             b.scene.nodes.push_back(node);
         },
         {}},
        {"vertex normals",
         [](SceneBuilder& b) {
             forAll(b.scene, [](Primitive& p) { p.normals.assign(p.positions.size(), glm::vec3(0, 0, 1)); });
         },
         {"uNormals"}},
        {"vertex colours",
         [](SceneBuilder& b) {
             forAll(b.scene, [](Primitive& p) { p.colors.assign(p.positions.size(), glm::vec4(0.5f)); });
         },
         {"uColors"}},
        {"base colour textures",
         [](SceneBuilder& b) { b.scene.materials[0].baseColorTexture = addTexture(b.scene, false); },
         {"uTexels8", "uTextures", "uTexcoords"}},
        {"textures of floats",
         [](SceneBuilder& b) { b.scene.materials[0].baseColorTexture = addTexture(b.scene, true); },
         {"uTexelsFloat", "uTextures", "uTexcoords"}},
        {"alpha", [](SceneBuilder& b) { b.scene.materials[0].alphaMode = AlphaMode::Blend; }, {}},
        {"normal maps",
         [](SceneBuilder& b) { b.scene.materials[0].normalTexture = addTexture(b.scene, false); },
         {"uTangents", "uTexels8", "uTextures", "uTexcoords"}},
        {"gloss", glossy([](Material&) {}), {}},
        {"transmission", glossy([](Material& m) { m.transmission = 0.5f; }), {}},
        {"clear coat", glossy([](Material& m) { m.clearcoat = 0.5f; }), {}},
        {"sheen", glossy([](Material& m) { m.sheenColor = glm::vec3(0.5f); }), {}},
        {"thin films", glossy([](Material& m) { m.iridescence = 0.5f; }), {}},
        {"anisotropy", glossy([](Material& m) { m.anisotropyStrength = 0.5f; }), {"uTangents"}},
        {"unlit surfaces",
         [](SceneBuilder& b) { b.scene.materials[std::size_t(another(b))].unlit = true; },
         {}},
        {"mirrors",
         [](SceneBuilder& b) {
             Material& m = b.scene.materials[std::size_t(another(b))];
             m.scattering = Scattering{};
             m.scattering->model = Scattering::Model::Mirror;
         },
         {}},
        {"a tree",
         [](SceneBuilder& b) {
             b.sphere({0, 0, 0}, 0.3f, 2, false, 0);
         },
         {"uNodes"}},
    };
    return list;
}

}  // namespace helio::test
