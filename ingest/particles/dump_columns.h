#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// What a column of a dump is used for.
enum class DumpField : uint8_t { unused, x, y, z, radius, type, id, name, quat_w, quat_x, quat_y, quat_z };

/// The columns of an `ITEM: ATOMS` line and what each is used for.
struct DumpColumns {
    std::vector<std::string> names; ///< as the file spells them
    std::vector<DumpField> fields; ///< one per column
    std::array<bool, 3> scaled{false, false, false}; ///< per axis: whether it is a fraction of the box (xs or xsu)
    double radius_factor = 1; ///< 0.5 when the column is a diameter
    bool has_radius = false, has_id = false, has_type = false;
    bool has_name = false; ///< types are given by name (`element`, `typelabel`) only
    bool has_orientation = false;
    std::string note; ///< a remark for the user, or empty

    bool any_scaled() const { return scaled[0] || scaled[1] || scaled[2]; }
    bool operator==(const DumpColumns&) const = default;
};

/// Decides by its name what each column is used for; upper and lower case are the same.
///
/// words: the column names. Throws InputError (at `place`) when an axis has no column or a needed column occurs twice.
DumpColumns plan_dump_columns(const std::vector<std::string_view>& words, const std::string& place);

} // namespace scree
