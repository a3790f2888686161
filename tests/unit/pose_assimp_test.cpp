// Poses beside those that assimp's own reading, interpolation and node hierarchy give for the same file.
#include <heliograph/pose.hpp>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

namespace helio {
namespace {

template <class Key>
std::size_t keyBefore(const Key* keys, unsigned count, double time) {
    std::size_t k = 0;
    while (k + 1 < count && keys[k + 1].mTime <= time) ++k;
    return k;
}

template <class Key>
auto valueOf(const Key* keys, unsigned count, double time) {
    const std::size_t k = keyBefore(keys, count, time);
    auto value = keys[k].mValue;
    if (k + 1 == count || time <= keys[k].mTime) return value;
    const double s = (time - keys[k].mTime) / (keys[k + 1].mTime - keys[k].mTime);
    if constexpr (std::is_same_v<decltype(value), aiQuaternion>) {
        aiQuaternion::Interpolate(value, keys[k].mValue, keys[k + 1].mValue, ai_real(s));
        return value.Normalize();  // assimp's is not unit where the keys are close
    } else {
        return value + (keys[k + 1].mValue - value) * ai_real(s);
    }
}

/** World transforms of assimp's nodes by name, with an animation at `seconds`. */
class Reference {
public:
    Reference(const aiScene& scene, const aiAnimation& animation, double seconds) {
        const double ticks = seconds * (animation.mTicksPerSecond != 0 ? animation.mTicksPerSecond : 1000.0);
        for (unsigned c = 0; c < animation.mNumChannels; ++c) {
            const aiNodeAnim& channel = *animation.mChannels[c];
            local_[channel.mNodeName.C_Str()] =
                aiMatrix4x4(valueOf(channel.mScalingKeys, channel.mNumScalingKeys, ticks),
                            valueOf(channel.mRotationKeys, channel.mNumRotationKeys, ticks),
                            valueOf(channel.mPositionKeys, channel.mNumPositionKeys, ticks));
        }
        visit(*scene.mRootNode, aiMatrix4x4());
    }

    std::vector<aiVector3D> skinned(const aiMesh& mesh) const {
        std::vector<aiVector3D> points(mesh.mNumVertices);
        for (unsigned b = 0; b < mesh.mNumBones; ++b) {
            const aiBone& bone = *mesh.mBones[b];
            const aiMatrix4x4 matrix = world_.at(bone.mName.C_Str()) * bone.mOffsetMatrix;
            for (unsigned w = 0; w < bone.mNumWeights; ++w) {
                points[bone.mWeights[w].mVertexId] +=
                    matrix * mesh.mVertices[bone.mWeights[w].mVertexId] * bone.mWeights[w].mWeight;
            }
        }
        return points;
    }

private:
    void visit(const aiNode& node, const aiMatrix4x4& parent) {
        const auto animated = local_.find(node.mName.C_Str());
        const aiMatrix4x4 world =
            parent * (animated == local_.end() ? node.mTransformation : animated->second);
        world_[node.mName.C_Str()] = world;
        for (unsigned c = 0; c < node.mNumChildren; ++c) visit(*node.mChildren[c], world);
    }

    std::map<std::string, aiMatrix4x4> local_, world_;
};

TEST(PoseBesideAssimp, FoxRunsWalksAndSurveys) {
    const std::filesystem::path file =
        std::filesystem::path(HELIOGRAPH_SHARED_DIR) / "assets" / "gltf" / "Fox.glb";
    if (!std::filesystem::exists(HELIOGRAPH_SHARED_DIR "/assets"))
        GTEST_SKIP() << "left out: there is no " HELIOGRAPH_SHARED_DIR "/assets";
    const Scene scene = load(file.string());
    Assimp::Importer importer;
    const aiScene* const reference = importer.ReadFile(file.string(), 0);
    ASSERT_NE(reference, nullptr) << importer.GetErrorString();
    ASSERT_EQ(reference->mNumAnimations, scene.animations.size());
    const aiMesh& mesh = *reference->mMeshes[0];
    for (unsigned a = 0; a < reference->mNumAnimations; ++a) {
        const aiAnimation& animation = *reference->mAnimations[a];
        double moved = 0, furthest = 0;
        for (double time : {0.0, 0.1, 0.37, 0.5, 1.1, 3.3}) {
            const Scene still = posed(scene, time, animation.mName.C_Str());
            const Instance placed = still.instances().at(0);
            const Primitive& primitive = still.meshes[std::size_t(placed.mesh)].primitives[0];
            const std::vector<aiVector3D> expected = Reference(*reference, animation, time).skinned(mesh);
            ASSERT_EQ(primitive.positions.size(), expected.size());
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const glm::dvec3 at(placed.transform * glm::dvec4(primitive.positions[i], 1.0));
                const glm::dvec3 there(expected[i].x, expected[i].y, expected[i].z);
                furthest = std::max(furthest, glm::distance(at, there));
                moved = std::max(moved,
                                 glm::distance(at, glm::dvec3(scene.meshes[0].primitives[0].positions[i])));
            }
        }
        EXPECT_GT(moved, 5) << animation.mName.C_Str() << ": of a fox 100 long";
        EXPECT_LT(furthest, 1e-5 * 154) << animation.mName.C_Str();  // of its diagonal; assimp has floats
        RecordProperty(std::string("furthest_") + animation.mName.C_Str(), std::to_string(furthest));
    }
}

}  // namespace
}  // namespace helio
