#pragma once

#include "render/stf/stf.h"

#include <filesystem>

namespace scree {

/// Writes shells so that they appear whole or not at all. key: of what they are; see stf_cache.h. Throws InputError.
void write_stf(const std::filesystem::path& file, const Stf& stf, uint64_t key);

/// Reads them into an Stf of the same phase function. Throws InputError for a file that is damaged, of another version
/// or another key.
void read_stf(const std::filesystem::path& file, uint64_t key, Stf& stf);

} // namespace scree
