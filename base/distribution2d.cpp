#include "base/distribution2d.h"

namespace scree {

namespace {

/// Turns n cell values into n + 1 cumulative sums from 0 to 1 (uniform when all are zero); returns the values' total.
template <class Values>
double cumulate(const Values& value, size_t n, double* out)
{
    out[0] = 0;
    for (size_t i = 0; i < n; ++i) out[i + 1] = out[i] + value(i);
    const double total = out[n];
    for (size_t i = 0; i <= n; ++i)
        out[i] = total > 0 ? out[i] / total : static_cast<double>(i) / static_cast<double>(n);
    out[n] = 1;
    return total;
}

/// Index of the cell that holds u and the position of u inside it (0..1), for n cells with cumulative sums c.
std::pair<size_t, double> find_cell(const double* c, size_t n, double u)
{
    const auto index = static_cast<size_t>(std::upper_bound(c, c + n + 1, u) - c);
    const size_t i = std::clamp<size_t>(index, 1, n) - 1;
    const double width = c[i + 1] - c[i];
    return {i, width > 0 ? std::clamp((u - c[i]) / width, 0.0, 1.0) : 0.5};
}

size_t cell_of(double x, size_t n)
{
    return std::min(n - 1, static_cast<size_t>(std::max(0.0, x) * static_cast<double>(n)));
}

} // namespace

Distribution2D::Distribution2D(const std::vector<float>& values, size_t width, size_t height)
    : width_(width), height_(height), rows_(height + 1), cells_(height * (width + 1))
{
    std::vector<double> totals(height);
    for (size_t y = 0; y < height; ++y) {
        totals[y] = cumulate([&](size_t x) { return static_cast<double>(values[y * width + x]); }, width,
                             &cells_[y * (width + 1)]);
    }
    cumulate([&](size_t y) { return totals[y]; }, height, rows_.data());
}

V2d Distribution2D::sample(double u1, double u2) const
{
    const auto [y, fy] = find_cell(rows_.data(), height_, u1);
    const auto [x, fx] = find_cell(&cells_[y * (width_ + 1)], width_, u2);
    return {(static_cast<double>(x) + fx) / static_cast<double>(width_),
            (static_cast<double>(y) + fy) / static_cast<double>(height_)};
}

double Distribution2D::pdf(const V2d& point) const
{
    const size_t x = cell_of(point.x, width_), y = cell_of(point.y, height_);
    const double* row = &cells_[y * (width_ + 1)];
    return (rows_[y + 1] - rows_[y]) * static_cast<double>(height_) * (row[x + 1] - row[x]) *
           static_cast<double>(width_);
}

} // namespace scree
