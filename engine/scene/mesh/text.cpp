#include "engine/scene/mesh/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace helio::mesh {
namespace {

constexpr bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r';
}

std::string_view withoutPlus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

}  // namespace

std::string_view Lines::physicalLine() {
    if (feed_ < rest_.data())  // kept: a text may have a million CR before its next LF
        feed_ = rest_.data() + std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, std::size_t(feed_ - rest_.data()));
    const std::size_t carriage = line.find('\r');
    std::size_t used = std::min(line.size() + 1, rest_.size());
    if (carriage != std::string_view::npos) {
        if (carriage + 1 < line.size()) used = carriage + 1;  // it ends a line by itself
        line = line.substr(0, carriage);
    }
    rest_.remove_prefix(used);
    ++passed_;
    return line;
}

bool Lines::next(std::string_view& line) {
    if (rest_.empty()) return false;
    number_ = passed_ + 1;
    line = physicalLine();
    if (!line.ends_with('\\')) return true;
    joined_.clear();
    while (line.ends_with('\\')) {
        joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
        if (rest_.empty()) break;
        line = physicalLine();
        if (!line.ends_with('\\')) joined_.append(line);
    }
    line = joined_;
    return true;
}

std::string_view takeWord(std::string_view& line) {
    std::size_t begin = 0;
    while (begin < line.size() && isBlank(line[begin])) ++begin;
    std::size_t end = begin;
    while (end < line.size() && !isBlank(line[end])) ++end;
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

std::string_view withoutMark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    if (text.starts_with(mark)) text.remove_prefix(mark.size());
    return text;
}

bool isUtf16(std::string_view text) {
    return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    return text;
}

std::optional<double> parseDouble(std::string_view word) {
    word = withoutPlus(word);
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto [at, error] = std::from_chars(word.data(), end, value);
    if (at != end || word.empty()) return std::nullopt;
    if (error == std::errc::result_out_of_range) {  // too small, or too large
        const bool isSmall = word.find("e-") != word.npos || word.find("E-") != word.npos;
        return isSmall ? std::optional(0.0) : std::nullopt;
    }
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<float> parseReal(std::string_view word) {
    const std::optional<double> value = parseDouble(word);
    // What single precision rounds to infinity.
    if (!value || std::abs(*value) >= 0x1.ffffffp127) return std::nullopt;
    return float(*value);
}

std::optional<std::int64_t> parseInteger(std::string_view word) {
    word = withoutPlus(word);
    std::int64_t value = 0;
    const char* const end = word.data() + word.size();
    const auto [at, error] = std::from_chars(word.data(), end, value);
    if (word.empty() || at != end || error != std::errc()) return std::nullopt;
    return value;
}

std::string shown(std::string_view text) {
    std::string result = "'";
    for (const char c : text.substr(0, 40)) result.push_back(c >= ' ' && c <= '~' ? c : '?');
    return result + (text.size() > 40 ? "...'" : "'");
}

}  // namespace helio::mesh
