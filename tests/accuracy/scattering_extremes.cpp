#include "tests/accuracy/scattering_extremes.hpp"

#include <fmt/format.h>

#include <map>

namespace helio::test {
namespace {

constexpr std::uint32_t kRounds = 16;

/** Random numbers, and parameters as the packed materials hold them (resolvedAlpha, the ranges of
 * validate()). */
const char* const kNumbers = R"(#define EXTREMES
uint gState, gStream;
uint nextBits() {
    gState = gState * 747796405u + gStream;
    const uint word = ((gState >> ((gState >> 28) + 4u)) ^ gState) * 277803737u;
    return (word >> 22) ^ word;
}
float number() { return float(nextBits() >> 8) * (1.0 / 16777216.0); }
float unit() {
    const uint choice = nextBits() % 8u;
    const float u = number();
    if (choice == 0u) return 0.0;
    if (choice == 1u) return 1.0;
    if (choice == 2u) return uintBitsToFloat(nextBits() & 0x7fffffu);
    if (choice == 3u) return exp2(-126.0 * u);
    return choice == 4u ? 1.0 - exp2(-24.0 * u) : u;
}
vec3 unit3() { return vec3(unit(), unit(), unit()); }
float width() {
    const float a = unit();
    return a < 1e-4 ? a : clamp(a, 1e-4, 1.0);
}
vec2 widths() {
    const float a = width(), b = (nextBits() & 1u) == 0u ? a : width();
    return max(a, b) < 1e-4 ? vec2(a, b) : clamp(vec2(a, b), 1e-4, 1.0);
}
float index() {
    const uint choice = nextBits() % 4u;
    const float u = number();
    return choice == 0u ? 1.0 : choice == 1u ? 1.0 + (u - 0.5) * 1e-6 : exp2((u - 0.5) * 13.28771);
}
float coin() { return float(nextBits() & 1u); }
vec3 direction(bool below) {
    const uint choice = nextBits() % 5u;
    const float u = number();
    float c = choice == 0u ? exp2(-126.0 * u) : choice == 1u ? 1.0 - exp2(-24.0 * u) : choice == 2u ? 0.0 : u;
    c = clamp(c, 1e-38, 1.0);
    const float s = sqrt((1.0 - c) * (1.0 + c)), a = 6.2831853 * number();
    return vec3(s * cos(a), s * sin(a), below && coin() > 0.5 ? -c : c);
}
vec3 numbers() {
    const uint choice = nextBits() % 8u;
    vec3 u = vec3(number(), number(), number());
    if (choice == 0u) u = floor(u * 2.0) * (1.0 - 1.0 / 16777216.0);
    return u;
}
bool bad(float x) { return isnan(x) || isinf(x) || x < 0.0; }
bool bad(vec3 v) { return bad(v.x) || bad(v.y) || bad(v.z); })";

/** How a lobe's p is drawn. */
std::string parameters(const std::string& name) {
    const std::string facets = "p[1] = vec4(widths(), coin(), 0.0);";
    const std::map<std::string, std::string> all = {
        {"phong", "p[0] = vec4(unit3(), coin() * exp2(20.0 * number()));"},
        {"blinnPhong", "p[0] = vec4(unit3(), coin() * exp2(20.0 * number()));"},
        {"beckmann", "p[1] = vec4(widths(), 1.0, 0.0);"},
        {"ggx", "p[1] = vec4(widths(), 0.0, 0.0);"},
        {"conductor",
         "p[0] = vec4(index(), index(), index(), 0.0); p[2] = vec4(100.0 * unit3(), 0.0);" + facets},
        {"dielectric", facets + "p[1].w = index();"},
        {"dielectricCompensated", facets + "p[1].w = index();"},
        {"metalCompensated", facets},
        {"gltfMixed",
         "p[0] = vec4(unit3(), unit()); p[1] = vec4(widths(), index(), unit()); p[2] = vec4(unit3(), unit());"
         "p[3] = vec4(float(nextBits() % 3u) - 1.0, unit(), unit(), (coin() * 2.0 - 1.0) * unit());"}};
    const auto found = all.find(name);
    return found == all.end() ? "p[0] = vec4(unit3(), unit());" : found->second;
}

}  // namespace

std::vector<std::string> extremeLobes() {
    std::vector<std::string> names;
    for (const Lobe& candidate : lobes())
        if (candidate.name != "gltfClear" && candidate.name != "gltfCoated") names.push_back(candidate.name);
    return names;
}

Extremes runExtremes(const Lobe& model, std::uint32_t batch, std::uint32_t invocations) {
    Preamble lines = model.lines();
    lines.lines.push_back(kNumbers);
    const std::string body = fmt::format(
        "gState = a * 2654435761u; gStream = (a * 2246822519u) | 1u; vec4 fault = vec4(0.0);"
        "for (int i = 0; i < {}; ++i) {{ const uint before = gState; mat4 p = mat4(0.0); {}"
        "vec3 wo = direction(false), wi = direction({}), u = numbers();"
        "ScatterValue v = VALUE(p, wo, wi); ScatterSample s = SAMPLE(p, wo, u);"
        "float off = s.density != 0.0 ? abs(length(s.direction) - 1.0) : 0.0;"
        "bool isBad = bad(v.value) || bad(v.density) || bad(s.weight) || isnan(s.density) || "
        "isinf(s.density) || "
        "!(off < 1e-4);"
        "if (isBad) fault = vec4(fault.x + 1.0, uintBitsToFloat(0x3f800000u | (before >> 9)), v.density, "
        "s.density); }}"
        "return fault;",
        kRounds, parameters(model.name), model.below);
    std::vector<std::uint32_t> first(invocations);
    for (std::uint32_t i = 0; i < invocations; ++i) first[i] = batch * invocations + i;
    const auto results = runOnDevice<glm::vec4>(lines, body, first);
    Extremes found;
    found.samples = std::uint64_t(invocations) * kRounds;
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (!(results[i].x > 0)) continue;
        if (found.faults == 0)
            found.first = fmt::format("{} batch {} invocation {}: densities {} and {}", model.name, batch, i,
                                      results[i].z, results[i].w);
        found.faults += std::uint64_t(results[i].x);
    }
    return found;
}

}  // namespace helio::test
