#pragma once
/** @file
 * Calls GLSL functions on the device over arrays of inputs, and compares with a reference in double.
 *
 *     std::vector<float> x = floatsBetween(-1.0f, 1.0f, 1'000'000);
 *     std::vector<float> y = runOnDevice<float>("shaders/shared/math.glsl", "realAcos(a)", x);
 *     UlpReport report = compareOnDevice<float>("shaders/shared/math.glsl", "realAcos(a)",
 *                                               [](double a) { return std::acos(a); }, x);
 *     EXPECT_LE(report.worst, 2) << report;
 *
 * Inputs are called a, b, c, d in the expression; an expression with a `return` in it is a function's body.
 * Types are float, int, uint, their glm vectors, and mat2 to mat4 (bool: write uint(...)). Runs on
 * test::device(): a validation message fails the test.
 */
#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace helio::test {

/** A type's name in GLSL and its size in 32-bit words, column by column. */
struct DeviceType {
    const char* glsl;
    const char* scalar;  ///< "float", "int" or "uint"
    std::uint32_t words;
};
template <typename T>
constexpr DeviceType deviceType() {
    if constexpr (std::is_same_v<T, float>)
        return {"float", "float", 1};
    else if constexpr (std::is_same_v<T, glm::vec2>)
        return {"vec2", "float", 2};
    else if constexpr (std::is_same_v<T, glm::vec3>)
        return {"vec3", "float", 3};
    else if constexpr (std::is_same_v<T, glm::vec4>)
        return {"vec4", "float", 4};
    else if constexpr (std::is_same_v<T, glm::mat2>)
        return {"mat2", "float", 4};
    else if constexpr (std::is_same_v<T, glm::mat3>)
        return {"mat3", "float", 9};
    else if constexpr (std::is_same_v<T, glm::mat4>)
        return {"mat4", "float", 16};
    else if constexpr (std::is_same_v<T, std::int32_t>)
        return {"int", "int", 1};
    else if constexpr (std::is_same_v<T, glm::ivec2>)
        return {"ivec2", "int", 2};
    else if constexpr (std::is_same_v<T, glm::ivec3>)
        return {"ivec3", "int", 3};
    else if constexpr (std::is_same_v<T, glm::ivec4>)
        return {"ivec4", "int", 4};
    else if constexpr (std::is_same_v<T, std::uint32_t>)
        return {"uint", "uint", 1};
    else if constexpr (std::is_same_v<T, glm::uvec2>)
        return {"uvec2", "uint", 2};
    else if constexpr (std::is_same_v<T, glm::uvec3>)
        return {"uvec3", "uint", 3};
    else if constexpr (std::is_same_v<T, glm::uvec4>)
        return {"uvec4", "uint", 4};
    else
        static_assert(sizeof(T) == 0, "the harness has no such type");
}

/** What stands above the expression: paths to include, and directives (#define, #extension), in order. */
struct Preamble {
    Preamble(const char* line) : lines{line} {}
    Preamble(std::string line) : lines{std::move(line)} {}
    Preamble(std::initializer_list<std::string> list) : lines(list) {}
    std::vector<std::string> lines;
};

/** One input array as words. */
struct DeviceInput {
    DeviceType type;
    const void* data;
    std::size_t count;
};

/** Runs the expression over all inputs, which must have one length; `result` gets that many results. */
void runOnDeviceWords(const Preamble& preamble, const std::string& expression, const DeviceType& resultType,
                      const std::vector<DeviceInput>& inputs, void* result);

/** One result per input. Throws ShaderError where the expression does not compile. */
template <typename R, typename First, typename... Rest>
std::vector<R> runOnDevice(const Preamble& preamble, const std::string& expression,
                           const std::vector<First>& first, const std::vector<Rest>&... rest) {
    static_assert(sizeof...(Rest) < 4, "at most four inputs");
    std::vector<R> results(first.size());
    runOnDeviceWords(preamble, expression, deviceType<R>(),
                     {{deviceType<First>(), first.data(), first.size()},
                      {deviceType<Rest>(), rest.data(), rest.size()}...},
                     results.data());
    return results;
}

