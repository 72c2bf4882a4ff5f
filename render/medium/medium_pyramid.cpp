#include "render/medium/medium_pyramid.h"

#include "ingest/support/error.h"

#include <tbb/parallel_for.h>

namespace scree {

namespace {

constexpr double most_cells = 1 << 20; ///< of the first level

} // namespace

void MediumPyramid::set_own_range(Cell& cell)
{
    const double brightest = std::max({cell.scattered[0], cell.scattered[1], cell.scattered[2]});
    cell.sigma_low = cell.sigma_high = cell.sigma_t;
    cell.loss_low = cell.loss_high = cell.sigma_t > 0 ? static_cast<float>(1 - brightest / cell.sigma_t) : 0;
    cell.back_low = cell.back_high = brightest > 0 ? static_cast<float>(1 - cell.forward / brightest) : 1;
}

MediumPyramid::MediumPyramid(const GridMedium& medium, const Imath::Box3d& box, double tolerance, const Progress& progress) : tolerance_(tolerance)
{
    const V3d extent = box.size();
    if (box.isEmpty() || !(extent.x > 0 && extent.y > 0 && extent.z > 0)) return;
    origin_ = box.min;
    width_ = std::max(medium.voxel(), std::cbrt(extent.x * extent.y * extent.z / most_cells));
    Level first;
    for (int k = 0; k < 3; ++k) first.size[static_cast<size_t>(k)] = static_cast<int64_t>(std::ceil(extent[k] / width_));
    first.cells.resize(static_cast<size_t>(first.size[0] * first.size[1] * first.size[2]));
    tbb::parallel_for(int64_t{0}, first.size[0], [&](int64_t x) {
        if (progress.cancelled()) return;
        for (int64_t y = 0; y < first.size[1]; ++y) {
            for (int64_t z = 0; z < first.size[2]; ++z) {
                V3d place = origin_ + width_ * V3d(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, static_cast<double>(z) + 0.5);
                for (int k = 0; k < 3; ++k) place[k] = std::min(place[k], box.max[k]); // the last cube reaches beyond the box
                Cell& cell = first.cells[static_cast<size_t>((x * first.size[1] + y) * first.size[2] + z)];
                cell.sigma_t = medium.sigma_t(place).x;
                const C3f albedo = medium.albedo(place);
                for (unsigned c = 0; c < 3; ++c) cell.scattered[c] = cell.sigma_t * albedo[c];
                cell.forward = static_cast<float>(cell.sigma_t * max_component(albedo) * medium.g(place));
                set_own_range(cell);
            }
        }
    });
    if (progress.cancelled()) throw Cancelled();
    levels_.push_back(std::move(first));
    while (levels_.back().cells.size() > 1) {
        const Level& below = levels_.back();
        Level above{{(below.size[0] + 1) / 2, (below.size[1] + 1) / 2, (below.size[2] + 1) / 2}, {}};
        above.cells.resize(static_cast<size_t>(above.size[0] * above.size[1] * above.size[2]));
        for (int64_t x = 0; x < above.size[0]; ++x) {
            for (int64_t y = 0; y < above.size[1]; ++y) {
                for (int64_t z = 0; z < above.size[2]; ++z) {
                    Cell& cell = above.cells[static_cast<size_t>((x * above.size[1] + y) * above.size[2] + z)];
                    int parts = 0;
                    for (int part = 0; part < 8; ++part) {
                        const int64_t i = 2 * x + (part & 1), j = 2 * y + (part >> 1 & 1), k = 2 * z + (part >> 2);
                        if (i >= below.size[0] || j >= below.size[1] || k >= below.size[2]) continue;
                        Cell own = below.at(i, j, k);
                        set_own_range(own); // the mean of the part, not what is within it
                        if (parts++ == 0) cell = own;
                        else {
                            cell.sigma_t += own.sigma_t;
                            for (size_t c = 0; c < 3; ++c) cell.scattered[c] += own.scattered[c];
                            cell.forward += own.forward;
                            cell.sigma_low = std::min(cell.sigma_low, own.sigma_low);
                            cell.sigma_high = std::max(cell.sigma_high, own.sigma_high);
                            cell.loss_low = std::min(cell.loss_low, own.loss_low);
                            cell.loss_high = std::max(cell.loss_high, own.loss_high);
                            cell.back_low = std::min(cell.back_low, own.back_low);
                            cell.back_high = std::max(cell.back_high, own.back_high);
                        }
                    }
                    const float share = 1 / static_cast<float>(parts);
                    cell.sigma_t *= share;
                    for (float& s : cell.scattered) s *= share;
                    cell.forward *= share;
                }
            }
        }
        levels_.push_back(std::move(above));
    }
    // No mean is above the largest sigma_t and albedo of all cubes. The rest is asked of somewhat larger ones: single grains are no medium.
    for (const Cell& cell : levels_[0].cells) {
        if (!(cell.sigma_t > 0)) continue;
        extremes_.sigma_t_high = std::max(extremes_.sigma_t_high, double{cell.sigma_t});
        extremes_.albedo_high = std::max(extremes_.albedo_high, 1 - double{cell.loss_low});
    }
    for (Cell cell : levels_[std::min<size_t>(1, levels_.size() - 1)].cells) {
        if (!(cell.sigma_t > 0)) continue;
        set_own_range(cell);
        extremes_.albedo_low = std::min(extremes_.albedo_low, 1 - double{cell.loss_high});
        extremes_.g_low = std::min(extremes_.g_low, 1 - double{cell.back_high});
        extremes_.g_high = std::max(extremes_.g_high, 1 - double{cell.back_low});
    }
}

bool MediumPyramid::is_same(const V3d& centre, double radius, MediumMean& mean) const
{
    if (levels_.empty()) return false;
    // The cubes of the level are as wide as the ball: it meets two of them along an axis at most.
    size_t number = 0;
    double width = width_;
    while (number + 1 < levels_.size() && width < 2 * radius) {
        width *= 2;
        ++number;
    }
    const Level& level = levels_[number];
    std::array<int64_t, 3> first, last;
    std::array<std::array<double, 2>, 3> share; // of the ball's width, of the first and of the last cube
    for (int k = 0; k < 3; ++k) {
        const auto a = static_cast<size_t>(k);
        const double lo = (centre[k] - radius - origin_[k]) / width, hi = (centre[k] + radius - origin_[k]) / width;
        const double end = static_cast<double>(level.size[a]);
        if (!(lo >= -1e-9 && hi <= end + 1e-9)) return false; // a ball within the region does not
        first[a] = static_cast<int64_t>(std::clamp(std::floor(lo), 0.0, end - 1));
        last[a] = static_cast<int64_t>(std::clamp(std::floor(hi), 0.0, end - 1));
        share[a][1] = last[a] > first[a] && hi > lo ? (hi - static_cast<double>(last[a])) / (hi - lo) : 0;
        share[a][0] = 1 - share[a][1];
    }
    double sigma = 0, scattered[3] = {0, 0, 0}, forward = 0;
    Cell range;
    bool begun = false;
    for (int64_t x = first[0]; x <= last[0]; ++x) {
        for (int64_t y = first[1]; y <= last[1]; ++y) {
            for (int64_t z = first[2]; z <= last[2]; ++z) {
                const Cell& cell = level.at(x, y, z);
                const double weight = share[0][x > first[0]] * share[1][y > first[1]] * share[2][z > first[2]];
                sigma += weight * cell.sigma_t;
                for (size_t c = 0; c < 3; ++c) scattered[c] += weight * cell.scattered[c];
                forward += weight * cell.forward;
                if (!begun) range = cell;
                else {
                    range.sigma_low = std::min(range.sigma_low, cell.sigma_low);
                    range.sigma_high = std::max(range.sigma_high, cell.sigma_high);
                    range.loss_low = std::min(range.loss_low, cell.loss_low);
                    range.loss_high = std::max(range.loss_high, cell.loss_high);
                    range.back_low = std::min(range.back_low, cell.back_low);
                    range.back_high = std::max(range.back_high, cell.back_high);
                }
                begun = true;
            }
        }
    }
    const double brightest = std::max({scattered[0], scattered[1], scattered[2]});
    if (!(sigma > 0 && brightest > 0)) return false;
    mean.sigma_t = sigma;
    for (unsigned c = 0; c < 3; ++c) mean.albedo[c] = static_cast<float>(std::min(extremes_.albedo_high, scattered[c] / sigma));
    mean.g = forward / brightest;
    const double loss = 1 - brightest / sigma, back = 1 - mean.g;
    constexpr double rounded = 1e-6; // what sums in float are off by; all three have no unit
    const auto close = [&](double low, double high, double value) { return low >= value * (1 - tolerance_) - rounded && high <= value * (1 + tolerance_) + rounded; };
    return close(range.sigma_low / sigma, range.sigma_high / sigma, 1) && close(range.loss_low, range.loss_high, loss) && close(range.back_low, range.back_high, back);
}

uint64_t MediumPyramid::bytes() const
{
    uint64_t sum = 0;
    for (const Level& level : levels_) sum += level.cells.size() * sizeof(Cell);
    return sum;
}

} // namespace scree
