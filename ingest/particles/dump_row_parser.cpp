#include "ingest/particles/dump_row_parser.h"

#include "base/error.h"
#include "base/text.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {

namespace {

// Positions relative to the middle are used as float, so they must stay well below 3.4e38.
constexpr double farthest = 1e37;

bool ends_word(char c) { return static_cast<unsigned char>(c) <= ' '; }

const char* skip_blanks(const char* p)
{
    while (ends_word(*p) && *p != '\n') ++p;
    return p;
}

const char* skip_word(const char* p)
{
    while (!ends_word(*p)) ++p;
    return p;
}

/// Parses a word of digits with an optional sign; null when it is anything else or too large.
const char* parse_integer(const char* p, int64_t& value)
{
    const bool negative = *p == '-';
    if (negative || *p == '+') ++p;
    const char* const first = p;
    uint64_t sum = 0;
    for (; *p >= '0' && *p <= '9'; ++p) sum = 10 * sum + static_cast<uint64_t>(*p - '0');
    // 18 digits always fit; longer numbers take the slow path.
    if (p == first || p - first > 18 || !ends_word(*p)) return nullptr;
    value = negative ? -static_cast<int64_t>(sum) : static_cast<int64_t>(sum);
    return p;
}

/// Powers of ten that a double holds exactly.
constexpr std::array<double, 23> exact_powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                              1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// Parses a plain decimal number of up to 15 digits, as nearly all are; returns null for everything else.
///
/// The digits and the power of ten are then both exact, so that one division rounds correctly (Clinger 1990).
const char* parse_short_real(const char* p, double& value)
{
    const bool negative = *p == '-';
    p += negative;
    uint64_t digits = 0;
    const char* const first = p;
    for (; static_cast<unsigned char>(*p - '0') < 10; ++p) digits = 10 * digits + static_cast<uint64_t>(*p - '0');
    int64_t count = p - first, decimals = 0;
    if (*p == '.') {
        const char* const point = p++;
        for (; static_cast<unsigned char>(*p - '0') < 10; ++p) digits = 10 * digits + static_cast<uint64_t>(*p - '0');
        decimals = p - point - 1;
        count += decimals;
    }
    if (count == 0 || count > 15 || !ends_word(*p)) return nullptr;
    value = static_cast<double>(digits) / exact_powers[static_cast<size_t>(decimals)];
    if (negative) value = -value;
    return p;
}

/// Parses a word as a real number; null when it is none.
const char* parse_real(const char* p, const char* end, double& value)
{
    if (const char* const stop = parse_short_real(p, value)) return stop;
    if (*p == '+') ++p;
    const auto [stop, error] = fast_float::from_chars(p, end, value);
    return error == std::errc() && ends_word(*stop) ? stop : nullptr;
}

} // namespace

/// The numbers of a line that are used, before they are checked.
struct DumpRowParser::Row {
    Imath::V3d position{0};
    double radius = 0;
    std::array<double, 4> quaternion{1, 0, 0, 0}; // w x y z
    int64_t type = 1, id = 0;
    const char* start = nullptr;
};

DumpRowParser::DumpRowParser(const DumpHeader& header, const std::vector<std::string>& type_names, std::string file,
                             ParticleFrame& frame)
    : header_(header), columns_(*header.columns), type_names_(type_names), file_(std::move(file)), frame_(frame)
{
    if (!columns_.any_scaled()) return;
    // Row i of the linear system gives the written coordinate i from the three fractions: the fraction itself if the
    // axis is scaled, otherwise the position relative to the box's lower corner.
    const auto& edges = header.box->edges;
    Imath::M33d system;
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < 3; ++k)
            system[axis][k] =
                columns_.scaled[static_cast<size_t>(axis)] ? (axis == k) : edges[static_cast<size_t>(k)][axis];
    try {
        to_fractions_ = system.inverse(true);
    } catch (const std::exception&) {
        throw InputError(fmt::format("{}:{}", file_, header.atoms_line - 1),
                         "scaled and unscaled coordinates mixed, in a box from which positions cannot be computed",
                         "a box with a volume, and all of xs ys zs or all of x y z");
    }
}

size_t DumpRowParser::column_of(DumpField field) const
{
    return static_cast<size_t>(std::ranges::find(columns_.fields, field) - columns_.fields.begin());
}

void DumpRowParser::fail(uint64_t line, size_t column, std::string_view word, const std::string& expected,
                         const std::string& hint) const
{
    throw InputError(
        fmt::format("{}:{}", file_, line),
        fmt::format("{} in column {} ({})", in_quotes(word), column + 1, in_quotes(columns_.names.at(column))),
        expected, hint);
}

void DumpRowParser::fail_columns(const LineBlock& block, uint64_t line, const char* line_start) const
{
    const char* end = line_start;
    const char* const block_end = block.text.data() + block.text.size();
    while (end < block_end && *end != '\n') ++end;
    const std::string_view text(line_start, static_cast<size_t>(end - line_start));
    throw InputError(fmt::format("{}:{}", file_, line),
                     fmt::format("{} columns: {}", split_words(text).size(), in_quotes(text)),
                     fmt::format("{} columns: {}", columns_.names.size(), join_words(columns_.names)));
}

void DumpRowParser::fail_place(const Row& row, uint64_t line, const Imath::V3d& place) const
{
    static constexpr std::array<DumpField, 3> fields{DumpField::x, DumpField::y, DumpField::z};
    int axis = 0;
    while (axis < 2 && std::abs(place[axis]) <= farthest) ++axis;
    const size_t column = column_of(fields[static_cast<size_t>(axis)]);
    const char* p = skip_blanks(row.start);
    for (size_t i = 0; i < column; ++i) p = skip_blanks(skip_word(p));
    fail(line, column, {p, static_cast<size_t>(skip_word(p) - p)}, "a finite number below 1e37",
         "did the simulation blow up?");
}

