#pragma once
/** @file The numbers in a PLY file's body, one after the other. */
#include "engine/scene/mesh/ply_header.hpp"
#include "engine/scene/mesh/ply_words.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace helio::mesh {

/** The number of a type that lies at `from`; `isSwapped` where the machine's byte order is the other one. */
double plyValue(const char* from, PlyType type, bool isSwapped);

class PlyValues {
public:
    PlyValues(const ByteSource& source, const PlyHeader& header, const std::string& file);

    /** Where the next values are, for messages: "vertex 7". The name must outlive its use. */
    void at(const std::string& element, std::uint64_t index) {
        element_ = &element;
        index_ = index;
    }
    /** The next value. Throws InputError where the file ends, or for a word that is no number. */
    double next(PlyType type);
    /** Goes past some values. */
    void skip(PlyType type, std::uint64_t count);
    /** Bytes from here to the end. */
    std::uint64_t left() const {
        return source_.size() - (isText_ ? words_.taken() : offset_ - (buffer_.size() - place_));
    }
    /** Bytes that so many values take at least. */
    double atLeast(PlyType type, double count) const {
        return count * (isText_ ? 2 : double(sizeOf(type))) - (isText_ ? 1 : 0);
    }
    double fraction() const;
    bool isText() const { return isText_; }
    bool isSwapped() const { return isSwapped_; }
    /** Of a binary file: the next whole records of so many bytes, at most `count`, as many as lie at hand;
     * none at the end of the file. Stays where it is. */
    std::span<const char> records(std::size_t size, std::uint64_t count);
    /** Goes past what records() gave. */
    void take(std::size_t bytes) { place_ += bytes; }
    /** Whether there is more than spaces. */
    bool hasMore();
    [[noreturn]] void refuse(const std::string& fault, const std::string& remedy) const;

private:
    /** Makes at least `size` bytes of the buffer available, where there are as many. */
    void fill(std::size_t size);
    double nextWord();

    const ByteSource& source_;
    const std::string& file_;
    bool isText_, isSwapped_;
    PlyWords words_;        ///< of a text; the buffer is for binary files
    std::uint64_t offset_;  ///< of what the buffer has not got yet
    std::vector<char> buffer_;
    std::size_t place_ = 0;  ///< in the buffer
    const std::string* element_ = nullptr;
    std::uint64_t index_ = 0;
};

}  // namespace helio::mesh