/** Where the device is farthest from the reference. Errors in units in the last place of the reference
 * rounded to float; a component that is NaN or infinite on one side only counts as infinitely far. */
struct UlpReport {
    double worst = 0;
    double mean = 0;        ///< over components, infinite ones left out
    std::size_t index = 0;  ///< of the worst
    std::size_t component = 0;
    double got = 0;
    double wanted = 0;
    std::size_t count = 0;  ///< results compared
    std::string input;      ///< the worst one's inputs, exact
};
std::ostream& operator<<(std::ostream& out, const UlpReport& report);

/** What an error is measured against. */
enum class UlpScale {
    Component,  ///< the component's own last place
    Largest     ///< that of the result's component of largest magnitude: for vectors that cancel
};

/** Compares `count` results of `components` floats with references. `describe` gives inputs. */
class UlpComparison {
public:
    UlpComparison(std::size_t components, UlpScale scale) : components_(components), scale_(scale) {}
    /** Returns whether this result is the worst so far. */
    bool add(const float* got, const double* wanted);
    UlpReport& report() { return report_; }
    void finish();

private:
    std::size_t components_;
    UlpScale scale_;
    UlpReport report_;
    double sum_ = 0;
    std::size_t finite_ = 0;
};

/** A value's exact decimal text and its bits. */
std::string describeWords(const DeviceType& type, const void* value);

template <typename T>
struct DoubleOf {
    using Type = T;  // integers stay
};
template <>
struct DoubleOf<float> {
    using Type = double;
};
template <glm::length_t N>
struct DoubleOf<glm::vec<N, float>> {
    using Type = glm::vec<N, double>;
};
template <glm::length_t C, glm::length_t R>
struct DoubleOf<glm::mat<C, R, float>> {
    using Type = glm::mat<C, R, double>;
};

/** Runs the expression on the device and `reference`, which takes the same inputs widened to double (integers
 * stay as they are) and gives the result in double, on the host. */
template <typename R, typename Reference, typename First, typename... Rest>
UlpReport compareOnDevice(const Preamble& preamble, const std::string& expression, const Reference& reference,
                          UlpScale scale, const std::vector<First>& first, const std::vector<Rest>&... rest) {
    const std::vector<R> got = runOnDevice<R>(preamble, expression, first, rest...);
    using Wanted = typename DoubleOf<R>::Type;
    constexpr std::size_t components = deviceType<R>().words;
    static_assert(sizeof(Wanted) == components * sizeof(double), "results to compare are of floats");
    UlpComparison comparison(components, scale);
    for (std::size_t i = 0; i < got.size(); ++i) {
        const Wanted wanted(
            reference(typename DoubleOf<First>::Type(first[i]), typename DoubleOf<Rest>::Type(rest[i])...));
        std::array<float, components> values;
        std::array<double, components> references;
        std::memcpy(values.data(), &got[i], sizeof(values));
        std::memcpy(references.data(), &wanted, sizeof(references));
        if (!comparison.add(values.data(), references.data())) continue;
        comparison.report().index = i;
        comparison.report().input = "a = " + describeWords(deviceType<First>(), &first[i]);
        char name = 'a';
        (void)name;
        ((comparison.report().input +=
          std::string(", ") + ++name + " = " + describeWords(deviceType<Rest>(), &rest[i])),
         ...);
    }
    comparison.finish();
    return comparison.report();
}
template <typename R, typename Reference, typename First, typename... Rest>
UlpReport compareOnDevice(const Preamble& preamble, const std::string& expression, const Reference& reference,
                          const std::vector<First>& first, const std::vector<Rest>&... rest) {
    return compareOnDevice<R>(preamble, expression, reference, UlpScale::Component, first, rest...);
}

/** `count` floats from `low` to `high`, both among them, evenly spaced in the order of their bits: every
 * binade of the range gets its share, zeros and subnormals too. */
std::vector<float> floatsBetween(float low, float high, std::size_t count);
/** `count` floats from `low` to `high`, both among them, evenly spaced by value. */
std::vector<float> floatsSpaced(float low, float high, std::size_t count);
/** Zeros, subnormals, neighbours of 1, 1e-30, 1e30, largest, infinities and a NaN, of both signs. */
std::vector<float> specialFloats();

}  // namespace helio::test
