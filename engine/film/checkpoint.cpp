#include "engine/film/checkpoint.hpp"

#include "engine/image/read_file.hpp"

#include <heliograph/error.hpp>
#include <heliograph/file.hpp>

#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace helio {
namespace {

/** The first bytes of every checkpoint, with the format's version. */
constexpr std::string_view magic = "heliograph checkpoint 2\n";

/** FNV-1a over 8-byte words. */
std::uint64_t checksum(const std::byte* data, std::size_t size) {
    std::uint64_t hash = 14695981039346656037ull;
    for (std::size_t i = 0; i < size; i += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, data + i, std::min<std::size_t>(8, size - i));
        hash = (hash ^ word) * 1099511628211ull;
        hash ^= hash >> 29;
    }
    return hash;
}

class Writer {
public:
    explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}
    void raw(const void* data, std::size_t size) {
        const auto* first = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), first, first + size);
    }
    template <typename T>
    void value(const T& x) {
        static_assert(std::is_trivially_copyable_v<T>);
        raw(&x, sizeof x);
    }
    void text(const std::string& s) {
        value(std::uint64_t(s.size()));
        raw(s.data(), s.size());
    }
    void floats(const std::vector<float>& v) {
        value(std::uint64_t(v.size()));
        raw(v.data(), v.size() * sizeof(float));
    }

private:
    std::vector<std::byte>& bytes_;
};

class Reader {
public:
    Reader(const std::vector<std::byte>& bytes, std::size_t at, std::size_t end)
        : bytes_(bytes), at_(at), end_(end) {}
    template <typename T>
    T value() {
        T x{};
        raw(&x, sizeof x);
        return x;
    }
    std::string text() {
        std::string s(length(1), '\0');
        raw(s.data(), s.size());
        return s;
    }
    std::vector<float> floats() {
        std::vector<float> v(length(sizeof(float)));
        raw(v.data(), v.size() * sizeof(float));
        return v;
    }
    bool failed() const { return failed_ || at_ != end_; }

private:
    /** A count of things of `size` bytes, 0 where the file has not so many. */
    std::size_t length(std::size_t size) {
        const auto count = value<std::uint64_t>();
        if (count <= (end_ - at_) / size) return std::size_t(count);
        failed_ = true;
        return 0;
    }
    void raw(void* data, std::size_t size) {
        if (size > end_ - at_) {
            failed_ = true;
            return;
        }
        if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
        at_ += size;
    }
    const std::vector<std::byte>& bytes_;
    std::size_t at_, end_;
    bool failed_ = false;
};

}  // namespace

void saveCheckpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
    std::vector<std::byte> bytes;
    bytes.reserve(4096 + (checkpoint.shares.size() + checkpoint.film.size() + checkpoint.state.size()) *
                             sizeof(float));
    Writer out(bytes);
    out.raw(magic.data(), magic.size());
    out.value(std::uint64_t(checkpoint.settings.size()));
    for (const auto& [name, setting] : checkpoint.settings) {
        out.text(name);
        out.text(setting);
    }
    out.value(checkpoint.reached);
    out.value(checkpoint.end);
    out.value(checkpoint.seconds);
    out.value(checkpoint.cpuSeconds);
    out.value(checkpoint.counters);
    out.floats(checkpoint.shares);
    out.floats(checkpoint.film);
    out.floats(checkpoint.state);
    out.value(checksum(bytes.data(), bytes.size()));
    writeFileAtomically(file, bytes);
}

Checkpoint loadCheckpoint(const std::filesystem::path& file,
                          const std::vector<std::pair<std::string, std::string>>& settings) {
    const std::vector<std::byte> bytes = readFile(file);
    const auto refuse = [&](const std::string& fault, const std::string& remedy) {
        throw InputError(file.string(), "", fault, remedy);
    };
    if (bytes.size() < magic.size() + 8 || std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
        refuse("is no checkpoint of this version", "give the file that --checkpoint wrote");
    const std::size_t end = bytes.size() - 8;
    std::uint64_t sum = 0;
    std::memcpy(&sum, bytes.data() + end, 8);
    if (sum != checksum(bytes.data(), end)) refuse("is damaged", "render again without --resume");

    Checkpoint checkpoint;
    Reader in(bytes, magic.size(), end);
    const auto count = in.value<std::uint64_t>();
    for (std::uint64_t i = 0; i < count && i < 1000; ++i) {
        std::string name = in.text();
        checkpoint.settings.emplace_back(std::move(name), in.text());
    }
    if (checkpoint.settings.size() != settings.size())
        refuse("is no checkpoint of this version", "render again without --resume");
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const auto& [name, was] = checkpoint.settings[i];
        if (checkpoint.settings[i] == settings[i]) continue;
        refuse(fmt::format("was written with another {}: {} there, {} now", name, was, settings[i].second),
               "give the options and scene it was written with, or render without --resume");
    }
    checkpoint.reached = in.value<std::uint32_t>();
    checkpoint.end = in.value<std::uint32_t>();
    checkpoint.seconds = in.value<double>();
    checkpoint.cpuSeconds = in.value<double>();
    checkpoint.counters = in.value<std::array<std::uint64_t, 5>>();
    checkpoint.shares = in.floats();
    checkpoint.film = in.floats();
    checkpoint.state = in.floats();
    if (in.failed()) refuse("is damaged", "render again without --resume");
    return checkpoint;
}

}  // namespace helio
