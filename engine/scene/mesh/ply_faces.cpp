#include "engine/scene/mesh/ply_faces.hpp"

#include "engine/scene/mesh/ply_values.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace helio::mesh {
namespace {

class FaceDecoder {
public:
    FaceDecoder(std::span<const char> records, const FaceLayout& layout, std::size_t corners, bool isSwapped,
                std::span<std::uint32_t> indices)
        : records_(records), layout_(layout), corners_(corners), isSwapped_(isSwapped), indices_(indices) {}

    /** The face's highest index; -1 for a face that is not like the others. */
    std::int64_t decode(std::size_t face) const {
        const char* at = &records_[face * layout_.size(corners_) + layout_.before];
        if (plyValue(at, layout_.countType, isSwapped_) != double(corners_)) return -1;
        at += sizeOf(layout_.countType);
        std::uint32_t first = 0, last = 0;
        std::int64_t highest = -1;
        std::uint32_t* to = &indices_[face * (corners_ - 2) * 3];
        for (std::size_t k = 0; k < corners_; ++k, at += sizeOf(layout_.type)) {
            const double value = plyValue(at, layout_.type, isSwapped_);
            if (!(value >= 0 && value <= std::numeric_limits<std::int32_t>::max()) ||
                value != std::floor(value)) {
                return -1;
            }
            const auto index = std::uint32_t(value);
            highest = std::max<std::int64_t>(highest, index);
            if (k == 0) first = index;
            if (k >= 2) {
                *to++ = first;
                *to++ = last;
                *to++ = index;
            }
            last = index;
        }
        return highest;
    }

private:
    std::span<const char> records_;
    const FaceLayout& layout_;
    std::size_t corners_;
    bool isSwapped_;
    std::span<std::uint32_t> indices_;
};

}  // namespace

std::optional<FaceLayout> faceLayout(const PlyElement& element) {
    FaceLayout layout;
    bool hasList = false;
    for (const PlyProperty& property : element.properties) {
        if (!property.isList) {
            (hasList ? layout.after : layout.before) += sizeOf(property.type);
            continue;
        }
        if (hasList) return std::nullopt;
        hasList = true;
        layout.countType = property.countType;
        layout.type = property.type;
    }
    return hasList ? std::optional(layout) : std::nullopt;
}

DecodedFaces decodeFaces(std::span<const char> records, const FaceLayout& layout, std::size_t corners,
                         bool isSwapped, std::span<std::uint32_t> indices) {
    const FaceDecoder decoder(records, layout, corners, isSwapped, indices);
    using Range = tbb::blocked_range<std::size_t>;
    const std::size_t size = records.size() / layout.size(corners);
    struct Faces {
        std::size_t wrong;  ///< the first; `size` for none
        std::int64_t highest = -1;
        std::size_t highestFace = 0;
    };
    const auto decode = [&](const Range& range, Faces faces) {
        for (std::size_t face = range.begin(); face < range.end() && faces.wrong == size; ++face) {
            const std::int64_t highest = decoder.decode(face);
            if (highest < 0) faces.wrong = face;
            if (highest > faces.highest) faces = {size, highest, face};
        }
        return faces;
    };
    const auto join = [&](const Faces& left, const Faces& right) {
        if (left.wrong < size) return left;
        return right.highest > left.highest ? right : Faces{right.wrong, left.highest, left.highestFace};
    };
    const Faces faces = tbb::parallel_reduce(Range(0, size, 2048), Faces{size}, decode, join);
    return {faces.wrong, faces.highest, faces.highestFace};
}

}  // namespace helio::mesh
