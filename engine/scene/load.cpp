#include "engine/scene/samples/sample.hpp"

#include <heliograph/error.hpp>
#include <heliograph/scene.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace helio {

Scene load(const std::string& source) {
    constexpr std::string_view samplePrefix = "sample:";
    if (source.starts_with(samplePrefix)) return makeSample(source.substr(samplePrefix.size()));
    throw InputError(source, "", "is no scene that can be read", "give sample:NAME");
}

}  // namespace helio
