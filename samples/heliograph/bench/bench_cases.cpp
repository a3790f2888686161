#include "bench_cases.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace helio::cli {
namespace {

/** 1, 2, 4, ... up to `most`. */
std::vector<std::uint32_t> doubling(std::uint32_t most, std::uint32_t first = 1) {
    std::vector<std::uint32_t> samples;
    for (std::uint32_t n = first; n <= most; n *= 2) samples.push_back(n);
    return samples;
}

struct Sampler {
    const char* name;
    SamplerKind kind;
};
constexpr Sampler kSamplers[] = {{"sobol", SamplerKind::Sobol},
                                 {"independent", SamplerKind::Independent},
                                 {"halton", SamplerKind::Halton},
                                 {"stratified", SamplerKind::Stratified},
                                 {"sobol-blue", SamplerKind::SobolBlue}};

class CaseList {
public:
    explicit CaseList(bool quick) : most_(quick ? 64 : 256), quick_(quick) {}

    BenchCase& add(const char* group, const char* scene, const char* method) {
        BenchCase added;
        added.group = group;
        added.scene = scene;
        added.method = method;
        added.samples = doubling(most_);
        cases_.push_back(std::move(added));
        return cases_.back();
    }
    /** The default method, which the others of a scene are compared with. */
    void plain(const char* scene) { add("samplers", scene, "sobol"); }

    void samplers(const char* scene) {
        for (const Sampler& sampler : kSamplers) {
            BenchCase& added = add("samplers", scene, sampler.name);
            added.options.sampler = sampler.kind;
            // Of scenes with a closed form, where no sample is worth much more than others.
            if (std::string(scene) == "cornell") continue;
            // Independent samples: variance over n. Numbers stratified in pairs: where light arrives over an
            // edge n^-3/2, where it is smooth less, and n^-1 for pairs that act on each other by their
            // product alone. On the irradiance scene little does.
            const bool isPaired = sampler.kind != SamplerKind::Halton && std::string(scene) == "irradiance";
            added.order = isPaired ? BenchCase::Order{-3, -1.2} : BenchCase::Order{-3, -0.95};
            if (sampler.kind == SamplerKind::Independent) added.order = {-1.05, -0.95};
        }
    }
    void errors(const char* scene) {
        add("errors", scene, "adaptive").options.adaptive = true;
        BenchCase& denoised = add("errors", scene, "denoised");
        denoised.options.denoise = true;
        denoised.denoised = denoised.biased = true;
        denoised.samples.erase(denoised.samples.begin());  // two halves take two samples
    }
    void integrator(const char* scene, const char* method, Integrator integrator) {
        BenchCase& added = add("integrators", scene, method);
        added.options.integrator = integrator;
        added.biased = true;
    }
    void lights(const char* scene) {
        add("lights", scene, "power").options.lights = LightChoice::Power;
        add("lights", scene, "uniform").options.lights = LightChoice::Uniform;
    }
    void accelerator(const char* scene, const char* method, AcceleratorKind kind) {
        BenchCase& added = add("accelerators", scene, method);
        added.options.accelerator = kind;
        added.options.maxDepth = 1;
        added.samples = doubling(quick_ ? 16 : 64);
    }
    BenchCase& raster(const char* group, const char* scene, const char* method, const char* pattern,
                      std::vector<std::uint32_t> samples) {
        BenchCase& added = add(group, scene, method);
        added.options.pipeline = Pipeline::Raster;
        added.pattern = pattern;
        added.samples = std::move(samples);
        return added;
    }
    void antialiasing(const char* scene) {
        const std::uint32_t most = quick_ ? 16 : 64;
        raster("antialiasing", scene, "ssaa", "ssaa{}", doubling(most));
        raster("antialiasing", scene, "msaa", "msaa{}", {2, 4, 8, 16});
        raster("antialiasing", scene, "fxaa", "fxaa", {1});
        const std::vector<std::uint32_t> squares =
            quick_ ? std::vector<std::uint32_t>{1, 4, 16} : std::vector<std::uint32_t>{1, 4, 16, 64};
        raster("antialiasing", scene, "grid", "grid{}", squares).squared = true;
        raster("antialiasing", scene, "jitter", "jitter{}", squares).squared = true;
        raster("antialiasing", scene, "random", "random{}", doubling(most));
    }
    void filter(const char* scene, const char* method, TextureFilter filter) {
        raster("filters", scene, method, "ssaa{}", doubling(quick_ ? 4 : 16)).options.textureFilter = filter;
    }
    void mips(const char* scene) {
        BenchCase& added = add("mips", scene, "passes/mip");
        added.unit = "texels a side";
        added.samples = doubling(quick_ ? 1024 : 4096, 64);
        added.samples.push_back(quick_ ? 1023 : 4095);  // odd at every level
    }
    void traversal(const char* rays, const char* question) {
        BenchCase& added = add("traversal", rays, question);
        added.unit = "triangles";
        added.samples = doubling(quick_ ? 1u << 16 : 1u << 20, 1u << 10);
    }
    std::vector<BenchCase> take() { return std::move(cases_); }

private:
    std::uint32_t most_;
    bool quick_;
    std::vector<BenchCase> cases_;
};

}  // namespace

