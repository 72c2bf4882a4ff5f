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
    uint64_t seed = 0; ///< chooses the variant of the tile in each cell
};

/// The spheres of an endlessly repeated tile that lie wholly in a domain: described by a rule, never listed.
///
/// The lattice of tiles is rotated about the middle of the domain's bounds, by a fixed generic rotation. Every
/// lattice vector of up to 9 cells stays at least 0.17 of a cell away from the axes and diagonals of the scene, so that
/// no repetition shows along them. A hash of the cell chooses the cell's variant of the tile. A sphere's id is
/// number(cell) * rows + row. Centres are `origin` plus multiples of a power of two, so that a file of points stores
/// them without loss. Any thread may call any const function.
class ProceduralFill {
public:
    struct Sphere {
        Imath::V3d centre; ///< scene
        float radius;
    };
    enum class CellKind : uint8_t { unknown, outside, boundary, inside };

    /// Throws InputError when the tile is so coarse or so fine for the domain that ids need more than 62 bits.
    ProceduralFill(std::shared_ptr<const Domain> domain, std::shared_ptr<const PackingTile> tile,
                   const FillOptions& options);

    const Domain& domain() const { return *domain_; }
    const PackingTile& tile() const { return *tile_; }
    /// The middle of the domain's bounds.
    const Imath::V3d& origin() const { return origin_; }
    /// Scene units per tile unit.
    double scale() const { return scale_; }
    /// Each coordinate of a centre, relative to the origin, is a multiple of 2^-24 of `voxel`.
    double voxel() const { return voxel_; }
    double largest_radius() const { return largest_radius_; }
    /// Radius of a row's spheres in the scene.
    float radius(uint64_t row) const { return static_cast<float>(tile_->radius[row] * scale_); }

    /// Transforms to tile units, with the corner of cell (0, 0, 0) at 0. offset: a scene place relative to `origin`.
    Imath::V3d to_lattice(const Imath::V3d& offset) const { return offset * to_lattice_; }
    /// The inverse of to_lattice.
    Imath::V3d from_lattice(const Imath::V3d& point) const { return point * from_lattice_; }
    /// Rotates directions from the scene to the lattice.
    Imath::V3d direction_to_lattice(const Imath::V3d& direction) const { return direction * rotation_.transposed(); }

    /// The cell that contains a place given in tile units.
    FillCell cell_at(const Imath::V3d& lattice) const;
    /// Whether the cell is one of the numbered cells around the domain; no other cell has spheres in the fill.
    bool has(const FillCell& cell) const;
    uint64_t cell_count() const { return count_[0] * count_[1] * count_[2]; }
    uint64_t number(const FillCell& cell) const;
    FillCell cell(uint64_t number) const;
    /// The index of the tile's variant in the cell.
    uint32_t variant(uint64_t cell_number) const;

    uint64_t id(uint64_t cell_number, uint64_t row) const { return cell_number * tile_->rows() + row; }
    /// The sphere of an id, whether or not the sphere is in the fill.
    Sphere sphere(uint64_t id) const;
    Sphere sphere(const FillCell& cell, uint32_t variant, uint64_t row) const;

    /// Where all spheres with their centres in the cell lie, as far as the distance field can tell.
    CellKind kind(uint64_t cell_number) const;
    /// Whether the sphere is in the fill, that is, wholly inside the domain.
    bool is_whole(uint64_t cell_number, uint64_t row) const;
    /// The same, when the caller already has the sphere.
    bool is_whole(uint64_t cell_number, uint64_t row, const Sphere& sphere) const;

    /// Expected number of spheres, estimated from the domain's volume alone.
    double expected_count() const;
    uint64_t bytes() const;
    /// How many sphere tests needed the domain's exact answer.
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
    std::array<int64_t, 3> first_{}; // lowest numbered cell along each axis
    std::array<uint64_t, 3> count_{};
    uint64_t key_ = 0; // of the hash that chooses the variants

    // The kind of each cell by its number; null where there are too many cells to store.
    mutable std::unique_ptr<std::atomic<uint8_t>[]> kinds_;
};

} // namespace scree
