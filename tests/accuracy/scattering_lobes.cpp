#include "tests/accuracy/scattering_lobes.hpp"

#include "engine/core/shared.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>

namespace helio::test {
namespace {

constexpr const char* kFolder = "shaders/scattering/";

/** Widths of microfacets, isotropic and not, from nearly a mirror to the roughest. */
const std::vector<glm::vec2> kWidths = {{1e-4f, 1e-4f}, {1e-3f, 1e-3f}, {0.01f, 0.01f}, {0.1f, 0.1f},
                                        {0.5f, 0.5f},   {1.0f, 1.0f},   {0.1f, 0.5f},   {1.0f, 0.02f}};

/** The expression that picks value(i) for an integer i in [low, high): an array would be filled anew by every
 * invocation. */
std::string choices(std::size_t low, std::size_t high, const std::function<std::string(std::size_t)>& value) {
    if (high - low == 1) return value(low);
    const std::size_t middle = (low + high) / 2;
    return fmt::format("(i < {} ? {} : {})", middle, choices(low, middle, value),
                       choices(middle, high, value));
}

Lobe diffuse() {
    Lobe lobe{
        "lambert",
        {fmt::format("{}lambert.glsl", kFolder), "#define VALUE(p, wo, wi) lambertValue(p[0].xyz, wo, wi)",
         "#define SAMPLE(p, wo, u) lambertSample(p[0].xyz, wo, u)"},
        {}};
    for (float albedo : {0.0f, 0.5f, 1.0f}) {
        LobeCase c{fmt::format("albedo {}", albedo)};
        c.p[0] = glm::vec4(albedo);
        lobe.cases.push_back(c);
    }
    return lobe;
}

Lobe orenNayar() {
    Lobe lobe{"orenNayar",
              {fmt::format("{}oren_nayar.glsl", kFolder),
               "#define VALUE(p, wo, wi) orenNayarValue(p[0].xyz, p[0].w, wo, wi)",
               "#define SAMPLE(p, wo, u) orenNayarSample(p[0].xyz, p[0].w, wo, u)"},
              {}};
    for (float roughness : {0.0f, 0.1f, 0.35f, 1.0f}) {
        LobeCase c{fmt::format("roughness {}", roughness)};
        c.p[0] = {1, 1, 1, roughness};
        lobe.cases.push_back(c);
    }
    return lobe;
}

Lobe phongLike(const std::string& name) {
    Lobe lobe{name,
              {fmt::format("{}phong.glsl", kFolder),
               fmt::format("#define VALUE(p, wo, wi) {}Value(p[0].xyz, p[0].w, wo, wi)", name),
               fmt::format("#define SAMPLE(p, wo, u) {}Sample(p[0].xyz, p[0].w, wo, u)", name)},
              {}};
    for (float exponent : {0.0f, 1.0f, 10.0f, 100.0f, 10000.0f}) {
        LobeCase c{fmt::format("exponent {}", exponent)};
        c.p[0] = {1, 1, 1, exponent};
        lobe.cases.push_back(c);
    }
    return lobe;
}

Lobe facets(const std::string& name, float beckmann) {
    Lobe lobe{name,
              {fmt::format("{}microfacet.glsl", kFolder),
               "#define VALUE(p, wo, wi) facetValue(Microfacets(p[1].xy, p[1].z > 0.5), wo, wi)",
               "#define SAMPLE(p, wo, u) facetSample(Microfacets(p[1].xy, p[1].z > 0.5), wo, u)"},
              {}};
    for (const glm::vec2& alpha : kWidths) {
        LobeCase c{fmt::format("alpha {} {}", alpha.x, alpha.y)};
        c.p[1] = {alpha, beckmann, 0};
        lobe.cases.push_back(c);
    }
    return lobe;
}

Lobe conductor() {
    Lobe lobe{
        "conductor",
        {fmt::format("{}conductor.glsl", kFolder), "#define FACETS(p) Microfacets(p[1].xy, p[1].z > 0.5)",
         "#define VALUE(p, wo, wi) conductorValue(p[0].xyz, p[2].xyz, FACETS(p), wo, wi)",
         "#define SAMPLE(p, wo, u) conductorSample(p[0].xyz, p[2].xyz, FACETS(p), wo, u)"},
        {}};
    for (const glm::vec2& alpha : {glm::vec2(1e-4f), glm::vec2(0.2f), glm::vec2(1.0f)}) {
        LobeCase c{fmt::format("alpha {}", alpha.x)};
        c.p[0] = {0.2f, 1.1f, 3.0f,
                  0};  // n: silver-like, copper-like, and an index of 3 that absorbs nothing
        c.p[2] = {3.9f, 2.6f, 0.0f, 0};
        c.p[1] = {alpha, 0, 0};
        lobe.cases.push_back(c);
    }
    return lobe;
}

Lobe dielectric() {
    Lobe lobe{
        "dielectric",
        {fmt::format("{}dielectric.glsl", kFolder), "#define FACETS(p) Microfacets(p[1].xy, p[1].z > 0.5)",
         "#define VALUE(p, wo, wi) dielectricValue(p[1].w, FACETS(p), false, wo, wi)",
         "#define SAMPLE(p, wo, u) dielectricSample(p[1].w, FACETS(p), false, wo, u)"},
        {}};
    for (float eta : {1.1f, 1.5f, 3.0f, 1 / 1.5f, 1 / 3.0f})
        for (const glm::vec3& alpha : {glm::vec3(1e-4f, 1e-4f, 0), glm::vec3(0.1f, 0.3f, 0),
                                       glm::vec3(1, 1, 0), glm::vec3(0.3f, 0.3f, 1)}) {
            LobeCase c{
                fmt::format("eta {} alpha {} {}{}", eta, alpha.x, alpha.y, alpha.z > 0 ? " Beckmann" : "")};
            c.p[1] = {alpha, eta};
            lobe.cases.push_back(c);
        }
    lobe.below = true;
    lobe.eta = "p[1].w";
    return lobe;
}

Lobe sheen() {
    Lobe lobe{"sheen",
              {fmt::format("{}sheen.glsl", kFolder), "#define VALUE(p, wo, wi) sheenValue(p[0].x, wo, wi)",
               "#define SAMPLE(p, wo, u) sheenSample(p[0].x, wo, u)"},
              {}};
    for (float roughness : {0.0f, 0.3f, 0.7f, 1.0f}) {
        LobeCase c{fmt::format("roughness {}", roughness)};
        c.p[0] = glm::vec4(roughness);
        lobe.cases.push_back(c);
    }
    lobe.conserves = false;  // its published fit is not bounded by 1 at low roughness
    return lobe;
}

/** Directional albedos of sheen at the two roughnesses of the cases, over the square root of the cosine. */
std::string sheenTables() {
    constexpr std::size_t nodes = 32;
    constexpr int columns = 96, rows = 64;
    constexpr double pi = std::numbers::pi;
    std::vector<glm::dvec2> table;
    for (std::size_t node = 0; node < nodes; ++node) {
        const double root = double(node) / (nodes - 1), c = std::max(root * root, double(1e-4L));
        const glm::dvec3 wo(std::sqrt((1 - c) * (1 + c)), double(0), c);
        glm::dvec2 sum(0);
        for (int i = 0; i < columns; ++i)
            for (int k = 0; k < rows; ++k) {
                const double u = (i + 0.5L) / columns, theta = pi / 2 * u * (2 - u),
                             phi = pi * (k + 0.5L) / rows;
                const glm::dvec3 wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                    std::cos(theta));
                sum += glm::dvec2(shared64::sheenValue(double(0.1f), wo, wi).value.x,
                                  shared64::sheenValue(double(0.5f), wo, wi).value.x) *
                       (std::sin(theta) * (1 - u) * 2 * pi * pi / (columns * rows));
            }
        table.push_back(sum);
    }
    const auto cell = [&](std::size_t i) {
        return fmt::format("vec4({:.7f}, {:.7f}, {:.7f}, {:.7f})", table[i].x, table[i].y, table[i + 1].x,
                           table[i + 1].y);
    };
    return fmt::format(
        "#define SHEEN_TABLE\nfloat sheenAlbedo(float cosine, float roughness) {{"
        "float x = sqrt(clamp(cosine, 0.0, 1.0)) * 31.0; int i = min(int(x), 30); vec4 ends = {};"
        "vec2 both = mix(ends.xy, ends.zw, x - float(i)); return roughness < 0.3 ? both.x : both.y; }}",
        choices(0, nodes - 1, cell));
}

/** p[0]: base colour, metallic; p[1]: alpha, eta, transmission; p[2]: f0, f90; p[3]: thin, coat, alpha of the
 * coat, sheen (negative: of roughness 0.1). */
Lobe gltf(const std::string& name) {
    Lobe lobe{
        name,
        {"#define HAS_DIELECTRIC true", "#define HAS_TRANSMISSION true", "#define HAS_CLEARCOAT true",
         "#define HAS_SHEEN true", "#define HAS_IRIDESCENCE true", sheenTables(),
         fmt::format("{}gltf.glsl", kFolder),
         "#define GLTF(p) GltfSurface(p[0].xyz, p[0].w, p[1].xy, p[2].xyz, p[2].w, p[1].z, p[1].w, p[3].x > "
         "0.5, "
         "p[3].y, p[3].z, vec3(0.0, 0.0, 1.0), vec3(abs(p[3].w)), p[3].w < 0.0 ? 0.1 : 0.5, "
         "p[3].x < 0.0 ? 1.0 : 0.0, 1.3, 400.0)",
         "#define VALUE(p, wo, wi) gltfValue(GLTF(p), wo, wi)",
         "#define SAMPLE(p, wo, u) gltfScatter(GLTF(p), wo, u)"},
        {}};
    lobe.below = true;
    lobe.eta = "(p[3].x > 0.5 ? 1.0 : p[1].z)";
    return lobe;
}

LobeCase gltfCase(std::string name, float base, float metallic, glm::vec2 alpha, float f0 = 0.04f) {
    LobeCase c{std::move(name)};
    c.p[0] = {base, base, base, metallic};
    c.p[1] = {alpha, 1.5f, 0};
    c.p[2] = {f0, f0, f0, 1};
    c.p[3] = {1, 0, 0, 0};
    return c;
}

/** Metals and glass, whose albedo stays below 1 and that are reciprocal. */
Lobe gltfClear() {
    Lobe lobe = gltf("gltfClear");
    for (float alpha : {1e-4f, 0.01f, 0.25f, 1.0f})
        lobe.cases.push_back(gltfCase(fmt::format("metal alpha {}", alpha), 1, 1, glm::vec2(alpha)));
    lobe.cases.push_back(gltfCase("brushed metal", 0.9f, 1, {0.6f, 0.05f}));
    LobeCase film = gltfCase("iridescent metal", 0.9f, 1, glm::vec2(0.2f));
    film.p[3].x = -1;
    lobe.cases.push_back(film);
    for (float eta : {1.5f, 1 / 1.5f}) {
        LobeCase glass = gltfCase(fmt::format("glass eta {}", eta), 1, 0, glm::vec2(0.2f));
        glass.p[1] = {0.2f, 0.2f, eta, 1};
        glass.p[3].x = 0;
        lobe.cases.push_back(glass);
    }
    LobeCase pane = gltfCase("thin pane", 1, 0, glm::vec2(0.3f));
    pane.p[1].w = 1;
    lobe.cases.push_back(pane);
    lobe.cases.push_back(gltfCase("black", 0, 1, glm::vec2(0.5f)));
    return lobe;
}

/** What holds a diffuse part or sheen. */
Lobe gltfMixed() {
    Lobe lobe = gltf("gltfMixed");
    for (float alpha : {0.0f, 1e-4f, 1e-3f, 0.01f, 0.05f, 0.2f, 0.5f, 1.0f})
        for (float f0 : {0.04f, 0.25f})
            lobe.cases.push_back(
                gltfCase(fmt::format("plastic alpha {} f0 {}", alpha, f0), 1, 0, glm::vec2(alpha), f0));
    lobe.cases.push_back(gltfCase("brushed plastic", 1, 0, {0.8f, 0.02f}));
    lobe.cases.push_back(gltfCase("half metal", 1, 0.5f, glm::vec2(0.3f)));
    LobeCase cloth = gltfCase("cloth", 1, 0, glm::vec2(0.8f));
    cloth.p[3] = {1, 0, 0, 0.9f};
    lobe.cases.push_back(cloth);
    cloth.name = "fine cloth";
    cloth.p[3].w = -1;
    lobe.cases.push_back(cloth);
    LobeCase film = gltfCase("iridescent plastic", 1, 0, glm::vec2(0.2f));
    film.p[3].x = -1;
    lobe.cases.push_back(film);
    // A mix of glass and paint, from outside and from inside.
    for (float eta : {1.5f, 1 / 1.5f}) {
        LobeCase painted = gltfCase(fmt::format("painted glass eta {}", eta), 1, 0.2f, {0.5f, 0.1f});
        painted.p[1].z = eta;
        painted.p[1].w = 0.5f;
        painted.p[3] = {0, 0, 0, 0};
        lobe.cases.push_back(painted);
    }
    return lobe;
}

/** Clear coats: the specification weighs them by the viewer's angle alone. */
Lobe gltfCoated() {
    Lobe lobe = gltf("gltfCoated");
    lobe.reciprocal = false;
    for (float coatAlpha : {0.0f, 0.05f, 0.5f, 1.0f}) {
        LobeCase coated =
            gltfCase(fmt::format("coat alpha {}", coatAlpha), 1, 0.3f, {0.5f, coatAlpha > 0 ? 0.5f : 0.1f});
        coated.p[3] = {1, 1, coatAlpha, 0};
        lobe.cases.push_back(coated);
    }
    LobeCase all = gltfCase("all", 1, 0.2f, {0.5f, 0.1f});
    all.p[1].w = 0.5f;
    all.p[3] = {0, 0.5f, 0.3f, 0.5f};
    lobe.cases.push_back(all);
    return lobe;
}

}  // namespace

