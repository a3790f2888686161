#include "engine/scene/gltf/json_reader.hpp"

#include "engine/scene/gltf/build.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
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
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            const std::size_t begin = i + 1;
            for (++i; i < text.size() && text[i] != '"'; ++i) {
                if (text[i] == '\\') ++i;
            }
            if (i >= text.size()) break;  // an open string, which the parser refuses
            if (i - begin > longest) longStrings.push_back({begin, i});
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
    constexpr std::array others = std::to_array<std::string_view>(
        {"asset", "extensions", "extensionsRequired", "extensionsUsed", "extras", "scene"});
    return Document::isList(name) || std::find(others.begin(), others.end(), name) != others.end();
}

/** The value of a long string that is a member `uri` is this and its number; of others it is empty. */
constexpr char longStringMark = '\x01';

}  // namespace

/** Takes the JSON parser's events; keeps what is read later. */
class Document::Parser {
public:
    /** Of the whole document, into it. */
    explicit Parser(Document& document) : Parser(document, &document, 0, "document") {}
    /** Of an object of one of its lists. */
    Parser(const Document& document, std::size_t begin, std::string place)
        : Parser(document, nullptr, begin, std::move(place)) {}

    json parse() {
        const std::size_t first = std::size_t(
            std::lower_bound(long_.begin(), long_.end(), begin_,
                             [](const LongString& one, std::size_t at) { return one.begin < at; }) -
            long_.begin());
        nextLong_ = first;
        const TextIterator from(text_, std::span(long_).subspan(first), begin_, &place_);
        const bool isStrict = filled_ != nullptr;  // an object ends before the text does
        json::sax_parse(from, TextIterator(text_, {}, text_.size(), nullptr), this,
                        json::input_format_t::json, isStrict);
        return std::move(root_);
    }
    std::size_t bytes() const { return bytes_; }

    bool null() { return add(nullptr); }
    bool boolean(bool value) { return add(value); }
    bool number_integer(json::number_integer_t value) { return add(value); }
    bool number_unsigned(json::number_unsigned_t value) { return add(value); }
    bool number_float(json::number_float_t value, const std::string&) { return add(value); }
    bool binary(json::binary_t&) { return add(nullptr); }
    bool string(std::string& value) {
        if (isLong() && key_ == "uri") value = longStringMark + std::to_string(nextLong_ - 1);
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
            filled_->lists_.erase(key_);  // of a member that is there twice the last counts
        } else if (part == Part::Extras) {
            isNextLeftOut_ = key_ != "heliograph";
        } else if (part == Part::Extensions && !isSupported(key_)) {
            put(json::object());  // its name is told to the user
            isNextLeftOut_ = true;
        }
        return true;
    }
    bool parse_error(std::size_t byte, const std::string&, const json::exception& error) {
        for (std::size_t i = 0; i < long_.size() && byte > long_[i].begin; ++i)
            byte += long_[i].end - long_[i].begin;  // which the parser has not seen
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
    enum class Part { Document, List, Extras, Extensions, Other };
    struct Open {
        json* value;
        Part part;
    };

    Parser(const Document& document, Document* filled, std::size_t begin, std::string member)
        : file_(document.file_),
          text_(document.text_),
          long_(document.longStrings_),
          most_(maximumDocument(text_.size())),
          filled_(filled),
          begin_(begin),
          member_(std::move(member)) {}

    // Bytes in 64-bit libstdc++ with glibc's allocator, which rounds n to a multiple of 16 above n + 8.
    static constexpr std::size_t objectBytes = 64, arrayBytes = 32, memberBytes = 96;
    static std::size_t textBytes(const std::string& text) { return text.size() > 15 ? text.size() + 24 : 0; }
    static std::size_t stringBytes(const std::string& text) { return 48 + textBytes(text); }

    void charge(std::size_t bytes, std::size_t transient = 0) {
        bytes_ += bytes;
        if (bytes_ + transient <= most_ || bytes_ <= documentProportion * (place_ - begin_)) return;
        throw InputError(file_, member_,
                         fmt::format("unfolds the JSON to more than {} MiB, for a file of {} bytes",
                                     most_ >> 20, text_.size()),
                         "leave out elements that say nothing");
    }

    /** Whether the string that the parser has just passed is a long one, whose content was not read. */
    bool isLong() {
        const bool isLong = nextLong_ < long_.size() && long_[nextLong_].end + 1 == place_;
        nextLong_ += isLong ? 1 : 0;
        return isLong;
    }

    bool isLeftOut() const { return leftOut_ > 0 || isNextLeftOut_; }
    bool isInList() const { return leftOut_ == 0 && !open_.empty() && open_.back().part == Part::List; }

    /** Room in an array for one more, which doubles: old and new are there for a while. */
    template <class Elements>
    void chargeElement(const Elements& elements) {
        const std::size_t before = elements.capacity(), size = sizeof(typename Elements::value_type);
        if (elements.size() == before) charge(std::max<std::size_t>(before, 1) * size, before * size);
    }

    /** Into the array or object that is open. */
    json* put(json value) {
        if (open_.empty()) {
            root_ = std::move(value);
            return &root_;
        }
        json& parent = *open_.back().value;
        if (parent.is_array()) {
            auto& elements = parent.get_ref<json::array_t&>();
            chargeElement(elements);
            return &elements.emplace_back(std::move(value));
        }
        auto& members = parent.get_ref<json::object_t&>();
        const auto [member, isNew] = members.try_emplace(key_);
        if (isNew) charge(memberBytes + textBytes(key_));
        member->second = std::move(value);
        return &member->second;
    }

    bool add(json value) {
        if (isInList()) refuseInList();
        const bool isWholeExtras = !open_.empty() && open_.back().value->is_object() && key_ == "extras";
        if (!isLeftOut() && !isWholeExtras) put(std::move(value));
        isNextLeftOut_ = false;
        return true;
    }

    bool start(json container, std::size_t bytes) {
        if (isInList()) {
            if (!container.is_object()) refuseInList();
            chargeElement(*list_);
            list_->push_back(place_ - 1);
            ++leftOut_;
            return true;
        }
        const bool isMember = !open_.empty() && open_.back().value->is_object();
        const bool isArrayOfExtras = isMember && key_ == "extras" && container.is_array();
        if (isLeftOut() || isArrayOfExtras) {
            ++leftOut_;
            isNextLeftOut_ = false;
            return true;
        }
        charge(bytes);
        const Part part = partOf(container, isMember);
        if (part == Part::List) list_ = &filled_->lists_[key_];
        json* const value = put(std::move(container));
        open_.push_back({value, part});
        return true;
    }

    Part partOf(const json& container, bool isMember) const {
        if (open_.empty()) return filled_ != nullptr ? Part::Document : Part::Other;
        if (open_.back().part == Part::Document && container.is_array() && isList(key_)) return Part::List;
        if (!isMember) return Part::Other;
        if (key_ == "extras") return Part::Extras;
        return key_ == "extensions" ? Part::Extensions : Part::Other;
    }

    bool end() {
        if (leftOut_ > 0) {
            --leftOut_;
        } else {
            if (open_.back().part == Part::List) list_->push_back(place_);
            open_.pop_back();
        }
        return true;
    }

    [[noreturn]] void refuseInList() const {
        throw InputError(file_, fmt::format("{}[{}]", member_, list_->size()), "is no object",
                         "give an object");
    }

    const std::string& file_;
    std::string_view text_;
    const std::vector<LongString>& long_;
    std::size_t most_, bytes_ = 0;
    Document* filled_;               ///< nullptr for an object of a list
    std::size_t begin_, place_ = 0;  ///< of the parser in the text
    std::size_t nextLong_ = 0;
    std::vector<std::size_t>* list_ = nullptr;  ///< that is open
    json root_;
    std::vector<Open> open_;
    std::string key_;          ///< of the innermost object
    std::string member_;       ///< of the document, or where the object is in it
    std::size_t leftOut_ = 0;  ///< open arrays and objects of what is left out, or stays text
    bool isNextLeftOut_ = false;
};

