#pragma once

#include "render/math.h"

#include <array>
#include <cstddef>

namespace scree {

/// Up to eight triangles whose distances from a place are found at once; empty lanes repeat another triangle.
///
/// Corners are in units in which the places that are asked about are about 1 apart, below 2^100 and off by less than 2^-149.
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

    /// A lower bound of the distance from a place to the nearest of the triangles, mostly some 1e-14 of the farthest corner's distance below it.
    ///
    /// The nearest of a triangle's points is that of one of its edges, or the foot on its plane, where that is in the triangle.
    double distance(const V3d& place) const;
    /// The point of a triangle that is nearest to a place, up to rounding.
    V3d nearest(size_t lane, const V3d& place) const;

private:
    double distance_with_needles(const V3d& place) const;
};

inline double TriangleBlock::distance(const V3d& place) const
{
    // Let u = 2^-53 and M be the distance of the farthest corner. Corners from the place, a to c, are off by u of each component, edges as well.
    //
    // Edges: each a + t e that is computed is within 8 u M of a point of the triangle, and t off by no more than 8 u M / |e| from the best
    // in 0..1, which makes that distance greater by no more than 8 u M; where |e|^2 underflows any t will do. Squares, sums
    // and the root add 4 u M. Together below 32 u M, of which `rounding` is twice as much.
    //
    // Plane: n = e0 x e2 is off by less than 8 u |e0| |e2| in length, so n.a by less than 16 u |a| |e0| |e2|, which `height` is lowered by
    // twice. No point of a triangle is nearer than its plane, so whether the foot is in it needs to be known only where it may be: it is
    // taken to be if it is outside by no more than about 2^-46 M.
    constexpr double tiny = 0x1p-900, inside = -0x1p-46;
    std::array<double, lanes> square, farthest, thin;
    for (size_t k = 0; k < lanes; ++k) {
        const double ox = double{corner[0][0][k]}, oy = double{corner[0][1][k]}, oz = double{corner[0][2][k]};
        const double px = double{corner[1][0][k]}, py = double{corner[1][1][k]}, pz = double{corner[1][2][k]};
        const double qx = double{corner[2][0][k]}, qy = double{corner[2][1][k]}, qz = double{corner[2][2][k]};
        const double ax = ox - place.x, ay = oy - place.y, az = oz - place.z;
        const double bx = px - place.x, by = py - place.y, bz = pz - place.z;
        const double cx = qx - place.x, cy = qy - place.y, cz = qz - place.z;
        const double ux = px - ox, uy = py - oy, uz = pz - oz, vx = qx - px, vy = qy - py, vz = qz - pz, wx = ox - qx, wy = oy - qy, wz = oz - qz;
        const double uu = ux * ux + uy * uy + uz * uz, vv = vx * vx + vy * vy + vz * vz, ww = wx * wx + wy * wy + wz * wz;
        const double aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;

        const double su = -(ax * ux + ay * uy + az * uz) / (uu > tiny ? uu : tiny);
        const double sv = -(bx * vx + by * vy + bz * vz) / (vv > tiny ? vv : tiny);
        const double sw = -(cx * wx + cy * wy + cz * wz) / (ww > tiny ? ww : tiny);
        const double tu = su < 0 ? 0 : su > 1 ? 1 : su, tv = sv < 0 ? 0 : sv > 1 ? 1 : sv, tw = sw < 0 ? 0 : sw > 1 ? 1 : sw;
        const double fx = ax + tu * ux, fy = ay + tu * uy, fz = az + tu * uz;
        const double gx = bx + tv * vx, gy = by + tv * vy, gz = bz + tv * vz;
        const double hx = cx + tw * wx, hy = cy + tw * wy, hz = cz + tw * wz;
        const double ff = fx * fx + fy * fy + fz * fz, gg = gx * gx + gy * gy + gz * gz, hh = hx * hx + hy * hy + hz * hz;
        const double fg = ff < gg ? ff : gg, edges = fg < hh ? fg : hh;

        const double nx = wy * uz - wz * uy, ny = wz * ux - wx * uz, nz = wx * uy - wy * ux;
        const double nn = nx * nx + ny * ny + nz * nz;
        // From the place's foot: n . (a x b) and so on, all of one sign in the triangle; here n points so that it is positive.
        const double iu = nx * (ay * bz - az * by) + ny * (az * bx - ax * bz) + nz * (ax * by - ay * bx);
        const double iv = nx * (by * cz - bz * cy) + ny * (bz * cx - bx * cz) + nz * (bx * cy - by * cx);
        const double iw = nx * (cy * az - cz * ay) + ny * (cz * ax - cx * az) + nz * (cx * ay - cy * ax);
        const double least = iu < iv ? (iu < iw ? iu : iw) : (iv < iw ? iv : iw);
        const double ab = aa > bb ? aa : bb, far = ab > cc ? ab : cc;
        const double high = ax * nx + ay * ny + az * nz, off = 0x1p-48 * (std::abs(ax) + std::abs(ay) + std::abs(az)) * (std::abs(ux) + std::abs(uy) + std::abs(uz)) * (std::abs(wx) + std::abs(wy) + std::abs(wz));
        const double height = std::abs(high) - off, low = height > 0 ? height : 0;
        const double plane = low * low / (nn > tiny ? nn : tiny);
        const double both = plane < edges ? plane : edges;
        // nn has 4 powers of lengths.
        const double scale = (std::abs(nx) + std::abs(ny) + std::abs(nz)) * far;
        square[k] = least >= inside * scale ? both : edges;
        farthest[k] = far;
        // Where the normal is hardly known the plane tells nothing.
        thin[k] = nn < 0x1p-52 * uu * ww || nn <= 0x1p-800 ? 1.0 : 0.0;
    }
    // By halves: a chain of minima is slow, and compilers may not reorder it.
    for (size_t half = lanes / 2; half > 0; half /= 2)
        for (size_t k = 0; k < half; ++k) {
            square[k] = square[k + half] < square[k] ? square[k + half] : square[k];
            farthest[k] = farthest[k + half] > farthest[k] ? farthest[k + half] : farthest[k];
            thin[k] = thin[k + half] > thin[k] ? thin[k + half] : thin[k];
        }
    if (thin[0] > 0) return distance_with_needles(place);
    return std::max(0.0, std::sqrt(square[0]) - 0x1p-47 * std::sqrt(farthest[0]) - 0x1p-140);
}

} // namespace scree
