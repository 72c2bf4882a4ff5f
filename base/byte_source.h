#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace scree {

/// Reads a file as a stream of bytes; gzip (any number of members) and Zstandard data are unpacked.
///
/// The file's first bytes decide its format, not its name. Memory use does not depend on the file's size.
class ByteSource {
public:
    /// Throws InputError when the file is missing, unreadable, a folder, or packed in another format (xz, bzip2, zip).
    explicit ByteSource(const std::filesystem::path& path);

    /// Reads the bytes of `text` as if they were the unpacked file `path`.
    ByteSource(std::filesystem::path path, std::shared_ptr<const std::string> text);

    ~ByteSource();
    ByteSource(ByteSource&&) noexcept;
    ByteSource& operator=(ByteSource&&) noexcept;

    /// Fills `out` with `size` bytes and returns their number, which is smaller than `size` only at the end.
    /// Throws InputError when packed data are damaged; packed data that merely end early set `truncated()`.
    size_t read(char* out, size_t size);

    /// Moves to an offset in bytes; allowed only when `seekable()`.
    void seek(uint64_t offset);
    bool seekable() const;

    /// Whether a packed stream ended early; known once `read` has reached the end.
    bool truncated() const;

    /// The fraction of the bytes on disk that was read, 0..1.
    double fraction() const;

    const std::filesystem::path& path() const;

    /// From now on keeps a copy of the bytes that `read` returns, unless the copy becomes larger than `limit` bytes.
    void keep(size_t limit);
    /// All bytes read since `keep`, or null when they were more than its limit.
    std::shared_ptr<const std::string> kept() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
