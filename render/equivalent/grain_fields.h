#pragma once

#include "base/math.h"
#include "base/progress.h"
#include "render/grains/grain_store.h"

#include <cstdint>
#include <memory>
#include <span>

namespace scree {

struct GrainFieldOptions {
    /// Edge of a voxel in volume-weighted mean radii: a continuum wants means over a few grains.
    double voxel_radii = 2.5;
    /// Edge of a voxel in render coordinates, 0: by voxel_radii. A series of frames may want one for all.
    double voxel = 0;
    FloatMargin margin{}; ///< by which the radii handed in are widened (GrainStore::margin)
};

/// Densities of moments of the radius, per unit of volume: sum of r^k over the volume, spheres of one type.
struct MomentDensity {
    double m2 = 0, m3 = 0, m4 = 0;

    double pack_rate() const { return 4 * pi / 3 * m3; }
    double cross_section() const { return pi * m2; } ///< per unit of volume
};

/// Sparse fields of pack rate and moments of the radius for each type of grain, in render coordinates.
///
/// Value (i, j, k) belongs to the place (i, j, k) * voxel, the same lattice in each frame. Around its centre a sphere
/// is spread with the weights of the quadratic B-spline, which sum to 1 (Hockney and Eastwood's triangular-shaped
/// cloud); a sphere larger than half a voxel is spread from points that fill it. So the sum over the voxels is that of
/// the spheres.
class GrainFields {
public:
    struct Grids; ///< grain_field_grids.h: the OpenVDB grids

    explicit GrainFields(std::unique_ptr<Grids> grids);
    ~GrainFields();
    GrainFields(GrainFields&&) noexcept;
    GrainFields& operator=(GrainFields&&) noexcept;

    /// Edge of a voxel; 0 where there are no spheres.
    double voxel() const;
    /// Types that have spheres, ascending.
    std::span<const uint8_t> types() const;
    /// Trilinear between voxels; zeros for a type that has no spheres.
    MomentDensity moments(uint8_t type, const V3d& place) const;
    /// Of all types.
    double pack_rate(const V3d& place) const;
    /// The sum of voxel values times the volume of a voxel: sum of r^k over the spheres of a type.
    MomentDensity totals(uint8_t type) const;
    /// Volume of all spheres, as the field of the pack rate has it.
    double sphere_volume() const;

    uint64_t voxels() const; ///< with material
    uint64_t bytes() const;
    const Grids& grids() const { return *grids_; }

private:
    std::unique_ptr<Grids> grids_;
};

/// Spreads spheres into fields; the same bits on any number of threads, and in any unit that is 2^k of another.
///
/// type_codes: one for each sphere, below type_count. Spheres without radius leave nothing. Throws InputError,
/// Cancelled.
GrainFields make_grain_fields(std::span<const GrainStore::Sphere> spheres, std::span<const uint8_t> type_codes,
                              uint32_t type_count, const GrainFieldOptions& options, const Progress& progress);

} // namespace scree
