#include "ingest/particles/particle_frame.h"

#include <algorithm>

namespace scree {

Imath::V3d middle_of_bounds(const std::vector<Imath::V3d>& positions)
{
    if (positions.empty()) return Imath::V3d(0);
    Imath::V3d lo = positions[0], hi = lo;
    for (const Imath::V3d& p : positions) {
        for (int axis = 0; axis < 3; ++axis) {
            lo[axis] = std::min(lo[axis], p[axis]);
            hi[axis] = std::max(hi[axis], p[axis]);
        }
    }
    return lo * 0.5 + hi * 0.5;
}

} // namespace scree
