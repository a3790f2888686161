#include "engine/scene/mesh/ply_words.hpp"

#include "engine/scene/mesh/text.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <string_view>

namespace helio::mesh {
namespace {

constexpr std::size_t blockSize = std::size_t(1) << 20, partSize = std::size_t(1) << 15;

}  // namespace

bool PlyWords::hasMore() {
    while (true) {
        for (; part_ < parts_.size(); ++part_, at_ = 0) {
            if (at_ < parts_[part_].values.size() || parts_[part_].hasFault) return true;
        }
        offset_ += block_.size();
        if (offset_ == source_.size()) {
            block_.clear();
            return false;
        }
        readBlock();
    }
}

void PlyWords::readBlock() {
    // A word is longer than any number where a block has no space; its parts are numbers of their own then.
    block_.resize(std::size_t(std::min<std::uint64_t>(source_.size() - offset_, blockSize)));
    source_.read(offset_, std::as_writable_bytes(std::span(block_)));
    if (offset_ + block_.size() < source_.size()) {
        const auto space = std::find_if(block_.rbegin(), block_.rend(), isSpace);
        if (space != block_.rend()) block_.resize(std::size_t(block_.rend() - space));
    }
    std::vector<std::size_t> ends;
    for (std::size_t end = 0; end < block_.size();) {
        end = std::min(end + partSize, block_.size());
        while (end < block_.size() && !isSpace(block_[end])) ++end;
        ends.push_back(end);
    }
    parts_.assign(ends.size(), {});
    tbb::parallel_for(std::size_t(0), ends.size(),
                      [&](std::size_t i) { parts_[i] = parse(i == 0 ? 0 : ends[i - 1], ends[i]); });
    part_ = at_ = 0;
}

PlyWords::Part PlyWords::parse(std::size_t begin, std::size_t end) const {
    Part part;
    part.values.reserve((end - begin) / 4);
    part.ends.reserve((end - begin) / 4);
    while (true) {
        while (begin < end && isSpace(block_[begin])) ++begin;
        if (begin == end) return part;
        std::size_t after = begin;
        while (after < end && !isSpace(block_[after])) ++after;
        const std::string_view word(&block_[begin], after - begin);
        const std::optional<double> value = parseDouble(word);
        if (!value) {
            part.fault = word.substr(0, 512);
            part.hasFault = true;
            return part;
        }
        part.values.push_back(*value);
        part.ends.push_back(std::uint32_t(after));
        begin = after;
    }
}

}  // namespace helio::mesh
