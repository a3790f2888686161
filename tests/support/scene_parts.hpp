#pragma once
/** @file Pieces that scenes of tests are put together from. */
#include "tests/accuracy/path_scenes.hpp"

#include <cstdint>
#include <vector>

namespace helio::test {

/** An upright box of square base; `at` is its near left corner. */
inline void block(SceneBuilder& builder, glm::vec3 at, float side, float height, int material) {
    const glm::vec3 a = at, b = at + glm::vec3(side, 0, 0), c = at + glm::vec3(side, 0, -side),
                    d = at + glm::vec3(0, 0, -side), up(0, height, 0);
    builder.quad(a, b, b + up, a + up, material);
    builder.quad(b, c, c + up, b + up, material);
    builder.quad(c, d, d + up, c + up, material);
    builder.quad(d, a, a + up, d + up, material);
    builder.quad(a + up, b + up, c + up, d + up, material);
}

/** A horizontal square about `centre`. */
inline void floorUnder(SceneBuilder& builder, float half, int material, glm::vec3 centre = {0, 0, 0}) {
    builder.quad(centre + glm::vec3(-half, 0, half), centre + glm::vec3(half, 0, half),
                 centre + glm::vec3(half, 0, -half), centre + glm::vec3(-half, 0, -half), material);
}

/** An image of values over [0, 1)^2, stored as floats. */
template <typename Value>
int addImage(Scene& scene, std::uint32_t width, std::uint32_t height, Value value) {
    std::vector<float> texels;
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const glm::vec3 c = value((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height));
            texels.insert(texels.end(), {c.x, c.y, c.z, 1});
        }
    }
    scene.images.push_back({"", width, height, std::move(texels)});
    return int(scene.images.size()) - 1;
}

}  // namespace helio::test
