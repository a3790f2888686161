#include "engine/scene/mesh/ply_values.hpp"

#include "engine/scene/mesh/text.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace helio::mesh {
namespace {

constexpr std::size_t bufferSize = std::size_t(1) << 20;

template <class T>
double valueOf(const std::array<char, 8>& bytes) {
    T value{};
    std::memcpy(&value, bytes.data(), sizeof value);
    return double(value);
}

}  // namespace

PlyValues::PlyValues(const ByteSource& source, const PlyHeader& header, const std::string& file)
    : source_(source),
      file_(file),
      isText_(header.format == PlyHeader::Format::Ascii),
      isSwapped_((header.format == PlyHeader::Format::BigEndian) ==
                 (std::endian::native == std::endian::little)),
      words_(source, header.size),
      offset_(header.size) {}

void PlyValues::refuse(const std::string& fault, const std::string& remedy) const {
    throw InputError(file_, element_ == nullptr ? "" : fmt::format("{} {}", *element_, index_), fault,
                     remedy);
}

double PlyValues::fraction() const {
    return source_.size() == 0 ? 1.0 : 1.0 - double(left()) / double(source_.size());
}

void PlyValues::fill(std::size_t size) {
    if (buffer_.size() - place_ >= size || offset_ == source_.size()) return;
    buffer_.erase(buffer_.begin(), buffer_.begin() + std::ptrdiff_t(place_));
    place_ = 0;
    const std::size_t kept = buffer_.size();
    const auto more = std::size_t(std::min<std::uint64_t>(source_.size() - offset_, bufferSize));
    buffer_.resize(kept + more);
    source_.read(offset_, std::as_writable_bytes(std::span(buffer_)).subspan(kept));
    offset_ += more;
}

double plyValue(const char* from, PlyType type, bool isSwapped) {
    std::array<char, 8> bytes{};
    const std::size_t size = sizeOf(type);
    std::memcpy(bytes.data(), from, size);
    if (isSwapped) std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
    switch (type) {
        case PlyType::Int8:
            return valueOf<std::int8_t>(bytes);
        case PlyType::Uint8:
            return valueOf<std::uint8_t>(bytes);
        case PlyType::Int16:
            return valueOf<std::int16_t>(bytes);
        case PlyType::Uint16:
            return valueOf<std::uint16_t>(bytes);
        case PlyType::Int32:
            return valueOf<std::int32_t>(bytes);
        case PlyType::Uint32:
            return valueOf<std::uint32_t>(bytes);
        case PlyType::Float32:
            return valueOf<float>(bytes);
        default:
            return valueOf<double>(bytes);
    }
}

double PlyValues::next(PlyType type) {
    if (isText_) return nextWord();
    const std::size_t size = sizeOf(type);
    fill(size);
    if (buffer_.size() - place_ < size) refuse("the file ends here", "write it again; it may be cut off");
    const double value = plyValue(&buffer_[place_], type, isSwapped_);
    place_ += size;
    return value;
}

std::span<const char> PlyValues::records(std::size_t size, std::uint64_t count) {
    fill(std::size_t(std::min<std::uint64_t>(count, std::max<std::size_t>(bufferSize / size, 1)) * size));
    const std::uint64_t atHand = (buffer_.size() - place_) / size;
    return std::span(buffer_).subspan(place_, std::size_t(std::min(count, atHand)) * size);
}

bool PlyValues::hasMore() {
    if (isText_) return words_.hasMore();
    do {
        fill(1);
        while (place_ < buffer_.size() && isSpace(buffer_[place_])) ++place_;
    } while (place_ == buffer_.size() && offset_ < source_.size());
    return place_ < buffer_.size();
}

double PlyValues::nextWord() {
    if (!words_.hasMore()) refuse("the file ends here", "write it again; it may be cut off");
    if (!words_.isNumber())
        refuse(fmt::format("has {} for a number", shown(words_.fault())), "give finite numbers");
    return words_.next();
}

void PlyValues::skip(PlyType type, std::uint64_t count) {
    if (isText_) {
        for (std::uint64_t i = 0; i < count; ++i) nextWord();
        return;
    }
    if (double(count) * double(sizeOf(type)) > double(left()))
        refuse("the file ends here", "write it again; it may be cut off");
    std::uint64_t bytes = count * sizeOf(type);
    const std::uint64_t inBuffer = std::min<std::uint64_t>(bytes, buffer_.size() - place_);
    place_ += std::size_t(inBuffer);
    offset_ += bytes - inBuffer;
}

}  // namespace helio::mesh
