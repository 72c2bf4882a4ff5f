#include "render/media/medium_pyramid.h"

#include "base/error.h"

#include <tbb/parallel_for.h>

namespace scree {

namespace {

constexpr double most_cells = 1 << 20; ///< of the first level
/// spacing in voxels: below 1, so that every voxel is sampled wherever the cubes begin
constexpr double finest_samples = 0.75;
constexpr double rounded = 1e-6; ///< rounding error of sums in single precision, for quantities without unit
/// a safe multiple of it, for tests that must not reject a ball that is_same() accepts
constexpr double slack = 4 * rounded;

} // namespace

void MediumPyramid::Cell::add(const Cell& other, Real weight)
{
    const bool first = sigma_t == 0 && sigma_high == 0 && back_high == 0;
    sigma_t += weight * other.sigma_t;
    for (size_t c = 0; c < 3; ++c) lost[c] += weight * other.lost[c];
    forward += weight * other.forward;
    sigma_square += weight * other.sigma_square;
    loss_square += weight * other.loss_square;
    back_square += weight * other.back_square;
    const auto widen = [first](Real& low, Real& high, Real other_low, Real other_high) {
        low = first ? other_low : std::min(low, other_low);
        high = first ? other_high : std::max(high, other_high);
    };
    widen(sigma_low, sigma_high, other.sigma_low, other.sigma_high);
    widen(loss_low, loss_high, other.loss_low, other.loss_high);
    widen(back_low, back_high, other.back_low, other.back_high);
}

void MediumPyramid::Cell::forget_range()
{
    sigma_low = sigma_high = sigma_t;
    loss_low = loss_high = loss();
    back_low = back_high = back();
}

void MediumPyramid::Cell::forget_squares()
{
    sigma_square = sigma_t * sigma_t;
    loss_square = sigma_t * loss() * loss();
    back_square = brightest() * back() * back();
}

MediumPyramid::Cell MediumPyramid::cell_at(const Medium& medium, const V3d& place)
{
    Cell cell;
    cell.sigma_t = medium.sigma_t(place).x;
    const Weight albedo = medium.albedo(place);
    for (unsigned c = 0; c < 3; ++c) cell.lost[c] = static_cast<Real>(cell.sigma_t * (1 - albedo[c]));
    cell.forward = static_cast<Real>(cell.brightest() * medium.g(place));
    cell.forget_range();
    cell.forget_squares();
    return cell;
}

MediumPyramid::MediumPyramid(const Medium& medium, const Imath::Box3d& box, double tolerance, double thin,
                             const Progress& progress)
    : tolerance_(tolerance), most_off_(tolerance + slack)
{
    const V3d extent = box.size();
    if (box.isEmpty() || !(extent.x > 0 && extent.y > 0 && extent.z > 0)) return;
    origin_ = box.min;
    width_ = std::max(medium.voxel(), std::cbrt(extent.x * extent.y * extent.z / most_cells));
    const int samples = std::clamp(static_cast<int>(std::ceil(width_ / (finest_samples * medium.voxel()))), 2, 64);
    const Real share = 1 / static_cast<Real>(samples);
    Level first;
    first.width = width_;
    for (int k = 0; k < 3; ++k)
        first.size[static_cast<size_t>(k)] = static_cast<int64_t>(std::ceil(extent[k] / width_));
    first.cells.resize(static_cast<size_t>(first.size[0] * first.size[1] * first.size[2]));
    tbb::parallel_for(int64_t{0}, first.size[0], [&](int64_t x) {
        if (progress.cancelled()) return;
        for (int64_t y = 0; y < first.size[1]; ++y) {
            for (int64_t z = 0; z < first.size[2]; ++z) {
                const V3d low =
                    origin_ + width_ * V3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
                Cell& cell = first.cells[static_cast<size_t>((x * first.size[1] + y) * first.size[2] + z)];
                // Sums row by row and plane by plane: one sum of so many terms in single precision would be inaccurate.
                for (int i = 0; i < samples; ++i) {
                    Cell plane;
                    for (int j = 0; j < samples; ++j) {
                        Cell row;
                        for (int k = 0; k < samples; ++k) {
                            V3d place = low + width_ / samples * V3d(k + 0.5, j + 0.5, i + 0.5);
                            for (int axis = 0; axis < 3; ++axis)
                                place[axis] =
                                    std::min(place[axis], box.max[axis]); // the last cube reaches beyond the box
                            row.add(cell_at(medium, place), share);
                        }
                        plane.add(row, share);
                    }
                    cell.add(plane, share);
                }
                cell.forget_range();
            }
        }
    });
    if (progress.cancelled()) throw Cancelled();
    levels_.push_back(std::move(first));
    for (double width = width_; levels_.back().cells.size() > 1; width *= 2) {
        for (Cell& cell : levels_.back().cells)
            if (cell.sigma_t * width < thin) cell.forget_squares();
        add_level();
    }
    fill_promising();
    // No mean exceeds the largest sigma_t and albedo of all cubes. The other extremes are taken over cubes of the next
    // level: single grains are not a medium.
    for (const Cell& cell : levels_[0].cells) {
        if (!(cell.sigma_t > 0)) continue;
        extremes_.sigma_t_high = std::max(extremes_.sigma_t_high, double{cell.sigma_t});
        extremes_.albedo_high = std::max(extremes_.albedo_high, 1 - double{cell.loss_low});
    }
    for (Cell cell : levels_[std::min<size_t>(1, levels_.size() - 1)].cells) {
        if (!(cell.sigma_t > 0)) continue;
        cell.forget_range();
        extremes_.albedo_low = std::min(extremes_.albedo_low, 1 - double{cell.loss_high});
        extremes_.g_low = std::min(extremes_.g_low, 1 - double{cell.back_high});
        extremes_.g_high = std::max(extremes_.g_high, 1 - double{cell.back_low});
    }
}

void MediumPyramid::add_level()
{
    const Level& below = levels_.back();
    Level above{2 * below.width, {(below.size[0] + 1) / 2, (below.size[1] + 1) / 2, (below.size[2] + 1) / 2}, {}};
    for (int64_t x = 0; x < above.size[0]; ++x) {
        for (int64_t y = 0; y < above.size[1]; ++y) {
            for (int64_t z = 0; z < above.size[2]; ++z) {
                const int64_t parts = (2 * x + 1 < below.size[0] ? 2 : 1) * (2 * y + 1 < below.size[1] ? 2 : 1) *
                                      (2 * z + 1 < below.size[2] ? 2 : 1);
                Cell& cell = above.cells.emplace_back();
                for (int64_t part = 0; part < 8; ++part) {
                    const int64_t i = 2 * x + (part & 1), j = 2 * y + (part >> 1 & 1), k = 2 * z + (part >> 2);
                    if (i >= below.size[0] || j >= below.size[1] || k >= below.size[2]) continue;
                    Cell own = below.at(i, j, k);
                    own.forget_range(); // use the mean of the part, not the variation inside it
                    cell.add(own, 1 / static_cast<Real>(parts));
                }
            }
        }
    }
    levels_.push_back(std::move(above));
}

void MediumPyramid::fill_promising()
{
    std::vector<uint32_t> above;
    for (size_t number = levels_.size(); number-- > 0; above.swap(promising_)) {
        const Level& level = levels_[number];
        promising_.resize(level.cells.size());
        tbb::parallel_for(int64_t{0}, level.size[0], [&](int64_t x) {
            for (int64_t y = 0; y < level.size[1]; ++y) {
                for (int64_t z = 0; z < level.size[2]; ++z) {
                    uint32_t bits =
                        number + 1 < levels_.size() ? above[levels_[number + 1].index(x / 2, y / 2, z / 2)] : 0;
                    // Two levels below the ball's level, the cube of its centre decides which cubes the ball certainly
                    // overlaps.
                    for (size_t of = number > 0 ? number + 2 : 0; of <= number + 2 && of < levels_.size(); ++of) {
                        if (may_hold(of, number, {x, y, z})) bits |= uint32_t{1} << of;
                    }
                    promising_[level.index(x, y, z)] = bits;
                }
            }
        });
    }
    promising_.swap(above);
}

bool MediumPyramid::may_hold(size_t number, size_t finer, const std::array<int64_t, 3>& cube) const
{
    const Level& level = levels_[number];
    // Except on the first level, a ball is wider than half a cube of its level and not wider than one cube. So a ball
    // with its centre in an outer quarter of a cube reaches into the next cube.
    std::array<int64_t, 3> own, next;
    double share = 1; // least part of the ball, by width, that is in its centre's cube
    for (size_t k = 0; k < 3; ++k) {
        own[k] = next[k] = cube[k] >> (number - finer);
        const int64_t quarter = number - finer == 2 ? cube[k] & 3 : -1;
        if (quarter == 0 && own[k] > 0) --next[k];
        if (quarter == 3 && own[k] + 1 < level.size[k]) ++next[k];
        share *= quarter == 1 || quarter == 2 ? 0.75 : 0.5;
    }
    const Cell& middle = level.at(own[0], own[1], own[2]);
    Cell range;
    for (const int64_t x : {own[0], next[0]}) {
        for (const int64_t y : {own[1], next[1]}) {
            for (const int64_t z : {own[2], next[2]}) range.add(level.at(x, y, z), 1);
        }
    }
    // The conditions of is_same(), which cover all cubes that a ball overlaps and their mean, can hold only if they
    // hold for the cubes here.
    const auto close = [this](double low, double high) {
        return (high - slack) * (1 - tolerance_) <= (low + slack) * (1 + tolerance_);
    };
    const double highest_mean = double{range.sigma_low} / (1 - most_off_);
    if (!(0.5 * level.width * highest_mean >= 1 - slack)) return false;
    if (!(may_be_close(range.sigma_low, range.sigma_high) && close(range.loss_low, range.loss_high) &&
          close(range.back_low, range.back_high)))
        return false;
    const double most = (0.25 * most_off_ * most_off_ + slack) * highest_mean * highest_mean;
    return share * middle.variance() <= most &&
           (number > 0 || share * middle.variance() + (1 - share) * least_variance_around(own) <= most);
}

double MediumPyramid::least_variance_around(const std::array<int64_t, 3>& cube) const
{
    const Level& level = levels_[0];
    const auto each = [&](size_t axis, const auto& visit) {
        for (int64_t i = std::max<int64_t>(0, cube[axis] - 1); i < std::min(level.size[axis], cube[axis] + 2); ++i)
            visit(i);
    };
    double least = level.at(cube[0], cube[1], cube[2]).variance();
    each(0, [&](int64_t x) {
        each(1, [&](int64_t y) { each(2, [&](int64_t z) { least = std::min(least, level.at(x, y, z).variance()); }); });
    });
    return least;
}

size_t MediumPyramid::level_of(double radius) const
{
    size_t number = 0;
    while (number + 1 < levels_.size() && levels_[number].width < 2 * radius) ++number;
    return number;
}

bool MediumPyramid::halve_until_same(const V3d& centre, double& radius, MediumMean& mean) const
{
    if (levels_.empty()) return false;
    std::array<int64_t, 3> cube;
    double room = width_; // distance from the centre to the faces of its cube of the first level
    for (int k = 0; k < 3; ++k) {
        const double at = (centre[k] - origin_[k]) / width_,
                     size = static_cast<double>(levels_[0].size[static_cast<size_t>(k)]);
        if (!(at >= 0 && at < size)) return false;
        cube[static_cast<size_t>(k)] = static_cast<int64_t>(at);
        const double part = at - std::floor(at);
        room = std::min(room, width_ * std::min(part, 1 - part));
    }
    const size_t own = levels_[0].index(cube[0], cube[1], cube[2]);
    const uint32_t promising = promising_[own];
    if (promising == 0) return false;
    double densest = extremes_.sigma_t_high;
    for (size_t level = level_of(radius); radius * densest >= 1; radius /= 2) {
        while (level > 0 && levels_[level - 1].width >= 2 * radius) --level;
        if (level == 0) {
            if ((promising & 1) == 0) return false;
            densest = std::min(densest,
                               double{levels_[0].cells[own].sigma_t} / (1 - most_off_)); // bound for homogeneous balls
            if (!(radius * densest >= 1)) return false;
        }
        if ((promising >> level & 1) != 0 && is_same(centre, radius, level, mean)) return true;
        if (radius < room) return false; // smaller balls lie in the same cube
    }
    return false;
}

bool MediumPyramid::is_same(const V3d& centre, double radius, size_t number, MediumMean& mean) const
{
    if (levels_.empty()) return false;
    // The cubes of the level are at least as wide as the ball: it overlaps at most two of them along an axis.
    const Level& level = levels_[number];
    const double width = level.width;
    std::array<int64_t, 3> first, last;
    std::array<std::array<double, 2>, 3> share; // part of the ball's width in the first and in the last cube
    for (int k = 0; k < 3; ++k) {
        const auto a = static_cast<size_t>(k);
        const double lo = (centre[k] - radius - origin_[k]) / width, hi = (centre[k] + radius - origin_[k]) / width;
        const double end = static_cast<double>(level.size[a]);
        if (!(lo >= -1e-9 && hi <= end + 1e-9)) return false; // never true for a ball inside the region
        first[a] = static_cast<int64_t>(std::clamp(std::floor(lo), 0.0, end - 1));
        last[a] = static_cast<int64_t>(std::clamp(std::floor(hi), 0.0, end - 1));
        share[a][1] = last[a] > first[a] && hi > lo ? (hi - static_cast<double>(last[a])) / (hi - lo) : 0;
        share[a][0] = 1 - share[a][1];
    }
    Cell ball;
    Real lowest = std::numeric_limits<Real>::max(), highest = 0;
    for (int64_t x = first[0]; x <= last[0]; ++x) {
        for (int64_t y = first[1]; y <= last[1]; ++y) {
            for (int64_t z = first[2]; z <= last[2]; ++z) {
                const Cell& cell = level.at(x, y, z);
                lowest = std::min(lowest, cell.sigma_low);
                highest = std::max(highest, cell.sigma_high);
                if (!may_be_close(lowest, highest)) return false; // rejects most balls that are not homogeneous
                ball.add(cell,
                         static_cast<Real>(share[0][x > first[0]] * share[1][y > first[1]] * share[2][z > first[2]]));
            }
        }
    }
    const double sigma = ball.sigma_t, brightest = ball.sigma_t - double{ball.least_lost()};
    if (!(sigma > 0 && brightest > 0)) return false;
    mean.sigma_t = sigma;
    for (unsigned c = 0; c < 3; ++c) mean.albedo[c] = std::min<double>(extremes_.albedo_high, 1 - ball.lost[c] / sigma);
    mean.g = ball.forward / brightest;
    const double loss = ball.least_lost() / sigma, back = 1 - mean.g;
    const auto close = [&](double low, double high, double square, double value) {
        const double most = value * tolerance_ + rounded;
        return low >= value - most && high <= value + most &&
               square - value * value <= 0.25 * most * most + rounded * value * value;
    };
    return close(ball.sigma_low / sigma, ball.sigma_high / sigma, ball.sigma_square / (sigma * sigma), 1) &&
           close(ball.loss_low, ball.loss_high, ball.loss_square / sigma, loss) &&
           close(ball.back_low, ball.back_high, ball.back_square / brightest, back);
}

uint64_t MediumPyramid::bytes() const
{
    uint64_t sum = promising_.size() * sizeof(uint32_t);
    for (const Level& level : levels_) sum += level.cells.size() * sizeof(Cell);
    return sum;
}

} // namespace scree
