// PLY of Stanford, text and binary of both byte orders: the elements "vertex" (x, y, z), "face" (a list of vertices)
// and "tristrips" are read, any others passed over.
#include "ingest/meshes/formats/byte_reader.h"
#include "ingest/meshes/formats/polygon_soup.h"
#include "ingest/meshes/formats/text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace scree::mesh_formats {

namespace {

enum class Number { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
    std::string name;
    Number type = Number::float32;
    std::optional<Number> count_type; ///< of a list
};

struct Element {
    std::string name;
    int64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    bool text = false;
    std::endian order = std::endian::little;
    std::vector<Element> elements;
};

Number parse_type(std::string_view word, const TextScanner& text)
{
    constexpr std::array<std::array<std::string_view, 2>, 8> names = {{{"char", "int8"},
                                                                       {"uchar", "uint8"},
                                                                       {"short", "int16"},
                                                                       {"ushort", "uint16"},
                                                                       {"int", "int32"},
                                                                       {"uint", "uint32"},
                                                                       {"float", "float32"},
                                                                       {"double", "float64"}}};
    for (size_t i = 0; i < names.size(); ++i) {
        if (word == names[i][0] || word == names[i][1]) return static_cast<Number>(i);
    }
    throw InputError(text.place(), quoted(word), "a PLY type: char, uchar, short, ushort, int, uint, float or double");
}

Property parse_property(TextScanner& text)
{
    Property property;
    std::string_view word = text.word_in_line();
    if (word == "list") {
        property.count_type = parse_type(text.word_in_line(), text);
        if (*property.count_type >= Number::float32)
            throw InputError(text.place(), "a list whose count is a real number", "a count of a whole-number type");
        word = text.word_in_line();
    }
    property.type = parse_type(word, text);
    property.name = text.word_in_line();
    return property;
}

void parse_format(TextScanner& text, Header& header)
{
    const std::string_view format = text.word_in_line();
    header.text = format == "ascii";
    header.order = format == "binary_big_endian" ? std::endian::big : std::endian::little;
    if (!header.text && format != "binary_big_endian" && format != "binary_little_endian") {
        throw InputError(text.place(), "format " + quoted(format),
                         "'ascii', 'binary_little_endian' or 'binary_big_endian'");
    }
}

/// Leaves the scanner at the first byte after the header.
Header parse_header(TextScanner& text)
{
    if (const std::string_view magic = text.word_in_line(); magic != "ply") {
        throw InputError(text.place(), quoted(magic), "'ply', the first word of a PLY mesh");
    }
    Header header;
    bool has_format = false;
    while (text.next_line()) {
        const std::string_view keyword = text.word_in_line();
        if (keyword == "format") {
            parse_format(text, header);
            has_format = true;
        } else if (keyword == "element") {
            Element& element = header.elements.emplace_back();
            element.name = text.word_in_line();
            element.count = text.integer(text.word_in_line(), "the count of an element");
            if (element.count < 0)
                throw InputError(text.place(), fmt::format("an element with the count {}", element.count), "0 or more");
        } else if (keyword == "property") {
            if (header.elements.empty()) throw InputError(text.place(), "a property", "an element before it");
            header.elements.back().properties.push_back(parse_property(text));
        } else if (keyword == "end_header") {
            if (!has_format) throw InputError(text.place(), "the end of the header", "a line 'format ...' before it");
            text.next_line();
            return header;
        } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
            throw InputError(text.place(), quoted(keyword), "'element', 'property', 'comment' or 'end_header'");
        }
    }
    throw InputError(text.place(), "the end of the file", "'end_header'");
}

/// Reads the numbers after the header, one after another.
class Body {
public:
    Body(TextScanner& text, const Header& header)
        : text_(text), bytes_(text.rest(), header.order), is_text_(header.text)
    {
    }

    /// index: number of the item within its element, for messages.
    double real(Number type, const Element& element, int64_t index)
    {
        if (is_text_) return text_.number(next_word(element, index), "a property");
        switch (type) {
        case Number::int8: return binary<int8_t>(element, index);
        case Number::uint8: return binary<uint8_t>(element, index);
        case Number::int16: return binary<int16_t>(element, index);
        case Number::uint16: return binary<uint16_t>(element, index);
        case Number::int32: return binary<int32_t>(element, index);
        case Number::uint32: return binary<uint32_t>(element, index);
        case Number::float32: return binary<float>(element, index);
        case Number::float64: break;
        }
        return binary<double>(element, index);
    }

    /// Goes through a double, which holds every integer of the format exactly.
    int64_t whole(Number type, const Element& element, int64_t index)
    {
        if (is_text_) return text_.integer(next_word(element, index), "a count or a vertex");
        return static_cast<int64_t>(real(type, element, index));
    }

    std::string place() const { return is_text_ ? text_.place() : text_.file(); }
    uint64_t line() const { return is_text_ ? text_.line() : 0; }

private:
    [[noreturn]] void throw_short(const Element& element, int64_t index) const
    {
        throw InputError(place(), fmt::format("the end of the file in {} {}", element.name, index),
                         fmt::format("{} of them, as the header says", element.count), "the file may be cut off");
    }

