#include "render/equivalent/level_set_surface.h"

#include "base/error.h"
#include "render/equivalent/surface_shells.h"

#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <openvdb/util/NullInterrupter.h>

namespace scree {

namespace {

constexpr double most_voxels = 8e6; ///< half a gigabyte during the computation, a million triangles
constexpr const char* stage = "medium's surface"; ///< stage name in the progress
constexpr double margin = 3; ///< extra voxels on each side of the band, so that the level lies well inside it

/// Adapter that gives a surface to OpenVDB without a copy.
class SurfaceOnLattice {
public:
    SurfaceOnLattice(const RegionSurface& surface, const VoxelLattice& lattice) : surface_(surface), lattice_(lattice)
    {
    }

    size_t polygonCount() const { return surface_.triangles.size(); }
    size_t pointCount() const { return surface_.positions.size(); }
    size_t vertexCount(size_t) const { return 3; }
    void getIndexSpacePoint(size_t n, size_t v, openvdb::Vec3d& pos) const
    {
        const V3d p = lattice_.index(surface_.positions[surface_.triangles[n][v]]);
        pos = {p.x, p.y, p.z};
    }

private:
    const RegionSurface& surface_;
    VoxelLattice lattice_;
};

class Interrupter final : public openvdb::util::NullInterrupter {
public:
    explicit Interrupter(const Progress& progress) : progress_(progress) {}

    bool wasInterrupted(int percent = -1) override
    {
        if (percent >= 0) progress_.update(stage, 0.01 * percent);
        return progress_.cancelled();
    }

private:
    const Progress& progress_;
};

} // namespace

RegionSurface level_surface(const openvdb::FloatGrid& grid, double level, const VoxelLattice& lattice)
{
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(grid, points, quads, level);
    RegionSurface surface;
    surface.voxel = lattice.voxel;
    surface.positions.reserve(points.size());
    for (const auto& p : points) surface.positions.emplace_back(lattice.place(V3d(p.x(), p.y(), p.z())));
    surface.triangles.reserve(2 * quads.size());
    // OpenVDB's polygons are clockwise seen from outside for level sets, counter-clockwise for other grids.
    for (const auto& q : quads) {
        surface.triangles.push_back({q[2], q[1], q[0]});
        surface.triangles.push_back({q[3], q[2], q[0]});
    }
    return surface;
}

double affordable_voxel(const RegionSurface& surface, double depth, double wanted)
{
    const double area = surface_area(surface), volume = std::abs(surface_volume(surface));
    double voxel = wanted;
    // A few layers of voxels outside the surface and beyond the level are stored too.
    while (area * (2 * margin) / (voxel * voxel) + std::min(area * depth, volume) / (voxel * voxel * voxel) >
           most_voxels)
        voxel *= 1.125;
    return voxel;
}

std::optional<RegionSurface> inset_on_lattice(const RegionSurface& surface, double depth, const VoxelLattice& lattice,
                                              const Progress& progress)
{
    const double level = depth / lattice.voxel;
    Interrupter interrupter(progress);
    // Renormalising is disabled: it would change exact values and helps only self-intersecting meshes. Removal of
    // intersecting voxels is disabled: it may take the walls of cavities for self-intersections.
    const int flags = openvdb::tools::DISABLE_RENORMALIZATION | openvdb::tools::DISABLE_NARROW_BAND_TRIMMING |
                      openvdb::tools::DISABLE_INTERSECTING_VOXEL_REMOVAL;
    const auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        interrupter, SurfaceOnLattice(surface, lattice), openvdb::math::Transform(), static_cast<float>(margin),
        static_cast<float>(level + margin), flags);
    if (progress.cancelled()) throw Cancelled();
    RegionSurface inset = level_surface(*grid, -level, lattice);
    if (progress.cancelled()) throw Cancelled();
    // For OpenVDB everything inside the outermost shells is inside, cavities too.
    drop_shells_in_cavities(surface, depth, inset);
    progress.update(stage, 1);
    if (inset.triangles.empty()) return std::nullopt;
    return inset;
}

} // namespace scree
