#include "tests/unit/mesh/support.hpp"

#include <fmt/format.h>

#include <cmath>

namespace helio::test {
namespace {

std::string binary(const std::string& title, const std::vector<float>& corners, std::uint32_t count) {
    std::string file = title;
    file.resize(80);
    file.append(reinterpret_cast<const char*>(&count), 4);
    for (std::size_t i = 0; i + 9 <= corners.size(); i += 9) {
        file.append(12, '\0');
        file.append(reinterpret_cast<const char*>(&corners[i]), 36);
        file.append(2, '\7');
    }
    return file;
}

std::string facet(float x) {
    return fmt::format(
        "facet normal 0 0 1\n outer loop\n  vertex {} 0 0\n  vertex {} 0 0\n  vertex {} 1 0\n "
        "endloop\nendfacet\n",
        x, x + 1, x);
}

const std::vector<float> two{0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0};

TEST_F(MeshFile, StlBinary) {
    for (const char* title : {"made here", "solid made here", "solid"}) {
        const Scene scene = load("a.stl", binary(title, two, 2));
        const Primitive& primitive = scene.meshes[0].primitives.at(0);
        EXPECT_EQ(primitive.indices.size(), 6u);
        EXPECT_EQ(primitive.positions[4], glm::vec3(6, 0, 0));
        EXPECT_TRUE(primitive.normals.empty()) << "facets are flat";
        EXPECT_TRUE(scene.warnings.empty());
        EXPECT_TRUE(mentions(load("b.stl", binary(title, two, 2) + "more").warnings, "what follows"));
    }
}

TEST_F(MeshFile, StlText) {
    const Scene scene = load("a.stl", "solid a name\n" + facet(0) + facet(2) + "endsolid a name\n");
    EXPECT_EQ(scene.triangleCount(), 2u);
    EXPECT_TRUE(scene.warnings.empty());
    std::string upper =
        "SOLID\r\nFACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 0\r\nVERTEX 0 1 0\r\n"
        "ENDLOOP\r\nENDFACET\r\nENDSOLID\r\n";
    EXPECT_EQ(load("b.stl", upper).triangleCount(), 1u);
    EXPECT_EQ(load("c.stl", "solid a\n" + facet(0) + "endsolid a\nsolid b\n" + facet(1) + "endsolid b")
                  .triangleCount(),
              2u);
    EXPECT_TRUE(mentions(load("d.stl", "solid a\n" + facet(0)).warnings, "endsolid"));
    EXPECT_TRUE(mentions(load("e.stl", "solid a\nendsolid a\n").warnings, "no facets"));
}

TEST_F(MeshFile, StlTextInSeveralBlocks) {
    std::string text = "solid\n";
    constexpr int facets = 30000;
    for (int i = 0; i < facets; ++i) text += facet(float(i));
    const Scene scene = load("a.stl", text + "endsolid\n");
    const auto& positions = scene.meshes[0].primitives.at(0).positions;
    ASSERT_EQ(positions.size(), std::size_t(facets) * 3);
    for (int i = 0; i < facets; ++i) ASSERT_EQ(positions[std::size_t(i) * 3], glm::vec3(i, 0, 0));
    const std::string what = refusal("b.stl", text + "facet normal 0 0 1\nouter loop\nvertex 0 0 x\n");
    EXPECT_NE(what.find(fmt::format("line {}: a vertex has 'x'", facets * 7 + 4)), std::string::npos) << what;
}

TEST_F(MeshFile, StlRefusals) {
    std::vector<float> wrong = two;
    wrong[13] = NAN;
    const std::string start = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
    const std::pair<std::string, const char*> cases[] = {
        {"", "is empty"},
        {"short", "header: has 5 bytes"},
        {binary("x", two, 3), "header: says 3 facets, the file has 2"},
        {binary("x", two, 0xffffffffu), "says 4294967295"},
        {binary("x", wrong, 2), "facet 1: has a corner that is not finite"},
        {start + "endloop\nendfacet\nendsolid\n", "line 7: a facet has 2 corners"},
        {start, "ends within a facet"},
        {start + "vertex 1 1\n", "line 6: a vertex has too few numbers"},
        {start + "vertex 1 1 inf\n", "'inf'"},
        {start + "facet\n", "begins in another"},
        {"solid\nvertex 0 0 0\n", "in no facet"},
        {"solid\nhello\n", "'hello' is no STL statement"},
    };
    for (const auto& [text, part] : cases) {
        const std::string what = refusal("bad.stl", text);
        EXPECT_NE(what.find(part), std::string::npos) << what;
    }
    const std::string whole = binary("x", two, 2);
    for (std::size_t length = 0; length < whole.size(); ++length) refusal("cut.stl", whole.substr(0, length));
}

}  // namespace
}  // namespace helio::test
