#pragma once

#include "base/math.h"
#include "base/progress.h"
#include "render/grains/grain_store.h"

#include <cstdint>
#include <memory>
#include <span>

namespace scree {

struct GrainFieldOptions {
    /// Edge of a voxel in volume-weighted mean radii; a continuum needs means over a few grains.
    double voxel_radii = 2.5;
    /// Edge of a voxel in render coordinates, for example the same for a series of frames; 0: use voxel_radii.
    double voxel = 0;
    FloatMargin margin{}; ///< the margin that the given radii already include (GrainStore::margin)
};

/// Densities of the moments of the radius, for spheres of one type: sum of r^k per unit of volume.
struct MomentDensity {
    double m2 = 0, m3 = 0, m4 = 0;

    double pack_rate() const { return 4 * pi / 3 * m3; }
    double cross_section() const { return pi * m2; } ///< per unit of volume
};

/// Sparse fields of pack rate and moments of the radius for each type of grain, in render coordinates.
///
/// Value (i, j, k) belongs to the point (i, j, k) * voxel, so that frames share one lattice. A sphere is spread around
/// its centre with the weights of the quadratic B-spline, which sum to 1 (Hockney and Eastwood's triangular-shaped
/// cloud); a sphere with a radius above half a voxel is spread from points that fill it. So the sum over the voxels
/// equals the sum over the spheres.
class GrainFields {
public:
    struct Grids; ///< grain_field_grids.h: the OpenVDB grids

    explicit GrainFields(std::unique_ptr<Grids> grids);
    ~GrainFields();
    GrainFields(GrainFields&&) noexcept;
    GrainFields& operator=(GrainFields&&) noexcept;

    /// Edge of a voxel; 0 if there are no spheres.
    double voxel() const;
    /// Type codes that have spheres, ascending.
    std::span<const uint8_t> types() const;
    /// Trilinear between voxels; zeros for a type that has no spheres.
    MomentDensity moments(uint8_t type, const V3d& place) const;
    /// The pack rate of all types together.
    double pack_rate(const V3d& place) const;
    /// The sum of voxel values times the volume of a voxel: sum of r^k over the spheres of a type.
    MomentDensity totals(uint8_t type) const;
    /// Volume of all spheres, by the field of the pack rate.
    double sphere_volume() const;

    uint64_t voxels() const; ///< number of voxels with material
    uint64_t bytes() const;
    const Grids& grids() const { return *grids_; }

private:
    std::unique_ptr<Grids> grids_;
};

/// Spreads spheres into fields; the result is bit-identical for any number of threads, and for units of length that
/// differ by a factor 2^k.
///
/// type_codes: one for each sphere, below type_count. Spheres of radius 0 are ignored. Throws InputError, Cancelled.
GrainFields make_grain_fields(std::span<const GrainStore::Sphere> spheres, std::span<const uint8_t> type_codes,
                              uint32_t type_count, const GrainFieldOptions& options, const Progress& progress);

} // namespace scree
