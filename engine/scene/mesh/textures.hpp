#pragma once
/** @file Images beside a mesh file that its materials name. */
#include "engine/scene/image_decoding.hpp"
#include "engine/scene/load_monitor.hpp"

#include <heliograph/scene.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace helio::mesh {

/** Reads each file once, and only from the folder or below; decodes together at the end. What cannot be read
 * is a warning. */
class TextureFiles {
public:
    TextureFiles(const std::string& file, Scene& scene) : file_(file), scene_(scene) {}

    /** Into Scene::textures; -1 for a file that is not there. */
    int texture(const std::string& name, bool isClamped);
    /** To be called last. An image that cannot be decoded leaves its textures white. */
    void decode(LoadMonitor& monitor);

private:
    int read(const std::string& name);

    const std::string& file_;  ///< the mesh
    Scene& scene_;
    std::map<std::pair<std::string, bool>, int> textures_;
    std::map<std::string, int> files_;
    std::vector<EncodedImage> images_;
};

}  // namespace helio::mesh