RenderOptions BenchCase::with(std::uint32_t count, std::uint32_t seed) const {
    RenderOptions result = options;
    result.samples = count;
    result.seed = seed;
    if (pattern.empty() || (pattern == "ssaa{}" && count == 1)) return result;
    std::uint32_t number = count;
    for (std::uint32_t side = 1; squared && side * side <= count; ++side) number = side;
    result.antialiasing = antialiasing(fmt::format(fmt::runtime(pattern), number), seed);
    return result;
}

std::string BenchCase::truth() const {
    if (group == "filters") return scene + ".texture";
    if (options.pipeline == Pipeline::Raster) return scene + ".raster";
    return options.maxDepth >= 0 ? fmt::format("{}.depth{}", scene, options.maxDepth) : scene;
}

BenchSettings benchSettings(bool quick) {
    if (quick) return {true, {48, 48}, 2, 1024, 12, 1u << 14};
    return {false, {96, 96}, 3, 4096, 32, 1u << 18};
}

std::vector<BenchCase> benchCases(bool quick) {
    CaseList list(quick);
    list.samplers("furnace");
    list.samplers("irradiance");
    list.samplers("cornell");
    list.add("lights", "cornell", "no-nee").options.nextEventEstimation = false;
    list.errors("cornell");
    list.plain("plates");
    list.errors("plates");
    list.plain("glass");
    list.errors("glass");
    list.integrator("glass", "whitted", Integrator::Whitted);
    list.integrator("glass", "direct", Integrator::Direct);
    list.plain("lights500");
    list.lights("lights500");
    list.errors("lights500");
    list.accelerator("plates", "bvh", AcceleratorKind::Bvh);
    list.accelerator("plates", "grid", AcceleratorKind::Grid);
    list.accelerator("plates", "octree", AcceleratorKind::Octree);
    list.accelerator("plates", "kd-tree", AcceleratorKind::KdTree);
    list.accelerator("plates", "bsp", AcceleratorKind::Bsp);
    list.accelerator("plates", "brute-force", AcceleratorKind::BruteForce);
    list.antialiasing("terrain");
    list.filter("terrain", "nearest", TextureFilter::Nearest);
    list.filter("terrain", "bilinear", TextureFilter::Bilinear);
    list.filter("terrain", "bicubic", TextureFilter::CatmullRom);
    list.filter("terrain", "bspline", TextureFilter::BSpline);
    list.filter("terrain", "trilinear", TextureFilter::Trilinear);
    list.filter("terrain", "anisotropic", TextureFilter::Anisotropic);
    list.filter("terrain", "ewa", TextureFilter::Ewa);
    for (const char* scene : {"bytes", "floats"}) list.mips(scene);
    for (const char* rays : {"coherent", "scattered"})
        for (const char* question : {"closest", "any"}) list.traversal(rays, question);
    return list.take();
}

std::vector<BenchCase> chosenCases(const std::vector<BenchCase>& cases,
                                   const std::vector<std::string>& names) {
    std::vector<BenchCase> chosen;
    std::set<std::string> known, used;
    for (const BenchCase& each : cases) {
        const std::string keys[] = {each.group, each.scene, each.method, each.scene + "/" + each.method};
        known.insert(std::begin(keys), std::end(keys) - 1);
        bool wanted = names.empty();
        for (const std::string& name : names) {
            if (std::ranges::find(keys, name) == std::end(keys)) continue;
            wanted = true;
            used.insert(name);
        }
        if (wanted) chosen.push_back(each);
    }
    for (const std::string& name : names) {
        if (used.contains(name)) continue;
        throw InputError(
            name, "", "is nothing that is measured",
            fmt::format("name a group, scene, method or SCENE/METHOD of {}", fmt::join(known, ", ")));
    }
    return chosen;
}

}  // namespace helio::cli
