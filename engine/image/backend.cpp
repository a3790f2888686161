#include "engine/image/backend.hpp"

#include <heliograph/error.hpp>

#include <dlfcn.h>

#include <cstring>

namespace helio {
namespace {

/** The folder of the library that this code is in, in the build tree and where it is installed alike. */
std::filesystem::path libraryFolder() {
    Dl_info info{};
    static const int anchor = 0;
    if (dladdr(&anchor, &info) == 0 || info.dli_fname == nullptr) return {};
    return std::filesystem::absolute(info.dli_fname).parent_path();
}

const ImageBackend& loadBackend() {
    const std::filesystem::path file = libraryFolder() / "libheliograph_image.so";
    void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
        const char* const reason = dlerror();
        throw Error("images cannot be read or written: " +
                    std::string(reason != nullptr ? reason : file.c_str()));
    }
    const auto version = reinterpret_cast<const char* (*)()>(dlsym(module, "heliographImageVersion"));
    const auto backend = reinterpret_cast<const ImageBackend* (*)()>(dlsym(module, "heliographImageBackend"));
    if (version == nullptr || backend == nullptr || std::strcmp(version(), HELIOGRAPH_VERSION) != 0) {
        throw Error("images cannot be read or written: " + file.string() +
                    " is not of version " HELIOGRAPH_VERSION);
    }
    return *backend();
}

}  // namespace

const ImageBackend& imageBackend() {
    static const ImageBackend& backend = loadBackend();
    return backend;
}

}  // namespace helio
