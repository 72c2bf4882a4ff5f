#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

/// Mean and standard error of independent numbers.
class Estimate {
public:
    void add(double x)
    {
        ++n_;
        const double delta = x - mean_;
        mean_ += delta / static_cast<double>(n_);
        m2_ += delta * (x - mean_);
    }
    uint64_t count() const { return n_; }
    double mean() const { return mean_; }
    double standard_error() const;
    /// (mean - truth) / standard error; 0 when both agree without scatter.
    double z(double truth) const;

private:
    uint64_t n_ = 0;
    double mean_ = 0, m2_ = 0;
};

struct ChiSquare {
    double statistic = 0;
    int degrees = 0;
    double p_value = 1;
    std::string text; ///< for failures
};

/// Pearson's test of counts against expected counts; cells expecting fewer than 5 are pooled.
ChiSquare chi_square(const std::vector<double>& observed, const std::vector<double>& expected);

/// Pearson's test that two sets of counts, over the same cells, come from one distribution.
///
/// Cells with few counts (first[i] < 25) or heavy weights are pooled. second_variance: the variance of each second[i],
/// which may be a weighted sum.
ChiSquare chi_square_two(const std::vector<double>& first, const std::vector<double>& second,
                         const std::vector<double>& second_variance);

/// The level of each of n tests at which all of them together have `level` (Sidak).
double sidak(double level, int n);

} // namespace scree
