#include "tests/support/sanitized.hpp"
#include "tests/unit/gltf_support.hpp"

#include <sys/stat.h>

#include <set>
#include <tuple>

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

TEST_F(Gltf, AFileByAnotherFormatsNameIsToldItsOwn) {
    const std::string glb = GltfDocument::triangle().glb();
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n";
    const std::tuple<const char*, std::string, const char*> files[] = {
        {"a.obj", glb, "name it .glb"}, {"a.stl", glb, "name it .glb"}, {"a.PLY", glb, "name it .glb"},
        {"b.obj", ply, "name it .ply"}, {"b.stl", ply, "name it .ply"}, {"b.gltf", ply, "name it .ply"}};
    for (const auto& [name, content, remedy] : files) {
        try {
            helio::load(write(name, content).string());
            ADD_FAILURE() << name;
        } catch (const InputError& error) {
            EXPECT_EQ(error.remedy, remedy) << error.what();
        }
    }
    EXPECT_EQ(helio::load(write("a.gltf", glb).string()).triangleCount(), 1u);  // of two names of one format
}

/** What is said where a scene cannot be loaded; empty where it can. */
std::string faultOf(const fs::path& scene) {
    try {
        helio::load(scene.string());
    } catch (const InputError& error) {
        return error.fault;
    }
    return {};
}

/** Strings above 64 KiB are left where they lie in the file. */
TEST_F(Gltf, LongStringsAreReadInPlace) {
    constexpr std::size_t count = 9000;
    GltfDocument file = GltfDocument::triangle();
    std::vector<float> positions;
    for (std::size_t i = 0; i < 3 * count; ++i) positions.push_back(float(i * 37 % 1000) / 7);
    file.primitive()["attributes"]["POSITION"] = file.addAccessor(positions, "VEC3", count);
    file.doc["nodes"][0]["name"] = std::string(100000, 'x');
    file.doc["asset"]["copyright"] = std::string(70000, 'c') + "\"\\";
    const std::string plain = file.withInlineBuffer().dump();
    ASSERT_GT(plain.size(), 300000u);
    const auto replaced = [&](char from, const std::string& to) {
        std::string text = plain;
        for (std::size_t at = text.find("base64,") + 7; text[at] != '"'; ++at) {
            if (text[at] != from) continue;
            text.replace(at, 1, to);
            at += to.size() - 1;
        }
        EXPECT_GT(text.size(), plain.size());
        return text;
    };
    // Some writers escape slashes and plus signs in JSON.
    for (const std::string& text : {plain, replaced('/', "\\/"), replaced('+', "\\u002B")}) {
        const Scene scene = helio::load(write("long.gltf", text).string());
        const auto& found = scene.meshes[0].primitives.at(0).positions;
        ASSERT_EQ(found.size(), count);
        EXPECT_EQ(std::memcmp(found.data(), positions.data(), positions.size() * sizeof(float)), 0);
        EXPECT_EQ(scene.nodes[0].name, "");
    }
    std::string broken = plain + "x";
    try {
        helio::load(write("long.gltf", broken).string());
        FAIL() << "loads";
    } catch (const InputError& error) {
        EXPECT_EQ(error.place, "line 1, byte " + std::to_string(broken.size()));
    }
    broken = plain;
    broken[broken.find("base64,") + 50000] = '!';
    write("long.gltf", broken);
    EXPECT_EQ(faultOf(folder_ / "long.gltf"), "is no valid base64");
}

TEST_F(Gltf, ManyNodesThatSaySomethingLoad) {
    constexpr int count = test::series(250000);
    std::string nodes, roots;
    for (int i = 0; i < count; ++i) {
        nodes += (i == 0 ? "{\"mesh\":0,\"translation\":[" : ",{\"mesh\":0,\"translation\":[") +
                 std::to_string(i) + ",0,0]}";
        roots += (i == 0 ? "" : ",") + std::to_string(i);
    }
    json document = GltfDocument::triangle().withInlineBuffer();
    document["nodes"] = document["scenes"][0]["nodes"] = "@";
    std::string text = document.dump();
    text.replace(text.find("\"nodes\":\"@\""), 11, "\"nodes\":[" + nodes + "]");
    text.replace(text.find("\"nodes\":\"@\""), 11, "\"nodes\":[" + roots + "]");
    const Scene scene = helio::load(write("many.gltf", text).string());
    EXPECT_EQ(scene.triangleCount(), std::uint64_t(count));
    EXPECT_EQ(scene.nodes.back().translation.x, float(count - 1));
}

/** Numbers of so many bytes each, the least first. */
std::string little(std::initializer_list<std::pair<int, std::uint32_t>> numbers) {
    std::string text;
    for (const auto& [size, number] : numbers)
        for (int i = 0; i < size; ++i) text.push_back(char(number >> (8 * i) & 255));
    return text;
}

/** Windows' headers of a picture. */
std::string bmp(std::uint32_t width, std::uint32_t height, std::uint32_t bits, std::uint32_t compression,
                const std::string& pixels) {
    const std::uint32_t colors = bits == 8 ? 256 : 0, start = 54 + 4 * colors;
    return "BM" +
           little({{4, start + std::uint32_t(pixels.size())},
                   {4, 0},
                   {4, start},
                   {4, 40},
                   {4, width},
                   {4, height},
                   {2, 1},
                   {2, bits},
                   {4, compression},
                   {4, std::uint32_t(pixels.size())},
                   {4, 0},
                   {4, 0},
                   {4, colors},
                   {4, 0}}) +
           std::string(4 * colors, '\0') + pixels;
}

