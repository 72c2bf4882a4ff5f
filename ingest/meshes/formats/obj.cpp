// Wavefront OBJ: the lines `v x y z` and `f a/t/n b/t/n ...`. The rest (normals, textures, groups, materials, lines,
// points) says nothing about the surface and is passed over.
#include "ingest/meshes/formats/polygon_soup.h"
#include "ingest/meshes/formats/text_scanner.h"

#include <fmt/format.h>

namespace scree::mesh_formats {

namespace {

void read_vertex(TextScanner& text, PolygonSoup& soup)
{
    Imath::V3d vertex;
    vertex.x = text.number(text.word_in_line(), "the x of a vertex");
    vertex.y = text.number(text.word_in_line(), "the y of a vertex");
    vertex.z = text.number(text.word_in_line(), "the z of a vertex");
    if (!is_usable(vertex)) check_vertex(vertex, text.place(), "a vertex");
    soup.positions.push_back(vertex);
}

/// A corner is `v`, `v/t`, `v//n` or `v/t/n`. Each counts from 1, or, if negative, back from the last one so far.
void read_face(TextScanner& text, PolygonSoup& soup)
{
    const uint64_t line = text.line();
    for (std::string_view word = text.word_in_line(); !word.empty(); word = text.word_in_line()) {
        const int64_t index = text.integer(word.substr(0, word.find('/')), "a vertex of a face");
        if (index == 0)
            throw InputError(text.place(), "a face with vertex 0", "vertices counted from 1, or backwards from -1");
        const int64_t from_zero = index > 0 ? index - 1 : static_cast<int64_t>(soup.positions.size()) + index;
        if (from_zero < 0) {
            throw InputError(text.place(), fmt::format("a face with vertex {}", index),
                             fmt::format("at most {} vertices back: there are no more so far", soup.positions.size()));
        }
        soup.corners.push_back(checked_index(from_zero, soup, text.place()));
    }
    const uint64_t begin = soup.face_ends.empty() ? 0 : soup.face_ends.back();
    if (soup.corners.size() == begin) throw InputError(text.place(), "a face without vertices", "three or more");
    soup.end_face(line);
}

} // namespace

PolygonSoup read_obj(std::string_view content, const std::string& file)
{
    TextScanner text(content, file, {.comments = true, .continuations = true});
    PolygonSoup soup;
    soup.index_base = 1;
    std::string first_unread;
    bool more = true;
    for (; more; more = text.next_line()) {
        const std::string_view keyword = text.word_in_line();
        if (keyword == "v")
            read_vertex(text, soup);
        else if (keyword == "f" || keyword == "fo")
            read_face(text, soup);
        else if (!keyword.empty() && first_unread.empty())
            first_unread = text.place() + " begins with " + quoted(keyword);
        else
            continue;
    }
    if (soup.face_ends.empty() && soup.positions.empty() && !first_unread.empty()) {
        throw InputError(file, "no line 'v x y z' and no line 'f a b c'", "a Wavefront OBJ mesh", first_unread);
    }
    return soup;
}

} // namespace scree::mesh_formats
