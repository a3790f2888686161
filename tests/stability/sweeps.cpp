// How far each quantity can go before pictures are wrong: renders scenes with known answers over ranges that
// end beyond what single precision can say, and prints a Markdown table.
//   stability_sweeps
#include "tests/stability/measure.hpp"
#include "tests/stability/variants.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace helio::test {
namespace {

/** What a value of the swept quantity makes wrong. */
struct Outcome {
    double error = 0;  ///< relative; NaN for a refusal
    double noise = 0;  ///< its standard error
    bool warned = false;
    std::string refusal;
};

struct Sweep {
    std::string name;
    double tolerance = 0;
    std::vector<double> values;
    std::function<Outcome(double)> run;
};

Renderer& renderer() {
    static Renderer shared;
    return shared;
}

Outcome against(const RenderResult& result, double truth) {
    const Mean mean = meanOf(result.image);
    Outcome outcome;
    outcome.error = std::abs(mean.value - truth) / truth;
    if (result.nanCount > 0) outcome.error = INFINITY;
    outcome.noise = mean.error / truth;
    outcome.warned = !result.warnings.empty();
    return outcome;
}

Outcome known(const KnownScene& scene, std::uint32_t samples = 1024) {
    return against(renderer().render(scene.scene, independentSamples(8, samples)), scene.truth);
}

/** The box sample under a change that must not show, against itself: same samples, so that noise is small. */
Outcome unchanged(const Scene& changed, Pipeline pipeline) {
    RenderOptions options = independentSamples(24, 64, pipeline);
    static const RenderResult truths[] = {
        renderer().render(load("sample:cornell"), independentSamples(24, 64, Pipeline::Path)),
        renderer().render(load("sample:cornell"), independentSamples(24, 64, Pipeline::Raster))};
    const RenderResult result = renderer().render(changed, options);
    Outcome outcome = against(result, meanOf(truths[int(pipeline)].image).value);
    outcome.noise = 0;
    return outcome;
}

std::vector<double> powers(double base, int first, int last, int step = 1) {
    std::vector<double> values;
    for (int k = first; k <= last; k += step) values.push_back(std::pow(base, k));
    return values;
}

Scene moved(double sizes, bool inVertices) {
    const float distance = float(sizes * 550);
    const Scene scene = load("sample:cornell");
    const Scene far =
        transformed(scene, glm::translate(glm::mat4(1.0f), glm::vec3(distance, -distance, 0.5f * distance)));
    return inVertices ? baked(far) : far;
}

std::vector<Sweep> sweeps() {
    const Scene cornell = load("sample:cornell");
    std::vector<Sweep> all;
    for (const Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        const std::string where = pipeline == Pipeline::Path ? ", path" : ", raster";
        all.push_back({"scale of the scene" + where, 1e-6, powers(2, -60, 60, 10), [=](double factor) {
                           return unchanged(
                               transformed(cornell, glm::scale(glm::mat4(1.0f), glm::vec3(float(factor)))),
                               pipeline);
                       }});
        all.push_back({"distance from the origin by a node, in sizes" + where, 1e-3, powers(10, 0, 9),
                       [=](double sizes) { return unchanged(moved(sizes, false), pipeline); }});
        all.push_back({"distance from the origin in the vertices, in sizes" + where, 1e-2, powers(10, 0, 7),
                       [=](double sizes) { return unchanged(moved(sizes, true), pipeline); }});
    }
    all.push_back({"aspect of triangles", 1e-3, powers(10, 1, 7),
                   [](double aspect) { return known(slivers(aspect), 64); }});
    all.push_back({"side of a lamp at distance 1", 1e-2, powers(2, -40, 40, 5),
                   [](double side) { return known(squareLight(float(side))); }});
    all.push_back({"albedo of a closed room, 1 - x", 2e-2, powers(10, -4, -1),
                   [](double x) { return known(furnace(float(1 - x)), 256); }});
    all.push_back({"index of glass, 1 + x", 1e-2, powers(10, -8, 2),
                   [](double x) { return known(glassBall(float(1 + x))); }});
    return all;
}

int main() {
    fmt::print(
        "| quantity | values | right within | largest right | first wrong, its error | said |\n"
        "|---|---|---|---|---|---|\n");
    for (const Sweep& sweep : sweeps()) {
        std::string right = "none", wrong = "none", said;
        for (const double value : sweep.values) {
            Outcome outcome;
            try {
                outcome = sweep.run(value);
            } catch (const Error& error) {
                outcome.error = NAN;
                outcome.refusal = error.what();
            }
            std::fprintf(stderr, "%s: %g: error %.2e, noise %.1e%s %s\n", sweep.name.c_str(), value,
                         outcome.error, outcome.noise, outcome.warned ? ", warned" : "",
                         outcome.refusal.c_str());
            const bool isRight = outcome.error <= sweep.tolerance + 4 * outcome.noise;
            if (isRight) right = fmt::format("{:.3g}", value);
            if (!isRight && (wrong == "none" || right == "none")) {
                wrong = fmt::format("{:.3g}, {:.1e}", value, outcome.error);
                said = !outcome.refusal.empty() ? "refused" : outcome.warned ? "warned" : "nothing";
            }
        }
        fmt::print("| {} | {:.3g} to {:.3g} | {:g} | {} | {} | {} |\n", sweep.name, sweep.values.front(),
                   sweep.values.back(), sweep.tolerance, right, wrong, said);
    }
    return 0;
}

}  // namespace
}  // namespace helio::test

int main() {
    return helio::test::main();
}
