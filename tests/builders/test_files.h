#pragma once

#include "base/error.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace scree::test {

/// A folder of its own for a test's files; removed with everything in it.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path path(const std::string& name = "") const { return path_ / name; }

    /// Writes a file and returns its name.
    std::string write(const std::string& name, const std::string& bytes) const;

private:
    std::filesystem::path path_;
};

std::string read_bytes(const std::filesystem::path& path);

/// The bytes as one gzip member; as one Zstandard frame.
std::string gzip(const std::string& bytes);
std::string zstd(const std::string& bytes);

std::vector<std::string> split_lines(const std::string& text);
std::string join_lines(const std::vector<std::string>& lines);
std::string replace_all(std::string text, const std::string& what, const std::string& with);

/// The InputError that `work` throws, or nothing when it throws none.
std::optional<InputError> input_error_of(const std::function<void()>& work);

} // namespace scree::test