Document::Document(const std::string& file, std::string_view text) : file_(file) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw InputError(file, "byte 0", "is text in UTF-16", "save it as UTF-8");
    const std::size_t end = text.find('\0');  // the parser takes it for the end
    if (text.find_first_not_of('\0', end) != text.npos && end != text.npos)
        throw InputError(file, fmt::format("byte {}", end), "has a NUL within its JSON",
                         "write the file again");
    text_ = text.substr(0, end);
    longStrings_ = scan(file, text_);
    Parser parser(*this);
    root_ = parser.parse();
    bytes_ = parser.bytes();
}

bool Document::isList(std::string_view name) {
    constexpr std::array lists = std::to_array<std::string_view>(
        {"accessors", "animations", "bufferViews", "buffers", "cameras", "images", "materials", "meshes",
         "nodes", "samplers", "scenes", "skins", "textures"});
    return std::find(lists.begin(), lists.end(), name) != lists.end();
}

std::size_t Document::size(std::string_view list) const {
    const auto found = lists_.find(list);
    return found == lists_.end() ? 0 : found->second.size() - 1;
}

std::size_t Document::longest(std::string_view list) const {
    const auto found = lists_.find(list);
    std::size_t longest = 0;
    if (found == lists_.end()) return longest;
    const std::vector<std::size_t>& begins = found->second;
    for (std::size_t i = 1; i < begins.size(); ++i) longest = std::max(longest, begins[i] - begins[i - 1]);
    return longest;
}

std::size_t Document::textBytes(std::string_view list, std::size_t index) const {
    const std::vector<std::size_t>& begins = lists_.find(list)->second;
    return begins[index + 1] - begins[index];
}

json Document::element(std::string_view list, std::size_t index, std::size_t* bytes) const {
    Parser parser(*this, lists_.find(list)->second[index], fmt::format("{}[{}]", list, index));
    json element = parser.parse();
    if (bytes != nullptr) *bytes += parser.bytes();
    return element;
}

std::optional<std::string_view> Document::longString(const std::string& value) const {
    std::size_t index = 0;
    if (value.empty() || value[0] != longStringMark) return std::nullopt;
    const char* const end = value.data() + value.size();
    const auto [at, error] = std::from_chars(value.data() + 1, end, index);
    if (at != end || error != std::errc() || index >= longStrings_.size()) return std::nullopt;
    return text_.substr(longStrings_[index].begin, longStrings_[index].end - longStrings_[index].begin);
}

}  // namespace helio::gltf
