// OFF of Geomview: [ST][C][N][4]OFF [BINARY], counts, vertices (one a line in text), faces `n a b c ...` with perhaps
// colours.
#include "ingest/meshes/formats/byte_reader.h"
#include "ingest/meshes/formats/polygon_soup.h"
#include "ingest/meshes/formats/text_scanner.h"

#include <fmt/format.h>

namespace scree::mesh_formats {

namespace {

struct Header {
    bool homogeneous = false, binary = false;
    uint32_t extra_numbers = 0; ///< after the coordinates of a vertex: normal, colour, texture
};

/// Reads the letters before "OFF"; throws on a word that is not an OFF header.
Header parse_keyword(std::string_view word, const TextScanner& text)
{
    const std::string whole(word);
    Header header;
    const auto eat = [&](std::string_view prefix) {
        if (!word.starts_with(prefix)) return false;
        word.remove_prefix(prefix.size());
        return true;
    };
    const bool texture = eat("ST"), colour = eat("C"), normal = eat("N");
    header.homogeneous = eat("4");
    if (word == "nOFF")
        throw InputError(text.place(), quoted(whole), "OFF, which has three dimensions",
                         "nOFF has any number of dimensions");
    if (word != "OFF") throw InputError(text.place(), quoted(whole), "'OFF', the first word of an OFF mesh");
    header.extra_numbers = (normal ? 3u : 0u) + (colour ? 4u : 0u) + (texture ? 2u : 0u);
    return header;
}

Imath::V3d dehomogenised(const Imath::V3d& p, double w)
{
    return w == 1 ? p : p / w; // w = 0 gives infinity or NaN, which check_vertex refuses
}

/// Refuses counts that the rest of the file cannot hold, before memory is allocated for them.
void check_counts(int64_t vertices, int64_t faces, size_t bytes_left, int64_t bytes_a_vertex, const std::string& place)
{
    const auto left = static_cast<int64_t>(bytes_left);
    if (vertices >= 0 && faces >= 0 && vertices <= left / bytes_a_vertex + 1 && faces <= left / 2 + 1) return;
    throw InputError(place, fmt::format("counts of {} vertices and {} faces", vertices, faces),
                     fmt::format("counts that fit the {} bytes after them", left), "the file may be cut off");
}

PolygonSoup read_text(TextScanner& text, const Header& header, std::string_view first_count)
{
    PolygonSoup soup;
    const int64_t vertices = text.integer(first_count, "the number of vertices");
    const int64_t faces = text.integer(text.word(), "the number of faces");
    check_counts(vertices, faces, text.rest().size(), 6, text.place());
    text.next_line(); // the number of edges, often left out or wrong, is not needed
    for (int64_t i = 0; i < vertices; ++i) {
        const std::string_view x = text.word();
        if (x.empty())
            throw InputError(text.place(), fmt::format("the end of the file after {} vertices", i),
                             fmt::format("{}", vertices));
        Imath::V3d p;
        p.x = text.number(x, "the x of a vertex");
        p.y = text.number(text.word_in_line(), "the y of a vertex");
        p.z = text.number(text.word_in_line(), "the z of a vertex");
        if (header.homogeneous) p = dehomogenised(p, text.number(text.word_in_line(), "the w of a vertex"));
        if (!is_usable(p)) check_vertex(p, text.place(), "a vertex");
        soup.positions.push_back(p);
        text.next_line();
    }
    for (int64_t i = 0; i < faces; ++i) {
        const std::string_view size = text.word();
        if (size.empty())
            throw InputError(text.place(), fmt::format("the end of the file after {} faces", i),
                             fmt::format("{}", faces));
        const uint64_t line = text.line();
        const int64_t corners = text.integer(size, "how many vertices a face has");
        if (corners < 1) throw InputError(text.place(), fmt::format("a face of {} vertices", corners), "three or more");
        for (int64_t k = 0; k < corners; ++k) {
            const int64_t index = text.integer(text.word(), "a vertex of a face");
            soup.corners.push_back(checked_index(index, soup, text.place()));
        }
        soup.end_face(line);
        text.next_line();
    }
    return soup;
}

PolygonSoup read_binary(std::string_view content, const Header& header, const std::string& file)
{
    ByteReader bytes(content, std::endian::big);
    const auto require = [&](bool read, const std::string& where) {
        if (!read) throw InputError(file, "the end of the file in " + where, "as much as its header announces");
    };
    int32_t vertices = 0, faces = 0, edges = 0;
    require(bytes.read(vertices) && bytes.read(faces) && bytes.read(edges), "the counts");
    check_counts(vertices, faces, bytes.left(), 12, file);
    PolygonSoup soup;
    for (int32_t i = 0; i < vertices; ++i) {
        float x = 0, y = 0, z = 0, w = 1;
        require(bytes.read(x) && bytes.read(y) && bytes.read(z) && (!header.homogeneous || bytes.read(w)) &&
                    bytes.skip(size_t{4} * header.extra_numbers),
                fmt::format("vertex {}", i));
        const Imath::V3d p = dehomogenised(Imath::V3d(x, y, z), w);
        if (!is_usable(p)) check_vertex(p, file, fmt::format("vertex {}", i));
        soup.positions.push_back(p);
    }
    for (int32_t i = 0; i < faces; ++i) {
        int32_t corners = 0, index = 0, colours = 0;
        require(bytes.read(corners), fmt::format("face {}", i));
        if (corners < 1) throw InputError(file, fmt::format("face {} of {} vertices", i, corners), "three or more");
        for (int32_t k = 0; k < corners; ++k) {
            require(bytes.read(index), fmt::format("face {}", i));
            soup.corners.push_back(checked_index(index, soup, file));
        }
        soup.end_face(0);
        require(bytes.read(colours) && colours >= 0 && bytes.skip(size_t{4} * static_cast<size_t>(colours)),
                fmt::format("the colour of face {}", i));
    }
    return soup;
}

} // namespace

PolygonSoup read_off(std::string_view content, const std::string& file)
{
    TextScanner text(content, file, {.comments = true});
    std::string_view word = text.word();
    Header header;
    // The keyword may be left out: then the file begins with the counts.
    if (word.empty() || word[0] < '0' || word[0] > '9' || word.starts_with("4OFF")) {
        header = parse_keyword(word, text);
        word = text.word_in_line();
        if (word == "BINARY") {
            text.next_line();
            return read_binary(text.rest(), header, file);
        }
        if (word.empty()) word = text.word();
    }
    return read_text(text, header, word);
}

} // namespace scree::mesh_formats
