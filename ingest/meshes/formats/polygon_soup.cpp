#include "ingest/meshes/formats/polygon_soup.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace scree::mesh_formats {

bool is_usable(const Imath::V3d& vertex)
{
    // False for NaN too.
    return std::abs(vertex.x) <= largest_coordinate && std::abs(vertex.y) <= largest_coordinate &&
           std::abs(vertex.z) <= largest_coordinate;
}

void check_vertex(const Imath::V3d& vertex, const std::string& place, const std::string& what)
{
    if (is_usable(vertex)) return;
    throw InputError(place, fmt::format("{} at ({}, {}, {})", what, vertex.x, vertex.y, vertex.z),
                     fmt::format("finite coordinates of at most {:g}", largest_coordinate));
}

uint32_t checked_index(int64_t index, const PolygonSoup& soup, const std::string& place)
{
    if (index < 0 || index >= std::numeric_limits<uint32_t>::max()) throw_index_out_of_range(index, soup, place);
    return static_cast<uint32_t>(index);
}

void throw_index_out_of_range(int64_t index, const PolygonSoup& soup, const std::string& place)
{
    const int64_t base = soup.index_base;
    const auto count = static_cast<int64_t>(soup.positions.size());
    throw InputError(place, fmt::format("a face with vertex {}", index + base),
                     count == 0 ? "vertices before faces"
                                : fmt::format("{} to {}, as there are {} vertices", base, count - 1 + base, count));
}

} // namespace scree::mesh_formats
