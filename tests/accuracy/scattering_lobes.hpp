#pragma once
/** @file
 * The scattering models as the tests run them on the device: GLSL for value and sample, and the parameters to
 * run them with, extremes included. Parameters are a mat4 `p`; see each lobe's macros for what its columns
 * hold.
 */
#include "passes/scene/facet_losses.hpp"
#include "tests/support/shader_harness.hpp"

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace helio::test {

struct LobeCase {
    std::string name;
    glm::mat4 p{0.0f};
};

struct Lobe {
    std::string name;
    std::vector<std::string> preamble;  ///< includes, and VALUE(p, wo, wi) and SAMPLE(p, wo, u)
    std::vector<LobeCase> cases;
    bool reciprocal = true;   ///< f(wo, wi) = f(wi, wo); across an interface with the squares of the indices
    bool conserves = true;    ///< albedo at most 1
    bool below = false;       ///< light goes through
    std::string eta = "1.0";  ///< index ratio of the case for what goes through
    Preamble lines() const {
        Preamble result({});
        result.lines = preamble;
        return result;
    }
};

/** Cosines of wo from straight above to grazing. */
inline const std::vector<float> kCosines = {1.0f, 0.8f, 0.5f, 0.2f, 0.05f, 1e-3f};

/** A direction with a given cosine at a given azimuth (radians). */
glm::vec3 directionAt(float cosine, float azimuth);

/** Facets with what they lose made up for: an interface to the index n, or for n = 0 a metal that reflects
 * all. */
Lobe compensatedFacets(const std::string& name, float n, float alpha, bool beckmann);

const std::vector<Lobe>& lobes();
const Lobe& lobe(const std::string& name);

}  // namespace helio::test
