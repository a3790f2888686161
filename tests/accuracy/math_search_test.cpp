// Functions of several numbers, float build against double build of the same source, at inputs that a search
// finds: it climbs from random and special points to where rounding is worst. The device gives the float
// build's bits (accuracy_device_math, gpu_shader_harness). Functions of one number are tried at every float:
// math_elementary_test.cpp.
//
// HELIOGRAPH_SEARCH_SECONDS=60 searches so many seconds a function, from other points each time, and prints a
// table.
#include "tests/accuracy/math_functions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>

namespace helio::test {
namespace {

constexpr int kMostInputs = 9, kMostOutputs = 9;

/** An input's range; `even`: drawn evenly over it, else over its floats, so that every binade counts alike.
 */
struct Range {
    float low, high;
    bool even = false;
};

struct Searched {
    const char* name;
    std::vector<Range> inputs;
    int outputs;
    double bound;  ///< ULP of the largest output
    std::function<void(const float*, double*)> single;
    std::function<void(const double*, double*)> exact;
    std::vector<int> directions = {};  ///< first inputs of triples that are made unit
    /** Errors of smaller outputs count in ULP of this: 1 for shares of light, whose last digits cancel where
     * an interface hardly reflects. */
    double least = 0;
};

template <typename Vector>
void store(double* out, const Vector& v) {
    for (int i = 0; i < v.length(); ++i) out[i] = double(v[i]);
}
template <typename Matrix>
void storeMatrix(double* out, const Matrix& m) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) out[3 * column + row] = double(m[column][row]);
}

// The same text in both precisions; `x` holds the inputs, `out` takes the outputs.
#define HELIO_BOTH(...)                    \
    [](const float* x, double* out) {      \
        using namespace shared32;          \
        __VA_ARGS__;                       \
    },                                     \
        [](const double* x, double* out) { \
            using namespace shared64;      \
            __VA_ARGS__;                   \
        }

/** Bounds are what searches of 2 to 8 seconds found, and some more. Large ones are of what is ill-conditioned in
 * the inputs: powers and exponentials of narrow lobes, and facets seen along the horizon. */
