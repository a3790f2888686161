#include "tests/unit/gltf_support.hpp"

#include <heliograph/pose.hpp>

#include <functional>

namespace helio::test {
namespace {

glm::vec3 vertex(const Scene& still, std::size_t index) {
    const Instance placed = still.instances().at(0);
    const Primitive& primitive = still.meshes[std::size_t(placed.mesh)].primitives.at(0);
    return placed.transform * glm::dvec4(primitive.positions.at(index), 1.0);
}

/** The triangle, each vertex on a joint of its own: nodes 1 to 3, children of node 4. Bind positions are the
 * vertices'. */
template <class Joint, class Weight>
GltfDocument skinnedTriangle(Weight one) {
    GltfDocument file = GltfDocument::triangle();
    std::vector<Joint> joints;
    std::vector<Weight> weights;
    for (int v = 0; v < 3; ++v) {
        joints.insert(joints.end(), {Joint(v), 0, 0, 0});
        weights.insert(weights.end(), {one, 0, 0, 0});
    }
    json& attributes = file.primitive()["attributes"];
    attributes["JOINTS_0"] = file.addAccessor(joints, "VEC4", 3);
    attributes["WEIGHTS_0"] = file.addAccessor(weights, "VEC4", 3, !std::is_same_v<Weight, float>);
    std::vector<float> matrices;
    for (const glm::vec2& at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)})
        matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -at.x, -at.y, 0, 1});
    file.doc["skins"] = {
        {{"joints", {1, 2, 3}}, {"inverseBindMatrices", file.addAccessor(matrices, "MAT4", 3)}}};
    file.doc["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0, "translation": [9, 9, 9]},
        {}, {"translation": [1, 0, 0]}, {"translation": [0, 1, 0]}, {"children": [1, 2, 3]}])");
    file.doc["scenes"] = {{{"nodes", {0, 4}}}};
    return file;
}

