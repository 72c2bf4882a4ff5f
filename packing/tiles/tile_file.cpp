#include "ingest/particles/vdb_points.h"
#include "packing/tiles/packing_tile.h"
#include "packing/tiles/tile_spheres.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace scree {

namespace {

constexpr double most_overlap = 1e-6; // of the smaller radius

std::string variant_name(size_t variant) { return variant == 0 ? "points" : fmt::format("variant_{}", variant); }

std::string text_of(const Imath::V3d& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

/// The edges of a frame's box. Throws InputError unless it is a cuboid that repeats in every direction.
Imath::V3d cuboid_of(const ParticleFrame& frame, const std::string& place)
{
    const std::string expected = "a cuboid that is periodic along x, y and z";
    const std::string hint = "scree pack tile makes one; --from DUMP cuts one out of a periodic simulation";
    if (!frame.box) throw InputError(place, "points without a box", expected, hint);
    const SimulationBox& box = *frame.box;
    Imath::V3d size;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
            const double x = box.edges[static_cast<size_t>(a)][b];
            if (a == b) size[a] = x;
            if (a == b ? !(x > 0 && std::isfinite(x)) : x != 0)
                throw InputError(place,
                                 fmt::format("a box of edges {}, {}, {}", text_of(box.edges[0]), text_of(box.edges[1]),
                                             text_of(box.edges[2])),
                                 expected, hint);
        }
    for (size_t axis = 0; axis < 3; ++axis)
        if (!box.periodic[axis])
            throw InputError(place, fmt::format("a box that is not periodic along {}", "xyz"[axis]), expected, hint);
    return size;
}

/// How far the row's sphere extends out of the cuboid; negative if it is inside.
double reach_out(const PackingTile& tile, size_t variant, uint64_t row)
{
    const Imath::V3d& p = tile.variants[variant][row];
    double out = -tile.size.x;
    for (int axis = 0; axis < 3; ++axis)
        out = std::max({out, tile.radius[row] - p[axis], p[axis] + tile.radius[row] - tile.size[axis]});
    return out;
}

[[noreturn]] void fail_variant(const std::string& place, size_t variant, uint64_t row, const std::string& what)
{
    throw InputError(place, fmt::format("{}: sphere {} {}", variant_name(variant), row, what),
                     "the same spheres in every variant; spheres that reach through a face of the cuboid are the first "
                     "rows and have the same place in every variant");
}

/// Variants are the same rows with the same radii and types.
void check_same_rows(const ParticleFrame& first, const ParticleFrame& other, size_t variant, const std::string& place)
{
    if (other.size() != first.size())
        throw InputError(
            place,
            fmt::format("{} with {} spheres, but {} in points", variant_name(variant), other.size(), first.size()),
            "the same spheres in every variant");
    for (uint64_t row = 0; row < first.size(); ++row) {
        if (other.id[row] != first.id[row])
            fail_variant(place, variant, row, fmt::format("has id {}, but {} in points", other.id[row], first.id[row]));
        if (other.radius[row] != first.radius[row])
            fail_variant(place, variant, row,
                         fmt::format("has radius {}, but {} in points", other.radius[row], first.radius[row]));
        if (other.type[row] != first.type[row])
            fail_variant(place, variant, row,
                         fmt::format("has type {}, but {} in points", other.type[row], first.type[row]));
    }
}

void check_overlaps(const PackingTile& tile, size_t variant, const std::vector<uint64_t>& ids, const std::string& place)
{
    const TileOverlap worst = largest_tile_overlap(tile, variant);
    if (!(worst.overlap > most_overlap)) return;
    const uint64_t a = worst.rows[0], b = worst.rows[1];
    throw InputError(
        place,
        fmt::format("{}: spheres {} and {} (radius {:.6g} at {}, {:.6g} at {}) overlap by {:.3g} of the smaller radius",
                    variant_name(variant), ids[a], a == b ? "its own image" : std::to_string(ids[b]), tile.radius[a],
                    text_of(tile.variants[variant][a]), tile.radius[b], text_of(tile.variants[variant][b]),
                    worst.overlap),
        "whole spheres that overlap by at most 1e-6 of the smaller radius",
        "scree pack tile --from makes a tile of a simulation's overlapping spheres");
}

/// The number of rows that have the same place in every variant; with one variant, the rows up to the last one that
/// reaches through a face.
uint32_t count_shared(const PackingTile& tile)
{
    uint64_t shared = tile.rows();
    if (tile.variants.size() == 1) {
        while (shared > 0 && reach_out(tile, 0, shared - 1) <= most_overlap * tile.radius[shared - 1]) --shared;
        return static_cast<uint32_t>(shared);
    }
    for (size_t v = 1; v < tile.variants.size(); ++v) {
        uint64_t same = 0;
        while (same < shared && (tile.variants[v][same] - tile.variants[0][same]).length2() == 0) ++same;
        shared = same;
    }
    return static_cast<uint32_t>(shared);
}

void check_inside(const PackingTile& tile, const std::string& place)
{
    for (size_t v = 0; v < tile.variants.size(); ++v)
        for (uint64_t row = tile.shared; row < tile.rows(); ++row)
            if (reach_out(tile, v, row) > most_overlap * tile.radius[row])
                fail_variant(
                    place, v, row,
                    fmt::format("at {} (radius {:.6g}) reaches through a face, but its place differs between variants",
                                text_of(tile.variants[v][row]), tile.radius[row]));
}

} // namespace