const std::vector<Searched>& searched() {
    constexpr Range any{-1e18f, 1e18f}, unit{-1, 1}, share{0, 1}, evenShare{0, 0.99999994f, true},
        index{1.01f, 4, true};
    constexpr Range positive{1e-18f, 1e18f}, angle{-7, 7, true}, alpha{1e-3f, 1};
    static const std::vector<Searched> table = {
        {"lengthSafe",
         {any, any, any},
         1,
         2,
         HELIO_BOTH(out[0] = double(lengthSafe(Vec3(x[0], x[1], x[2]))))},
        {"hypot", {any, any}, 1, 2, HELIO_BOTH(out[0] = double(hypot(x[0], x[1])))},
        {"normalizeSafe",
         {any, any, any},
         3,
         4,
         HELIO_BOTH(store(out, normalizeSafe(Vec3(x[0], x[1], x[2]), Vec3(Real(0)))))},
        {"angleBetween",
         {any, any, any, any, any, any},
         1,
         5,
         HELIO_BOTH(out[0] = double(angleBetween(Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])))),
         {},
         1},
        {"cross2",
         {any, any, any, any},
         1,
         2,
         HELIO_BOTH(out[0] = double(cross2(Vec2(x[0], x[1]), Vec2(x[2], x[3]))))},
        {"sumOfProducts",
         {any, any, any, any},
         1,
         2,
         HELIO_BOTH(out[0] = double(sumOfProducts(x[0], x[1], x[2], x[3])))},
        {"crossAccurate",
         {any, any, any, any, any, any},
         3,
         2,
         HELIO_BOTH(store(out, crossAccurate(Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5]))))},
        {"orthonormalBasis",
         {unit, unit, unit},
         3,
         4,
         HELIO_BOTH(Vec3 t; Vec3 b; orthonormalBasis(Vec3(x[0], x[1], x[2]), t, b); store(out, t)),
         {0}},
        {"realPow", {{1e-38f, 3e38f}, {-100, 100}}, 1, 1.2, HELIO_BOTH(out[0] = double(realPow(x[0], x[1])))},
        {"realAtan2", {any, any}, 1, 1.7, HELIO_BOTH(out[0] = double(realAtan2(x[0], x[1])))},
        {"rotationAbout",
         {any, any, any, angle},
         9,
         8,
         HELIO_BOTH(storeMatrix(out, rotationAbout(Vec3(x[0], x[1], x[2]), x[3])))},
        {"quaternionToMatrix",
         {unit, unit, unit, unit},
         9,
         6,
         HELIO_BOTH(storeMatrix(out, quaternionToMatrix(quaternionNormalize(Vec4(x[0], x[1], x[2], x[3])))))},
        {"quaternionRotate",
         {any, any, any, angle, unit, unit, unit},
         3,
         16,
         HELIO_BOTH(store(
             out, quaternionRotate(quaternionAbout(Vec3(x[0], x[1], x[2]), x[3]), Vec3(x[4], x[5], x[6])))),
         {4}},
        {"luminance",
         {positive, positive, positive},
         1,
         3,
         HELIO_BOTH(out[0] = double(luminance(Vec3(x[0], x[1], x[2]))))},
        {"filmicCurve", {{0, 1e4f}}, 1, 6, HELIO_BOTH(out[0] = double(filmicCurve(x[0])))},
        {"perspective",
         {{0.01f, 3, true}, {0.1f, 10}, positive},
         9,
         6,
         HELIO_BOTH(storeMatrix(out, perspective(x[0], x[1], x[2])))},
        {"fresnelDielectric",
         {share, index},
         1,
         20,
         HELIO_BOTH(out[0] = double(fresnelDielectric(x[0], x[1])))},
        {"fresnelConductor",
         {share, {0.05f, 5, true}, {0.05f, 10, true}},
         1,
         5,
         HELIO_BOTH(out[0] = double(fresnelConductor(x[0], x[1], x[2]))),
         {},
         1},
        {"fresnelTransmittance",
         {share, share, index},
         1,
         9,
         HELIO_BOTH(out[0] = double(fresnelTransmittance(x[0], x[1], x[2])))},
        {"schlickWeight", {evenShare}, 1, 8, HELIO_BOTH(out[0] = double(schlickWeight(x[0])))},
        {"ggxNormals",
         {unit, unit, share, alpha, alpha},
         1,
         20,
         HELIO_BOTH(out[0] = double(ggxNormals(Vec3(x[0], x[1], x[2]), Vec2(x[3], x[4])))),
         {0}},
        {"ggxShadowing",
         {unit, unit, share, unit, unit, share, alpha, alpha},
         1,
         8,
         HELIO_BOTH(
             out[0] = double(ggxShadowing(Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5]), Vec2(x[6], x[7])))),
         {0, 3}},
        {"ggxReflectedDensity",
         {unit, unit, share, unit, unit, share, alpha, alpha},
         1,
         24,
         HELIO_BOTH(out[0] = double(ggxReflectedDensity(Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5]),
                                                        Vec2(x[6], x[7])))),
         {0, 3}},
        {"beckmannShadowing",
         {unit, unit, share, unit, unit, share, alpha, alpha},
         1,
         12,
         HELIO_BOTH(out[0] = double(
                        beckmannShadowing(Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5]), Vec2(x[6], x[7])))),
         {0, 3}},
        {"orenNayarValue",
         {unit, unit, share, unit, unit, share, share},
         1,
         2,
         HELIO_BOTH(out[0] = double(
                        orenNayarValue(Vec3(Real(1)), x[6], Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5]))
                            .value.x)),
         {0, 3},
         1},
        {"sheenValue",
         {unit, unit, share, unit, unit, share, share},
         1,
         1200,
         HELIO_BOTH(out[0] =
                        double(sheenValue(x[6], Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])).value.x)),
         {0, 3},
         1},
        {"thinFilmReflectance",
         {{1, 1},
          {1.1f, 1.3f, true},
          share,
          {1, 1000, true},
          {0.05f, 1, true},
          {0.05f, 1, true},
          {0.05f, 1, true}},
         3,
         120,
         HELIO_BOTH(store(out, thinFilmReflectance(x[0], x[1], x[2], x[3], Vec3(x[4], x[5], x[6])))),
         {},
         1},
        {"beckmannNormals",
         {unit, unit, share, alpha, alpha},
         1,
         800,
         HELIO_BOTH(out[0] = double(beckmannNormals(Vec3(x[0], x[1], x[2]), Vec2(x[3], x[4])))),
         {0}},
        {"phongValue",
         {unit, unit, share, unit, unit, share, {1, 1000, true}},
         1,
         3000,
         HELIO_BOTH(
             out[0] = double(
                 phongValue(Vec3(Real(1)), x[6], Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])).value.x)),
         {0, 3},
         1},
        {"toneCurve (ACES)",
         {{0, 100}, {0, 100}, {0, 100}},
         3,
         8,
         HELIO_BOTH(store(out, toneCurve(TONE_ACES, Vec3(x[0], x[1], x[2])))),
         {},
         1},
        {"encodeSrgb", {share}, 1, 2, HELIO_BOTH(out[0] = double(encodeSrgb(x[0]))), {}, 1},
        {"blinnPhongNorm", {{0, 1e6f}}, 1, 8, HELIO_BOTH(out[0] = double(blinnPhongNorm(x[0])))},
        {"imageDistance",
         {{1e-3f, 1}, {2, 1e6f}},
         1,
         3,
         HELIO_BOTH(out[0] = double(imageDistance(x[0], x[1])))},
        {"hyperfocalDistance",
         {{1e-3f, 1}, {1, 64}, {1e-6f, 1e-3f}},
         1,
         4,
         HELIO_BOTH(out[0] = double(hyperfocalDistance(x[0], x[1], x[2])))},
        {"exposureValue100",
         {{1, 64}, {1e-4f, 0.4f}, {50, 100}},
         1,
         4,
         HELIO_BOTH(out[0] = double(exposureValue100(x[0], x[1], x[2])))},
        {"ggxSampleNormal",
         {unit, unit, share, alpha, alpha, evenShare, {0, 0.9f, true}},
         3,
         30000,
         HELIO_BOTH(store(out, ggxSampleNormal(Vec3(x[0], x[1], x[2]), Vec2(x[3], x[4]), Vec2(x[5], x[6])))),
         {0}},
        {"cosineHemisphere",
         {evenShare, evenShare},
         3,
         4,
         HELIO_BOTH(store(out, cosineHemisphere(Vec2(x[0], x[1]))))},
    };
    return table;
}

