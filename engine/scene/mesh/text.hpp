#pragma once
/** @file Lines, words and numbers of mesh files in text, taken from blocks that hold whole lines. */
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace helio::mesh {

/** A fault in a text. `line` counts from 1 in the text that was parsed. */
struct TextFault {
    std::size_t line = 0;
    std::string fault;
    std::string remedy;
};

/** The lines of a text, ended by LF, CR LF or CR. A backslash before the end joins a line with the next. */
class Lines {
public:
    explicit Lines(std::string_view text) : rest_(text) {}
    /** False after the last. `line` is valid until the next call. */
    bool next(std::string_view& line);
    /** Of the last line given; of its first part for joined ones. */
    std::size_t number() const { return number_; }
    /** Lines gone past so far. */
    std::size_t count() const { return passed_; }

private:
    std::string_view physicalLine();

    std::string_view rest_;
    const char* feed_ = nullptr;  ///< the next LF, or the end
    std::string joined_;
    std::size_t number_ = 0, passed_ = 0;
};

/** Takes the next word off a line; empty at its end. Words are parted by spaces and tabs. */
std::string_view takeWord(std::string_view& line);
/** Without the byte order mark that some editors put first in UTF-8. */
std::string_view withoutMark(std::string_view text);
/** Whether a text begins with UTF-16's byte order mark. */
bool isUtf16(std::string_view text);
/** Without spaces and tabs at both ends. */
std::string_view trimmed(std::string_view text);
/** A finite number that single precision can hold; what is too small for it is 0. */
std::optional<float> parseReal(std::string_view word);
/** A finite number. */
std::optional<double> parseDouble(std::string_view word);
std::optional<std::int64_t> parseInteger(std::string_view word);
/** A piece of a file for a message: short, whatever it holds. */
std::string shown(std::string_view text);

}  // namespace helio::mesh
