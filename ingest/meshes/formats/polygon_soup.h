#pragma once

#include "base/error.h"

#include <Imath/ImathVec.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scree::mesh_formats {

/// Polygons over shared vertices, as a file lists them.
struct PolygonSoup {
    std::vector<Imath::V3d> positions;
    std::vector<uint32_t> corners; ///< vertices of the faces, one face after the other, counted from 0
    std::vector<uint64_t> face_ends; ///< where each face ends in `corners`
    std::vector<uint64_t> face_lines; ///< the line each face begins on, or empty for binary files
    uint32_t index_base = 0; ///< the number of the first vertex in this format (OBJ: 1)

    /// Ends the face whose corners were appended. line: where it begins; 0 in a binary file.
    void end_face(uint64_t line)
    {
        face_ends.push_back(corners.size());
        if (line) face_lines.push_back(line);
    }
};

/// The readers parse the whole content of a file; `file` is its name, for messages. They throw InputError with the line
/// (text) or the vertex or face (binary). Every vertex they return passed `check_vertex`, but an index may be beyond
/// the last vertex.
PolygonSoup read_obj(std::string_view content, const std::string& file);
PolygonSoup read_off(std::string_view content, const std::string& file);
PolygonSoup read_ply(std::string_view content, const std::string& file);
PolygonSoup read_stl(std::string_view content, const std::string& file); ///< every corner has a vertex of its own

/// Larger coordinates are refused, because volumes must stay finite.
constexpr double largest_coordinate = 1e100;

/// Whether all three are finite and at most `largest_coordinate` in size.
bool is_usable(const Imath::V3d& vertex);

/// Throws InputError when the vertex is not usable.
void check_vertex(const Imath::V3d& vertex, const std::string& place, const std::string& what);

/// The index (counted from 0) as 32 bits; throws InputError when it is below 0 or does not fit.
uint32_t checked_index(int64_t index, const PolygonSoup& soup, const std::string& place);

/// Throws the InputError for an index that no vertex has. `index` counts from 0.
[[noreturn]] void throw_index_out_of_range(int64_t index, const PolygonSoup& soup, const std::string& place);

} // namespace scree::mesh_formats
