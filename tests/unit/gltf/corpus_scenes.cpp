#include "tests/unit/gltf/corpus.hpp"

#include <heliograph/pose.hpp>

namespace helio::test {
namespace {

glm::dvec3 vertexAt(const Scene& scene, double time, std::size_t index) {
    const Scene still = posed(scene, time);
    const Instance placed = still.instances().at(0);
    const Primitive& primitive = still.meshes[std::size_t(placed.mesh)].primitives.at(0);
    return glm::dvec3(placed.transform * glm::dvec4(primitive.positions.at(index), 1.0));
}

int addTimes(GltfDocument& file, const std::vector<float>& times) {
    return withBounds(file, file.addAccessor(times, "SCALAR", times.size()), times, 1);
}

void addChannel(GltfDocument& file, const char* path, int input, int output, const char* interpolation,
                int node = 0) {
    json& animation = file.doc["animations"][0];
    animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

template <class Joint, class Weight>
void addSkin(std::vector<CorpusFile>& files, const char* name) {
    GltfDocument file = boundedTriangle();
    const Weight one = std::is_same_v<Weight, float> ? Weight(1) : std::numeric_limits<Weight>::max();
    json& attributes = file.primitive()["attributes"];
    attributes["JOINTS_0"] = addVertices<Joint>(file, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 4);
    attributes["WEIGHTS_0"] = addVertices<Weight>(file, {one, 0, 0, 0, one, 0, 0, 0, one, 0, 0, 0}, 4,
                                                  !std::is_same_v<Weight, float>);
    const int matrices = file.addAccessor<float>(
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
        "MAT4", 2);
    file.doc["skins"] = json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}});
    file.doc["nodes"] = json::parse(
        R"([{"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [1, 0, 0], "rotation": [0, 0, 0, 1]}])");
    file.doc["scenes"][0]["nodes"] = {0, 1};
    const int times = addTimes(file, {0, 2});
    addChannel(file, "translation", times, file.addAccessor<float>({1, 0, 0, 1, 4, 0}, "VEC3", 2), "LINEAR",
               2);
    files.push_back({name, file, [](const Scene& scene) {
                         EXPECT_EQ(vertexAt(scene, 1, 0), glm::dvec3(0));
                         EXPECT_EQ(vertexAt(scene, 1, 1), glm::dvec3(1, 2, 0));
                         EXPECT_EQ(vertexAt(scene, 1, 2), glm::dvec3(0, 1, 0));
                     }});
}

