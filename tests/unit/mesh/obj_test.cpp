#include "tests/unit/mesh/support.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace helio::test {
namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(MeshFile, ObjIndicesCountFromBothEnds) {
    const Scene scene = load("a.obj", square + "f 1 2 3\nv 5 5 5\nf -5 -3 -2\n");
    const Primitive& primitive = scene.meshes[0].primitives.at(0);
    EXPECT_EQ(primitive.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(primitive.positions.size(), 5u);
    EXPECT_EQ(scene.instances().size(), 1u);
}

TEST_F(MeshFile, ObjIndicesCountBackwardsAcrossBlocks) {
    std::string text;  // some 7 MB: several blocks are parsed side by side
    constexpr int faces = 100000;
    for (int i = 0; i < faces; ++i) {
        text += fmt::format("v {} 0 0\nv {} 1 0\nv {} 0 1\nf -3 -2 -1\nf {} {} {}\n", i, i, i, 3 * i + 1,
                            3 * i + 2, 3 * i + 3);
    }
    const Scene scene = load("large.obj", text);
    const Primitive& primitive = scene.meshes[0].primitives.at(0);
    ASSERT_EQ(primitive.indices.size(), std::size_t(faces) * 6);
    for (std::uint32_t i = 0; i < faces; ++i) {
        for (std::uint32_t k = 0; k < 6; ++k) ASSERT_EQ(primitive.indices[i * 6 + k], i * 3 + k % 3);
    }
    EXPECT_EQ(primitive.positions.back(), glm::vec3(faces - 1, 0, 1));
    EXPECT_NE(refusal("late.obj", text + "f 1 2 x\n").find(fmt::format("line {}: ", faces * 5 + 1)),
              std::string::npos);
    EXPECT_NE(refusal("range.obj", text + "f 1 2 300001\n").find(fmt::format("line {}: ", faces * 5 + 1)),
              std::string::npos);
}

TEST_F(MeshFile, ObjDialects) {
    const Scene scene = load("a.obj",
                             "# comment\r\no name with spaces\r\n\r\n  v  0 0 0\r\nv 1 0 0 # at the end\r\n"
                             "v\t1\t1\t0\r\nvt 0 0 0\r\nvt 1 0\r\nvt 1\r\nvn 0 0 2\r\ng a b c\r\ns off\r\n"
                             "f 1/1/1 \\\r\n 2/2/1 \\\r\n3/3/1\r\nl 1 2\r\nvp 1 2\r\n");
    const Primitive& primitive = scene.meshes[0].primitives.at(0);
    ASSERT_EQ(primitive.positions.size(), 3u);
    for (const glm::vec3& normal : primitive.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(primitive.texcoords.at(0)[0], glm::vec2(0, 1)) << "v points up in the file";
    EXPECT_EQ(scene.skipped.size(), 2u);
    EXPECT_TRUE(scene.warnings.empty());
    const Scene carriage = load("mac.obj", "v 0 0 0\rv 1 0 0\rv 1 1 0\rf 1 2 3\r");
    EXPECT_EQ(carriage.triangleCount(), 1u);
    EXPECT_EQ(load("end.obj", square + "f 1 2 3").triangleCount(), 1u);
    EXPECT_EQ(load("plus.obj", "v +1 +0.5 1e0\nv 1. .5 -1e-60\nv 0 0 0\nf +1 2 3\n").triangleCount(), 1u);
}

TEST_F(MeshFile, ObjPolygonsAreCutWithoutOverlap) {
    // An L and an arrow: fans from the first corner would leave them. Areas by the shoelace formula.
    const Scene scene = load("l.obj",
                             "v 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4 5 6\n"
                             "v 0 0 5\nv 2 1 5\nv 0 2 5\nv 1 1 5\nf 7 8 9 10\n");
    const Primitive& primitive = scene.meshes[0].primitives.at(0);
    EXPECT_EQ(primitive.indices.size(), 18u);
    EXPECT_NEAR(areaOf(primitive), 3 + 1, 1e-6);
    std::string star = "f";
    std::string corners;
    constexpr int points = 200;
    double shoelace = 0;
    std::array<std::array<double, 2>, 2 * points> p{};
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double angle = 3.14159265358979 * double(i) / points, radius = i % 2 == 0 ? 1 : 0.5;
        p[i] = {radius * std::cos(angle), radius * std::sin(angle)};
        corners += fmt::format("v {} 3 {}\n", p[i][0], p[i][1]);
        star += fmt::format(" {}", i + 1);
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto& q = p[(i + 1) % p.size()];
        shoelace += (p[i][0] * q[1] - q[0] * p[i][1]) / 2;
    }
    const Scene cut = load("star.obj", corners + star + "\n");
    EXPECT_EQ(cut.triangleCount(), std::uint64_t(2 * points - 2));
    EXPECT_NEAR(areaOf(cut.meshes[0].primitives.at(0)), shoelace, 1e-5);
}

TEST_F(MeshFile, ObjCornersThatDifferAreVerticesOfTheirOwn) {
    const Scene scene = load("a.obj", square + "vn 0 0 1\nvn 0 1 0\nvt 0 0\nvt 1 1\n" +
                                          "f 1//1 2//1 3//1\nf 1//2 3//2 4\nf 1/1 2/2 3/1\n");
    const Primitive& primitive = scene.meshes[0].primitives.at(0);
    EXPECT_EQ(primitive.positions.size(), 9u);
    EXPECT_EQ(primitive.normals[primitive.indices[3]], glm::vec3(0, 1, 0));
    EXPECT_EQ(primitive.normals[primitive.indices[5]], glm::vec3(0, 0, 1)) << "flat where there is none";
    EXPECT_TRUE(mentions(scene.warnings, "texture coordinates"));
}

TEST_F(MeshFile, ObjColorsAreDecoded) {
    const Scene scene = load("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 1 1 1\nv 1 1 0\nf 1 2 3\n");
    const auto& colors = scene.meshes[0].primitives.at(0).colors;
    EXPECT_NEAR(colors[0].y, 0.21404114, 1e-6);  // IEC 61966-2-1
    EXPECT_EQ(colors[2], glm::vec4(1));
    EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec4(1));
}

