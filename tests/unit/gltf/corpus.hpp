#pragma once
/** @file
 * One small valid glTF file per extension and kind of accessor, with what loading it must give. The files are
 * ground for tests of faults too, and `gltf_corpus FOLDER` writes them for the Khronos validator.
 */
#include "tests/unit/gltf_support.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace helio::test {

struct CorpusFile {
    std::string name;  ///< letters, digits and underscores
    GltfDocument document;
    std::function<void(const Scene&)> check;
};

/** All of them, in a fixed order. */
std::vector<CorpusFile> gltfCorpus();

// Its parts.
void addAccessorFiles(std::vector<CorpusFile>& files);
void addExtensionFiles(std::vector<CorpusFile>& files);
void addSceneFiles(std::vector<CorpusFile>& files);

/** A triangle whose positions have the bounds that glTF requires. */
GltfDocument boundedTriangle();

/** Adds an accessor of vertex attributes: `components` numbers each, elements 4 bytes apart or a multiple. */
template <class T>
int addVertices(GltfDocument& file, const std::vector<T>& values, std::size_t components,
                bool isNormalized = false) {
    static const char* const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    const std::size_t count = values.size() / components;
    const std::size_t stride = (components * sizeof(T) + 3) / 4 * 4;
    std::string bytes(count * stride, '\0');
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(&bytes[i * stride], &values[i * components], components * sizeof(T));
    const bool isTight = stride == components * sizeof(T);
    json accessor = {{"bufferView", file.addView(bytes, isTight ? 0 : int(stride))},
                     {"componentType", componentType<T>()},
                     {"count", count},
                     {"type", types[components]}};
    if (isNormalized) accessor["normalized"] = true;
    file.doc["accessors"].push_back(accessor);
    return int(file.doc["accessors"].size()) - 1;
}

/** Gives an accessor the min and max that positions and the times of animations must have. */
template <class T>
int withBounds(GltfDocument& file, int accessor, const std::vector<T>& values, std::size_t components) {
    std::vector<T> low(values.begin(), values.begin() + std::ptrdiff_t(components)), high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
        low[i % components] = std::min(low[i % components], values[i]);
        high[i % components] = std::max(high[i % components], values[i]);
    }
    file.doc["accessors"][std::size_t(accessor)]["min"] = low;
    file.doc["accessors"][std::size_t(accessor)]["max"] = high;
    return accessor;
}

/** Notes an extension as used, and as required where it is. */
inline void use(GltfDocument& file, const std::string& extension, bool isRequired = false) {
    file.doc["extensionsUsed"].push_back(extension);
    if (isRequired) file.doc["extensionsRequired"].push_back(extension);
}

/** A PNG of 2 x 2 texels: red, half-transparent green; quarter-transparent blue, brown. */
std::string pngOfFourTexels();
/** The same texels, as lossless WebP. */
std::string webpOfFourTexels();
/** What both decode to. */
std::vector<std::uint8_t> fourTexels();

inline const Primitive& firstPrimitive(const Scene& scene) {
    return scene.meshes.at(0).primitives.at(0);
}

}  // namespace helio::test
