#pragma once
/** @file
 * Mip generation: every level of every texture of a scene as linear RGBA in full floats, each the 2:1 box of
 * the one before, with weights that keep the mean of odd sizes too. 1 + floor(log2(max(width, height)))
 * levels.
 */
#include <heliograph/device.hpp>
#include <heliograph/graph.hpp>

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace helio {

/** Number of levels of a full chain, the base counted. */
std::uint32_t mipLevelCount(std::uint32_t width, std::uint32_t height);

/** Where levels lie; the layout of shaders/texture/mip_table.glsl and of passes/mip/mip.glsl. Host only. */
struct MipLayout {
    /** From packed textures (offset, width, height, flags). Textures without the mipmap flag get no levels,
     * those that share their texels share the levels. `ripmaps`: levels halved so often along x and so often
     * along y, every pair; they take three times the texels of the base, and mip levels are among them.
     * Throws InputError beyond 2^27 texels in all. */
    explicit MipLayout(std::span<const glm::uvec4> textures, bool ripmaps = false);

    std::vector<glm::uvec4> table;
    std::vector<glm::uvec4> work;
    /** A level of one texture that a dispatch of its own makes, and the next where `second` is not negative:
     * the push constants of passes/mip/mip_wide.glsl but for the last. */
    struct Wide {
        glm::ivec2 size, sourceSize;
        std::int32_t target, source, second;
    };
    /** Work of one level: wide ones, by the texture's flags, and what the others share. */
    struct Level {
        std::uint32_t firstItem = 0, items = 0, invocations = 0;
        std::vector<std::pair<std::uint32_t, Wide>> wide = {};
    };
    std::vector<Level> levels;  ///< 1, 2, ...
    std::uint64_t texels = 0;   ///< of all levels from 1

private:
    void layMips(std::span<const glm::uvec4> textures, const std::vector<std::uint32_t>& chains);
    void layRipmaps(std::span<const glm::uvec4> textures, const std::vector<std::uint32_t>& chains);
    void checkTexels() const;
};

/** Mip levels on the device. Must outlive the plans it is declared in. */
class MipChains {
public:
    MipChains(Device& device, std::span<const glm::uvec4> textures, bool ripmaps = false);

    /** Whether any texture has levels to make. */
    bool needed() const { return layout_.texels > 0; }
    /** Declares the passes that make all levels. `textures` are read bindings of uTextures, uTexels8 and
     * uTexelsFloat (DeviceScene::bindings). The levels stay in memory: run once for a scene. */
    void declare(Graph& graph, const std::vector<Binding>& textures, const SpecConstants& spec);
    /** Read bindings of uMipTable and uMips for a pass that samples. */
    std::vector<Binding> bindings(Graph& graph);

    const MipLayout& layout() const { return layout_; }

private:
    void declareWide(Graph& graph, const std::vector<Binding>& textures, std::size_t level, Buffer mips);

    MipLayout layout_;
    DeviceBuffer table_, work_, mips_;
};

}  // namespace helio
