#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace helio {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

/** A scene that has one of everything. */
Scene whole() {
    Scene scene;
    scene.name = "built";
    scene.images.push_back({"image", 1, 1, std::vector<std::uint8_t>(4)});
    scene.textures.push_back({});
    scene.textures[0].image = 0;
    scene.materials.push_back({});
    scene.materials[0].baseColorTexture.texture = 0;
    Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.normals.assign(3, {0, 0, 1});
    primitive.tangents.assign(3, {1, 0, 0, 1});
    primitive.colors.assign(3, glm::vec4(1));
    primitive.texcoords.assign(1, {{0, 0}, {1, 0}, {0, 1}});
    primitive.indices = {0, 1, 2};
    primitive.material = 0;
    scene.meshes.push_back({"mesh", {primitive}});
    scene.cameras.push_back({});
    scene.lights.push_back({});
    scene.lights[0].type = PunctualLight::Type::Spot;
    scene.environment = Environment{glm::vec3(1), -1};
    scene.nodes.push_back({});
    scene.nodes[0].mesh = scene.nodes[0].camera = scene.nodes[0].light = 0;
    scene.roots = {0};
    return scene;
}

TEST(ValidateScene, AcceptsAWholeSceneAndAnEmptyOne) {
    EXPECT_NO_THROW(whole().validate());
    EXPECT_NO_THROW(Scene{}.validate());
}

TEST(ValidateScene, AcceptsTheBrightestLight) {
    Scene scene = whole();
    scene.materials[0].emission = scene.lights[0].intensity = scene.environment->radiance =
        glm::vec3(0x1p100f);
    EXPECT_NO_THROW(scene.validate());
}

