#include "render/gsdf/gsdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace scree {

namespace {

using Grid = DirectionGrid;

/// The two cells whose middles enclose a position, and the weight of the upper one. cells: the position, in cells from
/// the start of the first cell.
struct Tent {
    int low;
    double fraction;

    explicit Tent(double cells) : low(static_cast<int>(std::floor(cells - 0.5))), fraction(cells - 0.5 - low) {}
};

/// The integral over every cell of a stratum of the density interpolated between the cells' middles.
void integrate_cells(std::span<const float> density, std::span<float> mass)
{
    // In azimuth the mean of the interpolant over a cell is 1/8, 6/8, 1/8 of the neighbours'. In the polar angle each
    // half of a cell interpolates linearly between two rows, under the weight sin theta.
    constexpr int rows = Grid::rows, columns = Grid::columns;
    const double h = 0.5 * Grid::row_width;
    const auto azimuth_mean = [&](int row, int column) {
        return 0.125 * density[Grid::neighbour(row, column - 1)] + 0.75 * density[Grid::neighbour(row, column)] +
               0.125 * density[Grid::neighbour(row, column + 1)];
    };
    for (int row = 0; row < rows; ++row) {
        const double middle = (row + 0.5) * Grid::row_width, sine = std::sin(middle), cosine = std::cos(middle);
        // Integrals of sin(middle + x) and of (1 - |x| / row_width) sin(middle + x) over half a row on either side.
        const double full = std::sin(h) * sine, odd = (1 - std::cos(h)) * cosine;
        const double even_x = std::cos(h) + h * std::sin(h) - 1,
                     odd_x = std::sin(h) - h * std::cos(h); // integrals of x cos x and x sin x
        for (int column = 0; column < columns; ++column) {
            const double here = azimuth_mean(row, column);
            double sum = 0;
            for (const int side : {-1, 1}) {
                const double all = full + side * odd;
                const double moved = (even_x * sine + side * odd_x * cosine) / Grid::row_width;
                sum += here * (all - moved) + azimuth_mean(row + side, column) * moved;
            }
            mass[static_cast<size_t>(row * columns + column)] = static_cast<float>(sum * Grid::column_width);
        }
    }
}

} // namespace

PackedDirection::PackedDirection(const V3d& w)
{
    const double norm = std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
    double a = w.x / norm, b = w.y / norm;
    if (w.z < 0) {
        const double folded = (1 - std::abs(b)) * (a < 0 ? -1 : 1);
        b = (1 - std::abs(a)) * (b < 0 ? -1 : 1);
        a = folded;
    }
    u = static_cast<uint16_t>(std::lround((a + 1) * 32767));
    v = static_cast<uint16_t>(std::lround((b + 1) * 32767));
}

V3d PackedDirection::unpack() const
{
    double a = u / 32767.0 - 1, b = v / 32767.0 - 1;
    const double z = 1 - std::abs(a) - std::abs(b);
    if (z < 0) {
        const double folded = (1 - std::abs(b)) * (a < 0 ? -1 : 1);
        b = (1 - std::abs(a)) * (b < 0 ? -1 : 1);
        a = folded;
    }
    return V3d(a, b, z).normalized();
}

Gsdf::Gsdf(Data data) : data_(std::move(data)), shape_(data_.density.size()), cumulated_(data_.density.size())
{
    for (uint32_t s = 0; s < strata; ++s) {
        const std::span<float> shape(shape_.data() + index(s, 0), cells);
        integrate_cells(std::span(data_.density).subspan(index(s, 0), cells), shape);
        double sum = 0;
        for (uint32_t c = 0; c < cells; ++c) {
            const double mass = cell_mass(s, c);
            shape[c] = mass > 0 ? static_cast<float>(mass / shape[c]) : 0;
            sum += mass;
            cumulated_[index(s, c)] = static_cast<float>(sum);
        }
    }
    double total = 0;
    for (uint32_t bin = 0; bin < alpha_bins; ++bin) {
        stratum_mass_[bin * strata / alpha_bins] += 1 - data_.alpha0[bin];
        total += 1 - data_.alpha0[bin];
    }
    for (double& mass : stratum_mass_) mass = total > 0 ? mass / total : 1.0 / strata;
    always_met_ = std::ranges::all_of(data_.alpha0, [](float a) { return a == 0; });
}

