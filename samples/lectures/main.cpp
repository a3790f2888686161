// Measures the samples: lectures [NAME...] renders each, or all, and prints the numbers its pictures hold
// beside those that theory says. The exit code is 1 where one is outside its tolerance.
#include "samples/lectures/materials.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace {

using Measure = std::vector<helio::lectures::Figure> (*)(helio::Renderer&);

const std::vector<std::pair<std::string, Measure>> kSamples = {{"gallery", helio::lectures::measureGallery},
                                                               {"caustic", helio::lectures::measureCaustic},
                                                               {"brushed", helio::lectures::measureBrushed},
                                                               {"snell", helio::lectures::measureSnell},
                                                               {"lenses", helio::lectures::measureLenses}};

}  // namespace

int main(int count, char** arguments) try {
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty())
        for (const auto& [name, measure] : kSamples) names.push_back(name);
    helio::Renderer renderer;
    bool all = true;
    for (const std::string& name : names) {
        const auto sample =
            std::ranges::find_if(kSamples, [&](const auto& each) { return each.first == name; });
        if (sample == kSamples.end()) {
            std::fprintf(stderr, "lectures: error: '%s' is none of the samples that are measured\n",
                         name.c_str());
            return 2;
        }
        all = helio::lectures::print(name.c_str(), sample->second(renderer)) && all;
    }
    return all ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "lectures: error: %s\n", error.what());
    return 1;
}
