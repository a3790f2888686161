#include "tests/accuracy/path_reference.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <random>

namespace helio::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Face {
    glm::dvec3 a, e1, e2, normal;  ///< normal is unit
    double area = 0;
    glm::dvec3 albedo, emission;
    bool doubleSided = false;
    int instance = 0, triangle = 0;
};

struct World {
    std::vector<Face> faces;
    std::vector<int> lights;
    double lightArea = 0;
};

World flatten(const Scene& scene) {
    World world;
    int instanceIndex = 0;
    for (const Instance& instance : scene.instances()) {
        int triangle = 0;
        for (const Primitive& primitive : scene.meshes[std::size_t(instance.mesh)].primitives) {
            const Material& material = scene.materials[std::size_t(primitive.material)];
            for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
                glm::dvec3 p[3];
                for (std::size_t k = 0; k < 3; ++k)
                    p[k] = glm::dvec3(instance.transform *
                                      glm::dvec4(primitive.positions[primitive.indices[i + k]], 1.0));
                Face face;
                face.a = p[0];
                face.e1 = p[1] - p[0];
                face.e2 = p[2] - p[0];
                const glm::dvec3 n = glm::cross(face.e1, face.e2);
                face.area = 0.5 * glm::length(n);
                face.normal = n / (2 * face.area);
                face.albedo = glm::dvec3(material.baseColor);
                face.emission = glm::dvec3(material.emission);
                face.doubleSided = material.doubleSided;
                face.instance = instanceIndex;
                face.triangle = triangle++;
                if (face.emission != glm::dvec3(0.0)) {
                    world.lights.push_back(int(world.faces.size()));
                    world.lightArea += face.area;
                }
                world.faces.push_back(face);
            }
        }
        ++instanceIndex;
    }
    return world;
}

/** Moeller and Trumbore. Distance along d, or infinity. */
double meet(const Face& face, const glm::dvec3& o, const glm::dvec3& d) {
    const glm::dvec3 p = glm::cross(d, face.e2);
    const double determinant = glm::dot(face.e1, p);
    if (determinant == 0) return std::numeric_limits<double>::infinity();
    const glm::dvec3 s = o - face.a;
    const double u = glm::dot(s, p) / determinant;
    if (u < 0 || u > 1) return std::numeric_limits<double>::infinity();
    const glm::dvec3 q = glm::cross(s, face.e1);
    const double v = glm::dot(d, q) / determinant;
    if (v < 0 || u + v > 1) return std::numeric_limits<double>::infinity();
    const double t = glm::dot(face.e2, q) / determinant;
    return t > 0 ? t : std::numeric_limits<double>::infinity();
}

int nearest(const World& world, const glm::dvec3& o, const glm::dvec3& d, int from, double& distance) {
    distance = std::numeric_limits<double>::infinity();
    int found = -1;
    for (std::size_t i = 0; i < world.faces.size(); ++i) {
        if (int(i) == from) continue;
        const double t = meet(world.faces[i], o, d);
        if (t < distance) {
            distance = t;
            found = int(i);
        }
    }
    return found;
}

bool blocked(const World& world, const glm::dvec3& o, const glm::dvec3& to, int from, int target) {
    const glm::dvec3 d = to - o;
    for (std::size_t i = 0; i < world.faces.size(); ++i)
        if (int(i) != from && int(i) != target && meet(world.faces[i], o, d) < 1 - 1e-9) return true;
    return false;
}

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double operator()() { return double(engine_() >> 11) * 0x1p-53; }

private:
    std::mt19937_64 engine_;
};

/** A unit vector with cosine density about n: n plus a point of the unit sphere found by rejection. */
glm::dvec3 cosineAbout(const glm::dvec3& n, Random& random) {
    for (;;) {
        const glm::dvec3 p(2 * random() - 1, 2 * random() - 1, 2 * random() - 1);
        const double squared = glm::dot(p, p);
        if (squared > 1 || squared < 1e-12) continue;
        const glm::dvec3 d = n + p / std::sqrt(squared);
        const double length = glm::length(d);
        if (length > 1e-9) return d / length;
    }
}

