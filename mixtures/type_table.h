#pragma once

#include "mixtures/explicit_mixture.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// Types of spheres as a table on disk tells them.
struct TypeTable {
    std::vector<uint64_t> ids; ///< of each row; empty: the table tells none
    std::vector<uint16_t> code; ///< of each row: place in `words`
    std::vector<std::string> words; ///< the different types; whole numbers as such ("1" for "1.0")
};

/// Reads a text of rows (.csv, also .gz or .zst: a line of names, then a line a sphere, fields apart by comma,
/// semicolon or tab) or OpenVDB points (.vdb: an int32 attribute; without ids in the file's own order).
///
/// type, id: names of the columns (attributes); id may be missing there. Throws InputError naming file and line.
TypeTable read_type_table(const std::filesystem::path& path, const std::string& type = "type",
                          const std::string& id = "id");

/// The same from the attributes of the first PointDataGrid of an OpenVDB file.
TypeTable read_vdb_types(const std::filesystem::path& path, const std::string& type, const std::string& id);

/// The explicit mixture of a frame out of a table; by id where the table has ids, else by row.
///
/// type_of_word[k]: the grain type of words[k], below 65536. Throws InputError naming `place` when a sphere has no row
/// or two.
std::unique_ptr<ExplicitMixture> mixture_from_table(const TypeTable& table, const std::vector<uint32_t>& type_of_word,
                                                    const ParticleFrame& frame, const std::string& place);

} // namespace scree