    std::string_view next_word(const Element& element, int64_t index)
    {
        const std::string_view word = text_.word();
        if (word.empty()) throw_short(element, index);
        return word;
    }

    template <typename T>
    T binary(const Element& element, int64_t index)
    {
        T value{};
        if (!bytes_.read(value)) throw_short(element, index);
        return value;
    }

    TextScanner& text_;
    ByteReader bytes_;
    bool is_text_;
};

/// Reads one property of one item into `values` (a list, or one number).
void read_property(Body& body, const Property& property, const Element& element, int64_t index,
                   std::vector<double>& values)
{
    values.clear();
    const int64_t count = property.count_type ? body.whole(*property.count_type, element, index) : 1;
    if (count < 0)
        throw InputError(body.place(), fmt::format("a list of {} in {} {}", count, element.name, index), "0 or more");
    for (int64_t k = 0; k < count; ++k) values.push_back(body.real(property.type, element, index));
}

bool is_vertex_list(const Property& property)
{
    return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

void read_vertices(Body& body, const Element& element, PolygonSoup& soup, const std::string& file)
{
    std::vector<int> axis_of;
    std::array<bool, 3> has{};
    for (const Property& property : element.properties) {
        const bool is_axis =
            !property.count_type && property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
        axis_of.push_back(is_axis ? property.name[0] - 'x' : -1);
        if (is_axis) has[static_cast<size_t>(axis_of.back())] = true;
    }
    for (size_t axis = 0; axis < 3; ++axis) {
        if (!has[axis])
            throw InputError(file, fmt::format("vertices without '{}'", "xyz"[axis]), "the properties x, y and z");
    }
    std::vector<double> values;
    for (int64_t i = 0; i < element.count; ++i) {
        Imath::V3d p(0);
        for (size_t k = 0; k < element.properties.size(); ++k) {
            read_property(body, element.properties[k], element, i, values);
            if (axis_of[k] >= 0) p[axis_of[k]] = values[0];
        }
        if (!is_usable(p)) check_vertex(p, body.place(), fmt::format("vertex {}", i));
        soup.positions.push_back(p);
    }
}

bool has_faces(const Element& element)
{
    return element.name == "face" || element.name == "faces" || element.name == "tristrips";
}

/// Appends one item of "tristrips": strips that end with -1. In a strip each triangle turns the other way than the
/// triangle before it.
void append_strips(const std::vector<int64_t>& vertices, Body& body, PolygonSoup& soup)
{
    size_t length = 0;
    for (size_t i = 0; i < vertices.size(); ++i) {
        length = vertices[i] == -1 ? 0 : length + 1;
        if (length < 3) continue;
        const bool turned = length % 2 == 0;
        for (const size_t corner : {i - 2, turned ? i : i - 1, turned ? i - 1 : i}) {
            soup.corners.push_back(checked_index(vertices[corner], soup, body.place()));
        }
        soup.end_face(body.line());
    }
}

void read_faces(Body& body, const Element& element, PolygonSoup& soup, const std::string& file)
{
    if (std::none_of(element.properties.begin(), element.properties.end(), is_vertex_list)) {
        throw InputError(file, fmt::format("'{}' without vertices", element.name), "the list property vertex_indices");
    }
    std::vector<double> values;
    std::vector<int64_t> vertices;
    for (int64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) {
            read_property(body, property, element, i, values);
            if (!is_vertex_list(property)) continue;
            vertices.clear();
            for (const double value : values) {
                if (!(std::abs(value) < 1e15) || value != std::floor(value)) {
                    throw InputError(body.place(), fmt::format("vertex {} in {} {}", value, element.name, i),
                                     "a whole number");
                }
                vertices.push_back(static_cast<int64_t>(value));
            }
            if (element.name == "tristrips") {
                append_strips(vertices, body, soup);
            } else {
                for (const int64_t vertex : vertices) soup.corners.push_back(checked_index(vertex, soup, body.place()));
                soup.end_face(body.line());
            }
        }
    }
}

void pass_over(Body& body, const Element& element)
{
    std::vector<double> values;
    for (int64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
        for (const Property& property : element.properties) read_property(body, property, element, i, values);
    }
}

} // namespace

PolygonSoup read_ply(std::string_view content, const std::string& file)
{
    TextScanner text(content, file, {});
    const Header header = parse_header(text);
    if (std::none_of(header.elements.begin(), header.elements.end(), has_faces)) {
        throw InputError(file, "a point cloud: no element 'face'", "a mesh with vertices and faces");
    }
    Body body(text, header);
    PolygonSoup soup;
    for (const Element& element : header.elements) {
        if (element.name == "vertex" || element.name == "vertices")
            read_vertices(body, element, soup, file);
        else if (has_faces(element))
            read_faces(body, element, soup, file);
        else
            pass_over(body, element);
    }
    return soup;
}

} // namespace scree::mesh_formats
