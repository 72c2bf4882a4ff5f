#pragma once

#include "base/math.h"
#include "render/media/cosine_table.h"

#include <array>

namespace scree {

// The phase function of Henyey and Greenstein (1941), -1 < g < 1. cosine: between the directions before and after the
// scattering; 1 is straight on.

/// Samples a cosine with u in 0..1; accurate for small g, as nothing cancels.
inline double sample_henyey_greenstein(double g, double u)
{
    const double x = 2 * u - 1, y = 1 + g * x;
    const double cosine = (x + g * (0.5 * (x * x + 3) + g * (x + 0.5 * g * (x * x - 1)))) / (y * y);
    return std::clamp(cosine, -1.0, 1.0);
}

/// Its density per solid angle.
inline double pdf_henyey_greenstein(double g, double cosine)
{
    const double b = (1 - g) * (1 - g) + 2 * g * (1 - cosine);
    return (1 - g * g) / (4 * pi * b * std::sqrt(b));
}

/// A tabulated phase function, constant over each bin of the cosine.
class PhaseTable {
public:
    /// Throws InputError for a table that is not a density.
    explicit PhaseTable(const CosineTable& table);

    double sample(double u) const;
    double pdf(double cosine) const { return table_.density[CosineTable::bin(cosine)] / (2 * pi); }
    double mean_cosine() const { return mean_cosine_; }
    const CosineTable& table() const { return table_; }

private:
    CosineTable table_;
    double mean_cosine_ = 0;
    std::array<double, CosineTable::bins> cumulated_{}; ///< cumulative probability up to each bin's end
};

/// A phase function that depends on the angle alone: Henyey-Greenstein, or a table, which must outlive this object.
class PhaseFunction {
public:
    PhaseFunction() = default; ///< isotropic
    /// Henyey-Greenstein; -1 < g < 1.
    explicit PhaseFunction(double g) : g_(g) {}
    explicit PhaseFunction(const PhaseTable* table) : g_(table->mean_cosine()), table_(table) {}

    /// Samples a cosine with u in 0..1.
    double sample(double u) const { return table_ ? table_->sample(u) : sample_henyey_greenstein(g_, u); }
    /// Its density per solid angle.
    double pdf(double cosine) const { return table_ ? table_->pdf(cosine) : pdf_henyey_greenstein(g_, cosine); }
    double mean_cosine() const { return g_; }

private:
    double g_ = 0;
    const PhaseTable* table_ = nullptr;
};

/// The unit direction whose angle to d (unit) has this cosine; u in 0..1 is the azimuth around d.
inline V3d turned(const V3d& d, double cosine, double u)
{
    const double phi = 2 * pi * u, sine = safe_sqrt(1 - cosine * cosine);
    return Frame(d).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine}).normalized();
}

} // namespace scree