glm::dvec3 radiance(const World& world, glm::dvec3 o, glm::dvec3 d, int maxDepth, Random& random) {
    glm::dvec3 sum(0.0), throughput(1.0);
    int from = -1;
    for (int depth = 0;; ++depth) {
        double t;
        const int hit = nearest(world, o, d, from, t);
        if (hit < 0) return sum;
        const Face& face = world.faces[std::size_t(hit)];
        const bool front = glm::dot(face.normal, d) < 0;
        if (depth == 0 && (front || face.doubleSided)) sum += face.emission;
        if (maxDepth >= 0 && depth >= maxDepth) return sum;
        const glm::dvec3 n = front ? face.normal : -face.normal;
        o += d * t;
        throughput *= face.albedo;
        if (!world.lights.empty()) {
            double at = random() * world.lightArea;
            std::size_t chosen = 0;
            while (chosen + 1 < world.lights.size() &&
                   at >= world.faces[std::size_t(world.lights[chosen])].area)
                at -= world.faces[std::size_t(world.lights[chosen++])].area;
            const int target = world.lights[chosen];
            const Face& light = world.faces[std::size_t(target)];
            const double r = std::sqrt(random()), s = random();
            const glm::dvec3 q = light.a + light.e1 * (r * (1 - s)) + light.e2 * (r * s);
            const glm::dvec3 w = q - o;
            const double squared = glm::dot(w, w), here = glm::dot(n, w), there = -glm::dot(light.normal, w);
            if (here > 0 && (there > 0 || light.doubleSided) && target != hit &&
                !blocked(world, o, q, hit, target))
                sum += throughput * light.emission *
                       (here * std::abs(there) / (kPi * squared * squared) * world.lightArea);
        }
        const double keep =
            depth < 3 ? 1.0 : std::min(1.0, std::max({face.albedo.x, face.albedo.y, face.albedo.z}));
        if (!(keep > 0) || random() >= keep) return sum;
        throughput /= keep;
        d = cosineAbout(n, random);
        from = hit;
    }
}

}  // namespace

ReferenceImage traceReference(const Scene& source, std::array<std::uint32_t, 2> size,
                              const std::function<std::uint32_t(const ReferenceImage&, std::size_t)>& samples,
                              int maxDepth, std::uint64_t seed) {
    Scene scene = source;
    const World world = flatten(scene);
    const PlacedCamera placed = chooseCamera(scene, "", double(size[0]) / size[1]);
    const Camera& camera = scene.cameras[std::size_t(placed.camera)];
    const glm::dvec3 eye(placed.transform[3]), forward = -glm::normalize(glm::dvec3(placed.transform[2])),
                                               right = glm::normalize(glm::dvec3(placed.transform[0])),
                                               up = glm::normalize(glm::dvec3(placed.transform[1]));
    const double height = std::tan(double(camera.yfov) / 2), width = height * size[0] / size[1];

    ReferenceImage image;
    image.width = size[0];
    image.height = size[1];
    const std::size_t pixels = std::size_t(size[0]) * size[1];
    image.mean.resize(pixels);
    image.variance.resize(pixels);
    image.instance.assign(pixels, -1);
    image.triangle.assign(pixels, -1);
    image.depth.assign(pixels, 0);
    const auto direction = [&](double px, double py) {
        return glm::normalize(forward + right * (width * (2 * px / size[0] - 1)) +
                              up * (height * (1 - 2 * py / size[1])));
    };
    for (std::size_t i = 0; i < pixels; ++i) {
        const glm::dvec3 centre = direction(double(i % size[0]) + 0.5, double(i / size[0]) + 0.5);
        double t;
        const int seen = nearest(world, eye, centre, -1, t);
        if (seen < 0) continue;
        image.instance[i] = world.faces[std::size_t(seen)].instance;
        image.triangle[i] = world.faces[std::size_t(seen)].triangle;
        image.depth[i] = t * glm::dot(centre, forward);
    }
    tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
        const std::uint32_t count = samples(image, i);
        Random random(seed * 1000003 + i);
        glm::dvec3 sum(0.0), squares(0.0);
        for (std::uint32_t s = 0; s < count; ++s) {
            const double px = double(i % size[0]) + random(), py = double(i / size[0]) + random();
            const glm::dvec3 value = radiance(world, eye, direction(px, py), maxDepth, random);
            sum += value;
            squares += value * value;
        }
        const double n = std::max(count, 2u);
        image.mean[i] = sum / n;
        image.variance[i] = (squares / n - image.mean[i] * image.mean[i]) / (n - 1);
    });
    return image;
}

}  // namespace helio::test
