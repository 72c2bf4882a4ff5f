#pragma once

// Private to the medium: steps a ray through the bricks of a field and through the cells of a brick.

#include "render/media/brick_field.h"

namespace scree {

/// A ray in field coordinates. Its parameter t is that of the original ray.
struct FieldRay {
    V3d o, d;
    V3d inverse; ///< 1 / d, or 1e290 instead of infinity where d is almost 0
    std::array<int32_t, 3> step; ///< sign of d; 0 where d is almost 0: the ray does not move along that axis
    /// The face through which the ray leaves a cell: 0 or 1 cells from its lower face; 2 (never reached) where step is
    /// 0.
    std::array<int32_t, 3> ahead;

    FieldRay(const V3d& origin, const V3d& direction) : o(origin), d(direction)
    {
        for (int k = 0; k < 3; ++k) {
            const size_t a = static_cast<size_t>(k);
            inverse[k] = 1 / d[k];
            // far larger than any voxel's width, far smaller than 1e290
            const bool moves = std::abs(inverse[k]) < 1e150;
            if (!moves) inverse[k] = 1e290;
            step[a] = !moves ? 0 : d[k] > 0 ? 1 : -1;
            ahead[a] = !moves ? 2 : d[k] > 0 ? 1 : 0;
        }
    }
    V3d at(double t) const { return o + d * t; }
    /// Narrows t0..t1 to the part inside the box; false when nothing is left.
    bool clip(const Imath::Box3d& box, double& t0, double& t1) const;
};

inline bool FieldRay::clip(const Imath::Box3d& box, double& t0, double& t1) const
{
    for (int k = 0; k < 3; ++k) {
        if (step[static_cast<size_t>(k)] == 0) {
            if (!(o[k] >= box.min[k] && o[k] <= box.max[k])) return false;
            continue;
        }
        const double a = (box.min[k] - o[k]) * inverse[k], b = (box.max[k] - o[k]) * inverse[k];
        t0 = std::max(t0, std::min(a, b));
        t1 = std::min(t1, std::max(a, b));
    }
    return t0 < t1;
}

/// Where a ray leaves the cell of `size` units that begins at `low`: through each face whose distance equals `exit`
/// (two or three faces at an edge or corner).
///
/// Every step advances by at least one cell along at least one axis and never goes back: rounding cannot make a walk
/// loop.
struct RayStep {
    std::array<double, 3> faces;
    double exit;

    RayStep(const FieldRay& ray, const std::array<int32_t, 3>& low, int32_t size)
    {
        for (size_t k = 0; k < 3; ++k)
            faces[k] = (low[k] + ray.ahead[k] * size - ray.o[static_cast<int>(k)]) * ray.inverse[static_cast<int>(k)];
        exit = std::min(std::min(faces[0], faces[1]), faces[2]);
    }
    bool leaves_through(size_t axis) const { return faces[axis] <= exit; }
};

/// Calls visit(content index, low corner in cells, t0, t1) for each non-empty region along t0..t1, in order, until
/// `visit` returns true.
template <class Visit>
void walk_bricks(const BrickField& field, const FieldRay& ray, double t0, double t1, Visit&& visit)
{
    if (field.bricks[0] == 0 || !ray.clip(field.support, t0, t1)) return;
    std::array<int32_t, 3> brick;
    constexpr double inverse_width = 1.0 / BrickField::width;
    const auto brick_at = [&](const V3d& p, int k, int32_t low, int32_t high) {
        return static_cast<int32_t>(
            std::min(std::max(std::floor(p[k] * inverse_width), double{0} + low), double{0} + high));
    };
    const V3d start = ray.at(t0);
    for (int k = 0; k < 3; ++k)
        brick[static_cast<size_t>(k)] = brick_at(start, k, 0, field.bricks[static_cast<size_t>(k)] - 1);
    for (;;) {
        const BrickField::Region region = field.find(brick);
        const int32_t mask = ~(region.size - 1);
        const std::array<int32_t, 3> low{(brick[0] & mask) * BrickField::width, (brick[1] & mask) * BrickField::width,
                                         (brick[2] & mask) * BrickField::width};
        const RayStep step(ray, low, region.size * BrickField::width);
        const double t = std::min(std::max(step.exit, t0), t1);
        if (region.content >= 0 && visit(region.content, low, t0, t)) return;
        if (!(step.exit < t1)) return;
        if (region.size > 1) {
            const V3d p = ray.at(t);
            for (int k = 0; k < 3; ++k) {
                const size_t a = static_cast<size_t>(k);
                const int32_t first = brick[a] & mask, last = first + region.size - 1;
                if (step.leaves_through(a))
                    brick[a] = ray.step[a] > 0 ? last : first;
                else
                    brick[a] = ray.step[a] > 0   ? brick_at(p, k, brick[a], last)
                               : ray.step[a] < 0 ? brick_at(p, k, first, brick[a])
                                                 : brick[a];
            }
        }
        bool inside = true;
        for (size_t k = 0; k < 3; ++k) {
            brick[k] += step.leaves_through(k) ? ray.step[k] : 0;
            inside &= static_cast<uint32_t>(brick[k]) < static_cast<uint32_t>(field.bricks[k]);
        }
        if (!inside) return;
        t0 = t;
    }
}

/// Calls visit(low corner of a cell, t0, t1) for each cell along t0..t1 of the brick that begins at `low`, until
/// `visit` returns true. Returns whether it did.
template <class Visit>
bool walk_cells(const FieldRay& ray, const std::array<int32_t, 3>& low, double t0, double t1, Visit&& visit)
{
    std::array<int32_t, 3> cell;
    const V3d start = ray.at(t0);
    for (size_t k = 0; k < 3; ++k)
        cell[k] = low[k] + static_cast<int32_t>(std::min(std::max(std::floor(start[static_cast<int>(k)] - low[k]), 0.0),
                                                         double{BrickField::width - 1}));
    for (;;) {
        const RayStep step(ray, cell, 1);
        const double t = std::min(std::max(step.exit, t0), t1);
        if (visit(cell, t0, t)) return true;
        if (!(step.exit < t1)) return false;
        bool inside = true;
        for (size_t k = 0; k < 3; ++k) {
            cell[k] += step.leaves_through(k) ? ray.step[k] : 0;
            inside &= static_cast<uint32_t>(cell[k] - low[k]) < uint32_t{BrickField::width};
        }
        if (!inside) return false;
        t0 = t;
    }
}

} // namespace scree