ParticleFrame tile_frame(const PackingTile& tile, size_t variant)
{
    ParticleFrame frame;
    frame.position = tile.variants[variant];
    frame.radius = tile.radius;
    frame.type = tile.type;
    frame.id.resize(tile.rows());
    std::iota(frame.id.begin(), frame.id.end(), uint64_t{0});
    frame.has_ids = true;
    SimulationBox box;
    for (int axis = 0; axis < 3; ++axis) box.edges[static_cast<size_t>(axis)][axis] = tile.size[axis];
    box.periodic = {true, true, true};
    frame.box = box;
    // A fixed origin, not the middle of the spheres: rows that share a place must be rounded alike in every variant. It
    // is at a corner because OpenVDB would store eight nodes instead of one around 0.
    frame.origin = Imath::V3d(0);
    return frame;
}

void write_tile(const PackingTile& tile, const std::filesystem::path& path)
{
    std::vector<NamedPoints> grids;
    for (size_t v = 0; v < tile.variants.size(); ++v) grids.push_back({variant_name(v), tile_frame(tile, v)});
    write_vdb_points(grids, path);
}

PackingTile read_tile(const std::filesystem::path& path)
{
    const std::string place = path.string();
    const std::vector<std::string> names = list_vdb_points(path);
    const auto has = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
    PackingTile tile;
    const ParticleFrame first = has("points") ? read_vdb_points(path, "points") : read_vdb_points(path);
    if (first.size() == 0) throw InputError(place, "no spheres", "a tile of spheres");
    tile.size = cuboid_of(first, place);
    tile.radius = first.radius;
    tile.type = first.type;
    for (uint64_t row = 0; row < first.size(); ++row)
        if (!(first.radius[row] > 0))
            throw InputError(place, fmt::format("sphere {} of radius {}", first.id[row], first.radius[row]),
                             "radii above 0");
    const auto add = [&](const ParticleFrame& frame) {
        auto& places = tile.variants.emplace_back();
        for (const Imath::V3d& p : frame.position) places.push_back(wrapped_into(p - frame.box->lo, tile.size));
        check_overlaps(tile, tile.variants.size() - 1, frame.id, place);
    };
    add(first);
    for (size_t v = 1; has(variant_name(v)); ++v) {
        const ParticleFrame other = read_vdb_points(path, variant_name(v));
        check_same_rows(first, other, v, place);
        if (cuboid_of(other, place) != tile.size)
            throw InputError(place, variant_name(v) + " with a box of its own", "the same box for every variant");
        add(other);
    }
    tile.shared = count_shared(tile);
    check_inside(tile, place);
    return tile;
}

} // namespace scree
