#include "passes/renderer/frame.hpp"

namespace helio {

void Frame::add(std::initializer_list<std::string> names, const float* values, std::size_t stride,
                std::size_t offset) {
    const std::size_t pixels = std::size_t(width_) * height_;
    for (const std::string& name : names) {
        Channel channel{name, std::vector<float>(pixels)};
        for (std::size_t i = 0; i < pixels; ++i) channel.values[i] = values[i * stride + offset];
        channels_.push_back(std::move(channel));
        ++offset;
    }
}

ImageF Frame::image() const {
    ImageF image;
    image.width = width_;
    image.height = height_;
    image.data.resize(std::size_t(width_) * height_ * channels_.size());
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        image.channels.push_back(channels_[c].name);
        for (std::size_t i = 0; i < channels_[c].values.size(); ++i) {
            image.data[i * channels_.size() + c] = channels_[c].values[i];
        }
    }
    return image;
}

}  // namespace helio