TEST(ValidateScene, RefusesEachFaultNamingItsPlace) {
    struct Fault {
        const char* place;
        std::function<void(Scene&)> make;
    };
    const auto primitive = [](Scene& scene) -> Primitive& { return scene.meshes[0].primitives[0]; };
    const auto skin = [&](Scene& scene) {
        scene.skins = {{"skin", {0}, {}}};
        scene.nodes[0].skin = 0;
        primitive(scene).joints.assign(1, std::vector<glm::u16vec4>(3, glm::u16vec4(0)));
        primitive(scene).weights.assign(1, std::vector<glm::vec4>(3, glm::vec4(1, 0, 0, 0)));
    };
    const auto channel = [](Scene& scene) -> AnimationChannel& {
        scene.animations = {
            {"animation",
             {{0, AnimationPath::Translation, Interpolation::Linear, {0, 1}, std::vector<float>(6)}}}};
        return scene.animations[0].channels[0];
    };
    for (const auto& make : {std::function<void(Scene&)>(skin), std::function<void(Scene&)>(channel)}) {
        Scene scene = whole();
        make(scene);
        EXPECT_NO_THROW(scene.validate());
    }
    const Fault faults[] = {
        {"image 0", [](Scene& s) { s.images[0].width = 2; }},
        {"image 0", [](Scene& s) { s.images[0] = {}; }},
        {"texture 0", [](Scene& s) { s.textures[0].image = -1; }},
        {"texture 0", [](Scene& s) { s.textures[0].image = 1; }},
        {"material 0", [](Scene& s) { s.materials[0].baseColor.g = nan; }},
        {"material 0", [](Scene& s) { s.materials[0].baseColor.g = 1.5f; }},
        {"material 0", [](Scene& s) { s.materials[0].roughness = -0.1f; }},
        {"material 0", [](Scene& s) { s.materials[0].metallic = 2; }},
        {"material 0", [](Scene& s) { s.materials[0].emission.b = inf; }},
        {"material 0", [](Scene& s) { s.materials[0].emission.b = -1; }},
        {"material 0", [](Scene& s) { s.materials[0].ior = nan; }},
        {"material 0", [](Scene& s) { s.materials[0].normalTexture.texture = 1; }},
        {"material 0", [](Scene& s) { s.materials[0].baseColorTexture.texcoord = -1; }},
        {"material 0", [](Scene& s) { s.materials[0].baseColorTexture.transform[2][0] = inf; }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).material = 1; }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).indices[2] = 3; }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).indices.pop_back(); }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).normals.pop_back(); }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).tangents.pop_back(); }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).colors.pop_back(); }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).texcoords[0].pop_back(); }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).positions[1].y = nan; }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).normals[1].y = inf; }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).texcoords[0][2].x = nan; }},
        {"material 0", [](Scene& s) { s.materials[0].emission.b = 0x1.000002p100f; }},
        {"light 0", [](Scene& s) { s.lights[0].intensity.g = 0x1.000002p100f; }},
        {"environment", [](Scene& s) { s.environment->radiance.r = 0x1.000002p100f; }},
        {"camera 0", [](Scene& s) { s.cameras[0].yfov = 0; }},
        {"camera 0", [](Scene& s) { s.cameras[0].yfov = 3.2f; }},
        {"camera 0", [](Scene& s) { s.cameras[0].znear = 0; }},
        {"camera 0", [](Scene& s) { s.cameras[0].zfar = s.cameras[0].znear; }},
        {"camera 0", [](Scene& s) { s.cameras[0].perspective = false, s.cameras[0].ymag = 0; }},
        {"light 0", [](Scene& s) { s.lights[0].intensity.r = -1; }},
        {"light 0", [](Scene& s) { s.lights[0].range = nan; }},
        {"light 0", [](Scene& s) { s.lights[0].innerConeAngle = 1; }},
        {"environment", [](Scene& s) { s.environment->radiance.r = nan; }},
        {"environment", [](Scene& s) { s.environment->image = 3; }},
        {"node 0", [](Scene& s) { s.nodes[0].translation.x = nan; }},
        {"node 0", [](Scene& s) { s.nodes[0].mesh = 4; }},
        {"node 0", [](Scene& s) { s.nodes[0].children = {0}; }},
        {"roots", [](Scene& s) { s.roots = {-1}; }},
        {"material 0", [](Scene& s) { s.materials[0].transmission = 1.5f; }},
        {"material 0", [](Scene& s) { s.materials[0].thickness = -1; }},
        {"material 0", [](Scene& s) { s.materials[0].attenuationDistance = 0; }},
        {"material 0", [](Scene& s) { s.materials[0].attenuationDistance = nan; }},
        {"material 0", [](Scene& s) { s.materials[0].attenuationColor.g = 2; }},
        {"material 0", [](Scene& s) { s.materials[0].clearcoat = nan; }},
        {"material 0", [](Scene& s) { s.materials[0].clearcoatRoughness = -1; }},
        {"material 0", [](Scene& s) { s.materials[0].clearcoatNormalScale = inf; }},
        {"material 0", [](Scene& s) { s.materials[0].sheenColor.b = -1; }},
        {"material 0", [](Scene& s) { s.materials[0].sheenRoughness = 2; }},
        {"material 0", [](Scene& s) { s.materials[0].anisotropyStrength = 2; }},
        {"material 0", [](Scene& s) { s.materials[0].anisotropyRotation = inf; }},
        {"material 0", [](Scene& s) { s.materials[0].iridescence = -1; }},
        {"material 0", [](Scene& s) { s.materials[0].iridescenceIor = 0.5f; }},
        {"material 0", [](Scene& s) { s.materials[0].iridescenceThicknessMaximum = nan; }},
        {"material 0", [](Scene& s) { s.materials[0].dispersion = -1; }},
        {"material 0", [](Scene& s) { s.materials[0].sheenColorTexture.texture = 7; }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).variantMaterials = {0}; }},
        {"mesh 0 primitive 0", [&](Scene& s) { s.variants = {"a"}, primitive(s).variantMaterials = {5}; }},
        {"mesh 0 primitive 0",
         [&](Scene& s) { primitive(s).targets.resize(1), primitive(s).targets[0].normals.resize(2); }},
        {"mesh 0 primitive 0",
         [&](Scene& s) {
             primitive(s).targets = {{{{0, 0, 0}, {0, nan, 0}, {0, 0, 0}}, {}, {}}};
         }},
        {"mesh 0 primitive 1",
         [&](Scene& s) { s.meshes[0].primitives.push_back(primitive(s)), primitive(s).targets.resize(1); }},
        {"mesh 0", [](Scene& s) { s.meshes[0].weights = {1}; }},
        {"mesh 0 primitive 0", [&](Scene& s) { primitive(s).joints.resize(1); }},
        {"mesh 0 primitive 0", [&](Scene& s) { skin(s), primitive(s).weights[0].pop_back(); }},
        {"mesh 0 primitive 0", [&](Scene& s) { skin(s), primitive(s).weights[0][1].w = nan; }},
        {"node 0", [&](Scene& s) { skin(s), primitive(s).joints[0][2].z = 1; }},
        {"node 0", [](Scene& s) { s.nodes[0].skin = 0; }},
        {"node 0", [](Scene& s) { s.nodes[0].weights = {1}; }},
        {"skin 0", [&](Scene& s) { skin(s), s.skins[0].joints = {3}; }},
        {"skin 0", [&](Scene& s) { skin(s), s.skins[0].joints.clear(); }},
        {"skin 0", [&](Scene& s) { skin(s), s.skins[0].inverseBindMatrices.resize(2); }},
        {"skin 0", [&](Scene& s) { skin(s), s.skins[0].inverseBindMatrices = {glm::mat4(nan)}; }},
        {"animation 0 channel 0", [&](Scene& s) { channel(s).node = 1; }},
        {"animation 0 channel 0", [&](Scene& s) { channel(s).times = {}; }},
        {"animation 0 channel 0",
         [&](Scene& s) {
             channel(s).times = {1, 0};
         }},
        {"animation 0 channel 0",
         [&](Scene& s) {
             channel(s).times = {0, nan};
         }},
        {"animation 0 channel 0", [&](Scene& s) { channel(s).values.pop_back(); }},
        {"animation 0 channel 0", [&](Scene& s) { channel(s).values[3] = inf; }},
        {"animation 0 channel 0", [&](Scene& s) { channel(s).path = AnimationPath::Weights; }},
        {"animation 0 channel 0", [&](Scene& s) { channel(s), s.nodes[0].matrix = glm::mat4(1); }},
    };
    int index = 0;
    for (const Fault& fault : faults) {
        Scene scene = whole();
        fault.make(scene);
        try {
            scene.validate();
            ADD_FAILURE() << "fault " << index << " (" << fault.place << ") was accepted";
        } catch (const InputError& error) {
            EXPECT_EQ(error.file, "built");
            EXPECT_EQ(error.place, fault.place) << "fault " << index;
        }
        ++index;
    }
}

}  // namespace
}  // namespace helio