TEST_F(MeshFile, ObjMaterialsPartTheMesh) {
    write("two words.mtl",
          "newmtl red\nKd 1 0 0\r\n\nnewmtl lamp\nKd 0 0 0\nKe 2 3 4\nnewmtl unused\nKd x\n");
    const Scene scene = load("a.obj", "mtllib two words.mtl\n" + square +
                                          "usemtl lamp\nf 1 2 3\nusemtl red\nf 1 3 4\nusemtl lamp\nf 2 3 4\n"
                                          "usemtl nowhere\nf 1 2 4\n");
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(2, 3, 4));
    EXPECT_EQ(scene.materials[1].baseColor, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.materials[1].specular, 0);
    ASSERT_EQ(scene.meshes[0].primitives.size(), 3u);
    EXPECT_EQ(scene.meshes[0].primitives[0].indices.size(), 6u);
    EXPECT_EQ(scene.warnings.size(), 1u);
    EXPECT_TRUE(mentions(scene.warnings, "'nowhere' is nowhere defined"));
    const Scene missing = load("b.obj", "mtllib no.mtl\nmtllib ../a.mtl\n" + square + "usemtl x\nf 1 2 3\n");
    EXPECT_TRUE(mentions(missing.warnings, "'no.mtl' does not exist"));
    EXPECT_TRUE(mentions(missing.warnings, "leads out"));
}

TEST_F(MeshFile, ObjRefusals) {
    const std::pair<std::string, const char*> cases[] = {
        {"", "is empty"},
        {"hello\nworld\n", "line 1: holds no OBJ statement"},
        {std::string(1000, '\0'), "holds no OBJ statement"},
        {"v 1 2\n", "line 1: v has 2 numbers"},
        {"v 1 2 nan\n", "'nan'"},
        {"v 1 2 inf\n", "'inf'"},
        {"v 1 2 1e39\n", "'1e39'"},
        {"v 1 2 1e999\n", "'1e999'"},
        {"v 1 2 3x\n", "'3x'"},
        {"v 1 2 3 4 5\n", "5 numbers"},
        {"vn 1 2\n", "vn has 2"},
        {"vt\n", "vt has 0"},
        {square + "f 1 2\n", "line 5: a face has 2 corners"},
        {square + "f 1 2 0\n", "'0' is no index"},
        {square + "f 1 2 5\n", "line 5: index 5 is past the file's 4 vertices"},
        {square + "f 1 2 -5\n", "line 5: an index leads 1 elements before the first"},
        {square + "f 1 2 99999999999999999999\n", "no index"},
        {square + "f 1/1 2/1 3/1\n", "line 5: index 1 is past the file's 0 texture coordinates"},
        {square + "f 1//1 2//1 3//1\n", "0 normals"},
        {square + "f 1/1/1/1 2 3\n", "more than three indices"},
        {square + "f a b c\n", "'a' is no index"},
    };
    for (const auto& [text, part] : cases) {
        const std::string what = refusal("bad.obj", text);
        EXPECT_NE(what.find(part), std::string::npos) << what;
    }
    write("bad.mtl", "newmtl a\nKd 1 2 oops\n");
    const std::string what = [&] {
        try {
            helio::load(write("a.obj", "mtllib bad.mtl\n" + square + "usemtl a\nf 1 2 3\n"));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    }();
    EXPECT_NE(what.find("bad.mtl: line 2: Kd has 'oops' for a number; give"), std::string::npos) << what;
}

TEST_F(MeshFile, ObjWithoutFacesOrWithOddLinesWarns) {
    EXPECT_TRUE(mentions(load("a.obj", square).warnings, "no faces"));
    EXPECT_TRUE(mentions(load("a.obj", square + "f 1 2 3\nwhat 1\n").warnings, "line 6: 'what'"));
}

}  // namespace
}  // namespace helio::test
