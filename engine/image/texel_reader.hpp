#pragma once
/** @file Rows of pixels as a file stores them, to texels. */
#include "engine/image/backend.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace helio {

/** T: std::uint8_t, std::uint16_t or float. As long as all texels are equal none is stored; a large image of
 * one colour ends as one texel. */
template <class T>
class TexelReader {
public:
    TexelReader(std::uint32_t width, std::uint32_t height, std::size_t channels, std::uint64_t encoded,
                ImageBudget& budget)
        : width_(width), height_(height), channels_(channels), encoded_(encoded), budget_(budget) {}

    /** readRows(y, rows, values) fills in rows from y on, from the top to the bottom, and returns what went
     * wrong. It is asked for `together` rows at a time, or for few where that is 0. */
    template <class ReadRows>
    std::string read(std::uint32_t together, ReadRows&& readRows, DecodedImage& image) {
        constexpr std::size_t smallImage = std::size_t(1) << 18, stripBytes = std::size_t(1) << 22;
        if (std::size_t(width_) * height_ <= smallImage && !budget_.isTrial() && !allocate())
            return tooLarge();
        const std::size_t row = std::size_t(width_) * channels_ * sizeof(T);
        const auto strip =
            std::min(height_, together > 0 ? together
                                           : std::uint32_t(std::clamp<std::size_t>(stripBytes / row, 1, 64)));
        if (together > 0 && !budget_.hold(2 * row * strip, encoded_)) return tooLarge();
        std::vector<T> stored, spread;
        for (std::uint32_t y = 0; y < height_; y += strip) {
            const std::uint32_t rows = std::min(strip, height_ - y);
            const std::size_t texels = std::size_t(width_) * rows;
            stored.resize(texels * channels_);
            if (std::string fault = readRows(y, rows, stored.data()); !fault.empty()) return fault;
            spread.resize(texels * 4);
            spreadToRgba(stored, spread);
            if (y == 0) std::copy_n(spread.data(), 4, color_.data());
            if (budget_.isTrial()) continue;
            if (texels_.empty() && !isOneColor(spread) && !allocate()) return tooLarge();
            if (!texels_.empty())
                std::copy(spread.begin(), spread.end(), &texels_[std::size_t(width_) * 4 * y]);
        }
        const bool isOne = texels_.empty();
        image.width = isOne ? 1 : width_;
        image.height = isOne ? 1 : height_;
        image.fileWidth = width_;
        image.fileHeight = height_;
        if (isOne) texels_.assign(color_.begin(), color_.end());
        image.texels = std::move(texels_);
        return {};
    }

private:
    static constexpr T opaque() {
        if constexpr (std::is_floating_point_v<T>) return 1;
        return std::numeric_limits<T>::max();
    }

    std::string tooLarge() const { return unfoldsTo(width_, height_, encoded_); }

    void spreadToRgba(const std::vector<T>& stored, std::vector<T>& rgba) const {
        const std::size_t colors = channels_ >= 3 ? 3 : 1;
        for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
            const T* const from = &stored[i * channels_];
            for (std::size_t c = 0; c < 3; ++c) rgba[i * 4 + c] = from[colors == 3 ? c : 0];
            rgba[i * 4 + 3] = channels_ > colors ? from[colors] : opaque();
        }
    }

    bool isOneColor(const std::vector<T>& rgba) const {
        for (std::size_t i = 0; i < rgba.size(); i += 4) {
            if (!std::equal(color_.begin(), color_.end(), &rgba[i])) return false;
        }
        return true;
    }

    /** Room for all texels, of the colour that those so far have. */
    bool allocate() {
        const std::size_t values = std::size_t(width_) * height_ * 4;
        if (!budget_.take(values * sizeof(T), encoded_)) return false;
        texels_.resize(values);
        for (std::size_t i = 0; i < values; i += 4) std::copy_n(color_.data(), 4, &texels_[i]);
        return true;
    }

    std::uint32_t width_, height_;
    std::size_t channels_;
    std::uint64_t encoded_;
    ImageBudget& budget_;
    std::array<T, 4> color_{};
    std::vector<T> texels_;
};

}  // namespace helio
