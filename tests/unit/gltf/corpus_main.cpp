/** @file `gltf_corpus FOLDER` writes the corpus, as .gltf and as .glb. */
#include "tests/unit/gltf/corpus.hpp"

#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: gltf_corpus FOLDER\n");
        return 2;
    }
    const std::filesystem::path folder(argv[1]);
    std::filesystem::create_directories(folder);
    const auto files = helio::test::gltfCorpus();
    for (const helio::test::CorpusFile& file : files) {
        std::ofstream(folder / (file.name + ".gltf")) << file.document.withInlineBuffer().dump(1) << '\n';
        std::ofstream(folder / (file.name + ".glb"), std::ios::binary) << file.document.glb();
    }
    std::printf("%zu files, each as .gltf and .glb\n", files.size());
}