using Input = std::array<float, kMostInputs>;

/** Error of the float build in ULP of the largest output; infinite where one build alone gives no number; -1
 * where the outputs are outside of what normal floats hold. */
double errorAt(const Searched& f, const Input& input) {
    std::array<double, kMostInputs> wide{};
    for (std::size_t i = 0; i < f.inputs.size(); ++i) wide[i] = double(input[i]);
    std::array<double, kMostOutputs> got{}, truth{};
    f.single(input.data(), got.data());
    f.exact(wide.data(), truth.data());
    double largest = 0, difference = 0;
    for (int i = 0; i < f.outputs; ++i) {
        const auto k = std::size_t(i);
        if (std::isnan(truth[k]) || std::isnan(got[k])) {
            if (std::isnan(truth[k]) == std::isnan(got[k])) return -1;
            return std::numeric_limits<double>::infinity();
        }
        largest = std::max(largest, std::fabs(truth[k]));
        difference = std::max(difference, std::fabs(got[k] - truth[k]));
    }
    // Far enough from the least normal float that nothing on the way to the result is lost below it.
    if (!(largest > 1e-30L && largest < 1e30L)) return -1;
    const float nearest = static_cast<float>(std::max(largest, f.least));
    return difference / (double(std::nextafterf(nearest, INFINITY)) - double(nearest));
}

class Search {
public:
    Search(const Searched& f, std::uint32_t seed) : f_(f), random_(seed) {}

    /** Climbs until `goesOn` says no, and starts anew where it is stuck. */
    void run(const std::function<bool()>& goesOn) {
        while (goesOn()) {
            Input here = start();
            double error = errorAt(f_, here);
            for (int stuck = 0; stuck < 200 && goesOn(); ++stuck) {
                const Input next = changed(here);
                const double found = errorAt(f_, next);
                if (!(found > error)) continue;
                here = next;
                error = found;
                stuck = 0;
            }
            if (error > worst_) worst_ = error, where_ = here;
        }
    }
    double worst() const { return worst_; }
    const Input& where() const { return where_; }

private:
    std::uint32_t below(std::uint32_t n) { return std::uint32_t(random_() % n); }

