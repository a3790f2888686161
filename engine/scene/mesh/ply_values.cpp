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
/** A word of text longer than any number. */
constexpr std::size_t longestWord = 512;

template <class T>
double valueOf(const std::array<char, 8>& bytes) {
    T value{};
    std::memcpy(&value, bytes.data(), sizeof value);
    return double(value);
}

bool isSpace(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace

PlyValues::PlyValues(const ByteSource& source, const PlyHeader& header, const std::string& file)
    : source_(source),
      file_(file),
      isText_(header.format == PlyHeader::Format::Ascii),
      isSwapped_((header.format == PlyHeader::Format::BigEndian) ==
                 (std::endian::native == std::endian::little)),
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

double PlyValues::next(PlyType type) {
    if (isText_) return nextWord();
    const std::size_t size = sizeOf(type);
    fill(size);
    if (buffer_.size() - place_ < size) refuse("the file ends here", "write it again; it may be cut off");
    std::array<char, 8> bytes{};
    std::memcpy(bytes.data(), &buffer_[place_], size);
    place_ += size;
    if (isSwapped_) std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
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

bool PlyValues::hasMore() {
    while (true) {
        fill(longestWord);
        while (place_ < buffer_.size() && isSpace(buffer_[place_])) ++place_;
        if (place_ < buffer_.size()) return true;
        if (offset_ == source_.size()) return false;
    }
}

double PlyValues::nextWord() {
    if (!hasMore()) refuse("the file ends here", "write it again; it may be cut off");
    fill(longestWord);
    std::size_t end = place_;
    while (end < buffer_.size() && end - place_ < longestWord && !isSpace(buffer_[end])) ++end;
    const std::string_view word(&buffer_[place_], end - place_);
    const std::optional<double> value = parseDouble(word);
    if (!value) refuse(fmt::format("has {} for a number", shown(word)), "give finite numbers");
    place_ = end;
    return *value;
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
