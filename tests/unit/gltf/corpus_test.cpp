#include "tests/unit/gltf/corpus.hpp"

namespace helio::test {

/** GoogleTest shows this for a file, not its bytes. */
static void PrintTo(const CorpusFile& file, std::ostream* out) {
    *out << file.name;
}

namespace {

class GltfCorpus : public Gltf, public testing::WithParamInterface<CorpusFile> {};

TEST_P(GltfCorpus, LoadsWhole) {
    const CorpusFile& file = GetParam();
    for (const std::string& path : {write("corpus.gltf", file.document.withInlineBuffer().dump()).string(),
                                    write("corpus.glb", file.document.glb()).string()}) {
        const Scene scene = helio::load(path);
        EXPECT_NO_THROW(scene.validate());
        EXPECT_TRUE(scene.skipped.empty()) << scene.skipped[0].first;
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
        file.check(scene);
    }
}

INSTANTIATE_TEST_SUITE_P(Files, GltfCorpus, testing::ValuesIn(gltfCorpus()),
                         [](const auto& file) { return file.param.name; });

}  // namespace
}  // namespace helio::test