    float draw(const Range& range) {
        if (range.even) return std::uniform_real_distribution<float>(range.low, range.high)(random_);
        std::uniform_int_distribution<std::int64_t> keys(orderOf(range.low), orderOf(range.high));
        return floatOfOrder(keys(random_));
    }
    float special(const Range& range) {
        constexpr std::array<float, 10> values = {0.f,   -0.f,        1.f, -1.f,  0.5f,
                                                  -0.5f, 0.70710677f, 2.f, 1e-7f, 0.99999994f};
        const std::uint32_t k = below(std::uint32_t(values.size()) + 2);
        const float x = k < values.size() ? values[k] : k == values.size() ? range.low : range.high;
        return std::clamp(x, range.low, range.high);
    }
    Input start() {
        Input input{};
        const bool alike = below(3) == 0;  // of one magnitude: where sums cancel
        for (std::size_t i = 0; i < f_.inputs.size(); ++i) {
            input[i] = below(4) == 0 ? special(f_.inputs[i]) : draw(f_.inputs[i]);
            if (alike && i > 0) {
                const float near =
                    input[i - 1] * (1 + std::ldexp(1.f, -int(below(24)))) * (below(2) == 0 ? 1.f : -1.f);
                input[i] = std::clamp(near, f_.inputs[i].low, f_.inputs[i].high);
            }
        }
        return prepared(input);
    }
    Input changed(Input input) {
        const std::uint32_t i = below(std::uint32_t(f_.inputs.size()));
        const Range& range = f_.inputs[i];
        const std::uint32_t how = below(16);
        if (how == 0) {
            input[i] = special(range);
        } else if (how == 1) {
            input[i] = draw(range);
        } else if (how == 2) {
            input[i] = input[below(std::uint32_t(f_.inputs.size()))] * (below(2) == 0 ? 1.f : -1.f);
        } else {
            // So many floats up or down, of every magnitude.
            const std::int64_t far = std::int64_t(1) << below(26);
            const std::int64_t step = std::int64_t(random_() % std::uint64_t(2 * far + 1)) - far;
            input[i] = floatOfOrder(orderOf(input[i]) + step);
        }
        input[i] = std::clamp(input[i], range.low, range.high);
        return prepared(input);
    }
    /** Triples that are directions made unit; what is so small that its square is no normal float 0. */
    Input prepared(Input input) const {
        for (const int at : f_.directions) {
            float* v = input.data() + at;
            const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            if (length > 1e-15f) {
                for (int k = 0; k < 3; ++k) v[k] /= length;
            } else {
                v[0] = v[1] = 0, v[2] = 1;
            }
        }
        for (float& x : input)
            if (std::fabs(x) < 1e-18f) x = 0;
        return input;
    }

    const Searched& f_;
    std::mt19937_64 random_;
    double worst_ = 0;
    Input where_{};
};

TEST(MathSearch, NoInputIsWorseThanTheBound) {
    const char* seconds = std::getenv("HELIOGRAPH_SEARCH_SECONDS");
    const std::chrono::duration<double> limit(seconds ? std::atof(seconds) : 0.L);
    const std::uint32_t seed = seconds ? std::random_device()() : 1;
    std::printf("| function | worst, ULP | bound | at |\n|---|---|---|---|\n");
    for (const Searched& f : searched()) {
        Search search(f, seed);
        int left = 30'000;
        const auto begin = std::chrono::steady_clock::now();
        search.run([&] { return seconds ? std::chrono::steady_clock::now() - begin < limit : left-- > 0; });
        std::string at;
        for (std::size_t i = 0; i < f.inputs.size(); ++i) {
            std::array<char, 32> text{};
            std::snprintf(text.data(), text.size(), "%s%.9g", i ? ", " : "", double(search.where()[i]));
            at += text.data();
        }
        std::printf("| %s | %.2f | %.1f | %s |\n", f.name, search.worst(), f.bound, at.c_str());
        EXPECT_GT(search.worst(), 0) << f.name << ": nothing was tried";
        EXPECT_LE(search.worst(), f.bound) << f.name << " at " << at;
    }
}

}  // namespace
}  // namespace helio::test
