/** @file
 * One authored glTF file for each material extension, loaded and rendered by both pipelines, against the
 * extension's own formulas in double. The files hold a plate seen from straight above under a sun at 40
 * degrees, so that a pixel is the BRDF's value times the cosine.
 */
#include "tests/support/renderer.hpp"
#include "tests/unit/gltf_support.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace helio::test {
namespace {

using Vec = glm::dvec3;
constexpr double kPi = std::numbers::pi;
constexpr double kLift = 40 * kPi / 180;

/** The pixel in the middle, or a row's mean. */
Vec meanOf(const ImageF& image) {
    Vec sum(0);
    const std::size_t pixels = std::size_t(image.width) * image.height;
    for (std::size_t i = 0; i < pixels; ++i)
        for (int c = 0; c < 3; ++c) sum[c] += double(image.data[i * image.channels.size() + std::size_t(c)]);
    return sum / double(pixels);
}

// The view is along the normal; the light's direction and the half vector.
const Vec kLight(std::sin(kLift), 0, std::cos(kLift));
const Vec kHalf(std::sin(kLift / 2), 0, std::cos(kLift / 2));
const double kNl = std::cos(kLift), kVh = std::cos(kLift / 2);

double fifth(double cosine) {
    return std::pow(1 - cosine, 5);
}

/** D V of the specification's appendix B and of KHR_materials_anisotropy, of widths along x and y. */
double facets(double at, double ab, double turn = 0) {
    const auto rotated = [&](const Vec& v) {
        return Vec(std::cos(turn) * v.x + std::sin(turn) * v.y, std::cos(turn) * v.y - std::sin(turn) * v.x,
                   v.z);
    };
    const Vec h = rotated(kHalf), l = rotated(kLight);
    const double d = h.x * h.x / (at * at) + h.y * h.y / (ab * ab) + h.z * h.z;
    const double normals = 1 / (kPi * at * ab * d * d);
    const double visibility = 0.5 / (kNl * 1 + 1 * std::hypot(at * l.x, ab * l.y, l.z));
    return normals * visibility;
}

/** D V of KHR_materials_sheen. */
double sheen(double roughness) {
    const double alpha = roughness * roughness, s = std::sin(kLift / 2);
    const double normals = (2 + 1 / alpha) * std::pow(s, 1 / alpha) / (2 * kPi);
    const auto l = [&](double x) {
        const double t = (1 - alpha) * (1 - alpha);
        const auto mixed = [&](double p, double q) { return p + t * (q - p); };
        return mixed(21.5473, 25.3245) /
                   (1 + mixed(3.82987, 3.32435) * std::pow(x, mixed(0.19823, 0.16801))) +
               mixed(-1.97760, -1.27393) * x + mixed(-4.32054, -4.85967);
    };
    const auto lambda = [&](double x) { return std::exp(x < 0.5 ? l(x) : 2 * l(0.5) - l(1 - x)); };
    return normals / ((1 + lambda(1) + lambda(kNl)) * 4 * kNl);
}

/** Airy's summation of all reflections in a film on a metal, averaged over frequency by the responses of X, Y
 * and Z that the extension's reference fits by Gaussians, in linear Rec.709. What does not interfere is
 * white. */
Vec film(double index, double nanometres, const Vec& f0, double cosine) {
    const double beneath = std::sqrt(1 - (1 - cosine * cosine) / (index * index));
    const double r0 = std::pow((index - 1) / (index + 1), 2);
    const double r12 = r0 + (1 - r0) * fifth(cosine);
    const double path = 2 * index * nanometres * 1e-9 * beneath;
    struct Response {
        double weight, centre, variance;
    };
    const std::array<std::vector<Response>, 3> responses = {
        {{{0.846590, 1.6810e6, 4.3278e9}, {0.153868, 2.2399e6, 4.5282e9}},
         {{1.000222, 1.7953e6, 9.3046e9}},
         {{1.001122, 2.2084e6, 6.6121e9}}}};
    const glm::dmat3 toRgb(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314,
                           0.0415560, 1.0572252);
    Vec result;
    for (int c = 0; c < 3; ++c) {
        const double base = (1 + std::sqrt(f0[c])) / (1 - std::sqrt(f0[c]));
        const double at0 = std::pow((base - index) / (base + index), 2);
        const double r23 = at0 + (1 - at0) * fifth(beneath);
        // Amplitudes: reflection at a denser medium turns the phase by pi.
        const double a12 = -std::sqrt(r12), a23 = base < index ? std::sqrt(r23) : -std::sqrt(r23);
        const double incoherent = r12 + (1 - r12) * (1 - r12) * r23 / (1 - r12 * r23);
        Vec xyz(0);
        for (int k = 0; k < 3; ++k)
            for (const Response& response : responses[std::size_t(k)]) {
                const double width = std::sqrt(2 * response.variance);
                double sum = 0, weights = 0;
                for (int i = -400; i <= 400; ++i) {
                    const double x = i * 0.015, weight = std::exp(-x * x / 2);
                    const double phase = 2 * kPi * path * (response.centre + x * width);
                    const std::complex<double> turned = std::polar(1.0, phase);
                    const double reflectance = std::norm((a12 + a23 * turned) / (1.0 + a12 * a23 * turned));
                    sum += weight * (reflectance - incoherent);
                    weights += weight;
                }
                xyz[k] += response.weight * sum / weights;
            }
        result[c] = incoherent + (toRgb * xyz)[c];
    }
    return result;
}

class MaterialExtensions : public Gltf {
protected:
    /** A plate of 2 x 2 at z = 0 with tangents along x, a parallel view of its middle, and the sun. */
    static GltfDocument plate(const json& material, float half = 1) {
        GltfDocument file;
        const int positions = file.addAccessor<float>(
            {-half, -half, 0, half, -half, 0, half, half, 0, -half, half, 0}, "VEC3", 4);
        const int normals = file.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 4);
        const int tangents =
            file.addAccessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4);
        const int indices = file.addAccessor<std::uint32_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 6);
        file.doc["meshes"] = json::array(
            {{{"primitives",
               json::array(
                   {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TANGENT", tangents}}},
                     {"indices", indices},
                     {"material", 0}}})}}});
        file.doc["materials"] = json::array({material});
        file.doc["cameras"] = json::array(
            {{{"type", "orthographic"},
              {"orthographic", {{"xmag", 0.01}, {"ymag", 0.01}, {"zfar", 10}, {"znear", 0.01}}}}});
        file.doc["extensions"]["KHR_lights_punctual"]["lights"] =
            json::array({{{"type", "directional"}, {"intensity", 3.0}}});
        // A light shines along its -z: turned about y so that it comes from (sin, 0, cos).
        file.doc["nodes"] = json::array({{{"mesh", 0}},
                                         {{"camera", 0}, {"translation", {0, 0, 4}}},
                                         {{"rotation", {0, std::sin(kLift / 2), 0, std::cos(kLift / 2)}},
                                          {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
        file.doc["scenes"] = json::array({{{"nodes", {0, 1, 2}}}});
        file.doc["scene"] = 0;
        file.doc["extensionsUsed"] = {"KHR_lights_punctual"};
        const json extensions = material.value("extensions", json::object());
        for (const auto& [name, content] : extensions.items()) file.doc["extensionsUsed"].push_back(name);
        return file;
    }
    static json material(const Vec& color, double metallic, double roughness, const json& extensions) {
        return {{"pbrMetallicRoughness",
                 {{"baseColorFactor", {color.x, color.y, color.z, 1}},
                  {"metallicFactor", metallic},
                  {"roughnessFactor", roughness}}},
                {"extensions", extensions}};
    }
    /** A plate that light goes straight through (index 1), 0.3 thick, of a medium that absorbs. */
    static GltfDocument absorbingPlate() {
        return plate(material(Vec(1), 0, 0,
                              {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                               {"KHR_materials_ior", {{"ior", 1.0}}},
                               {"KHR_materials_volume",
                                {{"thicknessFactor", 0.3},
                                 {"attenuationDistance", 0.5},
                                 {"attenuationColor", {0.25, 0.5, 0.9}}}}}));
    }
    RenderResult shown(const GltfDocument& file, Pipeline pipeline, glm::vec3 surroundings = glm::vec3(0),
                       std::array<std::uint32_t, 2> size = {8, 8}, std::uint32_t samples = 4) const {
        return shown(load(file), pipeline, surroundings, size, samples);
    }
    static RenderResult shown(const Scene& scene, Pipeline pipeline, glm::vec3 surroundings,
                              std::array<std::uint32_t, 2> size = {8, 8}, std::uint32_t samples = 4) {
        RenderOptions options;
        options.pipeline = pipeline;
        options.size = size;
        options.samples = samples;
        options.auxiliary = false;
        options.environment = Environment{surroundings, -1};
        return renderer().render(scene, options);
    }
    /** Both pipelines show `truth`, per unit of the sun's irradiance of 3. */
    void expectBoth(const std::string& name, const json& made, const Vec& truth, double within = 4e-3) const {
        for (Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
            const Vec mean = meanOf(shown(plate(made), pipeline).image) / 3.0;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(mean[c], truth[c], within * truth[c] + 1e-6)
                    << name << " channel " << c << (pipeline == Pipeline::Path ? " path" : " raster");
            fmt::print("{} {}: {:.6f} {:.6f} {:.6f}, formula {:.6f} {:.6f} {:.6f}\n", name,
                       pipeline == Pipeline::Path ? "path" : "raster", mean.x, mean.y, mean.z, truth.x,
                       truth.y, truth.z);
        }
    }
};

const Vec kBlack(0);

TEST_F(MaterialExtensions, GlossIsTheirFormulas) {
    const double alpha = 0.16;  // roughness 0.4
    const double lobe = facets(alpha, alpha) * kNl;
    const double schlick = fifth(kVh);
    const auto reflectance = [&](double f0, double f90) { return f0 + (f90 - f0) * schlick; };
    expectBoth("specular",
               material(kBlack, 0, 0.4,
                        {{"KHR_materials_specular",
                          {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 0.25}}}}}),
               lobe * Vec(reflectance(0.02, 0.5), reflectance(0.01, 0.5), reflectance(0.005, 0.5)));
    expectBoth("ior", material(kBlack, 0, 0.4, {{"KHR_materials_ior", {{"ior", 1.8}}}}),
               Vec(lobe * reflectance(std::pow(0.8 / 2.8, 2), 1)));
    const double at = alpha + (1 - alpha) * 0.49;
    expectBoth(
        "anisotropy",
        material(Vec(0.8, 0.6, 0.4), 1, 0.4,
                 {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.7}, {"anisotropyRotation", 0.5}}}}),
        facets(at, alpha, 0.5) * kNl * Vec(reflectance(0.8, 1), reflectance(0.6, 1), reflectance(0.4, 1)));
    const json noSpecular = {{"specularFactor", 0.0}};
    expectBoth("clearcoat",
               material(kBlack, 0, 0.9,
                        {{"KHR_materials_specular", noSpecular},
                         {"KHR_materials_clearcoat",
                          {{"clearcoatFactor", 0.75}, {"clearcoatRoughnessFactor", 0.4}}}}),
               Vec(0.75 * 0.04 * lobe));
    expectBoth("sheen",
               material(kBlack, 0, 0.9,
                        {{"KHR_materials_specular", noSpecular},
                         {"KHR_materials_sheen",
                          {{"sheenColorFactor", {0.9, 0.5, 0.2}}, {"sheenRoughnessFactor", 0.6}}}}),
               Vec(0.9, 0.5, 0.2) * (sheen(0.6) * kNl));
    const Vec metal(0.9, 0.6, 0.3);
    for (double thickness : {250.0, 800.0})
        expectBoth(fmt::format("iridescence {} nm", thickness),
                   material(metal, 1, 0.4,
                            {{"KHR_materials_iridescence",
                              {{"iridescenceFactor", 1.0},
                               {"iridescenceIor", 1.4},
                               {"iridescenceThicknessMaximum", thickness}}}}),
                   lobe * film(1.4, thickness, metal, kVh), 0.01);
}

