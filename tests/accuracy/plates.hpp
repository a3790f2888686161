#pragma once
/** @file Plates of materials side by side, which do not see each other. */
#include "tests/accuracy/path_render.hpp"
#include "tests/accuracy/path_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace helio::test {

inline constexpr std::uint32_t kPlate = 8;  ///< pixels across

/** A row of unit plates at z = 0 that face +z, and a parallel view of them at an angle. */
struct Plates {
    SceneBuilder b;
    std::vector<std::string> names;

    /** A plate of this material at the next place; uvs as a picture has them, v down. */
    int add(const std::string& name, const Material& material) {
        b.scene.materials.push_back(material);
        const float x = float(names.size());
        const int instance = b.quad({x, -20, 0}, {x + 1, -20, 0}, {x + 1, 20, 0}, {x, 20, 0},
                                    int(b.scene.materials.size()) - 1);
        Primitive& primitive = b.scene.meshes[std::size_t(instance)].primitives[0];
        primitive.texcoords = {{{0, 1}, {1, 1}, {1, 0}, {0, 1}, {1, 0}, {0, 0}}};
        names.push_back(name);
        return instance;
    }
    void view(double degrees) {
        const double angle = degrees * std::numbers::pi / 180, middle = 0.5L * double(names.size());
        Camera camera;
        camera.perspective = false;
        camera.ymag = 0.5f;
        b.scene.cameras = {camera};
        const glm::vec3 back(0, -std::sin(angle), std::cos(angle)), up(0, std::cos(angle), std::sin(angle));
        Node eye;
        eye.camera = 0;
        eye.matrix = glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(up, 0), glm::vec4(back, 0),
                               glm::vec4(glm::vec3(middle, 0, 0) + 20.0f * back, 1));
        b.scene.nodes.push_back(eye);
        b.scene.roots.push_back(int(b.scene.nodes.size()) - 1);
    }
    Traced render(std::uint32_t samples, bool nextEvent = true,
                  NormalMapping mapping = NormalMapping::Folded) const {
        PathTraceOptions options;
        options.size = {kPlate * std::uint32_t(names.size()), kPlate};
        options.sampler = SamplerKind::Independent;
        options.nextEventEstimation = nextEvent;
        options.normalMapping = mapping;
        return trace(b.scene, options, samples);
    }
};

/** One plate of a picture, its rim left out. */
inline Estimate plate(const Traced& image, std::size_t index, int channel = 0) {
    return estimate(image, channel, [&](std::size_t i) {
        const std::size_t x = i % image.width, y = i / image.width;
        return x / kPlate == index && x % kPlate != 0 && x % kPlate != kPlate - 1 && y != 0 &&
               y != kPlate - 1;
    });
}

inline void expectMean(const Estimate& e, double truth, double within, const std::string& what) {
    EXPECT_LT(std::abs(e.mean - truth), 4 * e.error + 1e-5L)
        << what << ": " << e.mean << " +- " << e.error << ", not " << truth;
    EXPECT_LT(e.error, within) << what << ": too noisy to tell";
}

inline Material gltf(glm::vec3 color, float metallic, float roughness) {
    Material m;
    m.baseColor = glm::vec4(color, 1);
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}
inline Material model(Scattering::Model kind) {
    Material m;
    m.scattering = Scattering{};
    m.scattering->model = kind;
    return m;
}

}  // namespace helio::test
