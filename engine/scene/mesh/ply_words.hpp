#pragma once
/** @file The numbers in a text, parsed side by side a block ahead of their use. */
#include "engine/image/read_file.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace helio::mesh {

inline bool isSpace(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

class PlyWords {
public:
    /** Of what follows the first `offset` bytes. */
    PlyWords(const ByteSource& source, std::uint64_t offset) : source_(source), offset_(offset) {}

    /** Whether there is another word, be it a number or not. */
    bool hasMore();
    /** Whether it is a number; only after hasMore(). */
    bool isNumber() const { return at_ < parts_[part_].values.size(); }
    /** The word that is no number. */
    const std::string& fault() const { return parts_[part_].fault; }
    /** The number; goes past it. */
    double next() {
        const Part& part = parts_[part_];
        taken_ = offset_ + part.ends[at_];
        return part.values[at_++];
    }
    /** Bytes of the source up to the end of the last number that was taken. */
    std::uint64_t taken() const { return taken_; }

private:
    /** Of a block. What follows a word that is no number is not parsed. */
    struct Part {
        std::vector<double> values;
        std::vector<std::uint32_t> ends;  ///< of the values, in the block
        std::string fault;
        bool hasFault = false;
    };

    void readBlock();
    Part parse(std::size_t begin, std::size_t end) const;

    const ByteSource& source_;
    std::uint64_t offset_;  ///< of the block in the source
    std::vector<char> block_;
    std::vector<Part> parts_;
    std::size_t part_ = 0, at_ = 0;
    std::uint64_t taken_ = offset_;
};

}  // namespace helio::mesh
