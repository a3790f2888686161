#pragma once
/** @file Corners that share all their attributes become one vertex. */
#include <array>
#include <cstdint>
#include <vector>

namespace helio::mesh {

/** Numbers distinct triples in the order in which they come. 20 to 28 bytes each. */
class VertexMap {
public:
    using Key = std::array<std::int32_t, 3>;

    std::uint32_t add(const Key& key) {
        if (keys_.size() * 2 >= slots_.size()) grow();
        for (std::size_t at = place(key);; at = (at + 1) & (slots_.size() - 1)) {
            if (slots_[at] == empty) {
                slots_[at] = std::uint32_t(keys_.size());
                keys_.push_back(key);
                return slots_[at];
            }
            if (keys_[slots_[at]] == key) return slots_[at];
        }
    }
    const std::vector<Key>& keys() const { return keys_; }

private:
    static constexpr std::uint32_t empty = 0xffffffffu;

    /** Mixed as by splitmix64: indices come in runs that must not fall on one place. */
    std::size_t place(const Key& key) const {
        std::uint64_t h = 0;
        for (const std::int32_t part : key) {
            h = (h ^ std::uint32_t(part)) * 0x9E3779B97F4A7C15ull;
            h ^= h >> 29;
        }
        return std::size_t(h) & (slots_.size() - 1);
    }
    void grow() {
        slots_.assign(slots_.empty() ? 64 : slots_.size() * 2, empty);
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            std::size_t at = place(keys_[i]);
            while (slots_[at] != empty) at = (at + 1) & (slots_.size() - 1);
            slots_[at] = std::uint32_t(i);
        }
    }

    std::vector<std::uint32_t> slots_;
    std::vector<Key> keys_;
};

}  // namespace helio::mesh
