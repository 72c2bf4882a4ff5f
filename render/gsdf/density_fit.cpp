#include "render/gsdf/density_fit.h"

#include <tbb/parallel_for.h>

namespace scree {

namespace {

using Grid = DirectionGrid;
using Field = std::vector<double>; // strata * cells

constexpr uint32_t strata = Gsdf::strata, cells = Gsdf::cells;
constexpr int rows = Grid::rows, columns = Grid::columns;

size_t at(uint32_t stratum, int row, int column)
{
    return static_cast<size_t>(stratum) * cells + Grid::neighbour(row, column);
}

/// Density of one half from its counts; `total` receives the number of counts in each stratum.
Field count_density(const DirectionCounts& counts, std::array<double, strata>& total)
{
    Field density(counts.size());
    for (uint32_t s = 0; s < strata; ++s) {
        const size_t begin = at(s, 0, 0);
        total[s] = 0;
        for (uint32_t c = 0; c < cells; ++c) total[s] += static_cast<double>(counts[begin + c]);
        for (uint32_t c = 0; c < cells; ++c) {
            density[begin + c] =
                total[s] > 0 ? static_cast<double>(counts[begin + c]) / (total[s] * Grid::area(c)) : 1 / (4 * pi);
        }
    }
    return density;
}

/// Smooths across columns near the poles, where columns are narrower than rows are wide, until both resolve alike.
void smooth_poles(Field& field)
{
    tbb::parallel_for(0u, strata, [&](uint32_t s) {
        std::array<double, columns> values;
        for (int row = 0; row < rows; ++row) {
            const double narrow = 0.5 / std::sin((row + 0.5) * Grid::row_width); // half the widest column over this one
            for (int pass = 0; pass < std::min(64, static_cast<int>(narrow * narrow)); ++pass) {
                for (int c = 0; c < columns; ++c) values[static_cast<size_t>(c)] = field[at(s, row, c)];
                for (int c = 0; c < columns; ++c) {
                    const double sides = values[static_cast<size_t>((c + columns - 1) % columns)] +
                                         values[static_cast<size_t>((c + 1) % columns)];
                    field[at(s, row, c)] = 0.5 * values[static_cast<size_t>(c)] + 0.25 * sides;
                }
            }
        }
    });
}

/// One pass of the filter 1/4, 1/2, 1/4 along an axis: 0 rows, 1 columns, 2 strata.
void smooth_once(Field& field, Field& scratch, int axis)
{
    scratch = field;
    tbb::parallel_for(0u, strata, [&](uint32_t s) {
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const size_t here = at(s, row, column);
                size_t low, high;
                if (axis == 0) {
                    low = at(s, row - 1, column);
                    high = at(s, row + 1, column);
                } else if (axis == 1) {
                    low = at(s, row, column - 1);
                    high = at(s, row, column + 1);
                } else {
                    low = s > 0 ? here - cells : here;
                    high = s + 1 < strata ? here + cells : here;
                }
                field[here] = 0.5 * scratch[here] + 0.25 * (scratch[low] + scratch[high]);
            }
        }
    });
}

Field filtered(Field field, const std::array<int, 3>& passes)
{
    Field scratch;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < passes[static_cast<size_t>(axis)]; ++i) smooth_once(field, scratch, axis);
    }
    return field;
}

void mirror(Field& field)
{
    for (uint32_t s = 0; s < strata; ++s) {
        for (int row = 0; row < rows; ++row) {
            for (int column = 1; column < columns / 2; ++column) {
                double& a = field[at(s, row, column)];
                double& b = field[at(s, row, -column)];
                a = b = 0.5 * (a + b);
            }
        }
    }
}

Field smoothed(const Field& field, const Smoothing& how)
{
    Field base = field;
    if (how.mirror) mirror(base);
    if (how.poles) smooth_poles(base);
    if (how.passes == std::array<int, 3>{}) return base;
    Field result = filtered(base, how.passes);
    if (!how.twice) return result;
    for (size_t i = 0; i < base.size(); ++i) base[i] -= result[i];
    const Field rest = filtered(std::move(base), how.passes);
    for (size_t i = 0; i < rest.size(); ++i) result[i] = std::max(0.0, result[i] + rest[i]);
    return result;
}

/// Estimates the error of a smoothing from how well each half predicts the other.
class Judge {
public:
    Judge(const std::array<DirectionCounts, 2>& halves, const std::array<double, strata>& stratum_mass)
        : mass_(stratum_mass)
    {
        for (size_t half = 0; half < 2; ++half) density_[half] = count_density(halves[half], total_[half]);
        Field both(density_[0].size());
        for (size_t i = 0; i < both.size(); ++i) both[i] = 0.5 * (density_[0][i] + density_[1][i]);
        smooth_poles(both);
        expected_ = filtered(both, {2, 2, 2});
        for (double& e : expected_) e += 1e-3 / (4 * pi); // so that directions of hardly any light do not count
    }

    struct Verdict {
        double half = 0; ///< squared error of one smoothed half
        double full = 0; ///< squared error of both halves together
        double spread = 0; ///< standard error of these estimates
    };