TEST_F(MaterialExtensions, EmissionAndUnlitAreTheirFactors) {
    json lamp = material(kBlack, 0, 1,
                         {{"KHR_materials_emissive_strength", {{"emissiveStrength", 7.0}}},
                          {"KHR_materials_specular", {{"specularFactor", 0.0}}}});
    lamp["emissiveFactor"] = {1, 0.5, 0.25};
    expectBoth("emissive strength", lamp, Vec(7, 3.5, 1.75) / 3.0, 1e-6);
    expectBoth("unlit", material(Vec(0.9, 0.5, 0.2), 1, 0.4, {{"KHR_materials_unlit", json::object()}}),
               Vec(0.9, 0.5, 0.2) / 3.0, 1e-6);
}

TEST_F(MaterialExtensions, LightGoesThroughByTheirFormulas) {
    // A smooth pane under surroundings of radiance 1: F + (1 - F) base colour.
    const GltfDocument pane = plate(
        material(Vec(0.5, 0.25, 1), 0, 0, {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}}}));
    const Vec seen = meanOf(shown(pane, Pipeline::Path, glm::vec3(1), {8, 8}, 1024).image);
    // The sun is a direction that a smooth pane shows to nobody.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 0.04 + 0.96 * Vec(0.5, 0.25, 1)[c], 2e-3) << c;
    const Vec drawn = meanOf(shown(pane, Pipeline::Raster, glm::vec3(1)).image);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(drawn[c], 0.04 + 0.96 * Vec(0.5, 0.25, 1)[c], 2e-3) << c;
    fmt::print(
        "transmission path: {:.4f} {:.4f} {:.4f}, raster {:.4f} {:.4f} {:.4f}, formula 0.5200 0.2800 "
        "1.0000\n",
        seen.x, seen.y, seen.z, drawn.x, drawn.y, drawn.z);

    // A second plate behind it, turned away, makes a slab 0.3 thick of a medium of index 1.
    GltfDocument slab = absorbingPlate();
    slab.doc["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, -0.3}}, {"rotation", {1, 0, 0, 0}}});
    slab.doc["scenes"][0]["nodes"].push_back(3);
    const Vec truth(std::pow(0.25, 0.6), std::pow(0.5, 0.6), std::pow(0.9, 0.6));
    for (Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        const RenderResult result = shown(slab, pipeline, glm::vec3(1), {8, 8}, 16);
        const Vec left = meanOf(result.image);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(left[c], truth[c], 1e-3) << c;
        fmt::print("volume {}: {:.5f} {:.5f} {:.5f}, Beer-Lambert {:.5f} {:.5f} {:.5f}\n",
                   pipeline == Pipeline::Path ? "path" : "raster", left.x, left.y, left.z, truth.x, truth.y,
                   truth.z);
        EXPECT_EQ(
            std::ranges::any_of(result.skipped,
                                [](const auto& skipped) { return skipped.first == "shape of volumes"; }),
            pipeline == Pipeline::Raster);
    }
}

