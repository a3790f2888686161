#include "engine/core/shared.hpp"
#include "tests/support/struct_layout.hpp"

#include <gtest/gtest.h>
#include <heliograph_kernels/shader.hpp>

namespace helio {
namespace shared32 {
#include "tests/unit/shader/spot.glsl"
}
namespace test {
namespace {

using shared32::Spot;

struct SpotPush {
    glm::vec3 position;
    float power;
    glm::vec3 direction;
    std::uint32_t id;
};

TEST(SharedStruct, HasTheKernelsLayoutInAStorageBuffer) {
    EXPECT_EQ(layoutDifferences(HELIO_LAYOUT(Spot, position, power, direction, id, color, toWorld, falloff),
                                *reflect(shaders::spot_layout).binding("uSpots")),
              "");
}

TEST(SharedStruct, HasTheKernelsLayoutInPushConstants) {
    EXPECT_EQ(layoutDifferences(HELIO_LAYOUT(SpotPush, position, power, direction, id),
                                reflect(shaders::spot_layout).pushConstants),
              "");
}

/** What goes wrong in practice: a Vec3 after a scalar, which std430 moves to 16 bytes and C++ does not. */
TEST(SharedStruct, DifferencesAreNamed) {
    struct Moved {
        float power;
        glm::vec3 position;
        glm::vec3 direction;
        std::uint32_t identity;
        float more;
    };
    EXPECT_EQ(layoutDifferences(HELIO_LAYOUT(Moved, power, position, direction, identity, more),
                                reflect(shaders::spot_layout).pushConstants),
              "Moved: member 0 is 'power' in C++, 'position' in GLSL\n"
              "Moved: 'power' has 4 bytes in C++, 12 in GLSL (vec3)\n"
              "Moved: member 1 is 'position' in C++, 'power' in GLSL\n"
              "Moved: 'position' is at byte 4 in C++, 12 in GLSL\n"
              "Moved: 'position' has 12 bytes in C++, 4 in GLSL (float)\n"
              "Moved: member 3 is 'identity' in C++, 'id' in GLSL\n"
              "Moved: GLSL lacks 'more'\n"
              "Moved: has 36 bytes in C++, 32 in GLSL\n");
}

}  // namespace
}  // namespace test
}  // namespace helio
