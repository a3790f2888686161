#include <heliograph/pose.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace helio {
namespace {

using Quaternion = glm::dvec4;  // x, y, z, w, as stored

Quaternion normalized(const Quaternion& q) {
    const double length = glm::length(q);
    return length > 0 ? q / length : Quaternion(0, 0, 0, 1);
}

/** Spherical interpolation along the shorter arc. The angle between unit vectors is 2 atan2(|a - b|, |a + b|)
 * to full precision, also where it is small (Kahan); it is at most a right one after the choice of sign. */
Quaternion slerp(const Quaternion& a, Quaternion b, double s) {
    if (glm::dot(a, b) < 0) b = -b;
    const double angle = 2 * std::atan2(glm::length(a - b), glm::length(a + b));
    if (angle < 1e-8) return normalized(glm::mix(a, b, s));  // the sines' ratio is 1 - s, s to 1e-17
    return normalized((std::sin((1 - s) * angle) * a + std::sin(s * angle) * b) / std::sin(angle));
}

class Keys {
public:
    explicit Keys(const AnimationChannel& channel)
        : channel_(channel),
          values_(channel.interpolation == Interpolation::CubicSpline ? 3 : 1),
          width_(channel.values.size() / (channel.times.size() * values_)) {}

    std::size_t width() const { return width_; }
    double time(std::size_t key) const { return channel_.times[key]; }
    double value(std::size_t key, std::size_t i) const { return at(key, values_ == 3 ? 1 : 0, i); }

    /** glTF 2.0, appendix C.5: the cubic Hermite spline between a key and the next. */
    double spline(std::size_t key, double s, std::size_t i) const {
        const double duration = time(key + 1) - time(key);
        const double s2 = s * s, s3 = s2 * s;
        return (2 * s3 - 3 * s2 + 1) * value(key, i) + (s3 - 2 * s2 + s) * duration * at(key, 2, i) +
               (3 * s2 - 2 * s3) * value(key + 1, i) + (s3 - s2) * duration * at(key + 1, 0, i);
    }

    Quaternion quaternion(std::size_t key) const {
        return normalized({value(key, 0), value(key, 1), value(key, 2), value(key, 3)});
    }

private:
    double at(std::size_t key, std::size_t part, std::size_t i) const {
        return channel_.values[(key * values_ + part) * width_ + i];
    }

    const AnimationChannel& channel_;
    std::size_t values_;  ///< per key
    std::size_t width_;
};

}  // namespace

std::vector<double> valueAt(const AnimationChannel& channel, double time) {
    assert(!channel.times.empty());
    const Keys keys(channel);
    const bool isRotation = channel.path == AnimationPath::Rotation;
    std::vector<double> result(keys.width());
    const auto unit = [&] {
        if (isRotation) {
            const Quaternion q = normalized({result[0], result[1], result[2], result[3]});
            result = {q.x, q.y, q.z, q.w};
        }
        return std::move(result);
    };
    const auto& times = channel.times;
    const auto after = std::size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    if (after == 0 || after == times.size() || channel.interpolation == Interpolation::Step) {
        const std::size_t key = after == 0 ? 0 : after - 1;
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = keys.value(key, i);
        return unit();
    }
    const std::size_t key = after - 1;
    const double s = (time - keys.time(key)) / (keys.time(after) - keys.time(key));
    if (channel.interpolation == Interpolation::CubicSpline) {
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = keys.spline(key, s, i);
    } else if (isRotation) {
        const Quaternion q = slerp(keys.quaternion(key), keys.quaternion(after), s);
        return {q.x, q.y, q.z, q.w};
    } else {
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] = (1 - s) * keys.value(key, i) + s * keys.value(after, i);
    }
    return unit();
}

}  // namespace helio