glm::vec3 directionAt(float cosine, float azimuth) {
    const float sine = std::sqrt(std::max(0.0f, (1.0f - cosine) * (1.0f + cosine)));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

Lobe compensatedFacets(const std::string& name, float n, float alpha, bool beckmann) {
    Lobe lobe{name, {}, {}};
    lobe.below = n > 0;
    if (n > 0) lobe.eta = "p[1].w";
    Scattering s;
    s.model = n > 0 ? Scattering::Model::Dielectric : Scattering::Model::Conductor;
    s.alpha = glm::vec2(alpha);
    s.beckmann = beckmann;
    s.n = glm::vec3(n > 0 ? n : 0.01f);
    s.k = glm::vec3(100);
    const auto table = pack::facetLosses(s);
    const auto texel = [&](std::size_t i) {
        const glm::vec4& t = table[i];
        return fmt::format("vec4({:.8e}, {:.8e}, {:.8e}, {:.8e})", t.x, t.y, t.z, t.w);
    };
    for (float eta : {n, 1 / n}) {
        LobeCase c{fmt::format("n {} eta {} alpha {}{}", n, eta, alpha, beckmann ? " Beckmann" : "")};
        c.p[1] = {alpha, alpha, beckmann ? 1 : 0, n > 0 ? eta : 0};
        lobe.cases.push_back(c);
        if (!(n > 0)) break;
    }
    lobe.preamble = {
        "#define HAS_COMPENSATION true",
        fmt::format("#define HAS_MODEL(model) ((model) == {}u)", n > 0 ? 2 : 4),
        fmt::format("#define LOSS_TABLE\nvec4 lossTexel(int i) {{ return {}; }}",
                    choices(0, table.size(), texel)),
        fmt::format("{}models.glsl", kFolder),
        fmt::format(
            "#define SURFACE(p) ModelSurface({}, vec3(1.0), 0.0, vec3(0.01), vec3(100.0), p[1].w, 0.0, "
            "Microfacets(p[1].xy, p[1].z > 0.5), false, true, p[1].w < 1.0, 0)",
            n > 0 ? "MODEL_DIELECTRIC" : "MODEL_CONDUCTOR"),
        "#define JUDGED\nScatterSample judged(ModelSurface m, vec3 wo, vec3 u) { ScatterSample s = "
        "modelDirection(m, wo, u); "
        "if (s.density <= 0.0) return s; return sampleOf(s.direction, modelValue(m, wo, s.direction)); }",
        "#define VALUE(p, wo, wi) modelValue(SURFACE(p), wo, wi)",
        "#define SAMPLE(p, wo, u) judged(SURFACE(p), wo, u)"};
    return lobe;
}

const std::vector<Lobe>& lobes() {
    static const std::vector<Lobe> all = {diffuse(),
                                          orenNayar(),
                                          phongLike("phong"),
                                          phongLike("blinnPhong"),
                                          facets("ggx", 0),
                                          facets("beckmann", 1),
                                          conductor(),
                                          dielectric(),
                                          compensatedFacets("dielectricCompensated", 1.5f, 0.6f, false),
                                          compensatedFacets("metalCompensated", 0, 0.5f, false),
                                          sheen(),
                                          gltfClear(),
                                          gltfMixed(),
                                          gltfCoated()};
    return all;
}

const Lobe& lobe(const std::string& name) {
    for (const Lobe& candidate : lobes())
        if (candidate.name == name) return candidate;
    assert(false && "no such lobe");
    return lobes().front();
}

}  // namespace helio::test
