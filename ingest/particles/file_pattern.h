#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// The files that a pattern names, sorted by name with numbers as numbers ("a2" before "a10").
///
/// pattern: a file, a glob (`pour.*.dump`, `run?/a[12].dump`) or a printf pattern for the number in the file's name
/// (`pour.%04d.dump`; also `%d`). A file that bears the very name wins. Throws InputError when nothing matches.
std::vector<std::filesystem::path> files_of_pattern(const std::string& pattern);

} // namespace scree