int32_t DumpRowParser::type_of_name(std::string_view name) const
{
    const auto found = std::lower_bound(type_names_.begin(), type_names_.end(), name);
    if (found == type_names_.end() || *found != name) return 0;
    return static_cast<int32_t>(found - type_names_.begin()) + 1;
}

Imath::V3d DumpRowParser::unscaled(const Imath::V3d& written) const
{
    const SimulationBox& box = *header_.box;
    Imath::V3d known = written;
    for (int axis = 0; axis < 3; ++axis)
        if (!columns_.scaled[static_cast<size_t>(axis)]) known[axis] -= box.lo[axis];
    Imath::V3d place = written;
    for (int axis = 0; axis < 3; ++axis) {
        if (!columns_.scaled[static_cast<size_t>(axis)]) continue;
        double sum = box.lo[axis];
        for (int k = 0; k < 3; ++k) {
            double fraction = 0;
            for (int j = 0; j < 3; ++j) fraction += to_fractions_[k][j] * known[j];
            sum += fraction * box.edges[static_cast<size_t>(k)][axis];
        }
        place[axis] = sum;
    }
    return place;
}

void DumpRowParser::store(const Row& row, uint64_t index, uint64_t line) const
{
    const Imath::V3d place = columns_.any_scaled() ? unscaled(row.position) : row.position;
    // Written so that NaN fails too.
    const bool near = std::abs(place.x) <= farthest && std::abs(place.y) <= farthest && std::abs(place.z) <= farthest;
    if (!near) fail_place(row, line, place);
    frame_.position[index] = place;
    frame_.type[index] = static_cast<int32_t>(row.type);
    if (columns_.has_id) frame_.id[index] = static_cast<uint64_t>(row.id);
    if (columns_.has_radius) frame_.radius[index] = static_cast<float>(row.radius);
    if (!columns_.has_orientation) return;
    const auto& [w, x, y, z] = row.quaternion;
    const double largest = std::max({std::abs(w), std::abs(x), std::abs(y), std::abs(z)});
    Imath::Quatf turn; // LAMMPS writes zeros for grains that have no orientation: they keep the identity
    if (largest > 0) {
        const double length =
            largest * std::hypot(std::hypot(w / largest, x / largest), std::hypot(y / largest, z / largest));
        turn = Imath::Quatf(static_cast<float>(w / length), static_cast<float>(x / length),
                            static_cast<float>(y / length), static_cast<float>(z / length));
    }
    frame_.orientation[index] = turn;
}

void DumpRowParser::parse(const LineBlock& block, uint64_t first_row) const
{
    const char* p = block.text.data();
    const char* const end = p + block.text.size();
    const std::vector<DumpField>& fields = columns_.fields;
    const double factor = columns_.radius_factor;

    for (uint64_t i = 0; i < block.lines; ++i) {
        const uint64_t line = block.first_line + i;
        Row row;
        row.start = p;
        for (size_t column = 0; column < fields.size(); ++column) {
            p = skip_blanks(p);
            if (*p == '\n') fail_columns(block, line, row.start);
            const char* const word = p;
            const auto text = [&] { return std::string_view(word, static_cast<size_t>(skip_word(word) - word)); };
            const auto real = [&](double& value) {
                p = parse_real(word, end, value);
                if (!p) fail(line, column, text(), "a number");
            };
            const auto integer = [&](int64_t& value, const char* expected) {
                p = parse_integer(word, value);
                if (p) return;
                const std::optional<int64_t> slow = to_int64(text());
                if (!slow) fail(line, column, text(), expected);
                value = *slow;
                p = skip_word(word);
            };
            switch (fields[column]) {
            case DumpField::unused: p = skip_word(p); break;
            case DumpField::x: real(row.position.x); break;
            case DumpField::y: real(row.position.y); break;
            case DumpField::z: real(row.position.z); break;
            case DumpField::radius:
                real(row.radius);
                row.radius *= factor;
                if (!(row.radius >= 0 && row.radius <= farthest))
                    fail(line, column, text(),
                         factor == 1 ? "a radius, finite and 0 or more" : "a diameter, finite and 0 or more");
                break;
            case DumpField::type:
                integer(row.type, "a type number, an integer");
                if (row.type < std::numeric_limits<int32_t>::min() || row.type > std::numeric_limits<int32_t>::max())
                    fail(line, column, text(), "a type number, an integer of 32 bits");
                break;
            case DumpField::id:
                integer(row.id, "an id, an integer of 0 or more");
                if (row.id < 0) fail(line, column, text(), "an id, an integer of 0 or more");
                break;
            case DumpField::name:
                p = skip_word(p);
                row.type = type_of_name(text());
                if (row.type == 0)
                    fail(line, column, text(), "a type name that was in the file when it was opened",
                         "has the file changed?");
                break;
            case DumpField::quat_w:
            case DumpField::quat_x:
            case DumpField::quat_y:
            case DumpField::quat_z: {
                double& value =
                    row.quaternion[static_cast<size_t>(fields[column]) - static_cast<size_t>(DumpField::quat_w)];
                real(value);
                if (!std::isfinite(value)) fail(line, column, text(), "a finite number");
                break;
            }
            }
        }
        p = skip_blanks(p);
        if (*p != '\n') fail_columns(block, line, row.start);
        ++p;
        store(row, first_row + i, line);
    }
}

} // namespace scree
