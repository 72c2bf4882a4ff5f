#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace scree {

/// A file as a stream of bytes; gzip (any number of members) and Zstandard are unpacked on the way.
///
/// What a file is, is told by its first bytes and not by its name. Memory does not depend on the file's size.
class ByteSource {
public:
    /// Throws InputError when the file is missing, unreadable, no file, or packed in another way (xz, bzip2, zip).
    explicit ByteSource(const std::filesystem::path& path);

    /// The bytes of `text`, as if they were the plain file `path`.
    ByteSource(std::filesystem::path path, std::shared_ptr<const std::string> text);

    ~ByteSource();
    ByteSource(ByteSource&&) noexcept;
    ByteSource& operator=(ByteSource&&) noexcept;

    /// Fills `out` with `size` bytes; returns fewer only at the end.
    /// Throws InputError when packed data are damaged; packed data that merely end early set `truncated()`.
    size_t read(char* out, size_t size);

    /// Goes to a place in the bytes; only when `seekable()`.
    void seek(uint64_t offset);
    bool seekable() const;

    /// Whether a packed stream ended in its middle; known once `read` came to the end.
    bool truncated() const;

    /// The part of the file (as it lies on disk) that was read, 0..1.
    double fraction() const;

    const std::filesystem::path& path() const;

    /// From here on keeps a copy of what `read` returns, unless it becomes larger than `limit` bytes.
    void keep(size_t limit);
    /// Everything read since `keep`, or nothing when that was too much.
    std::shared_ptr<const std::string> kept() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
