#include "ingest/particles/file_pattern.h"

#include "base/error.h"
#include "base/text.h"

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <optional>

namespace scree {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The order of names in which runs of digits compare as numbers.
bool natural_less(const std::string& a, const std::string& b)
{
    size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (!is_digit(a[i]) || !is_digit(b[j])) {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i;
            ++j;
            continue;
        }
        while (i < a.size() && a[i] == '0') ++i;
        while (j < b.size() && b[j] == '0') ++j;
        size_t i_end = i, j_end = j;
        while (i_end < a.size() && is_digit(a[i_end])) ++i_end;
        while (j_end < b.size() && is_digit(b[j_end])) ++j_end;
        if (i_end - i != j_end - j) return i_end - i < j_end - j;
        const int order = a.compare(i, i_end - i, b, j, j_end - j);
        if (order != 0) return order < 0;
        i = i_end;
        j = j_end;
    }
    if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
    return a < b;
}

/// The %d of a printf pattern.
struct NumberField {
    size_t begin = 0, end = 0; ///< where "%04d" stands in the name
    size_t width = 0;
    bool zeros = false;
};

std::optional<NumberField> find_number_field(const std::string& name)
{
    for (size_t i = name.find('%'); i != std::string::npos; i = name.find('%', i + 1)) {
        NumberField field{i, i + 1, 0, false};
        if (field.end < name.size() && name[field.end] == '0') {
            field.zeros = true;
            ++field.end;
        }
        while (field.end < name.size() && is_digit(name[field.end]) && field.width < 100)
            field.width = 10 * field.width + static_cast<size_t>(name[field.end++] - '0');
        while (field.end < name.size() && (name[field.end] == 'l' || name[field.end] == 'z')) ++field.end;
        if (field.end < name.size() && (name[field.end] == 'd' || name[field.end] == 'i' || name[field.end] == 'u')) {
            ++field.end;
            return field;
        }
    }
    return std::nullopt;
}

/// Whether printf makes `name` from the pattern for some number.
bool matches(const std::string& name, const std::string& pattern, const NumberField& field)
{
    const std::string head = pattern.substr(0, field.begin), tail = pattern.substr(field.end);
    if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) return false;
    const std::string digits = name.substr(head.size(), name.size() - head.size() - tail.size());
    if (!std::ranges::all_of(digits, is_digit)) return false;
    if (field.zeros && digits.size() < field.width) return false;
    const bool padded = digits.size() > 1 && digits[0] == '0';
    return !padded || (field.zeros && digits.size() <= field.width);
}

std::vector<std::filesystem::path> printf_matches(const std::filesystem::path& pattern, const NumberField& field)
{
    std::vector<std::filesystem::path> files;
    const std::filesystem::path folder = pattern.parent_path();
    std::error_code failure;
    for (auto entry = std::filesystem::directory_iterator(folder.empty() ? "." : folder, failure);
         !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure)) {
        const std::string name = entry->path().filename().string();
        if (matches(name, pattern.filename().string(), field)) files.push_back(folder / name);
    }
    return files;
}

std::vector<std::filesystem::path> glob_matches(const std::string& pattern)
{
    std::vector<std::filesystem::path> files;
    glob_t found{};
    if (::glob(pattern.c_str(), 0, nullptr, &found) == 0)
        for (size_t i = 0; i < found.gl_pathc; ++i)
            if (!std::filesystem::is_directory(found.gl_pathv[i])) files.emplace_back(found.gl_pathv[i]);
    ::globfree(&found);
    return files;
}

} // namespace

std::vector<std::filesystem::path> files_of_pattern(const std::string& pattern)
{
    std::error_code ignored;
    if (pattern.empty()) throw InputError("''", "an empty name", "the name or pattern of a dump");
    if (std::filesystem::exists(pattern, ignored)) return {pattern};

    std::vector<std::filesystem::path> files;
    bool is_pattern = false;
    if (const auto field = find_number_field(std::filesystem::path(pattern).filename().string())) {
        is_pattern = true;
        files = printf_matches(pattern, *field);
    }
    if (files.empty() && pattern.find_first_of("*?[") != std::string::npos) {
        is_pattern = true;
        files = glob_matches(pattern);
    }
    if (!is_pattern) return {pattern}; // the error comes when the file is opened
    if (files.empty())
        throw InputError(pattern, "no file that matches", "at least one file",
                         "patterns are * ? [ab] or %d %04d; quote them from the shell");
    std::ranges::sort(files, [](const auto& a, const auto& b) { return natural_less(a.string(), b.string()); });
    return files;
}

} // namespace scree