void addAnimation(GltfDocument& file, int node, const char* path, int input, int output,
                  const char* interpolation = "LINEAR") {
    json& animation = file.doc["animations"][0];
    animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

TEST_F(Gltf, SkinsOfEveryTypeStandAsModelledAndFollowTheirJoints) {
    const auto test = [&](GltfDocument file) {
        const int times = file.addAccessor<float>({0, 1}, "SCALAR", 2);
        addAnimation(file, 2, "translation", times, file.addAccessor<float>({1, 0, 0, 1, 0, 8}, "VEC3", 2));
        const Scene scene = load(file);
        EXPECT_NO_THROW(scene.validate());
        EXPECT_TRUE(scene.skipped.empty());
        EXPECT_EQ(vertex(posed(scene), 1), glm::vec3(1, 0, 0));
        EXPECT_EQ(vertex(posed(scene, 0.5), 0), glm::vec3(0, 0, 0));
        EXPECT_EQ(vertex(posed(scene, 0.5), 1), glm::vec3(1, 0, 4));
        EXPECT_EQ(vertex(posed(scene, 0.5), 2), glm::vec3(0, 1, 0));
    };
    test(skinnedTriangle<std::uint8_t, float>(1));
    test(skinnedTriangle<std::uint16_t, float>(1));
    test(skinnedTriangle<std::uint8_t, std::uint8_t>(255));
    test(skinnedTriangle<std::uint16_t, std::uint16_t>(65535));
}

TEST_F(Gltf, AnimatesEveryPathWithEveryInterpolation) {
    for (const char* interpolation : {"LINEAR", "STEP", "CUBICSPLINE"}) {
        GltfDocument file = GltfDocument::triangle();
        const bool isSpline = interpolation[0] == 'C';
        const auto keys = [&](const std::vector<float>& first, const std::vector<float>& second) {
            return twoKeys(first, second, isSpline);
        };
        const std::size_t count = isSpline ? 6 : 2;
        const int times = file.addAccessor<float>({0, 2}, "SCALAR", 2);
        addAnimation(file, 0, "translation", times,
                     file.addAccessor(keys({0, 0, 0}, {2, 4, 6}), "VEC3", count), interpolation);
        addAnimation(file, 0, "scale", times, file.addAccessor(keys({1, 1, 1}, {3, 3, 3}), "VEC3", count),
                     interpolation);
        addAnimation(file, 0, "rotation", times,
                     file.addAccessor(keys({0, 0, 0, 1}, {0, 0, 1, 0}), "VEC4", count), interpolation);
        const glm::vec3 at = vertex(posed(load(file), 1), 1);
        // Halfway: scaled by 2, turned by a quarter about +Z, moved.
        const glm::vec3 expected = interpolation[0] == 'S' ? glm::vec3(1, 0, 0) : glm::vec3(1, 4, 3);
        EXPECT_LT(glm::distance(at, expected), 1e-6f) << interpolation;
    }
}

template <class T>
GltfDocument withNormalizedRotation(T one) {
    GltfDocument file = GltfDocument::triangle();
    const int times = file.addAccessor<float>({0, 1}, "SCALAR", 2);
    const int turns = file.addAccessor<T>({0, 0, 0, one, 0, 0, one, 0}, "VEC4", 2, true);
    addAnimation(file, 0, "rotation", times, turns);
    return file;
}

TEST_F(Gltf, ReadsNormalizedAnimations) {
    const auto test = [&](const GltfDocument& file) {
        EXPECT_LT(glm::distance(vertex(posed(load(file), 0.5), 1), glm::vec3(0, 1, 0)), 1e-6f);
    };
    test(withNormalizedRotation<std::int8_t>(127));
    test(withNormalizedRotation<std::uint8_t>(255));
    test(withNormalizedRotation<std::int16_t>(32767));
    test(withNormalizedRotation<std::uint16_t>(65535));
}

TEST_F(Gltf, ReadsMorphTargetsDenseSparseAndQuantized) {
    GltfDocument file = GltfDocument::triangle();
    const int dense = file.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    // 4-byte steps, as the extension asks.
    const int quantized =
        file.addAccessor<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 3, true);
    file.doc["bufferViews"].back()["byteStride"] = 4;
    const int sparse = int(file.doc["accessors"].size());
    const int indices = file.addView(packed<std::uint8_t>({2})),
              values = file.addView(packed<float>({0, 5, 0}));
    file.doc["accessors"].push_back({{"componentType", 5126},
                                     {"count", 3},
                                     {"type", "VEC3"},
                                     {"sparse",
                                      {{"count", 1},
                                       {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                       {"values", {{"bufferView", values}}}}}});
    file.primitive()["targets"] = {{{"POSITION", dense}}, {{"POSITION", quantized}}, {{"POSITION", sparse}}};
    file.doc["meshes"][0]["weights"] = {2, 0, 1};
    const Scene scene = load(file);
    EXPECT_EQ(vertex(posed(scene), 0), glm::vec3(0, 0, 2));
    EXPECT_EQ(vertex(posed(scene), 2), glm::vec3(0, 6, 2));
    file.doc["nodes"][0]["weights"] = {0, 3, 0};
    const Scene ofNode = load(file);
    EXPECT_EQ(vertex(posed(ofNode), 1), glm::vec3(4, 0, 0));
    EXPECT_EQ(vertex(posed(ofNode), 2), glm::vec3(0, 1, 0));
    const int times = file.addAccessor<float>({0, 1}, "SCALAR", 2);
    addAnimation(file, 0, "weights", times, file.addAccessor<float>({0, 0, 0, 4, 0, 2}, "SCALAR", 6));
    EXPECT_EQ(vertex(posed(load(file), 0.5), 2), glm::vec3(0, 6, 2));
}

TEST_F(Gltf, RefusesBrokenMotionNamingThePlace) {
    struct Fault {
        const char* place;
        std::function<void(GltfDocument&)> make;
    };
    const Fault faults[] = {
        {"skins[0].joints[0]", [](auto& f) { f.doc["skins"][0]["joints"][0] = 77; }},
        {"skins[0].joints", [](auto& f) { f.doc["skins"][0]["joints"] = json::array(); }},
        {"nodes[0].skin",
         [](auto& f) {
             f.doc["skins"][0]["joints"] = {1, 2};
         }},
        {"skins[0].inverseBindMatrices",
         [](auto& f) {
             f.doc["skins"][0]["joints"] = {1, 2, 3, 4};
         }},
        {"skins[0].inverseBindMatrices", [](auto& f) { f.doc["skins"][0]["inverseBindMatrices"] = 0; }},
        {"meshes[0].primitives[0].attributes",
         [](auto& f) { f.primitive()["attributes"].erase("WEIGHTS_0"); }},
        {"meshes[0].primitives[0].attributes.JOINTS_0",
         [](auto& f) { f.primitive()["attributes"]["JOINTS_0"] = f.primitive()["attributes"]["WEIGHTS_0"]; }},
        {"meshes[0].weights", [](auto& f) { f.doc["meshes"][0]["weights"] = {1}; }},
        {"nodes[0].weights",
         [](auto& f) {
             f.doc["nodes"][0]["weights"] = {1, 2};
         }},
        {"animations[0].channels[0].sampler",
         [](auto& f) { f.doc["animations"][0]["channels"][0]["sampler"] = 1; }},
        {"animations[0].channels[0].target.node",
         [](auto& f) { f.doc["animations"][0]["channels"][0]["target"]["node"] = 99; }},
        {"animations[0].samplers[0].interpolation",
         [](auto& f) { f.doc["animations"][0]["samplers"][0]["interpolation"] = "SINE"; }},
        {"animations[0].samplers[0].output",
         [](auto& f) { f.doc["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE"; }},
        {"animations[0].samplers[0].output",
         [](auto& f) { f.doc["animations"][0]["channels"][0]["target"]["path"] = "rotation"; }},
        {"animations[0].samplers[0].output",
         [](auto& f) { f.doc["animations"][0]["channels"][0]["target"]["path"] = "weights"; }},
        {"animations[0].samplers[0].input",
         [](auto& f) {
             f.doc["animations"][0]["samplers"][0]["input"] =
                 f.template addAccessor<float>({1, 0}, "SCALAR", 2);
         }},
        {"animations[0].channels[0].target",
         [](auto& f) {
             f.doc["nodes"][2] = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
         }},
    };
    int index = 0;
    for (const Fault& fault : faults) {
        GltfDocument file = skinnedTriangle<std::uint8_t, float>(1);
        const int times = file.addAccessor<float>({0, 1}, "SCALAR", 2);
        addAnimation(file, 2, "translation", times, file.addAccessor<float>({1, 0, 0, 1, 0, 8}, "VEC3", 2));
        fault.make(file);
        try {
            load(file);
            ADD_FAILURE() << "fault " << index << " (" << fault.place << ") was accepted";
        } catch (const InputError& error) {
            EXPECT_EQ(error.place, fault.place) << "fault " << index << ": " << error.what();
            EXPECT_FALSE(error.remedy.empty());
        }
        ++index;
    }
}

}  // namespace
}  // namespace helio::test
