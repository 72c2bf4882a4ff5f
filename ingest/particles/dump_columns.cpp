#include "ingest/particles/dump_columns.h"

#include "base/error.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace scree {

namespace {

constexpr size_t none = static_cast<size_t>(-1);

/// "c_NAME[3]" becomes {NAME, 3}; a plain name stays as it is and has index 0.
struct ComputedName {
    std::string base;
    int index = 0;
    bool computed = false; ///< the value of a compute, fix, variable or custom property
};

ComputedName parse_name(const std::string& lower)
{
    ComputedName result;
    std::string_view text = lower;
    // Longest first: "d2_" is a custom array, "d_" a custom vector.
    for (const std::string_view prefix : {"i2_", "d2_", "c_", "f_", "v_", "i_", "d_"})
        if (text.starts_with(prefix)) {
            text.remove_prefix(prefix.size());
            result.computed = true;
            break;
        }
    const size_t bracket = text.find('[');
    if (bracket != std::string_view::npos && text.ends_with(']')) {
        const auto index = to_int64(text.substr(bracket + 1, text.size() - bracket - 2));
        result.index = index && *index >= 0 && *index < 1000 ? static_cast<int>(*index) : 0;
        text = text.substr(0, bracket);
    }
    result.base = std::string(text);
    return result;
}

/// Finds the column for each use by its name; if several names fit, the best one is taken.
class Planner {
public:
    Planner(DumpColumns& columns, const std::string& place) : columns_(columns), place_(place)
    {
        for (const std::string& name : columns.names) {
            lower_.push_back(lower_case(name));
            parsed_.push_back(parse_name(lower_.back()));
        }
    }

    /// The column of that name, or `none`. Throws when two columns have the name.
    size_t find(std::string_view name) const
    {
        size_t found = none;
        for (size_t i = 0; i < lower_.size(); ++i) {
            if (lower_[i] != name) continue;
            if (found != none)
                throw InputError(place_, fmt::format("column {} twice", in_quotes(name)), "every column once",
                                 "write the dump with each quantity once");
            found = i;
        }
        return found;
    }

    /// The first column c_NAME, f_NAME, v_NAME, ... with that NAME, or `none`.
    size_t find_computed(std::string_view name) const
    {
        for (size_t i = 0; i < parsed_.size(); ++i)
            if (parsed_[i].computed && parsed_[i].base == name) return i;
        return none;
    }

    bool assign(size_t column, DumpField field)
    {
        if (column == none) return false;
        columns_.fields[column] = field;
        return true;
    }

    void coordinates();
    void radius();
    void types();
    void orientation();

private:
    DumpColumns& columns_;
    const std::string& place_;
    std::vector<std::string> lower_;
    std::vector<ComputedName> parsed_;
};

void Planner::coordinates()
{
    static constexpr std::array<DumpField, 3> fields{DumpField::x, DumpField::y, DumpField::z};
    std::string missing;
    for (size_t axis = 0; axis < 3; ++axis) {
        const std::string name(1, static_cast<char>('x' + axis));
        // Positions come before fractions of the box, because they keep more digits; wrapped ones before unwrapped.
        bool found = false;
        for (const auto& [suffix, scaled] : {std::pair{"", false}, {"u", false}, {"s", true}, {"su", true}}) {
            if (!assign(find(name + suffix), fields[axis])) continue;
            columns_.scaled[axis] = scaled;
            found = true;
            break;
        }
        if (!found) missing += (missing.empty() ? "" : " and ") + name;
    }
    if (missing.empty()) return;
    throw InputError(place_, fmt::format("no column for {} among: {}", missing, in_quotes(join_words(columns_.names))),
                     "a column for each of x, y and z (as x, xu, xs or xsu)",
                     "write it in LAMMPS with: dump 1 all custom 1000 pour.dump id type x y z radius");
}

void Planner::radius()
{
    const auto take = [&](size_t column, double factor) {
        if (!assign(column, DumpField::radius)) return false;
        columns_.radius_factor = factor;
        columns_.has_radius = true;
        return true;
    };
    if (take(find("radius"), 1) || take(find("diameter"), 0.5)) return;
    for (const auto& [name, factor] : {std::pair{"radius", 1.0}, {"rad", 1.0}, {"diameter", 0.5}, {"diam", 0.5}})
        if (take(find_computed(name), factor)) return;
}

void Planner::types()
{
    columns_.has_id = assign(find("id"), DumpField::id);
    columns_.has_type = assign(find("type"), DumpField::type);
    if (!columns_.has_type)
        columns_.has_name = assign(find("typelabel"), DumpField::name) || assign(find("element"), DumpField::name);
}

void Planner::orientation()
{
    // LAMMPS writes w i j k, both by name and as `compute property/atom quatw quati quatj quatk`.
    static constexpr std::array<DumpField, 4> fields{DumpField::quat_w, DumpField::quat_x, DumpField::quat_y,
                                                     DumpField::quat_z};
    std::array<size_t, 4> found{none, none, none, none};
    static constexpr std::array<std::string_view, 4> names{"quatw", "quati", "quatj", "quatk"};
    for (size_t i = 0; i < 4; ++i) {
        found[i] = find(names[i]);
        if (found[i] == none) found[i] = find_computed(names[i]);
    }
    if (std::ranges::all_of(found, [](size_t column) { return column == none; })) {
        for (size_t i = 0; i < parsed_.size(); ++i) {
            const ComputedName& name = parsed_[i];
            if (!name.computed || name.index < 1 || name.index > 4) continue;
            if (name.base == "q" || name.base.find("quat") != std::string::npos) {
                size_t& place = found[static_cast<size_t>(name.index - 1)];
                if (place == none) place = i;
            }
        }
    }
    const auto present = std::ranges::count_if(found, [](size_t column) { return column != none; });
    if (present == 0) return;
    if (present < 4) {
        columns_.note =
            fmt::format("only {} of the four columns quatw quati quatj quatk: orientations are left out", present);
        return;
    }
    for (size_t i = 0; i < 4; ++i) assign(found[i], fields[i]);
    columns_.has_orientation = true;
}

} // namespace

DumpColumns plan_dump_columns(const std::vector<std::string_view>& words, const std::string& place)
{
    DumpColumns columns;
    columns.names.assign(words.begin(), words.end());
    columns.fields.assign(words.size(), DumpField::unused);
    if (words.empty())
        throw InputError(place, "'ITEM: ATOMS' without column names",
                         "the columns, as in 'ITEM: ATOMS id type x y z radius'",
                         "LAMMPS before 2010 left them out: add them to the line");
    Planner planner(columns, place);
    planner.coordinates();
    planner.radius();
    planner.types();
    planner.orientation();
    return columns;
}

} // namespace scree
