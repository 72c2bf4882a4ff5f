#pragma once

#include "mixtures/mixture.h"

#include <Imath/ImathMatrix.h>

#include <vector>

namespace scree {

/// A number as the integer of its cell: its floor; 0 for what is too far out to count (2^60 and beyond) or not finite.
int64_t cell_of(double x);

/// The rotation about x by angles.x, then about y, then about z, in degrees; multiples of 90 are exact, and the bits
/// are the same on every machine, which those of the library's sine are not. Row vectors: place * matrix.
Imath::M33d rotation_in_degrees(const Imath::V3d& angles);

/// Cells in turns: cell (i, j, k) has type number (i + j + k) mod n.
class CheckerboardMixture final : public Mixture {
public:
    struct Board {
        Imath::V3d cell{1}; ///< edges of a cell, above 0
        Imath::V3d offset{0}; ///< where the corner of cell (0, 0, 0) lies
        Imath::V3d rotation{0}; ///< of the board about that corner; see rotation_in_degrees
    };

    /// origin: the place that positions are relative to.
    CheckerboardMixture(const Board& board, std::vector<uint32_t> types, const Imath::V3d& origin);

    uint32_t type(uint64_t index, const Imath::V3f& position) const override;
    std::optional<std::set<uint32_t>> possible_types() const override
    {
        return std::set<uint32_t>(types_.begin(), types_.end());
    }

private:
    Imath::V3d shift_, cell_, axis_[3];
    bool rotated_;
    std::vector<uint32_t> types_;
};

} // namespace scree
