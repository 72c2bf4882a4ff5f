#pragma once

#include <filesystem>
#include <string_view>

namespace scree {

/// A file that appears whole or not at all: written under another name in the same folder, then renamed.
class AtomicFile {
public:
    /// target: path of the finished file; an existing file there stays until `commit`.
    /// Throws InputError when the folder does not exist or cannot be written.
    explicit AtomicFile(std::filesystem::path target);

    /// Removes the temporary file unless it was committed.
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// The path to write to: in the target's folder, with its extension (some writers choose the format by extension).
    const std::filesystem::path& temporary() const { return temporary_; }

    /// Renames the finished file to its target. Throws InputError when that fails.
    void commit();

private:
    std::filesystem::path target_, temporary_;
    bool committed_ = false;
};

/// Writes a file that appears whole or not at all. Throws InputError.
void write_whole(const std::filesystem::path& path, std::string_view text);

} // namespace scree
