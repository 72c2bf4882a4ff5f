#include "tests/builders/statistics.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace scree {

namespace {

double upper_tail(double statistic, int degrees)
{
    if (degrees < 1) return 1;
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(degrees), statistic));
}

} // namespace

double Estimate::standard_error() const
{
    return n_ > 1 ? std::sqrt(m2_ / static_cast<double>(n_ - 1) / static_cast<double>(n_))
                  : std::numeric_limits<double>::infinity();
}

double Estimate::z(double truth) const
{
    if (mean_ == truth) return 0;
    return (mean_ - truth) / standard_error();
}

ChiSquare chi_square(const std::vector<double>& observed, const std::vector<double>& expected)
{
    ChiSquare result;
    double pooled_observed = 0, pooled_expected = 0, worst = 0;
    size_t worst_cell = 0;
    const auto add = [&](double o, double e) {
        result.statistic += (o - e) * (o - e) / e;
        ++result.degrees;
    };
    for (size_t i = 0; i < observed.size(); ++i) {
        if (expected[i] < 5) {
            pooled_observed += observed[i];
            pooled_expected += expected[i];
            continue;
        }
        const double term = (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
        if (term > worst) {
            worst = term;
            worst_cell = i;
        }
        add(observed[i], expected[i]);
    }
    if (pooled_expected >= 5)
        add(pooled_observed, pooled_expected);
    else if (pooled_observed > 30)
        result.statistic = std::numeric_limits<double>::infinity(); // counts where almost none are expected
    result.degrees -= 1;
    result.p_value = upper_tail(result.statistic, result.degrees);
    result.text = fmt::format("chi2 {} of {} degrees, p {}; worst cell {}: observed {}, expected {}; pooled {} of {}",
                              result.statistic, result.degrees, result.p_value, worst_cell,
                              observed.empty() ? 0 : observed[worst_cell], expected.empty() ? 0 : expected[worst_cell],
                              pooled_observed, pooled_expected);
    return result;
}

ChiSquare chi_square_two(const std::vector<double>& first, const std::vector<double>& second,
                         const std::vector<double>& second_variance)
{
    // Counts are Poisson: each count estimates its own variance.
    ChiSquare result;
    double pool_first = 0, pool_second = 0, pool_variance = 0;
    const auto add = [&](double a, double b, double variance) {
        if (variance <= 0) return;
        result.statistic += (a - b) * (a - b) / variance;
        ++result.degrees;
    };
    for (size_t i = 0; i < first.size(); ++i) {
        // Cells with few counts or with heavy single weights are not normal.
        if (first[i] < 25 || second_variance[i] > 4 * first[i] + second[i]) {
            pool_first += first[i];
            pool_second += second[i];
            pool_variance += second_variance[i];
            continue;
        }
        add(first[i], second[i], first[i] + second_variance[i]);
    }
    if (pool_first >= 25) add(pool_first, pool_second, pool_first + pool_variance);
    result.p_value = upper_tail(result.statistic, result.degrees);
    result.text = fmt::format("chi2 {} of {} degrees, p {}; pooled {} against {}", result.statistic, result.degrees,
                              result.p_value, pool_first, pool_second);
    return result;
}

double sidak(double level, int n) { return 1 - std::pow(1 - level, 1.0 / n); }

} // namespace scree
