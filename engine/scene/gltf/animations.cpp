#include "engine/scene/gltf/build.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <array>
#include <optional>

namespace helio::gltf {
namespace {

using nlohmann::json;

std::optional<AnimationPath> pathOf(const std::string& name) {
    if (name == "translation") return AnimationPath::Translation;
    if (name == "rotation") return AnimationPath::Rotation;
    if (name == "scale") return AnimationPath::Scale;
    if (name == "weights") return AnimationPath::Weights;
    return std::nullopt;
}

class AnimationBuilder {
public:
    AnimationBuilder(const Asset& asset, MemoryBudget& memory, helio::Scene& scene)
        : asset_(asset), memory_(memory), scene_(scene) {}

    Animation build(const json& from, const std::string& place) {
        Animation animation;
        animation.name = from.value("name", "");
        const json& samplers = from["samplers"];
        if (from["channels"].empty()) warn(scene_, place + " has no channels");
        memory_.take(place + ".channels", from["channels"].size() * sizeof(AnimationChannel), 0);
        animation.channels.reserve(from["channels"].size());
        for (std::size_t c = 0; c < from["channels"].size(); ++c) {
            const json& channel = from["channels"][c];
            const std::string channelPlace = fmt::format("{}.channels[{}]", place, c);
            const auto sampler = std::size_t(channel["sampler"].get<double>());
            if (sampler >= samplers.size()) {
                throw InputError(asset_.file(), channelPlace + ".sampler",
                                 fmt::format("is {}, no index into {}.samplers", sampler, place),
                                 fmt::format("the animation has {}", samplers.size()));
            }
            if (auto target = targetOf(channel["target"])) {
                read(samplers[sampler], channelPlace, fmt::format("{}.samplers[{}]", place, sampler),
                     *target);
                animation.channels.push_back(std::move(*target));
            }
        }
        return animation;
    }

private:
    /** The channel without its keys; nothing for one that the scene model has no place for. */
    std::optional<AnimationChannel> targetOf(const json& target) {
        const auto& path = target["path"].get_ref<const std::string&>();
        const auto known = pathOf(path);
        if (!known || !target.contains("node")) {
            skip(scene_, "animation of " + std::string(path.substr(0, 40)),
                 known ? "it names no node" : "translation, rotation, scale and weights are animated");
            return std::nullopt;
        }
        AnimationChannel channel;
        channel.node = int(target["node"].get<double>());
        channel.path = *known;
        const Node& node = scene_.nodes[std::size_t(channel.node)];
        // A mesh of points or lines is left out, and its weights with it.
        const bool isShown = node.mesh >= 0 && !scene_.meshes[std::size_t(node.mesh)].primitives.empty();
        const bool isLeftOut = *known == AnimationPath::Weights && node.mesh >= 0 && !isShown;
        if (isLeftOut) return std::nullopt;
        return channel;
    }

    void read(const json& sampler, const std::string& channelPlace, const std::string& place,
              AnimationChannel& channel) {
        const Node& node = scene_.nodes[std::size_t(channel.node)];
        if (channel.path != AnimationPath::Weights && node.matrix) {
            throw InputError(asset_.file(), channelPlace + ".target",
                             fmt::format("moves nodes[{}], which has a matrix", channel.node),
                             "give the node translation, rotation and scale");
        }
        const std::string interpolation = sampler.value("interpolation", "LINEAR");
        if (interpolation == "STEP") channel.interpolation = Interpolation::Step;
        if (interpolation == "CUBICSPLINE") channel.interpolation = Interpolation::CubicSpline;
        channel.times = numbers(int(sampler["input"].get<double>()), 1, place + ".input");
        bool isTwice = false;
        for (std::size_t i = 1; i < channel.times.size(); ++i) {
            if (channel.times[i] > channel.times[i - 1]) continue;
            if (channel.times[i] == channel.times[i - 1]) {
                isTwice = true;
                continue;
            }
            throw InputError(asset_.file(), place + ".input",
                             fmt::format("time {} is {}, before the one before it", i, channel.times[i]),
                             "give times that ascend");
        }
        if (isTwice) warn(scene_, place + ".input has a time twice");
        if (channel.times[0] < 0) warn(scene_, place + ".input begins before 0");
        const bool isRotation = channel.path == AnimationPath::Rotation,
                   isWeights = channel.path == AnimationPath::Weights;
        channel.values = numbers(int(sampler["output"].get<double>()), isWeights ? 1 : (isRotation ? 4 : 3),
                                 place + ".output");
        const std::size_t width = isWeights ? targets(node) : (isRotation ? 4 : 3);
        const std::size_t expected =
            channel.times.size() * width * (channel.interpolation == Interpolation::CubicSpline ? 3 : 1);
        if (width == 0 || channel.values.size() != expected) {
            throw InputError(asset_.file(), place + ".output",
                             fmt::format("has {} numbers for {} times of {} numbers each",
                                         channel.values.size(), channel.times.size(), width),
                             fmt::format("give {}", expected));
        }
    }

    std::size_t targets(const Node& node) const {
        if (node.mesh < 0) return 0;
        return scene_.meshes[std::size_t(node.mesh)].primitives[0].targets.size();
    }

    std::vector<float> numbers(int accessor, int components, const std::string& place) {
        asset_.check(accessor);
        memory_.takeFor(accessor, place, asset_.count(accessor) * std::size_t(components) * sizeof(float), 0);
        return asset_.floats(accessor, components, place);
    }

    const Asset& asset_;
    MemoryBudget& memory_;
    helio::Scene& scene_;
};

}  // namespace

void buildAnimations(const Asset& asset, MemoryBudget& memory, helio::Scene& scene) {
    const std::size_t count = asset.document().size("animations");
    memory.take("animations", count * sizeof(Animation), 0);
    scene.animations.reserve(count);
    AnimationBuilder builder(asset, memory, scene);
    for (std::size_t i = 0; i < count; ++i) {
        const json from = asset.document().element("animations", i);
        scene.animations.push_back(builder.build(from, fmt::format("animations[{}]", i)));
    }
}

}  // namespace helio::gltf