TEST_F(Gltf, TexturesOfOlderFormats) {
    const std::string redGreen = little({{3, 0xff0000}, {3, 0x00ff00}});  // blue first
    write("a.TGA",
          little({{2, 0}, {1, 2}, {4, 0}, {1, 0}, {4, 0}, {2, 2}, {2, 1}, {1, 24}, {1, 0x20}}) + redGreen);
    write("b.bmp", bmp(2, 1, 24, 0, redGreen + std::string(2, '\0')));
    const auto entry = [](std::uint32_t tag, std::uint32_t type, std::uint32_t count, std::uint32_t value) {
        return little({{2, tag}, {2, type}, {4, count}, {4, value}});
    };
    const std::uint32_t directory = 8, after = directory + 2 + 9 * 12 + 4;
    write("c.tif", "II*" + std::string(1, '\0') + little({{4, directory}, {2, 9}}) + entry(256, 3, 1, 2) +
                       entry(257, 3, 1, 1) + entry(258, 3, 3, after) + entry(259, 3, 1, 1) +
                       entry(262, 3, 1, 2) + entry(273, 4, 1, after + 6) + entry(277, 3, 1, 3) +
                       entry(278, 3, 1, 1) + entry(279, 4, 1, 6) +
                       little({{4, 0}, {2, 8}, {2, 8}, {2, 8}, {3, 0x0000ff}, {3, 0x00ff00}}));
    for (const char* name : {"a.TGA", "b.bmp", "c.tif"}) {
        const TextureImage image = loadTextureImage(folder_ / name);
        EXPECT_EQ(image.width, 2u) << name;
        EXPECT_EQ(image.height, 1u) << name;
        EXPECT_EQ(std::get<std::vector<std::uint8_t>>(image.texels),
                  (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255}))
            << name;
    }
    write("bomb.bmp", bmp(60000, 60000, 8, 1, std::string(100, '\0')));
    write("bomb.tga",
          little({{2, 0}, {1, 10}, {4, 0}, {1, 0}, {4, 0}, {2, 60000}, {2, 60000}, {1, 24}, {1, 0x20}}));
    for (const char* name : {"bomb.bmp", "bomb.tga"})
        EXPECT_THROW(loadTextureImage(folder_ / name), InputError) << name;
}

TEST_F(Gltf, SymbolicLinksStayInTheFolder) {
    const GltfDocument file = GltfDocument::triangle();
    json document = file.doc;
    document["buffers"] = {{{"byteLength", file.buffer.size()}, {"uri", "data.bin"}}};
    const fs::path inside = folder_ / "inside", parts = inside / "parts", scene = inside / "scene.gltf";
    fs::create_directories(parts);
    write("outside.bin", file.buffer);
    write("inside/parts/real.bin", file.buffer);
    write("inside/scene.gltf", document.dump());
    const std::string out = "'data.bin' leads out of the scene's folder by a symbolic link";
    const auto lead = [&](const fs::path& target) {
        fs::remove(inside / "data.bin");
        fs::create_symlink(target, inside / "data.bin");
    };
    lead("parts/real.bin");
    EXPECT_EQ(faultOf(scene), "");
    for (const fs::path& target :
         {fs::path("../outside.bin"), folder_ / "outside.bin", fs::path("/dev/zero")}) {
        lead(target);
        EXPECT_EQ(faultOf(scene), out) << target;
    }
    for (const char* target : {"data.bin", "nowhere.bin"}) {
        lead(target);
        EXPECT_NE(faultOf(scene), "") << target;
    }
    // A folder that is a link itself, and a scene that is one, to a folder with all that it needs.
    lead("parts/real.bin");
    fs::create_directory_symlink(inside, folder_ / "other");
    EXPECT_EQ(faultOf(folder_ / "other/scene.gltf"), "");
    fs::create_directory(folder_ / "links");
    fs::create_symlink(scene, folder_ / "links/scene.gltf");
    fs::create_symlink(inside / "data.bin", folder_ / "links/data.bin");
    EXPECT_EQ(faultOf(folder_ / "links/scene.gltf"), "");
    fs::remove(folder_ / "links/data.bin");
    fs::create_symlink("../outside.bin", folder_ / "links/data.bin");
    EXPECT_EQ(faultOf(folder_ / "links/scene.gltf"), out);
    // A folder on the way.
    fs::remove(inside / "data.bin");
    fs::create_directory_symlink(folder_, inside / "up");
    document["buffers"][0]["uri"] = "up/outside.bin";
    write("inside/scene.gltf", document.dump());
    EXPECT_EQ(faultOf(scene), "'up/outside.bin' leads out of the scene's folder by a symbolic link");
}

TEST_F(Gltf, PipesAndDevicesAreNoFiles) {
    json document = GltfDocument::triangle().doc;
    document["buffers"] = {{{"byteLength", 36}, {"uri", "data.bin"}}};
    const fs::path scene = write("scene.gltf", document.dump());
    ASSERT_EQ(::mkfifo((folder_ / "data.bin").c_str(), 0600), 0);
    EXPECT_EQ(faultOf(scene), "'data.bin' is no regular file");
    for (const char* extension : {".gltf", ".glb", ".obj", ".ply", ".stl"}) {
        const fs::path pipe = folder_ / (std::string("pipe") + extension);
        ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
        EXPECT_EQ(faultOf(pipe), "is no regular file") << extension;
        const fs::path device = folder_ / (std::string("device") + extension);
        fs::create_symlink("/dev/zero", device);
        EXPECT_EQ(faultOf(device), "is no regular file") << extension;
    }
}

}  // namespace
}  // namespace helio::test
