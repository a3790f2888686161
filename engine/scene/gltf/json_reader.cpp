#include "engine/scene/gltf/json_reader.hpp"

#include "engine/scene/gltf/build.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <vector>

namespace helio::gltf {
namespace {

using nlohmann::json;

constexpr int maximumNesting = 100;

/** The parser keeps a string three times over. */
constexpr std::size_t longest = std::size_t(1) << 16;

/** What walks a document recurses; a deep file must not overflow its stack. Returns the long strings. */
std::vector<LongString> scan(const std::string& file, std::string_view text) {
    std::vector<LongString> longStrings;
    int depth = 0;
    std::size_t strings = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            const std::size_t begin = i + 1;
            for (++i; i < text.size() && text[i] != '"'; ++i) {
                if (text[i] == '\\') ++i;
            }
            if (i >= text.size()) break;  // an open string, which the parser refuses
            if (i - begin > longest) longStrings.push_back({strings, begin, i});
            ++strings;
        } else if (c == '{' || c == '[') {
            if (++depth > maximumNesting) {
                throw InputError(file, fmt::format("byte {}", i), "its JSON is nested too deeply",
                                 fmt::format("nest at most {} levels", maximumNesting));
            }
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return longStrings;
}

/** The text without the content of its long strings, a character at a time. */
class TextIterator {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    /** Writes to `place` where it is. */
    TextIterator(std::string_view text, std::span<const LongString> left, std::size_t at, std::size_t* place)
        : text_(text), left_(left), at_(at), place_(place) {
        skip();
    }
    reference operator*() const { return text_[at_]; }
    TextIterator& operator++() {
        ++at_;
        skip();
        return *this;
    }
    TextIterator operator++(int) {
        TextIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const TextIterator& other) const { return at_ == other.at_; }

private:
    void skip() {
        if (!left_.empty() && at_ == left_.front().begin) {
            at_ = left_.front().end;
            left_ = left_.subspan(1);
        }
        if (place_ != nullptr) *place_ = at_;
    }

    std::string_view text_;
    std::span<const LongString> left_;
    std::size_t at_;
    std::size_t* place_;
};

/** What the parser says is wrong, without its number and its place, in one line of printable ASCII: it quotes
 * the file, which may hold anything. */
std::string reasonOf(const json::exception& error) {
    std::string_view message = error.what();
    if (const auto end = message.find(": "); end != message.npos) message.remove_prefix(end + 2);
    std::string reason;
    for (const char c : message.substr(0, 200)) reason.push_back(c >= ' ' && c <= '~' ? c : '?');
    return reason;
}

bool isDocumentMember(std::string_view name) {
    constexpr std::array members = std::to_array<std::string_view>(
        {"accessors", "animations", "asset", "bufferViews", "buffers", "cameras", "extensions",
         "extensionsRequired", "extensionsUsed", "extras", "images", "materials", "meshes", "nodes",
         "samplers", "scene", "scenes", "skins", "textures"});
    return std::find(members.begin(), members.end(), name) != members.end();
}

/** Takes the parser's events; keeps what is read later. */
class DocumentBuilder {
public:
    DocumentBuilder(const std::string& file, std::string_view text)
        : file_(file), text_(text), most_(maximumDocument(text.size())), longStrings_(scan(file, text)) {}

    Json parse() {
        json::sax_parse(TextIterator(text_, longStrings_, 0, &place_),
                        TextIterator(text_, {}, text_.size(), nullptr), this);
        return {std::move(root_), bytes_, std::move(longStrings_)};
    }

    bool null() { return add(nullptr); }
    bool boolean(bool value) { return add(value); }
    bool number_integer(json::number_integer_t value) { return add(value); }
    bool number_unsigned(json::number_unsigned_t value) { return add(value); }
    bool number_float(json::number_float_t value, const std::string&) { return add(value); }
    bool binary(json::binary_t&) { return add(nullptr); }
    bool string(std::string& value) {
        if (isLong() && key_ == "uri") value = longStringMark + std::to_string(longStringsMet_ - 1);
        if (!isLeftOut()) charge(stringBytes(value));
        return add(std::move(value));
    }
    bool start_object(std::size_t) { return start(json::object(), objectBytes); }
    bool start_array(std::size_t) { return start(json::array(), arrayBytes); }
    bool end_object() { return end(); }
    bool end_array() { return end(); }
    bool key(std::string& name) {
        isLong();
        if (leftOut_ > 0) return true;
        const Part part = open_.back().part;
        key_ = std::move(name);
        isNextLeftOut_ = false;
        if (part == Part::Document) {
            member_ = key_;
            isNextLeftOut_ = !isDocumentMember(key_);
        } else if (part == Part::Extras) {
            isNextLeftOut_ = key_ != "heliograph";
        } else if (part == Part::Extensions && !isSupported(key_)) {
            put(json::object());  // its name is told to the user
            isNextLeftOut_ = true;
        }
        return true;
    }
    bool parse_error(std::size_t byte, const std::string&, const json::exception& error) {
        for (std::size_t i = 0; i < longStrings_.size() && byte > longStrings_[i].begin; ++i)
            byte += longStrings_[i].end - longStrings_[i].begin;  // which the parser has not seen
        const auto end = text_.begin() + std::ptrdiff_t(std::min(byte, text_.size()));
        const auto lines = std::count(text_.begin(), end, '\n');
        const std::string place = fmt::format("line {}, byte {}", lines + 1, byte);
        if (dynamic_cast<const json::out_of_range*>(&error) != nullptr) {
            throw InputError(file_, place, "its JSON has a number that is out of range",
                             "give numbers that double precision holds");
        }
        throw InputError(file_, place, "is no valid JSON: " + reasonOf(error),
                         "write the file again; it may be cut off");
    }

private:
    enum class Part { Document, Extras, Extensions, Other };
    struct Open {
        json* value;
        Part part;
    };