/** A thickness is the mesh's, so it grows with its node, and a texture's green scales it. */
TEST_F(MaterialExtensions, ThicknessIsTheMeshsTimesItsTexture) {
    GltfDocument file = absorbingPlate();
    file.doc["nodes"][0]["scale"] = {2, 2, 2};
    Scene scene = load(file);
    TextureImage image;
    image.width = image.height = 1;
    image.texels = std::vector<std::uint8_t>{255, 102, 255, 255};
    scene.images.push_back(image);
    Texture texture;
    texture.image = 0;
    scene.textures.push_back(texture);
    scene.materials[0].thicknessTexture.texture = 0;
    Primitive& p = scene.meshes[0].primitives[0];
    p.texcoords = {std::vector<glm::vec2>(p.positions.size())};
    const Vec left = meanOf(shown(scene, Pipeline::Raster, glm::vec3(1)).image);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(left[c], std::pow(Vec(0.25, 0.5, 0.9)[c], 0.3 * 2 * 0.4 / 0.5), 1e-5) << c;
}

/** Two plates of glass one behind the other, over a lamp: each lets 1 - F through both of its faces, with all
 * reflections between them, and absorbs by its own colour. */
TEST_F(MaterialExtensions, GlassIsSeenThroughGlass) {
    const auto glass = [](const Vec& color) {
        return material(Vec(1), 0, 0,
                        {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                         {"KHR_materials_volume",
                          {{"thicknessFactor", 0.3},
                           {"attenuationDistance", 0.3},
                           {"attenuationColor", {color.x, color.y, color.z}}}}});
    };
    GltfDocument file = plate(glass(Vec(0.5, 0.8, 1)));
    json lamp = material(kBlack, 0, 1, json::object());
    lamp["emissiveFactor"] = {1, 1, 1};
    lamp["doubleSided"] = true;
    file.doc["materials"].push_back(glass(Vec(1, 0.6, 0.7)));
    file.doc["materials"].push_back(lamp);
    for (int made : {1, 2}) {
        json mesh = file.doc["meshes"][0];
        mesh["primitives"][0]["material"] = made;
        file.doc["meshes"].push_back(mesh);
    }
    const json turned = {1, 0, 0, 0};
    file.doc["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, -0.3}}, {"rotation", turned}});
    file.doc["nodes"].push_back({{"mesh", 1}, {"translation", {0, 0, -0.5}}});
    file.doc["nodes"].push_back({{"mesh", 1}, {"translation", {0, 0, -0.8}}, {"rotation", turned}});
    file.doc["nodes"].push_back({{"mesh", 2}, {"translation", {0, 0, -1}}});
    file.doc["scenes"][0]["nodes"] = {0, 1, 3, 4, 5, 6};
    const auto slab = [](double a) { return a * 0.96 * 0.96 / (1 - 0.04 * 0.04 * a * a); };
    const Vec truth = Vec(slab(0.5), slab(0.8), slab(1)) * Vec(slab(1), slab(0.6), slab(0.7));
    for (Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        const RenderResult result = shown(file, pipeline, glm::vec3(0), {8, 8}, 512);
        const Vec seen = meanOf(result.image);
        // Between the plates and the lamp the path tracer has further reflections: about twice 0.077^2.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(seen[c], truth[c], pipeline == Pipeline::Path ? 0.02 : 1e-4) << c;
        fmt::print("glass through glass {}: {:.4f} {:.4f} {:.4f}, formula {:.4f} {:.4f} {:.4f}\n",
                   pipeline == Pipeline::Path ? "path" : "raster", seen.x, seen.y, seen.z, truth.x, truth.y,
                   truth.z);
        if (pipeline == Pipeline::Path) continue;
        EXPECT_TRUE(std::ranges::any_of(result.counters, [](const auto& counter) {
            return counter.first == "refraction_pictures" && counter.second == 3;
        }));
    }
}

/** A rough pane before the edge of a lamp blurs it by its facets. */
TEST_F(MaterialExtensions, RoughPanesBlurWhatIsBehind) {
    GltfDocument file =
        plate(material(Vec(1), 0, 0.35, {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}}}), 4);
    json lamp = material(kBlack, 0, 1, {{"KHR_materials_specular", {{"specularFactor", 0.0}}}});
    lamp["emissiveFactor"] = {1, 1, 1};
    file.doc["extensionsUsed"].push_back("KHR_materials_specular");
    file.doc["materials"].push_back(lamp);
    json floor = file.doc["meshes"][0];
    floor["primitives"][0]["material"] = 1;
    file.doc["meshes"].push_back(floor);
    file.doc["nodes"].push_back({{"mesh", 1}, {"translation", {4, 0, -0.5}}});
    file.doc["materials"].push_back(material(kBlack, 0, 1, {{"KHR_materials_unlit", json::object()}}));
    floor["primitives"][0]["material"] = 2;
    file.doc["meshes"].push_back(floor);
    file.doc["nodes"].push_back({{"mesh", 2}, {"translation", {-4, 0, -0.5}}});
    file.doc["scenes"][0]["nodes"] = {0, 1, 3, 4};
    file.doc["cameras"][0]["orthographic"]["xmag"] = 1;
    file.doc["cameras"][0]["orthographic"]["ymag"] = 1;
    const RenderResult path = shown(file, Pipeline::Path, glm::vec3(0), {32, 32}, 96),
                       raster = shown(file, Pipeline::Raster, glm::vec3(0), {32, 32}, 1);
    const auto column = [](const RenderResult& result, std::uint32_t x) {
        double sum = 0;
        const std::size_t channels = result.image.channels.size();
        for (std::uint32_t y = 8; y < 24; ++y) sum += double(result.image.data[(y * 32 + x) * channels]);
        return sum / 16;
    };
    double squared = 0;
    for (std::uint32_t x = 0; x < 32; ++x) {
        const double truth = column(path, x), drawn = column(raster, x);
        squared += (drawn - truth) * (drawn - truth) / 32;
        if (x % 4 == 0) fmt::print("{:.3f} ({:.3f}) ", drawn, truth);
    }
    fmt::print("\nrough pane: RMS {:.4f} off the paths of a step of 0.96\n", std::sqrt(squared));
    EXPECT_LT(std::sqrt(squared), 0.03);
}

