// Every corpus file with something odd in it: it loads and can be posed, or is refused in one line.
#include "tests/support/sanitized.hpp"
#include "tests/unit/gltf/corpus.hpp"

#include <heliograph/pose.hpp>

#include <random>

namespace helio::test {
namespace {

struct Outcomes {
    int shown = 0, refused = 0;
};

void tryLoading(const fs::path& path, const std::string& what, Outcomes& outcomes) {
    try {
        const Scene scene = helio::load(path.string());
        EXPECT_NO_THROW(scene.validate()) << what;
        const Scene still = posed(scene, 0.7);
        for (const Instance& instance : still.instances()) {
            for (const Primitive& primitive : still.meshes[std::size_t(instance.mesh)].primitives) {
                for (const glm::vec3& p : primitive.positions)
                    ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << what;
                for (const glm::vec3& n : primitive.normals)
                    ASSERT_TRUE(std::isfinite(n.x + n.y + n.z)) << what;
            }
        }
        ++outcomes.shown;
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << what;
        ++outcomes.refused;
    } catch (const std::exception& error) {
        ADD_FAILURE() << what << ": " << error.what();
    }
}

class GltfCorpusSurvival : public Gltf {};

TEST_F(GltfCorpusSurvival, AnyValueInAnyPlace) {
    const std::vector<json>& odd = oddValues();
    std::mt19937 random(1);
    Outcomes outcomes;
    for (const CorpusFile& file : gltfCorpus()) {
        if (file.name == "samplers") continue;  // hundreds of places of one kind
        const json whole = file.document.withInlineBuffer();
        const json flat = whole.flatten();
        for (const auto& [pointer, value] : flat.items()) {
            for (json::json_pointer at(pointer); !at.empty(); at = at.parent_pointer()) {
                if (at.to_string() != pointer && random() % 4 != 0)
                    continue;  // inner places have many leaves
                if (test::kSanitized && random() % 4 != 0) continue;
                json document = whole;
                document[at] = odd[random() % std::size(odd)];
                tryLoading(write("odd.gltf", document.dump()), file.name + at.to_string(), outcomes);
            }
        }
    }
    EXPECT_GT(outcomes.shown, test::kSanitized ? 25 : 100);
    EXPECT_GT(outcomes.refused, test::kSanitized ? 125 : 500);
}

TEST_F(GltfCorpusSurvival, FlippedBytes) {
    std::mt19937 random(2);
    Outcomes outcomes;
    for (const CorpusFile& file : gltfCorpus()) {
        const std::string whole = file.document.glb();
        for (int trial = 0; trial < 8; ++trial) {
            std::string bytes = whole;
            // In the buffers, which JSON's own checks do not see.
            const std::size_t first = whole.size() - file.document.buffer.size();
            for (int k = 0; k < 3; ++k) bytes[first + random() % (whole.size() - first)] = char(random());
            tryLoading(write("flipped.glb", bytes), file.name, outcomes);
        }
    }
    EXPECT_GT(outcomes.shown, 200);
    EXPECT_GT(outcomes.refused, 30);
}

}  // namespace
}  // namespace helio::test
