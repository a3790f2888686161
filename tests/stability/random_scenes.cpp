#include "tests/stability/random_scenes.hpp"

#include "tests/accuracy/path_scenes.hpp"

#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/quaternion.hpp>

#include <cmath>
#include <random>

namespace helio::test {
namespace {

class Author {
public:
    explicit Author(std::uint64_t number) : random_(number) {}

    Scene write() {
        scene_.name = "random";
        const int materials = 1 + pick(5);
        for (int i = 0; i < materials; ++i) scene_.materials.push_back(material());
        scale_ = std::pow(10.0, double(pick(13) - 6));
        if (pick(3) == 0) offset_ = double(scale_) * std::pow(10.0, uniform() * 4) * direction();
        const int meshes = 1 + pick(5);
        for (int i = 0; i < meshes; ++i) mesh();
        const int lights = pick(3) == 0 ? pick(9) : pick(2);
        for (int i = 0; i < lights; ++i) light();
        if (pick(3) == 0) surroundings();
        camera();
        return std::move(scene_);
    }

private:
    int pick(int count) { return int(random_() % std::uint64_t(count)); }
    double uniform() { return double(random_() >> 11) * 0x1p-53; }
    /** Between 0 and 1, both ends and values near them among it. */
    float parameter() {
        switch (pick(6)) {
            case 0:
                return 0;
            case 1:
                return 1;
            case 2:
                return 1e-6f;
            case 3:
                return 1.0f - 6e-8f;
            default:
                return float(uniform());
        }
    }
    glm::vec3 color() { return {parameter(), parameter(), parameter()}; }
    glm::dvec3 point() { return {2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1}; }
    glm::dvec3 direction() {
        glm::dvec3 d = point();
        return glm::length(d) > 1e-3 ? glm::normalize(d) : glm::dvec3(0, 1, 0);
    }
    float power() { return float(std::pow(10.0, 12 * uniform() - 6)); }

    Material material() {
        Material m;
        m.baseColor = glm::vec4(color(), parameter());
        m.metallic = parameter();
        m.roughness = parameter();
        m.specular = parameter();
        m.specularColor = color();
        m.ior = 1.0f + parameter() * float(pick(3));
        m.doubleSided = pick(2) == 0;
        if (pick(4) == 0) m.emission = color() * power();
        if (pick(4) == 0) m.transmission = parameter(), m.thickness = parameter();
        if (m.thickness > 0 && pick(2) == 0) {
            m.attenuationDistance = power();
            m.attenuationColor = color();
        }
        if (pick(5) == 0) m.dispersion = parameter();
        if (pick(5) == 0) m.clearcoat = parameter(), m.clearcoatRoughness = parameter();
        if (pick(5) == 0) m.sheenColor = color(), m.sheenRoughness = parameter();
        if (pick(5) == 0) m.anisotropyStrength = parameter(), m.anisotropyRotation = float(7 * uniform());
        if (pick(5) == 0) m.iridescence = parameter(), m.iridescenceIor = 1 + parameter();
        if (pick(8) == 0) m.alphaMode = pick(2) == 0 ? AlphaMode::Mask : AlphaMode::Blend;
        if (pick(12) == 0) m.unlit = true;
        if (pick(3) == 0) {
            Scattering s;
            s.model = Scattering::Model(pick(7));
            s.roughness = parameter();
            s.alpha = {parameter(), parameter()};
            s.n = glm::vec3(0.01f) + 3.0f * color();
            s.k = 5.0f * color();
            s.exponent = parameter() * power();
            s.exponent = std::min(s.exponent, 1e6f);
            s.beckmann = pick(2) == 0;
            s.schlick = pick(2) == 0;
            m.scattering = s;
        }
        return m;
    }

    void place(Primitive primitive) {
        Node node;
        node.mesh = int(scene_.meshes.size());
        node.translation = glm::vec3(offset_);
        // Instances may be flattened or mirrored.
        if (pick(5) == 0) node.scale = {1, -1, 1};
        if (pick(8) == 0) node.scale.y = 0;
        scene_.meshes.push_back({"mesh", {std::move(primitive)}});
        const int copies = 1 + (pick(6) == 0 ? 1 : 0);  // a second one coincides
        for (int i = 0; i < copies; ++i) {
            scene_.roots.push_back(int(scene_.nodes.size()));
            scene_.nodes.push_back(node);
        }
    }
    void add(Primitive& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        for (const glm::dvec3& corner : {a, b, c}) {
            p.indices.push_back(std::uint32_t(p.positions.size()));
            p.positions.emplace_back(corner * scale_);
        }
    }

    /** A shape of its own node, far smaller than the rest or far larger. */
    void shape() {
        Primitive p;
        p.material = pick(int(scene_.materials.size()));
        const float size = float(scale_ * std::pow(10.0, 1 - 5 * uniform()));
        Shape s;
        s.kind = Shape::Kind(pick(5));
        s.radius = size;
        s.tubeRadius = size * (0.0105f + 0.979f * parameter());
        s.width = size;
        s.height = pick(3) == 0 ? size * float(std::pow(10.0, -6 * uniform())) : size;
        p.shape = s;
        Node node;
        node.mesh = int(scene_.meshes.size());
        node.translation = glm::vec3(offset_ + scale_ * (pick(3) == 0 ? glm::round(point()) : point()));
        if (pick(2) == 0)
            node.rotation = glm::quat(glm::rotation(glm::vec3(0, 0, 1), glm::vec3(direction())));
        if (pick(5) == 0) node.scale.x = node.scale.y = node.scale.z = -1;
        scene_.meshes.push_back({"shape", {std::move(p)}});
        const int copies = 1 + (pick(6) == 0 ? 1 : 0);  // a second one coincides
        for (int i = 0; i < copies; ++i) {
            scene_.roots.push_back(int(scene_.nodes.size()));
            scene_.nodes.push_back(node);
        }
    }