void addMorphs(std::vector<CorpusFile>& files) {
    GltfDocument file = boundedTriangle();
    file.primitive()["attributes"]["NORMAL"] = addVertices<float>(file, {0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    file.primitive()["attributes"]["TANGENT"] =
        addVertices<float>(file, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, 4);
    const std::vector<float> up{0, 0, 1, 0, 0, 1, 0, 0, 1};
    const int positions = withBounds(file, addVertices(file, up, 3), up, 3);
    const int normals = addVertices<float>(file, {1, 0, -1, 1, 0, -1, 1, 0, -1}, 3);
    const int tangents = addVertices<float>(file, {-1, 0, -1, -1, 0, -1, -1, 0, -1}, 3);
    const int indices = file.addView(packed<std::uint8_t>({2})),
              values = file.addView(packed<float>({0, 5, 0}));
    file.doc["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    json& sparse = file.doc["accessors"].back();
    sparse["min"] = {0, 0, 0}, sparse["max"] = {0, 5, 0};
    sparse["sparse"] = {{"count", 1},
                        {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                        {"values", {{"bufferView", values}}}};
    const int last = int(file.doc["accessors"].size()) - 1;
    file.primitive()["targets"] = {{{"POSITION", positions}, {"NORMAL", normals}, {"TANGENT", tangents}},
                                   {{"POSITION", last}}};
    file.doc["meshes"][0]["weights"] = {0, 1};
    const int times = addTimes(file, {0, 2});
    addChannel(file, "weights", times, file.addAccessor<float>({0, 0, 2, 1}, "SCALAR", 4), "LINEAR");
    files.push_back({"morph_targets", file, [](const Scene& scene) {
                         EXPECT_EQ(vertexAt(scene, 0, 2), glm::dvec3(0, 1, 0));
                         EXPECT_EQ(vertexAt(scene, 1, 2), glm::dvec3(0, 3.5, 1));
                         EXPECT_EQ(vertexAt(scene, 2, 0), glm::dvec3(0, 0, 2));
                         const Scene still = posed(scene, 1);
                         const Primitive& p = still.meshes.back().primitives.at(0);
                         EXPECT_EQ(p.normals.at(0), glm::vec3(1, 0, 0));
                         EXPECT_EQ(glm::vec3(p.tangents.at(0)), glm::vec3(0, 0, -1));
                     }});
}

void addAnimations(std::vector<CorpusFile>& files) {
    for (const char* interpolation : {"LINEAR", "STEP", "CUBICSPLINE"}) {
        GltfDocument file = boundedTriangle();
        file.doc["nodes"][0]["scale"] = {1, 1, 1};
        const bool isSpline = interpolation[0] == 'C';
        const auto keys = [&](const std::vector<float>& first, const std::vector<float>& second) {
            return twoKeys(first, second, isSpline);
        };
        const std::size_t count = isSpline ? 6 : 2;
        const int times = addTimes(file, {0, 2});
        const auto add = [&](const char* path, const char* type, const std::vector<float>& values) {
            addChannel(file, path, times, file.addAccessor(values, type, count), interpolation);
        };
        add("translation", "VEC3", keys({0, 0, 0}, {2, 4, 6}));
        add("rotation", "VEC4", keys({0, 0, 0, 1}, {0, 0, 1, 0}));
        add("scale", "VEC3", keys({1, 1, 1}, {3, 3, 3}));
        files.push_back({std::string("animation_") + interpolation, file,
                         [isStep = interpolation[0] == 'S'](const Scene& scene) {
                             const glm::dvec3 expected = isStep ? glm::dvec3(1, 0, 0) : glm::dvec3(1, 4, 3);
                             EXPECT_LT(glm::distance(vertexAt(scene, 1, 1), expected), 1e-6);
                         }});
    }
}

void addCamerasAndAlpha(std::vector<CorpusFile>& files) {
    GltfDocument cameras = boundedTriangle();
    cameras.doc["cameras"] = json::parse(
        R"([{"type": "perspective", "perspective": {"yfov": 1.2, "znear": 0.1, "aspectRatio": 1.5}},
            {"type": "orthographic", "orthographic": {"xmag": 4, "ymag": 2, "znear": 0, "zfar": 10}}])");
    cameras.doc["nodes"].push_back({{"camera", 0}});
    cameras.doc["nodes"].push_back({{"camera", 1}});
    cameras.doc["scenes"][0]["nodes"] = {0, 1, 2};
    files.push_back({"cameras", cameras, [](const Scene& scene) {
                         EXPECT_EQ(scene.placedCameras().size(), 2u);
                         EXPECT_FLOAT_EQ(scene.cameras.at(0).yfov, 1.2f);
                         EXPECT_FLOAT_EQ(scene.cameras.at(1).ymag, 2);
                     }});

    GltfDocument alpha = boundedTriangle();
    alpha.primitive()["material"] = 0;
    alpha.doc["materials"] = json::parse(
        R"([{"alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true}, {"alphaMode": "BLEND"}, {}])");
    files.push_back({"alpha_modes", alpha, [](const Scene& scene) {
                         EXPECT_EQ(scene.materials.at(0).alphaMode, AlphaMode::Mask);
                         EXPECT_EQ(scene.materials.at(0).alphaCutoff, 0.25f);
                         EXPECT_TRUE(scene.materials.at(0).doubleSided);
                         EXPECT_EQ(scene.materials.at(1).alphaMode, AlphaMode::Blend);
                         EXPECT_EQ(scene.materials.at(2).alphaMode, AlphaMode::Opaque);
                     }});
}

}  // namespace

void addSceneFiles(std::vector<CorpusFile>& files) {
    addSkin<std::uint8_t, float>(files, "skin_ubyte_float");
    addSkin<std::uint16_t, float>(files, "skin_ushort_float");
    addSkin<std::uint8_t, std::uint8_t>(files, "skin_ubyte_ubyte");
    addSkin<std::uint16_t, std::uint16_t>(files, "skin_ushort_ushort");
    addMorphs(files);
    addAnimations(files);
    addCamerasAndAlpha(files);
}

}  // namespace helio::test
