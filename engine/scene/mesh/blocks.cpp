#include "engine/scene/mesh/blocks.hpp"

namespace helio::mesh {

std::size_t cutAfterLine(std::string_view text) {
    for (std::size_t end = text.rfind('\n'); end != std::string_view::npos && end > 0;
         end = text.rfind('\n', end - 1)) {
        const std::size_t last = text[end - 1] == '\r' && end > 1 ? end - 2 : end - 1;
        if (text[last] != '\\') return end + 1;
    }
    if (text.find('\n') != std::string_view::npos || text.size() < 2) return 0;
    // Lines ended by CR alone. The last byte may be half of a CR LF.
    for (std::size_t end = text.rfind('\r', text.size() - 2); end != std::string_view::npos && end > 0;
         end = text.rfind('\r', end - 1)) {
        if (text[end - 1] != '\\') return end + 1;
    }
    return 0;
}

std::vector<char> BlockReader::next() {
    const std::uint64_t left = source_.size() - offset_;
    for (std::uint64_t size = size_;; size *= 2) {
        std::vector<char> block(std::size_t(std::min(size, left)));
        source_.read(offset_, std::as_writable_bytes(std::span(block)));
        const bool isRest = block.size() == left;
        const std::size_t length = isRest ? block.size() : cut_(std::string_view(block.data(), block.size()));
        if (length == 0 && !isRest) continue;
        block.resize(length);
        offset_ += length;
        return block;
    }
}

double BlockReader::fraction() const {
    return source_.size() == 0 ? 1.0 : double(offset_) / double(source_.size());
}

}  // namespace helio::mesh