/** A plate of glass that leans 45 degrees shifts what is behind it by d sin(t - t') / cos t', t' by Snell for
 * each colour. `thicknessFactor` is the view's way through it, d / cos t'. */
TEST_F(MaterialExtensions, PlatesShiftWhatIsBehindBySnellsLaw) {
    const double ior = 1.5, dispersion = 2, tilt = kPi / 4, d = 0.4, half = 0.5, edge = -0.1;
    const double inside = std::asin(std::sin(tilt) / ior);
    GltfDocument file = plate(material(Vec(1), 0, 0,
                                       {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                                        {"KHR_materials_volume", {{"thicknessFactor", d / std::cos(inside)}}},
                                        {"KHR_materials_ior", {{"ior", ior}}},
                                        {"KHR_materials_dispersion", {{"dispersion", dispersion}}}}),
                              4);
    const json leans = {0, std::sin(tilt / 2), 0, std::cos(tilt / 2)};
    file.doc["nodes"][0]["rotation"] = leans;
    json lamp = material(kBlack, 0, 1, {{"KHR_materials_specular", {{"specularFactor", 0.0}}}});
    lamp["emissiveFactor"] = {1, 1, 1};
    file.doc["extensionsUsed"].push_back("KHR_materials_specular");
    file.doc["materials"].push_back(lamp);
    json floor = file.doc["meshes"][0];
    floor["primitives"][0]["material"] = 1;
    file.doc["meshes"].push_back(floor);
    file.doc["nodes"].push_back({{"mesh", 1}, {"translation", {edge + 4, 0, -2}}});
    // The far face: behind along the normal (sin, 0, cos), turned over about its own x.
    const json over = {std::cos(tilt / 2), 0, -std::sin(tilt / 2), 0};
    file.doc["nodes"].push_back(
        {{"mesh", 0}, {"translation", {-d * std::sin(tilt), 0, -d * std::cos(tilt)}}, {"rotation", over}});
    file.doc["scenes"][0]["nodes"] = {0, 1, 3, 4};
    file.doc["cameras"][0]["orthographic"]["xmag"] = half;
    file.doc["cameras"][0]["orthographic"]["ymag"] = half / 128;
    const double schlick = 0.04 + 0.96 * std::pow(1 - std::cos(tilt), 5);
    for (Pipeline pipeline : {Pipeline::Path, Pipeline::Raster}) {
        const ImageF image = shown(file, pipeline, glm::vec3(0), {128, 1}, 1024).image;
        for (int c = 0; c < 3; ++c) {
            const auto at = [&](std::uint32_t x) {
                return double(image.data[x * image.channels.size() + std::size_t(c)]);
            };
            double sum = 0, lit = 0;
            for (std::uint32_t x = 0; x < 128; ++x) sum += at(x) / 128;
            for (std::uint32_t x = 96; x < 128; ++x) lit += at(x) / 32;
            const double found = half - 2 * half * sum / lit - edge;
            const double index = ior + (c - 1) * (ior - 1) * 0.025 * dispersion;
            const double bent = std::asin(std::sin(tilt) / index);
            // The raster pipeline's way through is as long for each colour.
            const double deep = pipeline == Pipeline::Path ? d / std::cos(bent) : d / std::cos(inside);
            const double truth = deep * std::sin(tilt - bent);
            EXPECT_NEAR(found, truth, 4e-3) << c;
            EXPECT_NEAR(lit, (1 - schlick) / (1 + schlick), pipeline == Pipeline::Path ? 0.02 : 2e-3) << c;
            fmt::print(
                "plate {} channel {}: shift {:.4f}, Snell {:.4f}; lets {:.4f} through, formula {:.4f}\n",
                pipeline == Pipeline::Path ? "path" : "raster", c, found, truth, lit,
                (1 - schlick) / (1 + schlick));
        }
    }
}

