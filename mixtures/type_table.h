#pragma once

#include "mixtures/explicit_mixture.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// Types of spheres, read from a table on disk.
struct TypeTable {
    std::vector<uint64_t> ids; ///< of each row; empty: the table has no ids
    std::vector<uint16_t> code; ///< of each row: index into `words`
    std::vector<std::string> words; ///< the different types; whole numbers without decimals ("1" for "1.0")
};

/// Reads a text table (.csv, also .gz or .zst: a line of column names, then one line per sphere, fields separated by
/// comma, semicolon or tab) or OpenVDB points (.vdb: an int32 attribute; without ids, in the file's own order).
///
/// type, id: names of the columns (attributes); the file may lack the ids. Throws InputError naming file and line.
TypeTable read_type_table(const std::filesystem::path& path, const std::string& type = "type",
                          const std::string& id = "id");

/// Reads the same table from the attributes of the first PointDataGrid of an OpenVDB file.
TypeTable read_vdb_types(const std::filesystem::path& path, const std::string& type, const std::string& id);

/// The explicit mixture of a frame from a table; spheres are matched by id if the table has ids, otherwise by row.
///
/// type_of_word[k]: the grain type of words[k], below 65536. Throws InputError naming `place` when a sphere has no row,
/// or when an id occurs twice.
std::unique_ptr<ExplicitMixture> mixture_from_table(const TypeTable& table, const std::vector<uint32_t>& type_of_word,
                                                    const ParticleFrame& frame, const std::string& place);

} // namespace scree