double Gsdf::alpha0(double q) const
{
    if (always_met_) return 0;
    const Tent place(q * alpha_bins);
    const int last = alpha_bins - 1;
    const float low = data_.alpha0[static_cast<size_t>(std::clamp(place.low, 0, last))];
    const float high = data_.alpha0[static_cast<size_t>(std::clamp(place.low + 1, 0, last))];
    return low + place.fraction * (high - low);
}

double Gsdf::mean_alpha0() const { return std::accumulate(data_.alpha0.begin(), data_.alpha0.end(), 0.0) / alpha_bins; }

uint32_t Gsdf::stratum(double q, double u)
{
    return static_cast<uint32_t>(
        std::clamp(static_cast<int>(std::floor(q * strata - 0.5 + u)), 0, static_cast<int>(strata) - 1));
}

double Gsdf::density(uint32_t stratum, const V3d& w) const
{
    const V2d angles = Grid::angles(w);
    const Tent row(angles.x / Grid::row_width), column(angles.y / Grid::column_width + 0.5);
    const float* values = data_.density.data() + index(stratum, 0);
    const auto across = [&](int r) {
        const float low = values[Grid::neighbour(r, column.low)], high = values[Grid::neighbour(r, column.low + 1)];
        return low + column.fraction * (high - low);
    };
    const double low = across(row.low), interpolated = low + row.fraction * (across(row.low + 1) - low);
    return interpolated * shape_[index(stratum, Grid::cell(angles))];
}

uint32_t Gsdf::sample_cell(uint32_t stratum, double u) const
{
    const auto begin = cumulated_.begin() + static_cast<std::ptrdiff_t>(index(stratum, 0));
    const auto end = begin + cells;
    const auto found = std::upper_bound(begin, end, static_cast<float>(u * *(end - 1)));
    auto cell = static_cast<uint32_t>(std::min(found, end - 1) - begin);
    while (cell > 0 && cell_mass(stratum, cell) == 0) --cell; // rounding can lead past the last cell that has mass
    return cell;
}

std::span<const GsdfRecord> Gsdf::records(uint32_t stratum, uint32_t cell) const
{
    const size_t i = index(stratum, cell);
    return std::span(data_.records).subspan(data_.first[i], data_.first[i + 1] - data_.first[i]);
}

uint32_t Gsdf::pick(uint32_t stratum, uint32_t cell, double u) const
{
    const size_t i = index(stratum, cell);
    const uint32_t count = data_.first[i + 1] - data_.first[i];
    return data_.first[i] + std::min(count - 1, static_cast<uint32_t>(u * count));
}

Weight Gsdf::weight(uint32_t number, const Material& material, double radius) const
{
    const GsdfRecord& r = data_.records[number];
    Weight weight = data_.weights.empty() ? Weight(1) : Weight(data_.weights[number]);
    const Weight each = material.kind == MaterialKind::lambert ? material.reflectance : material.tint;
    const double events = r.events;
    if (each != Weight(1))
        weight *= Weight(std::pow(each.x, events), std::pow(each.y, events), std::pow(each.z, events));
    if (material.transmits() && !is_black(material.absorption))
        weight *= exp(Weight(material.absorption) * (-r.length * radius));
    return weight;
}

std::string doubt_of(const GsdfQuality& quality, double wanted_error)
{
    if (static_cast<double>(quality.lost) > 1e-3 * static_cast<double>(quality.paths)) {
        return fmt::format("{} of {} paths were lost in the mesh; is it closed, and free of self-intersections?",
                           quality.lost, quality.paths);
    }
    if (quality.density_error <= wanted_error) return "";
    return fmt::format("its error is {:.2g} %, more than the {:g} % asked for", 100 * quality.density_error,
                       100 * wanted_error);
}

double Gsdf::mean_cosine() const
{
    double mean = 0;
    for (uint32_t s = 0; s < strata; ++s) {
        for (uint32_t c = 0; c < cells; ++c) {
            const auto of_cell = records(s, c);
            double sum = 0;
            for (const GsdfRecord& r : of_cell) sum += r.direction.unpack().z;
            if (!of_cell.empty()) mean += stratum_mass(s) * cell_mass(s, c) * sum / static_cast<double>(of_cell.size());
        }
    }
    return mean;
}

uint64_t Gsdf::bytes() const
{
    return (data_.alpha0.size() + data_.density.size() + shape_.size() + cumulated_.size()) * sizeof(float) +
           data_.first.size() * sizeof(uint32_t) + data_.records.size() * sizeof(GsdfRecord) +
           data_.weights.size() * sizeof(Imath::C3f);
}

} // namespace scree
