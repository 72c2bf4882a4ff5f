#pragma once

#include "base/math.h"

#include <array>
#include <cstddef>

namespace scree {

/// Up to eight triangles whose distances from a point are computed at once; unused lanes repeat another triangle.
///
/// Corners are in units in which the query points are about 1 apart; they are below 2^100 and exact to 2^-149.
struct TriangleBlock {
    static constexpr size_t lanes = 8;
    using Lanes = std::array<float, lanes>;

    std::array<std::array<Lanes, 3>, 3> corner{}; ///< [corner][axis][lane]

    void set(size_t lane, const std::array<V3f, 3>& triangle)
    {
        for (size_t k = 0; k < 3; ++k)
            for (size_t axis = 0; axis < 3; ++axis) corner[k][axis][lane] = triangle[k][static_cast<int>(axis)];
    }
    std::array<V3d, 3> triangle(size_t lane) const
    {
        std::array<V3d, 3> t;
        for (size_t k = 0; k < 3; ++k) t[k] = V3d(corner[k][0][lane], corner[k][1][lane], corner[k][2][lane]);
        return t;
    }

    /// Squared distances in float: `low` is never above the exact value, `about` may be above or below it.
    struct Squares {
        Lanes low, about;
    };
    Squares squares(const V3d& place) const;
    /// A lower bound of the distance from a point to one of the triangles, mostly about 1e-14 of the farthest corner's
    /// distance below the exact value.
    double distance(size_t lane, const V3d& place) const;
    /// The point of a triangle that is nearest to a given point, up to rounding.
    V3d nearest(size_t lane, const V3d& place) const;
};

inline TriangleBlock::Squares TriangleBlock::squares(const V3d& place) const
{
    // The nearest point of a triangle is the nearest point of one of its edges, or the foot of the perpendicular on its
    // plane if the foot is inside the triangle.
    //
    // Let u = 2^-24, q the query point relative to a corner of the block, M the farthest corner's distance from the
    // query point and S^2 = q^2 + M^2. The corners a, b, c relative to the query point have errors below 8 u S, the
    // edges below u of each component.
    //
    // Edges: each computed a + t e is within 16 u S of a point of the triangle, and t is within 16 u S / |e| of the
    // best t in 0..1; where |e|^2 underflows any t is good enough. With squares and sums the error is below 64 u S, and
    // (d - 64 u S)^2 >= (1 - 2^-13) d^2 - 2^-23 S^2.
    //
    // Plane: the error of n = w x u is below 8 u |u| |w| in length, so that of n.a is below 16 u |a| |u| |w|; `lowered`
    // is `high` minus twice this. The error of a counts as for the edges. No point of a triangle is nearer than its
    // plane, so the plane's distance may be used for `low` wherever the foot may be inside.
    constexpr float tiny = 0x1p-100f, tolerance = 0x1p-17f;
    const V3d origin(double{corner[0][0][0]}, double{corner[0][1][0]}, double{corner[0][2][0]});
    const V3f q(place - origin), o{origin};
    const float qq = q.x * q.x + q.y * q.y + q.z * q.z;
    Squares squares;
    for (size_t k = 0; k < lanes; ++k) {
        const float ox = corner[0][0][k], oy = corner[0][1][k], oz = corner[0][2][k];
        const float px = corner[1][0][k], py = corner[1][1][k], pz = corner[1][2][k];
        const float rx = corner[2][0][k], ry = corner[2][1][k], rz = corner[2][2][k];
        const float ax = (ox - o.x) - q.x, ay = (oy - o.y) - q.y, az = (oz - o.z) - q.z;
        const float bx = (px - o.x) - q.x, by = (py - o.y) - q.y, bz = (pz - o.z) - q.z;
        const float cx = (rx - o.x) - q.x, cy = (ry - o.y) - q.y, cz = (rz - o.z) - q.z;
        const float ux = px - ox, uy = py - oy, uz = pz - oz, vx = rx - px, vy = ry - py, vz = rz - pz, wx = ox - rx,
                    wy = oy - ry, wz = oz - rz;
        const float uu = ux * ux + uy * uy + uz * uz, vv = vx * vx + vy * vy + vz * vz,
                    ww = wx * wx + wy * wy + wz * wz;
        const float aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz,
                    cc = cx * cx + cy * cy + cz * cz;

        const float su = -(ax * ux + ay * uy + az * uz) / (uu > tiny ? uu : tiny);
        const float sv = -(bx * vx + by * vy + bz * vz) / (vv > tiny ? vv : tiny);
        const float sw = -(cx * wx + cy * wy + cz * wz) / (ww > tiny ? ww : tiny);
        const float tu = su < 0   ? 0
                         : su > 1 ? 1
                                  : su,
                    tv = sv < 0   ? 0
                         : sv > 1 ? 1
                                  : sv,
                    tw = sw < 0   ? 0
                         : sw > 1 ? 1
                                  : sw;
        const float fx = ax + tu * ux, fy = ay + tu * uy, fz = az + tu * uz;
        const float gx = bx + tv * vx, gy = by + tv * vy, gz = bz + tv * vz;
        const float hx = cx + tw * wx, hy = cy + tw * wy, hz = cz + tw * wz;
        const float ff = fx * fx + fy * fy + fz * fz, gg = gx * gx + gy * gy + gz * gz,
                    hh = hx * hx + hy * hy + hz * hz;
        const float fg = ff < gg ? ff : gg, edges = fg < hh ? fg : hh;

        const float nx = wy * uz - wz * uy, ny = wz * ux - wx * uz, nz = wx * uy - wy * ux;
        const float nn = nx * nx + ny * ny + nz * nz;
        // All are 0 or more where the foot is inside.
        const float iu = nx * (ay * bz - az * by) + ny * (az * bx - ax * bz) + nz * (ax * by - ay * bx);
        const float iv = nx * (by * cz - bz * cy) + ny * (bz * cx - bx * cz) + nz * (bx * cy - by * cx);
        const float iw = nx * (cy * az - cz * ay) + ny * (cz * ax - cx * az) + nz * (cx * ay - cy * ax);
        const float uv = iu < iv ? iu : iv, inside = uv < iw ? uv : iw;
        const float ab = aa > bb ? aa : bb, far = qq + (ab > cc ? ab : cc);
        const float u1 = std::abs(ux) + std::abs(uy) + std::abs(uz), w1 = std::abs(wx) + std::abs(wy) + std::abs(wz),
                    a1 = std::abs(ax) + std::abs(ay) + std::abs(az);
        const float high = std::abs(ax * nx + ay * ny + az * nz), lowered = high - 0x1p-19f * a1 * u1 * w1,
                    lowest = lowered > 0 ? lowered : 0;
        const float area = nn > tiny ? nn : tiny, plane = high * high / area, below = lowest * lowest / area;
        const float about = inside >= 0 ? plane : edges,
                    under = inside >= -tolerance * (u1 * w1) * far ? (below < edges ? below : edges) : edges;
        const float low = under * (1 - 0x1p-12f) - 0x1p-22f * far - 0x1p-100f;
        squares.about[k] = about;
        // 0 where the normal is inaccurate, because then the plane gives no bound; also for NaN.
        squares.low[k] = nn >= 0x1p-18f * uu * ww && nn > tiny && low > 0 ? low : 0;
    }
    return squares;
}

} // namespace scree
