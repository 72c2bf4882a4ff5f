#pragma once

#include "base/error.h"
#include "base/line_reader.h"
#include "ingest/particles/dump_columns.h"
#include "ingest/particles/particle_frame.h"

#include <memory>
#include <optional>
#include <string>

namespace scree {

/// The header of one frame of a dump: everything before its atoms.
struct DumpHeader {
    int64_t step = 0;
    std::optional<double> time;
    std::string units;
    std::optional<SimulationBox> box;
    uint64_t particles = 0;
    std::shared_ptr<const DumpColumns> columns;
    uint64_t atoms_line = 0; ///< number of the first line of atoms, from 1
    uint64_t atoms_offset = 0; ///< where that line begins, in uncompressed bytes
};

/// What `read_dump_header` found.
struct DumpHeaderResult {
    std::optional<DumpHeader> header; ///< empty: the file ended
    std::optional<InputError> truncation; ///< the file ended inside the header
};

/// Reads from "ITEM: TIMESTEP" (or the items before it) to "ITEM: ATOMS".
///
/// previous: the header of the frame before in the same file, or null. It supplies the units, which LAMMPS writes only
/// once, and equal columns are shared with it.
/// Throws InputError at file:line.
DumpHeaderResult read_dump_header(LineReader& reader, const DumpHeader* previous);

/// Parses the box of an `ITEM: BOX BOUNDS` line and the three lines under it.
///
/// words: the words after BOX BOUNDS: optionally `xy xz yz` or `abc origin`, then optionally three boundaries
/// (`pp ff ff`). line: the line of these words. Throws InputError at `place`:LINE.
SimulationBox parse_dump_box(const std::vector<std::string>& words, const std::array<std::string, 3>& rows,
                             const std::string& place, uint64_t line);

} // namespace scree