    // Bytes in 64-bit libstdc++ with glibc's allocator, which rounds n to a multiple of 16 above n + 8.
    static constexpr std::size_t objectBytes = 64, arrayBytes = 32, memberBytes = 96;
    static std::size_t textBytes(const std::string& text) { return text.size() > 15 ? text.size() + 24 : 0; }
    static std::size_t stringBytes(const std::string& text) { return 48 + textBytes(text); }

    void charge(std::size_t bytes, std::size_t transient = 0) {
        bytes_ += bytes;
        if (bytes_ + transient <= most_ || bytes_ <= documentProportion * place_) return;
        throw InputError(file_, member_.empty() ? "document" : member_,
                         fmt::format("unfolds the JSON to more than {} MiB, for a file of {} bytes",
                                     most_ >> 20, text_.size()),
                         "leave out elements that say nothing");
    }

    /** Whether the string that comes next in the text is a long one, whose content was not read. */
    bool isLong() {
        const bool isLong =
            longStringsMet_ < longStrings_.size() && longStrings_[longStringsMet_].ordinal == stringsMet_;
        longStringsMet_ += isLong ? 1 : 0;
        ++stringsMet_;
        return isLong;
    }

    bool isLeftOut() const { return leftOut_ > 0 || isNextLeftOut_; }

    /** Into the array or object that is open. */
    json* put(json value) {
        if (open_.empty()) {
            root_ = std::move(value);
            return &root_;
        }
        json& parent = *open_.back().value;
        if (parent.is_array()) {
            auto& elements = parent.get_ref<json::array_t&>();
            const std::size_t before = elements.capacity();
            if (elements.size() == before) {  // doubles: old and new are there for a while
                const std::size_t grown = before == 0 ? 1 : before;
                charge(grown * sizeof(json), before * sizeof(json));
            }
            return &elements.emplace_back(std::move(value));
        }
        auto& members = parent.get_ref<json::object_t&>();
        const auto [member, isNew] = members.try_emplace(key_);
        if (isNew) charge(memberBytes + textBytes(key_));
        member->second = std::move(value);
        return &member->second;
    }

    bool add(json value) {
        const bool isWholeExtras = !open_.empty() && open_.back().value->is_object() && key_ == "extras";
        if (!isLeftOut() && !isWholeExtras) put(std::move(value));
        isNextLeftOut_ = false;
        return true;
    }

    bool start(json container, std::size_t bytes) {
        const bool isMember = !open_.empty() && open_.back().value->is_object();
        const bool isArrayOfExtras = isMember && key_ == "extras" && container.is_array();
        if (isLeftOut() || isArrayOfExtras) {
            ++leftOut_;
            isNextLeftOut_ = false;
            return true;
        }
        charge(bytes);
        const Part part = open_.empty()                      ? Part::Document
                          : isMember && key_ == "extras"     ? Part::Extras
                          : isMember && key_ == "extensions" ? Part::Extensions
                                                             : Part::Other;
        json* const value = put(std::move(container));
        open_.push_back({value, part});
        return true;
    }

    bool end() {
        if (leftOut_ > 0) {
            --leftOut_;
        } else {
            open_.pop_back();
        }
        return true;
    }

    const std::string& file_;
    std::string_view text_;
    std::size_t most_, bytes_ = 0;
    std::vector<LongString> longStrings_;
    std::size_t place_ = 0;  ///< of the parser in the text
    std::size_t stringsMet_ = 0, longStringsMet_ = 0;
    json root_;
    std::vector<Open> open_;
    std::string key_, member_;  ///< of the innermost object; of the document
    std::size_t leftOut_ = 0;   ///< open arrays and objects of what is left out
    bool isNextLeftOut_ = false;
};

}  // namespace

Json readJson(const std::string& file, std::string_view text) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw InputError(file, "byte 0", "is text in UTF-16", "save it as UTF-8");
    const std::size_t end = text.find('\0');  // the parser takes it for the end
    if (text.find_first_not_of('\0', end) != text.npos && end != text.npos)
        throw InputError(file, fmt::format("byte {}", end), "has a NUL within its JSON",
                         "write the file again");
    text = text.substr(0, end);
    return DocumentBuilder(file, text).parse();
}

}  // namespace helio::gltf
