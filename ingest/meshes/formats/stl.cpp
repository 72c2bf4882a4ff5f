// STL, text (`solid ... facet ... vertex x y z ...`) and binary (80 bytes, the count, 50 bytes a triangle).
#include "base/text.h"
#include "ingest/meshes/formats/byte_reader.h"
#include "ingest/meshes/formats/polygon_soup.h"
#include "ingest/meshes/formats/text_scanner.h"

#include <fmt/format.h>

namespace scree::mesh_formats {

namespace {

constexpr size_t header_size = 84, triangle_size = 50;

PolygonSoup read_binary(std::string_view content, uint32_t triangles, const std::string& file)
{
    ByteReader bytes(content.substr(header_size), std::endian::little);
    PolygonSoup soup;
    soup.positions.reserve(size_t{3} * triangles);
    for (uint32_t i = 0; i < triangles; ++i) {
        bytes.skip(12); // the normal; the order of the vertices is more reliable
        for (int k = 0; k < 3; ++k) {
            float x = 0, y = 0, z = 0;
            bytes.read(x);
            bytes.read(y);
            bytes.read(z);
            const Imath::V3d p(x, y, z);
            if (!is_usable(p)) check_vertex(p, file, fmt::format("a vertex of triangle {}", i));
            soup.corners.push_back(checked_index(static_cast<int64_t>(soup.positions.size()), soup, file));
            soup.positions.push_back(p);
        }
        bytes.skip(2);
        soup.end_face(0);
    }
    return soup;
}

void read_facet(TextScanner& text, PolygonSoup& soup)
{
    const uint64_t line = text.line();
    text.next_line(); // the normal
    size_t corners = 0;
    for (;;) {
        const std::string_view word = text.word();
        const std::string keyword = lower_case(word);
        if (keyword == "endfacet") break;
        if (keyword == "outer" || keyword == "endloop") {
            text.next_line();
        } else if (keyword == "vertex") {
            Imath::V3d p;
            p.x = text.number(text.word_in_line(), "the x of a vertex");
            p.y = text.number(text.word_in_line(), "the y of a vertex");
            p.z = text.number(text.word_in_line(), "the z of a vertex");
            if (!is_usable(p)) check_vertex(p, text.place(), "a vertex");
            soup.corners.push_back(checked_index(static_cast<int64_t>(soup.positions.size()), soup, text.place()));
            soup.positions.push_back(p);
            ++corners;
        } else {
            throw InputError(text.place(), word.empty() ? "the end of the file in a facet" : quoted(word),
                             "'vertex x y z' or 'endfacet'");
        }
    }
    if (corners < 3) throw InputError(text.place(), fmt::format("a facet of {} vertices", corners), "three");
    soup.end_face(line);
    text.next_line();
}

PolygonSoup read_text(std::string_view content, const std::string& file)
{
    TextScanner text(content, file, {});
    PolygonSoup soup;
    bool open = false;
    for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
        const std::string keyword = lower_case(word);
        if (keyword == "facet") {
            read_facet(text, soup);
        } else if (keyword == "solid" || keyword == "endsolid") {
            open = keyword == "solid";
            text.next_line(); // a name, which may be any words
        } else {
            throw InputError(text.place(), quoted(word), "'facet', 'solid' or 'endsolid'");
        }
    }
    if (open) throw InputError(text.place(), "the end of the file", "'endsolid'", "the file may be cut off");
    return soup;
}

} // namespace

PolygonSoup read_stl(std::string_view content, const std::string& file)
{
    uint32_t triangles = 0;
    const bool has_count = content.size() >= header_size;
    if (has_count) ByteReader(content.substr(header_size - 4), std::endian::little).read(triangles);
    const uint64_t announced = header_size + triangle_size * uint64_t{triangles};

    // Binary files may begin with "solid" too; their size or a zero byte distinguishes them from text.
    if (has_count && content.size() == announced) return read_binary(content, triangles, file);
    const size_t text_begin = content.find_first_not_of(" \t\r\n");
    const bool text = text_begin != std::string_view::npos && lower_case(content.substr(text_begin, 5)) == "solid" &&
                      content.substr(0, 1024).find('\0') == std::string_view::npos;
    if (text) return read_text(content, file);
    if (has_count && content.size() > announced && triangles > 0) return read_binary(content, triangles, file);
    throw InputError(file,
                     has_count ? fmt::format("{} bytes and a count of {} triangles", content.size(), triangles)
                               : fmt::format("{} bytes that do not begin with 'solid'", content.size()),
                     has_count ? fmt::format("{} bytes for them, or text that begins with 'solid'", announced)
                               : "an STL mesh, text or binary",
                     has_count ? "the file may be cut off" : "");
}

} // namespace scree::mesh_formats
