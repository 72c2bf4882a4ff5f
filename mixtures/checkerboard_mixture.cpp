#include "mixtures/checkerboard_mixture.h"

#include <cmath>
#include <numbers>

namespace scree {

namespace {

/// Cosine and sine of an angle in degrees: reduced to an eighth of a turn, then by Taylor series.
std::pair<double, double> cosine_and_sine(double degrees)
{
    const double turns = degrees / 90, quarter = std::floor(turns + 0.5);
    const double x = (turns - quarter) * (std::numbers::pi / 2), xx = x * x;
    double c = 0, s = 0;
    for (int k = 10; k > 0; --k) { // Horner, from the smallest term
        c = (1 - c) * xx / (2 * k * (2 * k - 1));
        s = (1 - s) * xx / (2 * k * (2 * k + 1));
    }
    c = 1 - c;
    s = x * (1 - s);
    switch (static_cast<int>(quarter - 4 * std::floor(quarter / 4))) {
    case 1: return {-s, c};
    case 2: return {-c, -s};
    case 3: return {s, -c};
    default: return {c, s};
    }
}

} // namespace

int64_t cell_of(double x) { return std::abs(x) < 0x1p60 ? static_cast<int64_t>(std::floor(x)) : 0; }

Imath::M33d rotation_in_degrees(const Imath::V3d& angles)
{
    const auto [cx, sx] = cosine_and_sine(angles.x);
    const auto [cy, sy] = cosine_and_sine(angles.y);
    const auto [cz, sz] = cosine_and_sine(angles.z);
    const Imath::M33d x(1, 0, 0, 0, cx, sx, 0, -sx, cx), y(cy, 0, -sy, 0, 1, 0, sy, 0, cy),
        z(cz, sz, 0, -sz, cz, 0, 0, 0, 1);
    return x * y * z;
}

CheckerboardMixture::CheckerboardMixture(const Board& board, std::vector<uint32_t> types, const Imath::V3d& origin)
    : shift_(origin - board.offset), cell_(board.cell), rotated_(board.rotation != Imath::V3d(0)),
      types_(std::move(types))
{
    const Imath::M33d rotation = rotation_in_degrees(board.rotation);
    for (int a = 0; a < 3; ++a)
        axis_[a] = Imath::V3d(rotation[a][0], rotation[a][1], rotation[a][2]); // the board's axes in space
}

uint32_t CheckerboardMixture::type(uint64_t, const Imath::V3f& position) const
{
    Imath::V3d p = shift_ + Imath::V3d(position);
    if (rotated_) p = Imath::V3d(p.dot(axis_[0]), p.dot(axis_[1]), p.dot(axis_[2]));
    const int64_t sum = cell_of(p.x / cell_.x) + cell_of(p.y / cell_.y) + cell_of(p.z / cell_.z);
    if (types_.size() == 2) return types_[static_cast<size_t>(sum & 1)];
    const auto n = static_cast<int64_t>(types_.size());
    const int64_t rest = sum % n;
    return types_[static_cast<size_t>(rest < 0 ? rest + n : rest)];
}

} // namespace scree
