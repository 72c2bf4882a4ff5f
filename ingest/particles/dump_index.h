#pragma once

#include "base/progress.h"
#include "ingest/particles/dump_header.h"

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace scree {

/// Where the frames of one dump file are.
struct DumpFileIndex {
    std::vector<DumpHeader> frames;
    std::optional<InputError> truncation; ///< why the last frame is incomplete; that frame is not in `frames`
    std::vector<std::string> notes; ///< remarks for the user, without the file's name
    std::set<std::string, std::less<>> type_names; ///< of the frames that give types by name only
    std::shared_ptr<const std::string> text; ///< the whole uncompressed file, if it was compressed and is not too large
};

/// Finds the frames of a file without holding the file in memory; lines of atoms are counted but not parsed.
///
/// keep: how many uncompressed bytes may be kept. Throws InputError at file:line when the file is not a dump, a header
/// cannot be read, or the number of lines of atoms is not the promised one. Throws Cancelled.
DumpFileIndex index_dump_file(const std::filesystem::path& path, size_t keep, const std::function<void(double)>& update,
                              const Progress& progress);

} // namespace scree