    Verdict judge(const Smoothing& how) const
    {
        const Field a = smoothed(density_[0], how), b = smoothed(density_[1], how);
        // A smoothed half differs from the other half by its own error and by the other half's noise; that noise is
        // known (Poisson).
        Verdict verdict;
        std::array<double, strata> halves{};
        for (uint32_t s = 0; s < strata; ++s) {
            double sum = 0, own = 0, apart = 0;
            for (int row = 0; row < rows; ++row) {
                const double area = Grid::area(static_cast<uint32_t>(row * columns));
                for (int column = 0; column < columns; ++column) {
                    const size_t i = at(s, row, column);
                    const double weight = area / expected_[i];
                    const double x = a[i] - density_[1][i], y = b[i] - density_[0][i], z = a[i] - b[i];
                    sum += 0.5 * weight * (x * x + y * y);
                    apart += weight * z * z;
                    for (size_t half = 0; half < 2; ++half) {
                        if (total_[half][s] > 0) own += 0.5 * weight * density_[half][i] / (total_[half][s] * area);
                    }
                }
            }
            halves[s] = mass_[s] * (sum - own);
            verdict.half += halves[s];
            verdict.full += halves[s] - mass_[s] * apart / 4;
        }
        for (const double half : halves) verdict.spread += std::pow(half - verdict.half / strata, 2);
        verdict.spread = std::sqrt(verdict.spread);
        return verdict;
    }

    Field fit(const Smoothing& how) const
    {
        Field both(density_[0].size());
        for (uint32_t s = 0; s < strata; ++s) {
            const double sum = total_[0][s] + total_[1][s];
            const double share = sum > 0 ? total_[0][s] / sum : 0.5;
            for (size_t i = at(s, 0, 0); i < at(s, 0, 0) + cells; ++i)
                both[i] = share * density_[0][i] + (1 - share) * density_[1][i];
        }
        return smoothed(both, how);
    }

private:
    std::array<Field, 2> density_;
    std::array<std::array<double, strata>, 2> total_;
    std::array<double, strata> mass_;
    Field expected_;
};

/// Scales each row by one factor in all strata until the row receives as much as was counted, and strata to a mass
/// of 1.
std::vector<float> keep_rows(Field density, const Field& counted, const std::array<double, strata>& stratum_mass)
{
    for (int iteration = 0; iteration < 8; ++iteration) {
        for (uint32_t s = 0; s < strata; ++s) {
            double sum = 0;
            for (uint32_t c = 0; c < cells; ++c) sum += density[at(s, 0, 0) + c] * Grid::area(c);
            for (uint32_t c = 0; c < cells; ++c) density[at(s, 0, 0) + c] /= sum;
        }
        for (int row = 0; row < rows && iteration < 7; ++row) {
            double wanted = 0, found = 0;
            for (uint32_t s = 0; s < strata; ++s) {
                for (int column = 0; column < columns; ++column) {
                    wanted += stratum_mass[s] * counted[at(s, row, column)];
                    found += stratum_mass[s] * density[at(s, row, column)];
                }
            }
            if (!(found > 0)) continue;
            for (uint32_t s = 0; s < strata; ++s) {
                for (int column = 0; column < columns; ++column) density[at(s, row, column)] *= wanted / found;
            }
        }
    }
    return {density.begin(), density.end()};
}

/// The smoothings one step away: fewer or more passes along one axis, or one flag changed.
std::vector<Smoothing> neighbours(const Smoothing& from)
{
    constexpr int most = 64;
    std::vector<Smoothing> all(3, from);
    all[0].mirror = !from.mirror;
    all[1].poles = !from.poles;
    all[2].twice = !from.twice;
    for (size_t axis = 0; axis < 3; ++axis) {
        for (const int passes : {from.passes[axis] / 2, std::max(1, 2 * from.passes[axis])}) {
            if (passes == from.passes[axis] || passes > most) continue;
            all.push_back(from);
            all.back().passes[axis] = passes;
        }
    }
    return all;
}

} // namespace

DensityFit fit_density(const std::array<DirectionCounts, 2>& halves, const std::array<double, strata>& stratum_mass,
                       const Smoothing& start)
{
    const Judge judge(halves, stratum_mass);
    DensityFit fit;
    fit.smoothing = start;
    Judge::Verdict best = judge.judge(start);
    for (bool any = true; any;) {
        any = false;
        for (const Smoothing& next : neighbours(fit.smoothing)) {
            const Judge::Verdict verdict = judge.judge(next);
            if (verdict.half >= best.half) continue;
            best = verdict;
            fit.smoothing = next;
            any = true;
        }
    }
    // The mean magnitude of Gaussian errors is sqrt(2 / pi) of their root mean square. The spread is added because the
    // estimate has an error of its own, and the smallest of many estimates is too small.
    fit.error = std::sqrt(2 / pi * (std::max(0.0, best.full) + best.spread));
    fit.density = keep_rows(judge.fit(fit.smoothing), judge.fit({{0, 0, 0}, false, false, false}), stratum_mass);
    return fit;
}

} // namespace scree
