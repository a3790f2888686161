#include "tests/unit/gltf_support.hpp"

#include <set>

namespace helio::test {
namespace {

/** Three nodes, two meshes, two images. */
fs::path writeScene(const fs::path& folder, const std::string& red, const std::string& blue) {
    GltfDocument file = GltfDocument::triangle();
    file.primitive()["attributes"]["TEXCOORD_0"] = file.addAccessor<float>({0, 0, 1, 0, 0, 1}, "VEC2", 3);
    for (const std::string& png : {red, blue}) {
        file.doc["images"].push_back({{"bufferView", file.addView(png)}, {"mimeType", "image/png"}});
        file.doc["textures"].push_back({{"source", file.doc["images"].size() - 1}});
    }
    file.doc["materials"] = json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                          {"emissiveTexture", {{"index", 1}}}}});
    file.primitive()["material"] = 0;
    file.doc["meshes"].push_back(file.doc["meshes"][0]);
    file.doc["nodes"].push_back({{"mesh", 1}});
    file.doc["scenes"][0]["nodes"].push_back(1);
    std::ofstream(folder / "scene.glb", std::ios::binary) << file.glb();
    return folder / "scene.glb";
}

TEST_F(Gltf, LoadingReportsItsStages) {
    const fs::path file = writeScene(folder_, png(1, 0, 0), png(0, 0, 1));
    std::set<std::string> stages;
    LoadOptions options;
    options.progress = [&](const LoadProgress& progress) {
        EXPECT_GE(progress.fraction, 0);
        EXPECT_LE(progress.fraction, 1);
        stages.insert(progress.stage);
        return true;
    };
    EXPECT_EQ(helio::load(file.string(), options).images.size(), 2u);
    EXPECT_TRUE(stages.contains("geometry"));
    EXPECT_TRUE(stages.contains("images"));
}

TEST_F(Gltf, LoadingStopsWhereverItIsAskedTo) {
    const fs::path file = writeScene(folder_, png(1, 0, 0), png(0, 0, 1));
    bool isWhole = false;
    for (int allowed = 0; !isWhole; ++allowed) {
        int calls = 0;
        LoadOptions options;
        options.progress = [&](const LoadProgress&) { return calls++ < allowed; };
        try {
            helio::load(file.string(), options);
            isWhole = true;
            EXPECT_GE(allowed, 4);
        } catch (const Cancelled&) {
            EXPECT_EQ(calls, allowed + 1) << "asked again after it was told to stop";
        }
    }
}

}  // namespace
}  // namespace helio::test
