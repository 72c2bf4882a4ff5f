#pragma once

#include "base/line_reader.h"
#include "ingest/particles/dump_header.h"
#include "ingest/particles/particle_frame.h"

#include <Imath/ImathMatrix.h>

#include <string>
#include <vector>

namespace scree {

/// Parses lines of atoms into the entries of a frame; several threads may parse blocks at once.
class DumpRowParser {
public:
    /// frame: the arrays to fill, already of the right size. All references must outlive the parser.
    DumpRowParser(const DumpHeader& header, const std::vector<std::string>& type_names, std::string file,
                  ParticleFrame& frame);

    /// Parses a block; its first line becomes row first_row of the frame. Throws InputError at file:line.
    void parse(const LineBlock& block, uint64_t first_row) const;

private:
    struct Row;
    [[noreturn]] void fail(uint64_t line, size_t column, std::string_view word, const std::string& expected,
                           const std::string& hint = "") const;
    [[noreturn]] void fail_columns(const LineBlock& block, uint64_t line, const char* line_start) const;
    [[noreturn]] void fail_place(const Row& row, uint64_t line, const Imath::V3d& place) const;
    size_t column_of(DumpField field) const;
    int32_t type_of_name(std::string_view name) const;
    void store(const Row& row, uint64_t index, uint64_t line) const;
    Imath::V3d unscaled(const Imath::V3d& written) const;

    const DumpHeader& header_;
    const DumpColumns& columns_;
    const std::vector<std::string>& type_names_;
    std::string file_;
    ParticleFrame& frame_;
    /// Maps the coordinates of the file to fractions of the box. On axes that are not scaled, the box's lower corner
    /// must be subtracted first.
    Imath::M33d to_fractions_;
};

} // namespace scree
