#pragma once
/** @file Whether a scene is the one that is on the device already. */
#include <heliograph/scene.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace helio {

/** 128-bit fingerprint of what the device scene is made of: placed meshes with their transforms, materials,
 * textures, images, placed lights and the environment. Names and cameras are not part of it, so that an edit
 * of those keeps the device scene. Two scenes of equal content are equal, wherever they live. Not
 * cryptographic. Reads every byte: about 0.1 s per GB of geometry and texels. */
struct SceneIdentity {
    std::array<std::uint64_t, 2> words{};
    bool operator==(const SceneIdentity&) const = default;
};
SceneIdentity identify(const Scene& scene, const std::optional<Environment>& environment);

}  // namespace helio