/** A view that meets glass at 45 degrees, half of whose floor is a lamp: how far the lamp's edge moves tells
 * the angle of refraction of each colour. */
TEST_F(MaterialExtensions, DispersionBendsColoursBySnellsLaw) {
    const double ior = 1.5, dispersion = 2, tilt = kPi / 4, depth = 2, half = 0.5;
    GltfDocument file = plate(material(Vec(1), 0, 0,
                                       {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                                        {"KHR_materials_volume", {{"thicknessFactor", 1.0}}},
                                        {"KHR_materials_ior", {{"ior", ior}}},
                                        {"KHR_materials_dispersion", {{"dispersion", dispersion}}}}),
                              4);
    // The plate leans towards +x; the floor's lamp is where x > -0.9.
    file.doc["nodes"][0]["rotation"] = {0, std::sin(tilt / 2), 0, std::cos(tilt / 2)};
    json lamp = material(kBlack, 0, 1, {{"KHR_materials_specular", {{"specularFactor", 0.0}}}});
    lamp["emissiveFactor"] = {1, 1, 1};
    file.doc["extensionsUsed"].push_back("KHR_materials_specular");
    file.doc["materials"].push_back(lamp);
    json floor = file.doc["meshes"][0];
    floor["primitives"][0]["material"] = 1;
    file.doc["meshes"].push_back(floor);
    const double edge = -0.9;
    file.doc["nodes"].push_back({{"mesh", 1}, {"translation", {edge + 4, 0, -depth}}});
    file.doc["scenes"][0]["nodes"] = {0, 1, 3};
    file.doc["cameras"][0]["orthographic"]["xmag"] = half;
    file.doc["cameras"][0]["orthographic"]["ymag"] = half / 256;
    const RenderResult result = shown(file, Pipeline::Path, glm::vec3(0), {256, 1}, 1024);
    const ImageF& image = result.image;
    for (int c = 0; c < 3; ++c) {
        const auto at = [&](std::uint32_t x) {
            return double(image.data[x * image.channels.size() + std::size_t(c)]);
        };
        double sum = 0, lit = 0;
        for (std::uint32_t x = 0; x < 256; ++x) sum += at(x) / 256;
        for (std::uint32_t x = 224; x < 256; ++x) lit += at(x) / 32;
        ASSERT_GT(lit, 0.1);
        const double found = half - 2 * half * sum / lit;  // where along x the edge is seen
        // Snell with the extension's index: ior, and half of (ior - 1) / 20 * dispersion to either side.
        const double index = ior + (c - 1) * (ior - 1) * 0.025 * dispersion;
        const double bend = tilt - std::asin(std::sin(tilt) / index);
        // The view at x enters at height -x tan(tilt), goes down at `bend` from the vertical towards -x.
        const double seen = (edge + depth * std::tan(bend)) / (1 + std::tan(tilt) * std::tan(bend));
        const double angle = std::atan((found - edge) / (depth - found * std::tan(tilt)));
        EXPECT_NEAR(angle * 180 / kPi, bend * 180 / kPi, 0.1) << "channel " << c;
        EXPECT_NEAR(found, seen, 5e-3);
        fmt::print("dispersion channel {}: bent by {:.4f} degrees, Snell {:.4f}\n", c, angle * 180 / kPi,
                   bend * 180 / kPi);
    }
}

}  // namespace
}  // namespace helio::test
