#pragma once

#include "base/math.h"

namespace scree {

/// Cells over the sphere of directions, equally wide in polar angle and in azimuth, in the frame of an Encounter.
///
/// A cell is a row (polar angle, from straight on to straight back) and a column (azimuth). The plane of incidence lies
/// in the middle of columns, because much light is scattered within this plane.
struct DirectionGrid {
    static constexpr uint32_t rows = 64, columns = 32, cells = rows * columns;
    static constexpr double row_width = pi / rows, column_width = 2 * pi / columns;

    /// Polar angle and azimuth (0..2 pi) of a unit vector.
    static V2d angles(const V3d& w)
    {
        const double phi = std::atan2(w.y, w.x);
        return {std::atan2(std::hypot(w.x, w.y), w.z), phi < 0 ? phi + 2 * pi : phi};
    }
    static V3d direction(double theta, double phi)
    {
        return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    }
    static uint32_t cell(const V2d& angles)
    {
        const auto row = std::min(rows - 1, static_cast<uint32_t>(angles.x / row_width));
        return row * columns + static_cast<uint32_t>(angles.y / column_width + 0.5) % columns;
    }
    static V3d centre(uint32_t cell)
    {
        return direction((cell / columns + 0.5) * row_width, cell % columns * column_width);
    }
    /// The cell at a row and a column, each at most one beyond its range; beyond a pole lies the opposite column.
    static uint32_t neighbour(int row, int column)
    {
        constexpr int row_count = rows, column_count = columns;
        if (row < 0 || row >= row_count) {
            row = row < 0 ? -1 - row : 2 * row_count - 1 - row;
            column += column_count / 2;
        }
        return static_cast<uint32_t>(row * column_count + (column + column_count) % column_count);
    }
    /// Solid angle of a cell.
    static double area(uint32_t cell)
    {
        const double lower = cell / columns * row_width;
        return 2 * column_width * std::sin(lower + 0.5 * row_width) * std::sin(0.5 * row_width);
    }
};

} // namespace scree
