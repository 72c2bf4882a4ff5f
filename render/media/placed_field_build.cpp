#include "render/media/placed_field_build.h"

#include "base/error.h"

#include <fmt/format.h>

namespace scree {

namespace {

using openvdb::Coord;

/// scene = columns * voxel + constant.
struct Placement {
    std::array<V3d, 3> columns;
    V3d constant;
};

Placement placement_of(const openvdb::GridBase& grid, const Imath::M44d& to_scene, const std::string& name,
                       const std::string& place)
{
    const auto map = grid.transform().baseMap();
    if (!map->isLinear())
        throw InputError(place, fmt::format("a {} transform of the grid of {}", map->type(), name),
                         "a linear (affine) transform", "resample the grid: frustum transforms are not supported");
    const auto from_vdb = [](const openvdb::Vec3d& v) { return V3d(v.x(), v.y(), v.z()); };
    Placement p;
    for (int k = 0; k < 3; ++k) {
        // The Jacobian: a difference of two points would lose digits far from 0.
        const V3d column = from_vdb(map->applyJacobian(openvdb::Vec3d(k == 0, k == 1, k == 2)));
        to_scene.multDirMatrix(column, p.columns[static_cast<size_t>(k)]);
    }
    to_scene.multVecMatrix(from_vdb(map->applyMap(openvdb::Vec3d(0))), p.constant);
    return p;
}

void place_field(PlacedField& placed, const Placement& p, const Coord& origin, const RenderSpace& space,
                 const std::string& name, const std::string& place)
{
    const V3d &x = p.columns[0], &y = p.columns[1], &z = p.columns[2];
    // The adjugate is exact under scaling by powers of two.
    const double determinant = x.dot(y.cross(z));
    const std::array<V3d, 3> inverse{y.cross(z) / determinant, z.cross(x) / determinant, x.cross(y) / determinant};
    for (const V3d& row : inverse)
        if (!std::isfinite(row.x + row.y + row.z))
            throw InputError(place, fmt::format("a transform of the grid of {} that cannot be inverted", name),
                             "voxels with a volume above 0");
    const double half = placed.field.nearest ? 0.5 : 0; // a voxel extends half an edge around its centre
    const V3d from_origin = space.origin - p.constant;
    const V3d first(origin.x() - half, origin.y() - half, origin.z() - half);
    for (size_t k = 0; k < 3; ++k) {
        const V3d& row = inverse[k];
        placed.to_field.rows[k] = V3d(space.world_length(row.x), space.world_length(row.y), space.world_length(row.z));
        placed.to_field.b[static_cast<int>(k)] = row.dot(from_origin) - first[static_cast<int>(k)];
        const int a = static_cast<int>(k);
        placed.to_render.rows[k] = space.vector(V3d(x[a], y[a], z[a]));
        placed.to_render.b[a] = space.length(x[a] * first.x + y[a] * first.y + z[a] * first.z - from_origin[a]);
    }
}

} // namespace

PlacedField make_placed_field(const openvdb::GridBase& grid, const FieldLimits& limits, bool nearest,
                              const Imath::M44d& to_scene, const RenderSpace& space, const std::string& place,
                              const Progress& progress)
{
    const Placement placement = placement_of(grid, to_scene, limits.name, place);
    PlacedField placed;
    Coord origin(0);
    placed.field = make_brick_field(grid, limits, nearest, place, progress, origin);
    place_field(placed, placement, origin, space, limits.name, place);
    return placed;
}

} // namespace scree
