#include "base/text.h"
#include "ingest/particles/dump_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

enum class BoxKind { orthogonal, restricted, general };

/// Which axes are periodic, from boundary words like `pp ff fs`.
std::array<bool, 3> parse_boundaries(const std::vector<std::string>& words, size_t first, const std::string& place)
{
    std::array<bool, 3> periodic{false, false, false};
    if (first == words.size()) return periodic;
    const auto is_boundary = [](const std::string& word) {
        return word.size() == 2 && word.find_first_not_of("pfsm") == std::string::npos;
    };
    const std::vector<std::string> rest(words.begin() + static_cast<std::ptrdiff_t>(first), words.end());
    if (rest.size() != 3 || !std::ranges::all_of(rest, is_boundary))
        throw InputError(place,
                         fmt::format("BOX BOUNDS followed by {}", in_quotes(fmt::format("{}", fmt::join(rest, " ")))),
                         "three boundary words of the letters p, f, s, m (as in 'pp ff ff'), or none",
                         "a tilted box has 'xy xz yz' or 'abc origin' before them");
    for (size_t axis = 0; axis < 3; ++axis) periodic[axis] = rest[axis] == "pp";
    return periodic;
}

std::vector<double> parse_row(const std::string& row, size_t count, const char* expected, const std::string& place)
{
    const std::vector<std::string_view> words = split_words(row);
    if (words.size() != count)
        throw InputError(place, fmt::format("{} numbers: {}", words.size(), in_quotes(row)), expected);
    std::vector<double> values;
    for (const std::string_view word : words) {
        const std::optional<double> value = to_double(word);
        if (!value || !std::isfinite(*value))
            throw InputError(place, in_quotes(word), fmt::format("a finite number in: {}", expected));
        values.push_back(*value);
    }
    return values;
}

} // namespace

SimulationBox parse_dump_box(const std::vector<std::string>& words, const std::array<std::string, 3>& rows,
                             const std::string& place, uint64_t line)
{
    const auto at = [&](uint64_t row) { return fmt::format("{}:{}", place, line + row); };
    const auto begins_with = [&](std::initializer_list<std::string_view> names) {
        return words.size() >= names.size() && std::equal(names.begin(), names.end(), words.begin());
    };
    BoxKind kind = BoxKind::orthogonal;
    size_t boundaries = 0;
    if (begins_with({"xy", "xz", "yz"})) {
        kind = BoxKind::restricted;
        boundaries = 3;
    } else if (begins_with({"abc", "origin"})) {
        kind = BoxKind::general;
        boundaries = 2;
    }

    SimulationBox box;
    box.periodic = parse_boundaries(words, boundaries, at(0));
    box.triclinic = kind != BoxKind::orthogonal;

    if (kind == BoxKind::general) {
        for (size_t i = 0; i < 3; ++i) {
            const auto row =
                parse_row(rows[i], 4, "4 numbers: an edge vector and one coordinate of the origin", at(i + 1));
            box.edges[i] = {row[0], row[1], row[2]};
            box.lo[static_cast<int>(i)] = row[3];
        }
        if (box.edges[0].dot(box.edges[1].cross(box.edges[2])) <= 0)
            throw InputError(at(1), "edge vectors that do not span a right-handed box",
                             "three edges of a right-handed box");
        return box;
    }

    std::array<double, 3> lo{}, hi{}, tilt{0, 0, 0};
    for (size_t i = 0; i < 3; ++i) {
        const bool tilted = kind == BoxKind::restricted;
        const auto row =
            parse_row(rows[i], tilted ? 3 : 2, tilted ? "3 numbers: lo hi tilt" : "2 numbers: lo hi", at(i + 1));
        lo[i] = row[0];
        hi[i] = row[1];
        if (tilted) tilt[i] = row[2];
    }
    // A tilted box is written as its bounding box (LAMMPS manual, Howto triclinic).
    const auto [xy, xz, yz] = tilt;
    lo[0] -= std::min({0.0, xy, xz, xy + xz});
    hi[0] -= std::max({0.0, xy, xz, xy + xz});
    lo[1] -= std::min(0.0, yz);
    hi[1] -= std::max(0.0, yz);
    for (size_t i = 0; i < 3; ++i) {
        if (hi[i] >= lo[i] && std::isfinite(hi[i] - lo[i])) continue;
        throw InputError(at(i + 1), fmt::format("a box from {} to {} in {}", lo[i], hi[i], static_cast<char>('x' + i)),
                         "a lower bound below the upper one",
                         box.triclinic ? "with xy xz yz, the bounds are those of the bounding box" : "");
    }
    box.lo = {lo[0], lo[1], lo[2]};
    box.edges[0] = {hi[0] - lo[0], 0, 0};
    box.edges[1] = {xy, hi[1] - lo[1], 0};
    box.edges[2] = {xz, yz, hi[2] - lo[2]};
    return box;
}

} // namespace scree
