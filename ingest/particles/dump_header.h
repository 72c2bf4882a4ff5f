#pragma once

#include "base/error.h"
#include "base/line_reader.h"
#include "ingest/particles/dump_columns.h"
#include "ingest/particles/particle_frame.h"

#include <memory>
#include <optional>
#include <string>

namespace scree {

/// What a dump says of a frame before its atoms.
struct DumpHeader {
    int64_t step = 0;
    std::optional<double> time;
    std::string units;
    std::optional<SimulationBox> box;
    uint64_t particles = 0;
    std::shared_ptr<const DumpColumns> columns;
    uint64_t atoms_line = 0; ///< number of the first line of atoms, from 1
    uint64_t atoms_offset = 0; ///< where that line begins, in unpacked bytes
};

/// What `read_dump_header` came upon.
struct DumpHeaderResult {
    std::optional<DumpHeader> header; ///< nothing: the file ended
    std::optional<InputError> truncation; ///< the file ended inside the header
};

/// Reads from "ITEM: TIMESTEP" (or what stands before it) to "ITEM: ATOMS".
///
/// previous: the header before in the same file, or null; LAMMPS writes the units once, and equal columns are shared.
/// Throws InputError at file:line.
DumpHeaderResult read_dump_header(LineReader& reader, const DumpHeader* previous);

/// The box of an `ITEM: BOX BOUNDS` line and the three lines under it.
///
/// words: what follows BOX BOUNDS: nothing, or boundaries (`pp ff ff`), or `xy xz yz` or `abc origin` before them.
/// Throws InputError (at `place`:`line`, line being that of words).
SimulationBox parse_dump_box(const std::vector<std::string>& words, const std::array<std::string, 3>& rows,
                             const std::string& place, uint64_t line);

} // namespace scree
