#include "tests/unit/mesh/support.hpp"

#include <heliograph/image.hpp>

#include <algorithm>
#include <cmath>

namespace helio::test {
namespace {

/** Numbers as a binary PLY file stores them. */
class Body {
public:
    explicit Body(bool isBigEndian) : isBigEndian_(isBigEndian) {}
    template <class T>
    Body& add(T value) {
        std::string bytes(sizeof value, '\0');
        std::memcpy(bytes.data(), &value, sizeof value);
        if (isBigEndian_) std::reverse(bytes.begin(), bytes.end());
        text += bytes;
        return *this;
    }
    std::string text;

private:
    bool isBigEndian_;
};

const std::string vertexHeader = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string faceHeader = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
const std::string squareText =
    "ply\nformat ascii 1.0\n" + vertexHeader + faceHeader + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

TEST_F(MeshFile, PlyTextWithEveryAttribute) {
    const Scene scene =
        load("a.ply",
             "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info x\r\n"
             "element vertex 3\r\nproperty double x\r\nproperty float32 y\r\nproperty float z\r\n"
             "property float nx\r\nproperty float ny\r\nproperty float nz\r\n"
             "property float s\r\nproperty float t\r\nproperty uchar red\r\nproperty uchar green\r\n"
             "property uchar blue\r\nproperty uchar alpha\r\nproperty float quality\r\n"
             "element face 1\r\nproperty list uint8 uint32 vertex_index\r\nproperty int label\r\n"
             "end_header\r\n"
             "0 0 0 0 0 2 0 0 255 128 0 255 7\r\n1 0 0 0 0 1 1 0 0 0 0 128 7\r\n"
             "1 1 0 0 0 1 1 0.75 255 255 255 255 7\r\n3 0 1 2 9\r\n");
    const Primitive& primitive = scene.meshes[0].primitives.at(0);
    EXPECT_EQ(primitive.indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(primitive.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(primitive.texcoords.at(0)[2], glm::vec2(1, 0.25f)) << "v points up in the file";
    EXPECT_NEAR(primitive.colors[0].y, 0.21586050, 1e-6) << "128 of 255 in sRGB";
    EXPECT_NEAR(primitive.colors[1].a, 128.0 / 255, 1e-6);
    EXPECT_EQ(scene.materials[0].alphaMode, AlphaMode::Blend);
    EXPECT_EQ(scene.skipped.size(), 2u) << "quality and label";
}

TEST_F(MeshFile, PlyBinaryOfBothByteOrders) {
    for (const bool isBigEndian : {false, true}) {
        Body body(isBigEndian);
        for (float x : {0.0f, 1.0f, 1.5f})
            body.add(x).add(double(x * x)).add(std::int16_t(-3)).add(std::uint16_t(65535));
        body.add(std::uint8_t(3)).add(std::uint16_t(2)).add(std::uint16_t(1)).add(std::uint16_t(0));
        const std::string header =
            "element vertex 3\nproperty float x\nproperty double y\nproperty short z\nproperty ushort what\n"
            "element face 1\nproperty list uchar ushort vertex_indices\nend_header\n";
        const std::string format = isBigEndian ? "binary_big_endian" : "binary_little_endian";
        const std::string file = "ply\nformat " + format + " 1.0\n" + header + body.text;
        const Scene scene = load("a.ply", file);
        const Primitive& primitive = scene.meshes[0].primitives.at(0);
        EXPECT_EQ(primitive.indices, (std::vector<std::uint32_t>{2, 1, 0}));
        EXPECT_EQ(primitive.positions[2], glm::vec3(1.5f, 2.25f, -3));
        for (std::size_t length = 0; length < file.size(); ++length)
            refusal("cut.ply", file.substr(0, length));
    }
}

TEST_F(MeshFile, PlyPolygonsStripsAndOtherElements) {
    const Scene scene =
        load("a.ply", "ply\nformat ascii 1.0\nelement camera 2\nproperty list uchar float f\n" +
                          std::string("element face 1\nproperty list uchar int vertex_indices\n"
                                      "element vertex 6\nproperty float x\nproperty float y\n"
                                      "property float z\nend_header\n"
                                      "3 1 2 3\n0\n6 4 5 0 1 2 3\n"
                                      "1 1 0\n1 2 0\n0 2 0\n0 0 0\n2 0 0\n2 1 0\n"));
    EXPECT_EQ(scene.triangleCount(), 4u);
    EXPECT_NEAR(areaOf(scene.meshes[0].primitives.at(0)), 3, 1e-6) << "an L of three unit squares";
    const Scene strips =
        load("s.ply", "ply\nformat ascii 1.0\n" + vertexHeader +
                          "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                          "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 3\n");
    const auto& indices = strips.meshes[0].primitives.at(0).indices;
    EXPECT_EQ(indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 0, 1, 3}));
}

TEST_F(MeshFile, PlyOfMoreStripsThanAFaceMayHaveCorners) {
    constexpr std::size_t strips = (std::size_t(1) << 20) + 1;  // of four corners each, and a -1 between them
    std::string file = "ply\nformat binary_little_endian 1.0\n" + vertexHeader +
                       "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    const auto put = [&file](auto value) {
        file.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (const float value : {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) put(value);
    put(std::int32_t(strips * 5));
    for (std::size_t i = 0; i < strips; ++i)
        for (const std::int32_t corner : {0, 1, 2, 3, -1}) put(corner);
    const Scene scene = load("strips.ply", file);
    EXPECT_EQ(scene.triangleCount(), strips * 2);
    const auto& indices = scene.meshes[0].primitives.at(0).indices;
    EXPECT_EQ(std::vector<std::uint32_t>(indices.end() - 6, indices.end()),
              (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
}

TEST_F(MeshFile, PlyOfBlenderWithoutFaces) {
    const Scene scene = load("a.ply",
                             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nproperty list uchar uint vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n");
    EXPECT_EQ(scene.triangleCount(), 0u);
    ASSERT_EQ(scene.warnings.size(), 2u);
    EXPECT_EQ(scene.warnings[0], "line 7: vertex_indices is of faces, which no element names; left out");
}

TEST_F(MeshFile, PlyTextureFile) {
    ImageF image;
    image.width = image.height = 2;
    image.channels = {"R", "G", "B"};
    image.data.assign(12, 0.5f);
    saveImage(folder_ / "a b.png", image);
    const std::string body =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float u\nproperty "
        "float "
        "v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 "
        "0 1\n3 0 1 "
        "2\n";
    const Scene scene = load("a.ply", "ply\nformat ascii 1.0\ncomment TextureFile a b.png\n" + body);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.materials[0].baseColorTexture.texture, 0);
    const Scene missing = load("b.ply", "ply\nformat ascii 1.0\ncomment TextureFile ../x.png\n" + body);
    EXPECT_EQ(missing.images.size(), 0u);
    EXPECT_TRUE(mentions(missing.warnings, "leads out"));
}

TEST_F(MeshFile, PlyPointsAreLeftOut) {
    const Scene scene =
        load("a.ply", "ply\nformat ascii 1.0\n" + vertexHeader + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n");
    EXPECT_EQ(scene.triangleCount(), 0u);
    EXPECT_TRUE(mentions(scene.warnings, "no faces"));
}

TEST_F(MeshFile, PlyRefusals) {
    ASSERT_EQ(load("good.ply", squareText).triangleCount(), 2u);
    const auto with = [](const std::string& from, const std::string& to) {
        std::string text = squareText;
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    const std::pair<std::string, const char*> cases[] = {
        {"", "is empty"},
        {"plain", "line 1: is no PLY file"},
        {"ply\n", "line 2: the header has no end_header"},
        {with("format ascii 1.0\n", ""), "names no format"},
        {with("ascii 1.0", "ascii 2.0"), "version"},
        {with("ascii", "binary_middle_endian"), "line 2: format 'binary_middle_endian'"},
        {with("element face 2", "element face"), "no count"},
        {with("element face 2", "element face -1"), "no count"},
        {with("element face 2", "element vertex 2"), "twice"},
        {with("element face 2", "element face 3"), "face 2: the file ends here"},
        {with("element vertex 4", "element vertex 99999999999"), "no room for so many"},
        {with("float x", "float w"), "has no x, y and z"},
        {with("float x", "complex x"), "'complex' is no type"},
        {with("uchar int", "float int"), "no type of integers"},
        {with("vertex_indices", "corners"), "has no list vertex_indices"},
        {with("1 0 0\n", "1 0 nan\n"), "vertex 1: has 'nan'"},
        {with("1 0 0\n", "1 0 1e39\n"), "vertex 1: z is 1e+39"},
        {with("1 0 0\n", "1 0 x\n"), "vertex 1: has 'x'"},
        {with("3 0 1 2", "3 0 1 4"), "face 0: index 4 is past the 4 vertices"},
        {with("3 0 1 2", "3 0 1 -1"), "face 0: -1 is no index"},
        {with("3 0 1 2", "3 0 1 0.5"), "face 0: 0.5 is no index"},
        {with("3 0 1 2", "2 0 1"), "face 0: a face has 2 corners"},
        {with("3 0 1 2", "200 0 1 2"), "200 entries, which the file cannot hold"},
        {with("3 0 1 2", "-3 0 1 2"), "-3 entries"},
    };
    for (const auto& [text, part] : cases) {
        const std::string what = refusal("bad.ply", text);
        EXPECT_NE(what.find(part), std::string::npos) << what;
    }
}

TEST_F(MeshFile, PlyWithoutLengthOfNormalsIsFlat) {
    const Scene scene =
        load("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
             "float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face "
             "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 1\n1 0 0 0 0 0\n0 1 0 0 0 "
             "1\n3 0 1 2\n");
    EXPECT_TRUE(scene.meshes[0].primitives.at(0).normals.empty());
    EXPECT_EQ(scene.warnings.size(), 1u);
}

}  // namespace
}  // namespace helio::test
