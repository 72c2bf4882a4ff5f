#pragma once

#include "render/stf/stf.h"

#include <filesystem>

namespace scree {

/// Writes shells, whole or not at all. key: what identifies them, see StfCache. Throws InputError.
void write_stf(const std::filesystem::path& file, const Stf& stf, uint64_t key);

/// Reads shells into `stf`, which must have their phase function. Throws InputError for a file that is damaged, of
/// another version or of another key.
void read_stf(const std::filesystem::path& file, uint64_t key, Stf& stf);

} // namespace scree
