#pragma once

#include "mixtures/mixture.h"

#include <Imath/ImathMatrix.h>

#include <vector>

namespace scree {

/// The integer index of the cell that holds x: floor(x), or 0 where |x| is 2^60 or more or x is not finite.
int64_t cell_of(double x);

/// The rotation about x by angles.x, then about y by angles.y, then about z by angles.z, in degrees.
///
/// Multiples of 90 are exact. The bits are the same on every machine; the library's sine does not guarantee that.
/// Row vectors: position * matrix.
Imath::M33d rotation_in_degrees(const Imath::V3d& angles);

/// Cells of alternating types: cell (i, j, k) has type number (i + j + k) mod n.
class CheckerboardMixture final : public Mixture {
public:
    struct Board {
        Imath::V3d cell{1}; ///< edge lengths of a cell, above 0
        Imath::V3d offset{0}; ///< position of the corner of cell (0, 0, 0)
        Imath::V3d rotation{0}; ///< rotation of the board about that corner; see rotation_in_degrees
    };

    /// origin: the point that positions are relative to.
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
