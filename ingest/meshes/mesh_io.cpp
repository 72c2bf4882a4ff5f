#include "base/text.h"
#include "ingest/meshes/formats/polygon_soup.h"
#include "ingest/meshes/mesh_topology.h"
#include "ingest/meshes/polygons.h"
#include "ingest/meshes/triangle_mesh.h"
#include "ingest/meshes/weld.h"

#include <fmt/format.h>

#include <fstream>

namespace scree {

namespace {

using mesh_formats::PolygonSoup;

struct Format {
    const char* extension;
    PolygonSoup (*read)(std::string_view content, const std::string& file);
};

constexpr Format formats[] = {{".obj", mesh_formats::read_obj},
                              {".ply", mesh_formats::read_ply},
                              {".stl", mesh_formats::read_stl},
                              {".off", mesh_formats::read_off}};

const Format& format_of(const std::filesystem::path& path)
{
    const std::string extension = lower_case(path.extension().string());
    for (const Format& format : formats) {
        if (extension == format.extension) return format;
    }
    throw InputError(path.string(),
                     extension.empty() ? "a name without extension" : "the extension " + in_quotes(extension),
                     ".obj, .ply, .stl or .off");
}

std::string content_of(const std::filesystem::path& path)
{
    const std::string place = path.string();
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw InputError(place, "no such file", "a mesh");
    if (std::filesystem::is_directory(status)) throw InputError(place, "a directory", "a mesh file");
    std::ifstream file(path, std::ios::binary);
    std::string content((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (!file.is_open() || file.bad())
        throw InputError(place, "a file that cannot be read", "a mesh file", "check its permissions");
    if (content.empty()) throw InputError(place, "an empty file", "a mesh");
    return content;
}

/// Throws on text in UTF-16; skips a byte order mark of UTF-8.
std::string_view without_byte_order_mark(std::string_view content, const std::string& place)
{
    if (content.starts_with("\xff\xfe") || content.starts_with("\xfe\xff")) {
        throw InputError(place, "text in UTF-16", "a binary file or text in ASCII or UTF-8");
    }
    if (content.starts_with("\xef\xbb\xbf")) content.remove_prefix(3);
    return content;
}

std::string place_of_face(const std::string& file, const PolygonSoup& soup, size_t face)
{
    return soup.face_lines.empty() ? file : fmt::format("{}:{}", file, soup.face_lines[face]);
}

/// The corners of a face; of successive corners at the same place only one is kept.
std::vector<uint32_t> distinct_corners(const PolygonSoup& soup, size_t begin, size_t end)
{
    const auto same = [&](uint32_t a, uint32_t b) { return soup.positions[a] == soup.positions[b]; };
    std::vector<uint32_t> corners;
    for (size_t i = begin; i < end; ++i) {
        if (corners.empty() || !same(corners.back(), soup.corners[i])) corners.push_back(soup.corners[i]);
    }
    while (corners.size() > 1 && same(corners.front(), corners.back())) corners.pop_back();
    return corners;
}

TriangleMesh triangulated(PolygonSoup&& soup, const std::string& file)
{
    TriangleMesh mesh;
    mesh.triangles.reserve(soup.face_ends.size());
    std::vector<std::array<uint32_t, 3>> parts;
    size_t begin = 0;
    for (size_t face = 0; face < soup.face_ends.size(); ++face) {
        const size_t end = soup.face_ends[face];
        for (size_t i = begin; i < end; ++i) {
            if (soup.corners[i] >= soup.positions.size()) {
                mesh_formats::throw_index_out_of_range(soup.corners[i], soup, place_of_face(file, soup, face));
            }
        }
        const std::vector<uint32_t> corners = distinct_corners(soup, begin, end);
        parts.clear();
        if (corners.size() >= 3 && !triangulate_polygon(soup.positions, corners, parts)) {
            throw InputError(place_of_face(file, soup, face),
                             fmt::format("a face of {} corners that crosses or overlaps itself{}", corners.size(),
                                         soup.face_lines.empty() ? fmt::format(" (face {})", face) : ""),
                             "faces that do neither", "export the mesh as triangles");
        }
        for (const auto& [a, b, c] : parts) {
            if (has_area(soup.positions[a], soup.positions[b], soup.positions[c])) mesh.triangles.push_back({a, b, c});
        }
        begin = end;
    }
    mesh.positions = std::move(soup.positions);
    return mesh;
}

/// The mesh with one vertex per place, in the order in which the places first occur in `positions`.
TriangleMesh welded(const TriangleMesh& mesh)
{
    const std::vector<uint32_t> first = first_at_same_position(mesh.positions);
    std::vector<uint32_t> renumbered(first.size());
    TriangleMesh result;
    for (size_t i = 0; i < first.size(); ++i) {
        if (first[i] == i) {
            renumbered[i] = static_cast<uint32_t>(result.positions.size());
            result.positions.push_back(mesh.positions[i]);
        } else {
            renumbered[i] = renumbered[first[i]];
        }
    }
    result.triangles.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles)
        result.triangles.push_back({renumbered[a], renumbered[b], renumbered[c]});
    return result;
}

} // namespace

TriangleMesh read_mesh(const std::filesystem::path& path)
{
    const std::string file = path.string();
    const std::string content = content_of(path);
    const Format& format = format_of(path);
    PolygonSoup soup = format.read(without_byte_order_mark(content, file), file);
    if (soup.positions.empty()) throw InputError(file, "a mesh without vertices", "vertices and faces");
    if (soup.face_ends.empty()) {
        throw InputError(file, fmt::format("{} vertices and no face", soup.positions.size()), "a mesh with faces");
    }
    TriangleMesh mesh = triangulated(std::move(soup), file);
    if (mesh.triangles.empty()) throw InputError(file, "no face with an area", "a mesh with faces");

    // STL has no shared vertices. Other formats have them, but exporters duplicate vertices where normals or texture
    // coordinates jump. Such vertices are merged if that closes the surface; parts that only touch stay separate.
    if (format.read == mesh_formats::read_stl) return welded(mesh);
    if (!topology_of(mesh).closed) {
        TriangleMesh joined = welded(mesh);
        if (joined.positions.size() < mesh.positions.size() && topology_of(joined).closed) return joined;
    }
    return mesh;
}

} // namespace scree
