#include "engine/gpu/device_impl.hpp"

#include <heliograph/device.hpp>

#include <algorithm>
#include <stdexcept>

namespace helio {

std::uint32_t formatBytes(Format format) {
    return format == Format::Undefined ? 0 : std::uint32_t(vk::blockSize(gpu::vulkanFormat(format)));
}

std::string_view formatName(Format format) {
    switch (format) {
        case Format::Undefined:
            return "undefined";
        case Format::R32UI:
            return "R32UI";
        case Format::R32I:
            return "R32I";
        case Format::R32F:
            return "R32F";
        case Format::RG32UI:
            return "RG32UI";
        case Format::RG32F:
            return "RG32F";
        case Format::RGBA32UI:
            return "RGBA32UI";
        case Format::RGBA32F:
            return "RGBA32F";
        case Format::RGBA16F:
            return "RGBA16F";
        case Format::RGBA8:
            return "RGBA8";
        case Format::R8:
            return "R8";
    }
    return "undefined";
}

// Work in flight may still use the resource: it goes when that is done.
DeviceBuffer::Impl::~Impl() {
    device->queue.retire(std::move(resource));
}
DeviceImage::Impl::~Impl() {
    device->queue.retire(std::move(resource));
}

DeviceBuffer::DeviceBuffer(Device& device, std::string name, std::uint64_t bytes) {
    Device::Impl& impl = device.impl();
    gpu::BufferResource resource =
        gpu::createBuffer(impl, std::move(name), std::max<std::uint64_t>(bytes, 4));
    impl_.reset(new Impl{&impl, std::move(resource)});
}
DeviceBuffer::~DeviceBuffer() = default;
DeviceBuffer::DeviceBuffer(DeviceBuffer&&) noexcept = default;
DeviceBuffer& DeviceBuffer::operator=(DeviceBuffer&&) noexcept = default;

const std::string& DeviceBuffer::name() const {
    return impl_->resource.name;
}
std::uint64_t DeviceBuffer::bytes() const {
    return impl_->resource.bytes;
}
void DeviceBuffer::upload(const void* data, std::uint64_t bytes, std::uint64_t offset) {
    impl_->device->staging.upload(impl_->resource, data, bytes, offset);
}

DeviceImage::~DeviceImage() = default;
DeviceImage::DeviceImage(DeviceImage&&) noexcept = default;
DeviceImage& DeviceImage::operator=(DeviceImage&&) noexcept = default;

const std::string& DeviceImage::name() const {
    return impl_->resource.name;
}
std::uint32_t DeviceImage::width() const {
    return impl_->resource.extent.width;
}
std::uint32_t DeviceImage::height() const {
    return impl_->resource.extent.height;
}
Format DeviceImage::format() const {
    return impl_->format;
}

}  // namespace helio
