#pragma once
/** @file Puts the channels of a result's image together. */
#include <heliograph/image.hpp>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace helio {

/** An image to which channels are added one group at a time. */
class Frame {
public:
    Frame(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}
    /** Adds channels whose values lie at `values[pixel * stride + offset + c]`. */
    void add(std::initializer_list<std::string> names, const float* values, std::size_t stride,
             std::size_t offset = 0);
    /** Interleaves all channels, in the order they were added. */
    ImageF image() const;

private:
    struct Channel {
        std::string name;
        std::vector<float> values;
    };
    std::uint32_t width_, height_;
    std::vector<Channel> channels_;
};

}  // namespace helio
