#pragma once

#include "packing/solids/distance_field.h"
#include "packing/solids/domain.h"
#include "packing/solids/surface_cells.h"
#include "packing/tiles/packing_tile.h"

#include <Imath/ImathMatrix.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

namespace scree {

/// A cell of the lattice of tiles.
struct FillCell {
    int64_t x = 0, y = 0, z = 0;
};

struct FillOptions {
    double radius = 0; ///< mean radius of the spheres in the scene's unit
    uint64_t seed = 0; ///< of which variant of the tile stands where
};

/// The whole spheres of an endlessly repeated tile that lie in a domain: described, never listed.
///
/// The lattice of tiles stands at a fixed generic rotation about the middle of the domain's bounds: from any place,
/// along an axis or a diagonal of the scene, it comes back no nearer than 0.17 of a cell within 9 cells. Which variant
/// of the tile stands in a cell is a hash of the cell. A sphere's id is number(cell) * rows + row; places are multiples
/// of a power of two from `origin`, so that a file of points holds them without loss. All answers may be asked from
/// several threads.
class ProceduralFill {
public:
    struct Sphere {
        Imath::V3d centre; ///< scene
        float radius;
    };
    enum class CellKind : uint8_t { unknown, outside, boundary, inside };

    /// Throws InputError when the tile is too coarse or too fine for the domain to be counted in 62 bits.
    ProceduralFill(std::shared_ptr<const Domain> domain, std::shared_ptr<const PackingTile> tile,
                   const FillOptions& options);

    const Domain& domain() const { return *domain_; }
    const PackingTile& tile() const { return *tile_; }
    /// The middle of the domain's bounds.
    const Imath::V3d& origin() const { return origin_; }
    /// Scene units a tile unit.
    double scale() const { return scale_; }
    /// Places are multiples of this from the origin, on each axis: 2^-24 of `voxel`.
    double voxel() const { return voxel_; }
    double largest_radius() const { return largest_radius_; }
    /// Radius of a row's spheres in the scene.
    float radius(uint64_t row) const { return static_cast<float>(tile_->radius[row] * scale_); }

    /// Tile units; the corner of cell (0, 0, 0) is at 0. offset: a place of the scene relative to `origin`.
    Imath::V3d to_lattice(const Imath::V3d& offset) const { return offset * to_lattice_; }
    /// The inverse.
    Imath::V3d from_lattice(const Imath::V3d& point) const { return point * from_lattice_; }
    /// Rotates directions from the scene to the lattice.
    Imath::V3d direction_to_lattice(const Imath::V3d& direction) const { return direction * rotation_.transposed(); }

    /// The cell of a place, in tile units.
    FillCell cell_at(const Imath::V3d& lattice) const;
    /// Whether the cell is one of those around the domain that are numbered; spheres of no other are in the fill.
    bool has(const FillCell& cell) const;
    uint64_t cell_count() const { return count_[0] * count_[1] * count_[2]; }
    uint64_t number(const FillCell& cell) const;
    FillCell cell(uint64_t number) const;
    /// Which variant of the tile stands in the cell.
    uint32_t variant(uint64_t cell_number) const;

    uint64_t id(uint64_t cell_number, uint64_t row) const { return cell_number * tile_->rows() + row; }
    /// The sphere of an id, whether it is in the fill or not.
    Sphere sphere(uint64_t id) const;
    Sphere sphere(const FillCell& cell, uint32_t variant, uint64_t row) const;

    /// What the distance field says of all the spheres whose centre is in the cell.
    CellKind kind(uint64_t cell_number) const;
    /// Whether the sphere is in the fill: the whole of it in the domain.
    bool is_whole(uint64_t cell_number, uint64_t row) const;
    /// The same, where the sphere is at hand.
    bool is_whole(uint64_t cell_number, uint64_t row, const Sphere& sphere) const;

    /// How many spheres there may be: by the domain's volume, without looking.
    double expected_count() const;
    uint64_t bytes() const;
    /// How many times the domain had to be asked.
    uint64_t exact_tests() const { return near_surface_.domain_tests(); }

private:
    bool decide(const Sphere& sphere) const;

    std::shared_ptr<const Domain> domain_;
    std::shared_ptr<const PackingTile> tile_;
    DistanceField field_;
    SurfaceCells near_surface_;
    Imath::V3d origin_;
    double scale_ = 1, voxel_ = 1, step_ = 1, inverse_step_ = 1, largest_radius_ = 0;
    Imath::M33d rotation_, to_lattice_, from_lattice_; // Imath multiplies row vectors from the left
    std::array<int64_t, 3> first_{}; // of the numbered cells
    std::array<uint64_t, 3> count_{};
    uint64_t key_ = 0; // of the hash that chooses variants

    // Cells by number, where they are few enough to be kept.
    mutable std::unique_ptr<std::atomic<uint8_t>[]> kinds_;
};

} // namespace scree
