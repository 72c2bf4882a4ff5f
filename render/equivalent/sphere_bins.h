#pragma once

#include "render/grains/grain_store.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace scree {

/// The mean radius of spheres, weighted by volume: the typical radius of the material.
///
/// margin: the margin that the given radii already include. 0 without spheres. The order of summation is fixed, so the
/// result is the same for any number of threads.
double volume_weighted_radius(std::span<const GrainStore::Sphere> spheres, const FloatMargin& margin);

/// Assigns spheres to the blocks of a voxel lattice: a sorted list whose size depends on the filled blocks and not on
/// the extent of the scene.
///
/// A block is `edge` voxels along each side; its first voxel is edge * (x, y, z).
class SphereBins {
public:
    using Voxel = std::array<int64_t, 3>;
    struct Entry {
        uint64_t key;
        uint32_t sphere;
        bool operator<(const Entry& other) const { return key != other.key ? key < other.key : sphere < other.sphere; }
    };
    /// The spheres of one block, in the order of the list.
    struct Bin {
        Voxel block;
        std::span<const Entry> entries;
    };
    /// Sets the first and last voxel that a sphere affects; returns false if it affects none.
    using Range = std::function<bool(uint32_t sphere, Voxel& first, Voxel& last)>;

    /// count: number of spheres. Throws InputError for voxels farther than 2^20 blocks from voxel 0.
    SphereBins(uint32_t count, int edge, const Range& range);

    std::span<const Bin> bins() const { return bins_; }

private:
    std::vector<Entry> entries_;
    std::vector<Bin> bins_; ///< ordered by key
};

} // namespace scree
