#pragma once
/** @file
 * A long text in blocks that are parsed side by side and put together in order: what is in memory at once is
 * a few blocks, whatever the file's size.
 */
#include "engine/image/read_file.hpp"
#include "engine/scene/load_monitor.hpp"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace helio::mesh {

/** How many of the first bytes of a text make a block that can be parsed by itself; 0 for none. */
using Cut = std::size_t (*)(std::string_view text);

/** After the last line end that joins no lines. */
std::size_t cutAfterLine(std::string_view text);

class BlockReader {
public:
    BlockReader(const ByteSource& source, Cut cut, std::size_t size = std::size_t(1) << 20)
        : source_(source), cut_(cut), size_(size) {}
    /** The next block, empty at the end. What follows the last cut is a block too. */
    std::vector<char> next();
    double fraction() const;

private:
    const ByteSource& source_;
    Cut cut_;
    std::size_t size_;
    std::uint64_t offset_ = 0;
};

/** Calls parse(block) for every block from any thread, consume(result) with its results in order, one at a
 * time. Exceptions come through. */
template <class Parse, class Consume>
void forEachBlock(const ByteSource& source, Cut cut, LoadMonitor& monitor, Parse&& parse, Consume&& consume) {
    using Block = std::shared_ptr<std::vector<char>>;
    using Result = std::shared_ptr<decltype(parse(std::string_view()))>;
    BlockReader reader(source, cut);
    const auto read = [&](tbb::flow_control& control) -> Block {
        monitor.report("geometry", reader.fraction());
        auto block = std::make_shared<std::vector<char>>(reader.next());
        if (block->empty()) control.stop();
        return block;
    };
    const auto parseBlock = [&](const Block& block) {
        using Parsed = decltype(parse(std::string_view()));
        return std::make_shared<Parsed>(parse(std::string_view(block->data(), block->size())));
    };
    const auto consumeResult = [&](const Result& result) { consume(std::move(*result)); };
    const std::size_t inFlight = 2 * std::max(1u, std::thread::hardware_concurrency());
    tbb::parallel_pipeline(
        inFlight, tbb::make_filter<void, Block>(tbb::filter_mode::serial_in_order, read) &
                      tbb::make_filter<Block, Result>(tbb::filter_mode::parallel, parseBlock) &
                      tbb::make_filter<Result, void>(tbb::filter_mode::serial_in_order, consumeResult));
}

}  // namespace helio::mesh
