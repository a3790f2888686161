/** @file
 * The Cornell box as measured by the Cornell University Program of Computer Graphics (Goral et al. 1984; data
 * of 1985 to 2005): a real room of about 55 cm, in millimetres, seen by a camera outside its open front.
 *
 * Colours. The measured spectra (76 reflectances from 400 to 700 nm; the light's radiance 0, 8, 15.6, 18.4 at
 * 400, 500, 600, 700 nm, linear between) are integrated at 1 nm against the CIE 1931 2 degree observer,
 * divided by the observer's ybar sum 106.856917, and taken to linear Rec.709. A reflectance's RGB is the
 * light reflected once over the light itself, channel by channel: what the light shows after one bounce is
 * then the spectral answer exactly. The light keeps the data's own scale, which gives it a luminance of 12.4.
 */
#include "engine/scene/samples/sample.hpp"

#include <array>
#include <cmath>

namespace helio::samples::cornell {
namespace {

using Quad = std::array<glm::vec3, 4>;

Primitive quads(const std::vector<Quad>& faces, int material) {
    Primitive primitive;
    primitive.material = material;
    for (const Quad& face : faces) {
        const auto first = std::uint32_t(primitive.positions.size());
        primitive.positions.insert(primitive.positions.end(), face.begin(), face.end());
        for (std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) primitive.indices.push_back(first + corner);
    }
    return primitive;
}

int addDiffuse(Scene& scene, const char* name, glm::vec3 reflectance) {
    Material material;
    material.name = name;
    material.baseColor = glm::vec4(reflectance, 1.0f);
    material.metallic = 0;
    material.specular = 0;
    scene.materials.push_back(material);
    return int(scene.materials.size()) - 1;
}

void addObject(Scene& scene, const char* name, int material, const std::vector<Quad>& faces) {
    scene.meshes.push_back({name, {quads(faces, material)}});
    Node node;
    node.name = name;
    node.mesh = int(scene.meshes.size()) - 1;
    scene.nodes.push_back(node);
    scene.roots.push_back(int(scene.nodes.size()) - 1);
}

Scene makeCornell() {
    Scene scene;
    const int white = addDiffuse(scene, "white", {0.7386209f, 0.7354082f, 0.7506001f});
    const int green = addDiffuse(scene, "green", {0.1185431f, 0.3829416f, 0.0236929f});
    const int red = addDiffuse(scene, "red", {0.4506721f, 0.0359978f, 0.0115972f});
    const int light = addDiffuse(scene, "light", glm::vec3(0.78f));
    scene.materials[std::size_t(light)].emission = {20.7201452f, 10.8542970f, 2.7700841f};

    // Corners run counter-clockwise seen from the room, and from outside for the blocks. Blocks have no
    // bottom.
    addObject(scene, "floor", white, {{{{552.8f, 0, 0}, {0, 0, 0}, {0, 0, 559.2f}, {549.6f, 0, 559.2f}}}});
    // The light lies in a hole of the ceiling: overlapping them would leave the first hit to chance. The
    // frame around the hole shares its corners with both, so that nothing leaks.
    const Quad outer{{{556, 548.8f, 0}, {556, 548.8f, 559.2f}, {0, 548.8f, 559.2f}, {0, 548.8f, 0}}};
    const Quad hole{{{343, 548.8f, 227}, {343, 548.8f, 332}, {213, 548.8f, 332}, {213, 548.8f, 227}}};
    std::vector<Quad> frame;
    for (std::size_t i = 0; i < 4; ++i) {
        frame.push_back({outer[i], outer[(i + 1) % 4], hole[(i + 1) % 4], hole[i]});
    }
    addObject(scene, "ceiling", white, frame);
    addObject(scene, "back wall", white,
              {{{{549.6f, 0, 559.2f}, {0, 0, 559.2f}, {0, 548.8f, 559.2f}, {556, 548.8f, 559.2f}}}});
    addObject(scene, "right wall", green,
              {{{{0, 0, 559.2f}, {0, 0, 0}, {0, 548.8f, 0}, {0, 548.8f, 559.2f}}}});
    addObject(scene, "left wall", red,
              {{{{552.8f, 0, 0}, {549.6f, 0, 559.2f}, {556, 548.8f, 559.2f}, {556, 548.8f, 0}}}});
    addObject(scene, "light", light, {hole});
    addObject(scene, "short block", white,
              {{{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
               {{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
               {{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
               {{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
               {{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}}});
    addObject(scene, "tall block", white,
              {{{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
               {{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
               {{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
               {{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
               {{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}}});

    // Published: at (278, 273, -800) looking along +Z, focal length 0.035 with a film of 0.025 by 0.025.
    Camera camera;
    camera.name = "camera";
    camera.yfov = 2 * std::atan(0.0125f / 0.035f);
    camera.znear = 1;
    scene.cameras.push_back(camera);
    Node eye;
    eye.name = "camera";
    eye.camera = 0;
    eye.translation = {278, 273, -800};
    eye.rotation = {0, 0, 1, 0};  // half a turn about Y: the camera's -Z becomes +Z
    scene.nodes.push_back(eye);
    scene.roots.push_back(int(scene.nodes.size()) - 1);
    return scene;
}

const RegisterSample registered{"cornell", makeCornell};

}  // namespace
}  // namespace helio::samples::cornell
