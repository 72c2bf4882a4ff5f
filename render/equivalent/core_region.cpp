#include "render/equivalent/core_region.h"

#include "base/error.h"
#include "render/equivalent/hull_inset.h"
#include "render/equivalent/level_set_surface.h"
#include "render/equivalent/sphere_bins.h"
#include "render/equivalent/surface_shells.h"

#include <Imath/ImathBox.h>
#include <fmt/format.h>

namespace scree {

namespace {

constexpr double voxels_deep = 6; ///< voxels along the depth of a heap's core

void check_depth(const char* place, double depth)
{
    if (!(depth >= 0) || !std::isfinite(depth))
        throw InputError(place, fmt::format("a depth of {}", depth), "a length, 0 or more");
}

} // namespace

std::optional<RegionSurface> inset_of_mesh(std::span<const V3f> positions,
                                           std::span<const std::array<uint32_t, 3>> triangles, double depth,
                                           const Progress& progress)
{
    check_depth("inset of a mesh", depth);
    RegionSurface surface;
    surface.positions.assign(positions.begin(), positions.end());
    surface.triangles.assign(triangles.begin(), triangles.end());
    if (surface.triangles.empty()) return std::nullopt;
    Imath::Box3d bounds;
    for (const auto& t : triangles)
        for (const uint32_t v : t) {
            if (v >= positions.size())
                throw InputError("inset of a mesh", fmt::format("vertex {}", v),
                                 fmt::format("below {}", positions.size()));
            bounds.extendBy(V3d(positions[v]));
        }
    if (!is_balanced(surface))
        throw InputError("inset of a mesh", "a mesh that is not closed", "every edge with a face on either side",
                         "`scree info` reports on a mesh file");
    if (depth == 0) return surface;
    const V3d size = bounds.size();
    if (2 * depth >= std::min({size.x, size.y, size.z})) return std::nullopt;

    openvdb::initialize();
    const double wanted = std::min(depth / 4, std::max({size.x, size.y, size.z}) / 64);
    const double voxel = affordable_voxel(surface, depth, wanted);
    // Shifted slightly, so that no face of an axis-aligned box runs through voxel centres.
    const VoxelLattice lattice{bounds.min - V3d(0.37, 0.41, 0.43) * voxel, voxel};
    auto inset = inset_on_lattice(surface, depth, lattice, progress);
    if (inset) inset->coarsened = voxel > wanted;
    return inset;
}

std::optional<RegionSurface> core_of_spheres(std::span<const GrainStore::Sphere> spheres, double depth,
                                             const Progress& progress, const HeapOptions& options)
{
    check_depth("core of a heap", depth);
    const double radius = volume_weighted_radius(spheres, {});
    if (!(radius > 0)) return std::nullopt;
    const double closing = options.closing * radius;
    const VoxelLattice lattice{V3d(0), options.voxel * radius};
    // A deeper surface is smoother, so that finer voxels would not improve it.
    const double voxel = std::max(lattice.voxel, (closing + depth) / voxels_deep);
    return inset_of_hull(dilated_spheres(spheres, closing, lattice, progress), closing + depth, {lattice.origin, voxel},
                         progress);
}

} // namespace scree
