#include "render/gsdf/map_errors.h"

#include <tbb/parallel_for.h>

#include <limits>

namespace scree {

namespace {

using Map = ScatteringMap;
using Row = std::vector<double>; // of direction cells

/// Marginal distributions of a row: over turns and over directions.
struct Margins {
    Row turn = Row(Map::turns), direction = Row(Map::directions);

    Margins(const Map& map, uint32_t row)
    {
        for (uint32_t t = 0; t < Map::turns; ++t) {
            for (uint32_t d = 0; d < Map::directions; ++d) {
                turn[t] += map.mass[Map::index(row, t, d)];
                direction[d] += map.mass[Map::index(row, t, d)];
            }
        }
    }
};

void set_product(Map& map, uint32_t row, const Row& turn, const Row& direction)
{
    for (uint32_t t = 0; t < Map::turns; ++t) {
        for (uint32_t d = 0; d < Map::directions; ++d) map.mass[Map::index(row, t, d)] = turn[t] * direction[d];
    }
}

/// Henyey and Greenstein's form over the cells of a row, for any g.
class HenyeyGreensteinRow {
public:
    explicit HenyeyGreensteinRow(uint32_t row)
    {
        constexpr int impacts = 8, steps = 4;
        const double low = Map::lowest_q(row), width = Map::highest_q(row) - low;
        for (uint32_t d = 0; d < Map::directions; ++d) {
            for (int i = 0; i < impacts * steps * steps; ++i) {
                const double q = low + (i % impacts + 0.5) / impacts * width;
                const double beta = pi * (d / Map::azimuths + (i / impacts % steps + 0.5) / steps) / Map::polar;
                const double delta =
                    2 * pi * (d % Map::azimuths + (i / impacts / steps + 0.5) / steps - 0.5) / Map::azimuths;
                cosine_.push_back(std::sqrt(q) * std::sin(beta) * std::cos(delta) + std::sqrt(1 - q) * std::cos(beta));
                weight_.push_back(std::sin(beta));
            }
        }
        samples_ = impacts * steps * steps;
    }

    Row masses(double g) const
    {
        Row masses(Map::directions);
        double total = 0;
        for (size_t d = 0; d < masses.size(); ++d) {
            for (size_t i = d * samples_; i < (d + 1) * samples_; ++i) {
                const double s = 1 + g * g - 2 * g * cosine_[i];
                masses[d] += weight_[i] / (s * std::sqrt(s));
            }
            total += masses[d];
        }
        for (double& mass : masses) mass /= total;
        return masses;
    }

private:
    Row cosine_, weight_;
    size_t samples_ = 0;
};

double distance(const Row& a, const Row& b)
{
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
    return sum;
}

/// The g whose form is nearest to the masses.
double fit_g(const HenyeyGreensteinRow& form, const Row& masses)
{
    double best_g = 0, least = std::numeric_limits<double>::infinity();
    const auto look = [&](double from, double to, double step) {
        for (double g = from; g <= to + 1e-9; g += step) {
            const double error = distance(form.masses(g), masses);
            if (error >= least) continue;
            least = error;
            best_g = g;
        }
    };
    look(-0.96, 0.96, 0.04);
    look(best_g - 0.03, std::min(0.99, best_g + 0.03), 0.005);
    return best_g;
}

} // namespace

FormError compare_maps(const std::string& form, const ScatteringMap& map, const ScatteringMap& truth)
{
    const std::vector<double> a = map.direction_mass(), b = truth.direction_mass();
    FormError error{form, 0, 0};
    for (uint32_t row = 0; row < Map::rows; ++row) {
        double direction = 0, full = 0;
        for (size_t i = size_t{row} * Map::directions; i < (size_t{row} + 1) * Map::directions; ++i)
            direction += std::abs(a[i] - b[i]);
        for (size_t i = Map::index(row, 0, 0); i < Map::index(row + 1, 0, 0); ++i)
            full += std::abs(map.mass[i] - truth.mass[i]);
        error.direction += truth.row_mass[row] * direction;
        error.full += truth.row_mass[row] * full;
    }
    return error;
}

MapErrors map_errors(const ScatteringMap& gsdf, const BruteForceMaps& truth)
{
    MapErrors errors;
    Map factored, hg, isotropic;
    tbb::parallel_for(0u, Map::rows, [&](uint32_t row) {
        const Margins margins(truth.other, row);
        set_product(factored, row, margins.turn, margins.direction);
        const HenyeyGreensteinRow form(row);
        errors.hg_g[row] = fit_g(form, margins.direction);
        set_product(hg, row, margins.turn, form.masses(errors.hg_g[row]));
        Row sphere(Map::directions);
        for (uint32_t d = 0; d < Map::directions; ++d) sphere[d] = Map::solid_angle_share(d);
        set_product(isotropic, row, Row(Map::turns, 1.0 / Map::turns), sphere);
    });
    errors.forms = {compare_maps("gsdf", gsdf, truth.both), compare_maps("factored", factored, truth.both),
                    compare_maps("hg", hg, truth.both), compare_maps("isotropic", isotropic, truth.both)};
    // The halves differ by sqrt(2) of the noise of one half, which is sqrt(2) of the noise of both together.
    const FormError apart = compare_maps("noise", truth.halves[0], truth.halves[1]);
    errors.noise = {"noise", 0.5 * apart.direction, 0.5 * apart.full};
    return errors;
}

} // namespace scree
