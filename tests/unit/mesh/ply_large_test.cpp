/** @file PLY files of many blocks, which are decoded side by side. */
#include "tests/unit/mesh/support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace helio::test {
namespace {

enum class Form { Text, Little, Big };

/** Points on a wave with colours, and runs of faces with 3 and 4 corners, now long, now short. */
class LargePly {
public:
    static constexpr std::uint32_t vertices = 150000, faces = 200000;

    static glm::vec3 position(std::uint32_t i) {
        return {float(i) * 0.25f, float(i % 977) * 0.5f, -float(i)};
    }
    static std::uint8_t red(std::uint32_t i) { return std::uint8_t(i * 7); }
    static std::vector<std::uint32_t> corners(std::uint32_t face) {
        const bool isQuad = face >= 60000 && (face < 120000 || face % 3 == 0);
        std::vector<std::uint32_t> result;
        for (std::uint32_t k = 0; k < (isQuad ? 4u : 3u); ++k)
            result.push_back((face * 31 + k * (face % 5 + 1)) % (vertices - 1));
        return result;
    }

    explicit LargePly(Form form) : form_(form) {}

    /** `faultyVertex` has no finite y, `faultyFace` a negative index. */
    std::string text(std::int64_t faultyVertex = -1, std::int64_t faultyFace = -1) {
        constexpr const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        out_ = fmt::format(
            "ply\nformat {} 1.0\nelement vertex {}\nproperty short tag\nproperty float x\nproperty double y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
            "{}\n"
            "property uchar kind\nproperty list uchar int vertex_indices\nproperty short end\nend_header\n",
            names[int(form_)], vertices, faces);
        for (std::uint32_t i = 0; i < vertices; ++i) {
            const glm::vec3 p = position(i);
            put(std::int16_t(-5));
            put(p.x);
            put(std::int64_t(i) == faultyVertex ? HUGE_VAL : double(p.y));
            put(p.z);
            for (int c = 0; c < 3; ++c) put(c == 0 ? red(i) : std::uint8_t(255));
            endLine();
        }
        for (std::uint32_t f = 0; f < faces; ++f) {
            std::vector<std::uint32_t> indices = corners(f);
            put(std::uint8_t(3));
            put(std::uint8_t(indices.size()));
            for (const std::uint32_t index : indices)
                put(std::int64_t(f) == faultyFace ? std::int32_t(-7) : std::int32_t(index));
            put(std::int16_t(4));
            endLine();
        }
        return std::move(out_);
    }

private:
    template <class T>
    void put(T value) {
        if (form_ == Form::Text) {
            out_ += fmt::format("{} ", value);
            return;
        }
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), &value, sizeof value);
        if (form_ == Form::Big) std::reverse(bytes.begin(), bytes.end());
        out_.append(bytes.data(), bytes.size());
    }
    void endLine() {
        if (form_ == Form::Text) out_.back() = '\n';
    }

    Form form_;
    std::string out_;
};

TEST_F(MeshFile, LargePlyIsWhatWasWritten) {
    for (const Form form : {Form::Text, Form::Little, Form::Big}) {
        SCOPED_TRACE(int(form));
        const Scene scene = load("large.ply", LargePly(form).text());
        const Primitive& primitive = scene.meshes[0].primitives.at(0);
        ASSERT_EQ(primitive.positions.size(), LargePly::vertices);
        std::size_t wrong = 0;
        for (std::uint32_t i = 0; i < LargePly::vertices; ++i) {
            wrong += primitive.positions[i] != LargePly::position(i);
            const double encoded = LargePly::red(i) / 255.0;
            const double linear =
                encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
            wrong += std::abs(primitive.colors[i].r - linear) > 1e-6 || primitive.colors[i].g != 1;
        }
        EXPECT_EQ(wrong, 0u) << "vertices";
        std::size_t at = 0;
        for (std::uint32_t f = 0; f < LargePly::faces; ++f) {
            // A polygon may be cut anew: its triangles then are of the same corners.
            std::vector<std::uint32_t> corners = LargePly::corners(f), found;
            for (std::size_t k = 0; k < (corners.size() - 2) * 3; ++k)
                found.push_back(primitive.indices.at(at++));
            if (corners.size() == 3) {
                wrong += found != corners;
                continue;
            }
            for (auto* const list : {&corners, &found}) {
                std::sort(list->begin(), list->end());
                list->erase(std::unique(list->begin(), list->end()), list->end());
            }
            wrong += found != corners;
        }
        EXPECT_EQ(at, primitive.indices.size());
        EXPECT_EQ(wrong, 0u) << "faces";
    }
}

TEST_F(MeshFile, LargePlyNamesThePlaceOfAFault) {
    for (const Form form : {Form::Text, Form::Little, Form::Big}) {
        SCOPED_TRACE(int(form));
        EXPECT_NE(refusal("bad.ply", LargePly(form).text(123456))
                      .find(form == Form::Text ? "vertex 123456: has 'inf'" : "vertex 123456: y is inf"),
                  std::string::npos);
        for (const int face : {40000, 100000, 199999}) {
            const std::string said = refusal("bad.ply", LargePly(form).text(-1, face));
            EXPECT_NE(said.find(fmt::format("face {}: -7 is no index", face)), std::string::npos) << said;
        }
        std::string text = LargePly(form).text();
        text.resize(text.size() - (form == Form::Text ? 3 : 1));
        const std::string said = refusal("bad.ply", text);
        EXPECT_NE(said.find("face 199999: the file ends here"), std::string::npos) << said;
    }
}

}  // namespace
}  // namespace helio::test