    void mesh() {
        const int kind = pick(5);
        if (kind == 4) return shape();
        Primitive p;
        p.material = pick(int(scene_.materials.size()));
        if (kind == 0) {  // a soup
            const int count = 1 + pick(pick(2) == 0 ? 20 : 300);
            for (int i = 0; i < count; ++i) {
                const glm::dvec3 a = point();
                const double size = std::pow(10.0, -6 * uniform());
                glm::dvec3 b = a + size * point(), c = a + size * point();
                switch (pick(6)) {
                    case 0:
                        b = a;
                        break;  // a line
                    case 1:
                        c = a + 0.5 * (b - a);
                        break;  // a line through all
                    case 2:
                        c = a + 1e-7 * size * point();
                        break;  // a sliver
                    case 3:
                        add(p, a, b, c);
                        break;  // twice
                    default:
                        break;
                }
                add(p, a, b, c);
            }
        } else if (kind == 1) {  // a ball, smooth or not
            const glm::dvec3 centre = 0.7 * point();
            const double radius = std::pow(10.0, -3 * uniform());
            const std::vector<glm::vec3> corners = unitSphere(pick(3));
            for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
                add(p, centre + radius * glm::dvec3(corners[i]), centre + radius * glm::dvec3(corners[i + 1]),
                    centre + radius * glm::dvec3(corners[i + 2]));
            if (pick(2) == 0)
                for (const glm::vec3& corner : corners)
                    p.normals.emplace_back(pick(20) == 0 ? glm::normalize(glm::vec3(direction()))
                                                         : glm::normalize(corner));
        } else {  // a room or sheets, in one plane where coordinates repeat
            const double y = pick(2) == 0 ? -1.0 : std::round(2 * uniform()) - 1.0;
            const double size = kind == 2 ? 1.0 : std::pow(10.0, 3 - 6 * uniform());
            add(p, {-size, y, -size}, {size, y, size}, {size, y, -size});
            add(p, {-size, y, -size}, {-size, y, size}, {size, y, size});
        }
        place(std::move(p));
    }

    void light() {
        if (pick(2) == 0) {
            PunctualLight source;
            source.type = PunctualLight::Type(pick(3));
            source.intensity = color() * power() * float(scale_ * scale_);
            source.outerConeAngle = 0.01f + 1.5f * parameter();
            source.innerConeAngle = 0.99f * source.outerConeAngle * parameter();
            Node node;
            node.light = int(scene_.lights.size());
            // Often on a corner or in a plane of the sheets.
            node.translation = glm::vec3(offset_ + scale_ * (pick(2) == 0 ? glm::round(point()) : point()));
            scene_.lights.push_back(source);
            scene_.roots.push_back(int(scene_.nodes.size()));
            scene_.nodes.push_back(node);
            return;
        }
        Material glow;
        glow.metallic = glow.specular = 0;
        glow.emission = color() * power();
        glow.doubleSided = pick(2) == 0;
        Primitive p;
        p.material = int(scene_.materials.size());
        scene_.materials.push_back(glow);
        const glm::dvec3 a = pick(2) == 0 ? glm::dvec3(0, 1, 0) : point();
        const double size = std::pow(10.0, 6 - 12 * uniform());
        add(p, a, a + size * direction(), a + size * direction());
        place(std::move(p));
    }

    void surroundings() {
        Environment environment;
        environment.radiance = color() * power();
        if (pick(2) == 0) {
            TextureImage image;
            image.width = 1u << pick(5);
            image.height = 1u << pick(4);
            std::vector<float> texels;
            for (std::uint32_t i = 0; i < image.width * image.height; ++i)
                for (int c = 0; c < 4; ++c) texels.push_back(pick(3) == 0 ? 0.0f : power());
            image.texels = std::move(texels);
            environment.image = int(scene_.images.size());
            scene_.images.push_back(std::move(image));
        }
        scene_.environment = environment;
    }

    void camera() {
        Camera camera;
        camera.yfov = 0.05f + 2.5f * float(uniform());
        camera.znear = float(1e-4 * scale_);
        Node node;
        const glm::dvec3 eye = pick(3) == 0 ? glm::round(2.0 * point()) : 2.0 * point();
        const glm::dvec3 back = glm::length(eye) > 1e-3 ? glm::normalize(eye) : glm::dvec3(0, 0, 1);
        node.translation = glm::vec3(offset_ + scale_ * eye);
        node.rotation = glm::quat(glm::rotation(glm::vec3(0, 0, 1), glm::vec3(back)));
        node.camera = 0;
        scene_.cameras = {camera};
        scene_.roots.push_back(int(scene_.nodes.size()));
        scene_.nodes.push_back(node);
    }

    std::mt19937_64 random_;
    Scene scene_;
    double scale_ = 1;
    glm::dvec3 offset_{0.0};
};

}  // namespace

Scene randomScene(std::uint64_t number) {
    return Author(number).write();
}

}  // namespace helio::test
