#pragma once
/** @file Bytes of files, whole or in parts. */
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace helio {

/** Bytes that can be read from any place and any thread: a file's, or in memory. */
class ByteSource {
public:
    virtual ~ByteSource() = default;
    virtual std::uint64_t size() const = 0;
    /** Fills `bytes` with those from `offset` on, which must lie in the source. */
    virtual void read(std::uint64_t offset, std::span<std::byte> bytes) const = 0;
};

/** A regular file. The constructor and read() throw InputError, naming it, where it cannot be opened or read.
 */
class FileSource final : public ByteSource {
public:
    explicit FileSource(const std::filesystem::path& file);
    ~FileSource() override;
    FileSource(const FileSource&) = delete;
    FileSource& operator=(const FileSource&) = delete;
    std::uint64_t size() const override { return size_; }
    void read(std::uint64_t offset, std::span<std::byte> bytes) const override;

private:
    std::filesystem::path file_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

class MemorySource final : public ByteSource {
public:
    explicit MemorySource(std::span<const std::byte> content) : content_(content) {}
    std::uint64_t size() const override { return content_.size(); }
    void read(std::uint64_t offset, std::span<std::byte> bytes) const override;

private:
    std::span<const std::byte> content_;
};

/** The bytes of a regular file. Throws InputError naming it where it cannot be opened or read. */
std::vector<std::byte> readFile(const std::filesystem::path& file);

}  // namespace helio
