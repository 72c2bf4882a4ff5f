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
    std::optional<InputError> truncation; ///< why the last frame, which is not in `frames`, is not whole
    std::vector<std::string> notes; ///< what a reader should know, without the file's name
    std::set<std::string, std::less<>> type_names; ///< of the frames whose types are told by name only
    std::shared_ptr<const std::string> text; ///< the whole unpacked file, when it was packed and not too large to keep
};

/// Finds the frames of a file without holding it in memory: every line is passed by, none of atoms is parsed.
///
/// keep: how many unpacked bytes may be kept. Throws InputError at file:line when the file is no dump, a header
/// cannot be read, or the number of lines of atoms is not the promised one; Cancelled.
DumpFileIndex index_dump_file(const std::filesystem::path& path, size_t keep, const std::function<void(double)>& update,
                              const Progress& progress);

} // namespace scree
