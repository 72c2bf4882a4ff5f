#pragma once

#include "ingest/particles/dump_header.h"
#include "ingest/particles/dump_series.h"
#include "ingest/particles/particle_frame.h"

#include <string>
#include <vector>

namespace scree {

/// Parses the atoms of one frame.
///
/// reader: at the first line of atoms. type_names: the names of types 1, 2, ..., sorted.
/// Throws InputError at file:line, Cancelled.
ParticleFrame read_dump_rows(LineReader& reader, const DumpHeader& header, const std::vector<std::string>& type_names,
                             const ParticleReadOptions& options, const Progress& progress);

} // namespace scree
