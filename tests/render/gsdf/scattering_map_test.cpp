// Scattering maps and the errors of simpler forms, on cases with known answers.

#include "render/gsdf/gsdf_builder.h"
#include "render/gsdf/map_errors.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <numeric>

namespace scree {
namespace {

using Map = ScatteringMap;

Material glass(double ior)
{
    Material material;
    material.kind = MaterialKind::dielectric;
    material.ior = ior;
    return material;
}

/// All rows alike: the product of a distribution of turns and one of directions.
Map product_map(const std::vector<double>& turns, const std::function<std::vector<double>(uint32_t row)>& directions)
{
    Map map;
    for (uint32_t row = 0; row < Map::rows; ++row) {
        const std::vector<double> of_row = directions(row);
        for (uint32_t t = 0; t < Map::turns; ++t) {
            for (uint32_t d = 0; d < Map::directions; ++d) map.mass[Map::index(row, t, d)] = turns[t] * of_row[d];
        }
        map.row_mass[row] = Map::highest_q(row) - Map::lowest_q(row);
    }
    return map;
}

BruteForceMaps exactly(const Map& map) { return {{map, map}, map, map, 0}; }

const FormError& form(const MapErrors& errors, const std::string& name)
{
    return *std::ranges::find(errors.forms, name, &FormError::form);
}

std::vector<double> uniform_directions()
{
    std::vector<double> shares(Map::directions);
    for (uint32_t d = 0; d < Map::directions; ++d) shares[d] = Map::solid_angle_share(d);
    return shares;
}

TEST(ScatteringMap, CellsCoverTheSphereAndAllImpacts)
{
    const std::vector<double> shares = uniform_directions();
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-12);
    EXPECT_EQ(Map::highest_q(0), 1);
    EXPECT_EQ(Map::lowest_q(Map::rows - 1), 0);
    for (uint32_t row = 0; row + 1 < Map::rows; ++row) EXPECT_EQ(Map::lowest_q(row), Map::highest_q(row + 1));
}

TEST(ScatteringMap, CellsAreWhereTheirAnglesSay)
{
    const double b = 0.6, c = 0.8, q = b * b; // the entry at (b, 0, -c), n_o = (-b, 0, c)
    const V3d entry(b, 0, -c), normal = -entry, along = V3d(c, 0, b); // azimuth 0: omega_o's
    const V3d across(0, 1, 0);
    const auto direction = [&](double beta, double delta) {
        return std::cos(beta) * normal + std::sin(beta) * (std::cos(delta) * along + std::sin(delta) * across);
    };
    for (uint32_t turn = 0; turn < Map::turns; ++turn) {
        for (uint32_t d = 0; d < Map::directions; ++d) {
            const double gamma_o = 2 * pi * turn / Map::turns;
            const V3d exit = direction(1, -gamma_o); // omega_o is gamma_o ahead of it
            const V3d w =
                direction(pi * (d / Map::azimuths + 0.5) / Map::polar, 2 * pi * (d % Map::azimuths) / Map::azimuths);
            EXPECT_EQ(Map::cell_of(q, exit, w), turn * Map::directions + d);
        }
    }
    // For light that goes straight on, omega_i is omega_o and the exit lies in the plane of incidence; for an exit at
    // the entry, that plane is used as well.
    const uint32_t straight = static_cast<uint32_t>(std::acos(c) / pi * Map::polar) * Map::azimuths;
    EXPECT_EQ(Map::cell_of(q, V3d(b, 0, c), V3d(0, 0, 1)), straight);
    EXPECT_EQ(Map::cell_of(q, entry, V3d(0, 0, 1)), straight);
    EXPECT_EQ(Map::cell_of(q, (entry + 1e-5 * V3d(0, 1, 0)).normalized(), V3d(0, 0, 1)), straight);
}

TEST(MapErrors, AProductIsWhatTheFactoredFormKnows)
{
    std::vector<double> directions = uniform_directions();
    for (uint32_t d = 0; d < Map::directions; ++d)
        directions[d] *= 1 + 0.5 * std::cos(2 * pi * (d % Map::azimuths) / Map::azimuths);
    const Map truth = product_map({0.3, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}, [&](uint32_t) { return directions; });
    const MapErrors errors = map_errors(truth, exactly(truth));
    EXPECT_NEAR(form(errors, "gsdf").full, 0, 1e-12);
    EXPECT_NEAR(form(errors, "factored").full, 0, 1e-12);
    EXPECT_NEAR(form(errors, "factored").direction, 0, 1e-12);
    // Isotropic: the error is the mean of |cos| / 2 over 24 azimuths; together with the turns it is not less.
    double expected = 0;
    for (uint32_t i = 0; i < Map::azimuths; ++i)
        expected += 0.5 * std::abs(std::cos(2 * pi * i / Map::azimuths)) / Map::azimuths;
    EXPECT_NEAR(form(errors, "isotropic").direction, expected, 1e-12);
    EXPECT_GT(form(errors, "isotropic").full, expected);
    EXPECT_EQ(errors.noise.full, 0);
}

TEST(MapErrors, CorrelationIsWhatTheFactoredFormMisses)
{
    // Half of the light leaves at turn 0 into one direction, half at turn 4 into another.
    Map truth;
    for (uint32_t row = 0; row < Map::rows; ++row) {
        truth.mass[Map::index(row, 0, 7)] = truth.mass[Map::index(row, 4, 200)] = 0.5;
        truth.row_mass[row] = 1.0 / Map::rows;
    }
    const MapErrors errors = map_errors(truth, exactly(truth));
    EXPECT_NEAR(form(errors, "factored").direction, 0, 1e-12);
    EXPECT_NEAR(form(errors, "factored").full, 1, 1e-12); // 1/4 in each of four cells for 1/2 in two
}

TEST(MapErrors, FindsTheParameterOfHenyeyAndGreenstein)
{
    const double g = 0.6;
    const auto directions = [&](uint32_t row) {
        // By sampling the form itself, uniformly in q within the row.
        std::vector<double> masses(Map::directions);
        constexpr int n = 400'000;
        Sampler sampler(5, row, 0, 0);
        for (int i = 0; i < n; ++i) {
            const double s = (1 - g * g) / (1 - g + 2 * g * sampler.next());
            const double cosine = (1 + g * g - s * s) / (2 * g), sine = safe_sqrt(1 - cosine * cosine),
                         phi = 2 * pi * sampler.next();
            const double q = Map::lowest_q(row) + sampler.next() * (Map::highest_q(row) - Map::lowest_q(row));
            masses[Map::cell_of(q, V3d(std::sqrt(q), 0, safe_sqrt(1 - q)),
                                V3d(sine * std::cos(phi), sine * std::sin(phi), cosine))] += 1.0 / n;
        }
        return masses;
    };
    const Map truth = product_map(std::vector<double>(Map::turns, 1.0 / Map::turns), directions);
    const MapErrors errors = map_errors(truth, exactly(truth));
    for (const double found : errors.hg_g) EXPECT_NEAR(found, g, 0.011); // two steps of the search
    // Counting over K = 384 cells has an error of sqrt(2 K / (pi n)): 2.5 %, less where cells are unlike.
    EXPECT_LT(form(errors, "hg").direction, 0.03);
    EXPECT_GT(form(errors, "isotropic").direction, 0.5);
}

TEST(BruteForceMaps, AreTheSameOnAnyNumberOfThreads)
{
    const GrainBody body{nullptr, glass(1.5)};
    const auto masses = [&](size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return brute_force_maps(body, 100'000, 3).both.mass;
    };
    EXPECT_EQ(masses(1), masses(3));
}

/// The errors of a sphere's GSDF and of simpler forms against brute force.
MapErrors errors_of_sphere(const Material& material)
{
    const GrainBody body{nullptr, material};
    const auto gsdf = build_gsdf(body, {.error = 0.02});
    const BruteForceMaps truth = brute_force_maps(body, 1'200'000, 1);
    const ScatteringMap map = map_of_gsdf(*gsdf);
    for (const Map* each : {&map, &truth.both}) {
        EXPECT_NEAR(std::accumulate(each->row_mass.begin(), each->row_mass.end(), 0.0), 1, 1e-9);
        for (uint32_t row = 0; row < Map::rows; ++row) {
            const auto first = each->mass.begin() + static_cast<std::ptrdiff_t>(Map::index(row, 0, 0));
            EXPECT_NEAR(std::accumulate(first, first + Map::row_cells, 0.0), 1, 1e-6);
        }
    }
    return map_errors(map, truth);
}

TEST(MapErrors, OfALambertSphere)
{
    const MapErrors errors = errors_of_sphere(Material{});
    // 10^5 paths a row over up to 384 cells: noise of up to sqrt(2 K / (pi n)) = 5 %. The GSDF adds 2 % that is
    // independent.
    EXPECT_LT(errors.noise.full, 0.05);
    EXPECT_LT(form(errors, "gsdf").full, std::hypot(errors.noise.full, 0.03));
    // All light leaves where it came in, so a uniform place is wrong, and so is half of the directions.
    EXPECT_GT(form(errors, "isotropic").full, 1.7);
    EXPECT_GT(form(errors, "isotropic").direction, 1);
    EXPECT_GT(form(errors, "hg").direction, 0.2);
    // The place is always the same, so there is no correlation to lose.
    EXPECT_LT(form(errors, "factored").full, std::hypot(errors.noise.full, 0.07));
}

TEST(MapErrors, OfAGlassSphere)
{
    // There is one direction for each number of reflections. Strata of impacts smear it by some degrees, which these
    // cells resolve.
    const MapErrors errors = errors_of_sphere(glass(1.5));
    EXPECT_LT(errors.noise.full, 0.05);
    EXPECT_LT(form(errors, "gsdf").full, 0.5 * form(errors, "hg").full);
    EXPECT_LT(form(errors, "gsdf").direction, form(errors, "hg").direction);
    EXPECT_LT(form(errors, "factored").full, form(errors, "hg").full);
    EXPECT_LT(form(errors, "hg").direction, form(errors, "isotropic").direction);
}

} // namespace
} // namespace scree
