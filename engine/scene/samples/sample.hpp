#pragma once
/** @file The built-in samples: each registers itself from its own file, so no list of them grows. */
#include <heliograph/scene.hpp>

#include <functional>
#include <string>

namespace helio {

/** Registers `sample:NAME` at static initialisation: `const RegisterSample x{"name", makeScene};`. */
struct RegisterSample {
    RegisterSample(std::string name, std::function<Scene()> make);
};

/** Builds a sample. Throws InputError that lists the names for one that does not exist. */
Scene makeSample(const std::string& name);

}  // namespace helio
