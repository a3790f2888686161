#include "engine/scene/mesh/mtl.hpp"

#include "engine/image/read_file.hpp"
#include "engine/scene/folder.hpp"
#include "engine/scene/mesh/attributes.hpp"
#include "engine/scene/mesh/mtl_material.hpp"
#include "engine/scene/mesh/text.hpp"
#include "engine/scene/mesh/textures.hpp"
#include "engine/scene/notes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace helio::mesh {
namespace {

namespace fs = std::filesystem;

/** Finds the definitions of the names that are used; the first of each counts. */
class Library {
public:
    Library(const std::string& file, const std::vector<std::string>& names, TextureFiles& textures,
            Scene& scene)
        : file_(file), textures_(textures), scene_(scene), found_(names.size()) {
        for (std::size_t i = 0; i < names.size(); ++i) wanted_.emplace(names[i], i);
    }

    /** What follows mtllib: one file, its name perhaps with spaces, or several. */
    void read(const std::string& libraries) {
        if (readOne(libraries, false)) return;
        std::string_view rest = libraries;
        bool isFirst = true;
        for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
            readOne(word, true);
            isFirst = false;
        }
        if (isFirst) warn(scene_, "mtllib names no file");
    }

    std::optional<Material>& material(std::size_t index) { return found_[index]; }

private:
    bool readOne(std::string_view name, bool mayWarn) {
        const auto complain = [&](std::string_view what) {
            if (mayWarn)
                warn(scene_, fmt::format("material file {} {}; its materials are white", shown(name), what));
            return false;
        };
        const std::optional<fs::path> path = pathBelow(name);
        if (!path) return complain("leads out of the file's folder");
        fs::path file;
        std::vector<std::byte> bytes;
        try {
            file = fileBelow(file_, *path);
            bytes = readFile(file);
        } catch (const InputError& error) {
            return complain(error.fault);
        }
        parse(file.string(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        return true;
    }

    void parse(const std::string& file, std::string_view text) {
        Lines lines(withoutMark(text));
        std::string_view line;
        MtlBlock block;
        bool isWanted = false;
        std::size_t target = 0;
        const auto flush = [&] {
            if (isWanted) found_[target] = materialOf(file, block, textures_, scene_);
        };
        while (lines.next(line)) {
            std::string_view rest = line;
            const std::string_view keyword = takeWord(rest);
            if (keyword.empty() || keyword[0] == '#') continue;
            if (keyword == "newmtl") {
                flush();
                block = {};
                block.name = trimmed(rest);
                const auto wanted = wanted_.find(block.name);
                isWanted = wanted != wanted_.end() && !found_[wanted->second];
                if (isWanted) target = wanted->second;
            } else if (isWanted) {
                block.lines.push_back({lines.number(), std::string(keyword), std::string(trimmed(rest))});
            }
        }
        flush();
    }

    const std::string& file_;
    TextureFiles& textures_;
    Scene& scene_;
    std::map<std::string, std::size_t> wanted_;
    std::vector<std::optional<Material>> found_;
};

}  // namespace

void loadMaterials(const std::string& file, const std::vector<std::string>& libraries,
                   const std::vector<std::string>& names, bool hasColors, LoadMonitor& monitor,
                   Scene& scene) {
    TextureFiles textures(file, scene);
    Library library(file, names, textures, scene);
    for (const std::string& name : libraries) library.read(name);
    for (std::size_t i = 0; i < names.size(); ++i) {
        std::optional<Material>& found = library.material(i);
        if (!found) {
            found = neutralMaterial(hasColors);
            found->name = names[i];
            if (!names[i].empty())
                warn(scene, fmt::format("material {} is nowhere defined; white is shown", shown(names[i])));
        }
        scene.materials.push_back(std::move(*found));
    }
    textures.decode(monitor);
}

}  // namespace helio::mesh
