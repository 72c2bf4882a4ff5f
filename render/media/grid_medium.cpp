#include "render/media/grid_medium.h"

#include "render/media/brick_walk.h"
#include "render/media/grid_medium_data.h"

#include <optional>

namespace scree {

namespace {

using Kind = DensityRegion::Kind;
using Sigma = GridMediumData::Sigma;
using Cell = std::array<int32_t, 3>;

/// sigma_t along the part of a ray inside one cell: a cubic (three linear factors) in s, where s in 0..1 is the
/// distance over `length`.
///
/// f: its values at s = 0, 1/3, 2/3 and 1. Its integral by Simpson's 3/8 rule is exact for cubics, and is a sum of
/// terms that are not negative.
struct CubicDensity {
    std::array<double, 4> f;
    double length;

    double integral() const { return length / 8 * (f[0] + 3 * f[1] + 3 * f[2] + f[3]); }
    double at(double s) const
    {
        const std::array<double, 4> c = coefficients();
        return std::max(0.0, c[0] + s * (c[1] + s * (c[2] + s * c[3])));
    }
    /// The s for which the integral over 0..s is `depth`, by Newton's method inside a shrinking bracket.
    double find(double depth) const
    {
        const std::array<double, 4> c = coefficients();
        double low = 0, high = 1, s = std::min(1.0, depth / integral());
        for (int step = 0; step < 100; ++step) {
            const double error = length * s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * c[3] / 4))) - depth;
            (error < 0 ? low : high) = s;
            const double slope = length * (c[0] + s * (c[1] + s * (c[2] + s * c[3])));
            double next = s - error / slope;
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            if (std::abs(next - s) <= 4e-16 * s || next == low || next == high) return next;
            s = next;
        }
        return s;
    }

private:
    std::array<double, 4> coefficients() const
    {
        return {f[0], (-11 * f[0] + 18 * f[1] - 9 * f[2] + 2 * f[3]) / 2,
                (18 * f[0] - 45 * f[1] + 36 * f[2] - 9 * f[3]) / 2, (-9 * f[0] + 27 * f[1] - 27 * f[2] + 9 * f[3]) / 2};
    }
};

class Walk {
public:
    Walk(const GridMediumData& medium, const V3d& o, const V3d& d)
        : medium_(medium), field_(medium.density.field),
          ray_(medium.density.to_field.point(o), medium.density.to_field.vector(d))
    {
    }

    /// False for a ray with values that are not finite, or that moves along no axis.
    bool is_sound() const
    {
        const V3d sum = ray_.o + ray_.d;
        return std::isfinite(sum.x + sum.y + sum.z) && (ray_.step[0] != 0 || ray_.step[1] != 0 || ray_.step[2] != 0);
    }

    /// The t at which it scatters, if it does.
    std::optional<double> event(double t0, double t1, Sampler& sampler) const;
    std::optional<double> chromatic_event(double t0, double t1, SpectralState& state, Sampler& sampler) const;
    double transmittance(double t0, double t1, Sampler& sampler) const;
    Color chromatic_transmittance(double t0, double t1, Sampler& sampler) const;

private:
    const DensityRegion& regions(int32_t index) const { return medium_.regions[static_cast<size_t>(index)]; }
    double sigma_at(const DensityRegion& region, const Cell& low, const V3d& p) const
    {
        return medium_.scale[0] * field_.at_brick(region.offset, low, p);
    }
    Sigma sigmas_at(const DensityRegion& region, const Cell& low, const V3d& p) const
    {
        Sigma density{field_.at_brick(region.offset, low, p), 0, 0};
        for (size_t plane = 1; plane < static_cast<size_t>(field_.planes); ++plane)
            density[plane] = field_.at_brick(region.offset + plane * BrickField::corners, low, p);
        return medium_.sigma_of(density);
    }

    /// The four points at which a cell's cubic is sampled. With `nearest` all are the cell's middle: on a face the
    /// nearest voxel could be the neighbour's.
    std::array<V3d, 4> nodes(const Cell& cell, double t0, double t1) const
    {
        const V3d middle(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
        if (field_.nearest) return {middle, middle, middle, middle};
        const double third = (t1 - t0) / 3;
        return {ray_.at(t0), ray_.at(t0 + third), ray_.at(t1 - third), ray_.at(t1)};
    }
    CubicDensity cubic(const DensityRegion& region, const Cell& low, const Cell& cell, double t0, double t1) const
    {
        const std::array<V3d, 4> p = nodes(cell, t0, t1);
        return {{sigma_at(region, low, p[0]), sigma_at(region, low, p[1]), sigma_at(region, low, p[2]),
                 sigma_at(region, low, p[3])},
                t1 - t0};
    }
    std::array<CubicDensity, 3> cubics(const DensityRegion& region, const Cell& low, const Cell& cell, double t0,
                                       double t1) const
    {
        const std::array<V3d, 4> p = nodes(cell, t0, t1);
        const std::array<Sigma, 4> f{sigmas_at(region, low, p[0]), sigmas_at(region, low, p[1]),
                                     sigmas_at(region, low, p[2]), sigmas_at(region, low, p[3])};
        std::array<CubicDensity, 3> result;
        for (size_t c = 0; c < 3; ++c) result[c] = {{f[0][c], f[1][c], f[2][c], f[3][c]}, t1 - t0};
        return result;
    }

    const GridMediumData& medium_;
    const BrickField& field_;
    FieldRay ray_;
};

std::optional<double> Walk::event(double t0, double t1, Sampler& sampler) const
{
    double depth = draw_optical_depth(sampler); // remaining until the next collision
    std::optional<double> scattered;
    walk_bricks(field_, ray_, t0, t1, [&](int32_t index, const Cell& low, double from, double to) {
        const DensityRegion& region = regions(index);
        if (region.kind == Kind::exact)
            return walk_cells(ray_, low, from, to, [&](const Cell& cell, double a, double b) {
                const CubicDensity along = cubic(region, low, cell, a, b);
                const double passed = along.integral();
                if (depth < passed) {
                    scattered = std::min(b, a + (b - a) * along.find(depth));
                    return true;
                }
                depth -= passed;
                return false;
            });
        for (;;) {
            const double passed = region.majorant * (to - from);
            if (depth >= passed) {
                depth -= passed;
                return false;
            }
            from += depth / region.majorant;
            // Below region.least a collision is real whatever the density there, so no lookup is needed.
            const double u = region.least < region.majorant ? sampler.next() * region.majorant : 0;
            if (u < region.least || u < sigma_at(region, low, ray_.at(from))) {
                scattered = from;
                return true;
            }
            depth = draw_optical_depth(sampler);
        }
    });
    return scattered;
}

std::optional<double> Walk::chromatic_event(double t0, double t1, SpectralState& state, Sampler& sampler) const
{
    const size_t hero = state.hero;
    double depth = draw_optical_depth(sampler);
    std::optional<double> scattered;
    // Probability density of this walk if channel c were the hero, over its density for the actual hero. The
    // contribution of the path in channel c has the same factors. The mean of the ratio over walks is 1, so that it
    // does not overflow.
    std::array<double, 3> ratio{1, 1, 1};
    const auto pass = [&](const Sigma& passed) {
        for (size_t c = 0; c < 3; ++c) ratio[c] *= std::exp(passed[hero] - passed[c]);
    };
    const auto collide = [&](const Sigma& sigma) {
        if (sigma[hero] > 0) // rounding can place a collision where the density is still 0
            for (size_t c = 0; c < 3; ++c) ratio[c] *= sigma[c] / sigma[hero];
    };
    walk_bricks(field_, ray_, t0, t1, [&](int32_t index, const Cell& low, double from, double to) {
        const DensityRegion& region = regions(index);
        if (region.kind == Kind::constant) {
            const Sigma& sigma = medium_.least[static_cast<size_t>(index)];
            const double length = std::min(to - from, depth / sigma[hero]);
            const bool ends = depth < sigma[hero] * (to - from);
            pass({sigma[0] * length, sigma[1] * length, sigma[2] * length});
            depth -= sigma[hero] * length;
            if (!ends) return false;
            collide(sigma);
            scattered = from + length;
            return true;
        }
        if (region.kind == Kind::exact)
            return walk_cells(ray_, low, from, to, [&](const Cell& cell, double a, double b) {
                std::array<CubicDensity, 3> along = cubics(region, low, cell, a, b);
                const bool ends = depth < along[hero].integral();
                if (ends) {
                    scattered = std::min(b, a + (b - a) * along[hero].find(depth));
                    along = cubics(region, low, cell, a, *scattered);
                }
                const Sigma passed{along[0].integral(), along[1].integral(), along[2].integral()};
                pass(passed);
                depth -= passed[hero];
                if (ends) collide({along[0].f[3], along[1].f[3], along[2].f[3]});
                return ends;
            });
        for (;;) {
            const double passed = region.majorant * (to - from);
            if (depth >= passed) {
                depth -= passed;
                return false;
            }
            from += depth / region.majorant;
            const Sigma sigma = sigmas_at(region, low, ray_.at(from));
            if (sampler.next() * region.majorant < sigma[hero]) {
                collide(sigma);
                scattered = from;
                return true;
            }
            const double null = region.majorant - sigma[hero];
            for (size_t c = 0; c < 3; ++c) ratio[c] *= std::max(0.0, region.majorant - sigma[c]) / null;
            depth = draw_optical_depth(sampler);
        }
    });
    const Color factor(static_cast<Real>(ratio[0]), static_cast<Real>(ratio[1]), static_cast<Real>(ratio[2]));
    state.multiply(factor);
    return scattered;
}

constexpr double roulette_below = 0.1;

double Walk::transmittance(double t0, double t1, Sampler& sampler) const
{
    double left = 1;
    const auto is_lost = [&] {
        if (left >= roulette_below) return false;
        left = sampler.next() * roulette_below < left ? roulette_below : 0;
        return left == 0;
    };
    walk_bricks(field_, ray_, t0, t1, [&](int32_t index, const Cell& low, double from, double to) {
        const DensityRegion& region = regions(index);
        if (region.kind == Kind::exact)
            return walk_cells(ray_, low, from, to, [&](const Cell& cell, double a, double b) {
                left *= std::exp(-cubic(region, low, cell, a, b).integral());
                return is_lost();
            });
        left *= std::exp(-region.least * (to - from));
        if (is_lost()) return true;
        const double residual = region.residual_majorant;
        if (residual == 0) return false;
        for (;;) {
            from += draw_optical_depth(sampler) / residual;
            if (!(from < to)) return false;
            const double fraction = (sigma_at(region, low, ray_.at(from)) - region.least) / residual;
            left *= 1 - std::min(1.0, std::max(0.0, fraction));
            if (is_lost()) return true;
        }
    });
    return left;
}

Color Walk::chromatic_transmittance(double t0, double t1, Sampler& sampler) const
{
    std::array<double, 3> left{1, 1, 1};
    const auto is_lost = [&] {
        const double most = std::max({left[0], left[1], left[2]});
        if (most >= roulette_below) return false;
        const double kept = sampler.next() * roulette_below < most ? roulette_below / most : 0;
        for (double& l : left) l = kept > 0 ? l * kept : 0;
        return kept == 0;
    };
    walk_bricks(field_, ray_, t0, t1, [&](int32_t index, const Cell& low, double from, double to) {
        const DensityRegion& region = regions(index);
        const Sigma& least = medium_.least[static_cast<size_t>(index)];
        if (region.kind == Kind::exact)
            return walk_cells(ray_, low, from, to, [&](const Cell& cell, double a, double b) {
                const std::array<CubicDensity, 3> along = cubics(region, low, cell, a, b);
                for (size_t c = 0; c < 3; ++c) left[c] *= std::exp(-along[c].integral());
                return is_lost();
            });
        for (size_t c = 0; c < 3; ++c) left[c] *= std::exp(-least[c] * (to - from));
        if (is_lost()) return true;
        const double residual = region.residual_majorant;
        if (residual == 0) return false;
        for (;;) {
            from += draw_optical_depth(sampler) / residual;
            if (!(from < to)) return false;
            const Sigma sigma = sigmas_at(region, low, ray_.at(from));
            for (size_t c = 0; c < 3; ++c)
                left[c] *= 1 - std::min(1.0, std::max(0.0, (sigma[c] - least[c]) / residual));
            if (is_lost()) return true;
        }
    });
    return {static_cast<Real>(left[0]), static_cast<Real>(left[1]), static_cast<Real>(left[2])};
}

} // namespace

GridMedium::GridMedium(std::shared_ptr<const GridMediumData> data) : data_(std::move(data)) {}

MediumEvent GridMedium::event(const V3d& o, const V3d& d, double t0, double t1, SpectralState& state,
                              Sampler& sampler) const
{
    MediumEvent event;
    const Walk walk(*data_, o, d);
    if (!walk.is_sound()) return event;
    const std::optional<double> t =
        data_->achromatic ? walk.event(t0, t1, sampler) : walk.chromatic_event(t0, t1, state, sampler);
    if (!t) return event;
    event.scattered = true;
    event.t = *t;
    const V3d p = o + d * event.t;
    event.albedo = data_->albedo_at(p);
    event.phase = PhaseFunction(data_->g_at(p));
    return event;
}

Color GridMedium::transmittance(const V3d& o, const V3d& d, double t0, double t1, Sampler& sampler) const
{
    const Walk walk(*data_, o, d);
    if (!walk.is_sound()) return Color(1);
    return data_->achromatic ? Color(static_cast<Real>(walk.transmittance(t0, t1, sampler)))
                             : walk.chromatic_transmittance(t0, t1, sampler);
}

Imath::Box3d GridMedium::bounds() const
{
    Imath::Box3d bounds;
    const Imath::Box3d& support = data_->density.field.support;
    if (support.isEmpty()) return bounds;
    for (int corner = 0; corner < 8; ++corner)
        bounds.extendBy(data_->density.to_render.point(V3d((corner & 1 ? support.max : support.min).x,
                                                           (corner & 2 ? support.max : support.min).y,
                                                           (corner & 4 ? support.max : support.min).z)));
    return bounds;
}

bool GridMedium::is_achromatic() const { return data_->achromatic; }

double GridMedium::largest_sigma_t() const
{
    double largest = 0;
    for (const DensityRegion& region : data_->regions) largest = std::max(largest, region.majorant);
    return largest;
}

uint64_t GridMedium::bytes() const
{
    return sizeof(GridMediumData) + data_->density.field.bytes() + data_->albedo.field.bytes() +
           data_->g.field.bytes() + data_->regions.capacity() * sizeof(DensityRegion) +
           data_->least.capacity() * sizeof(Sigma);
}

double GridMedium::voxel() const
{
    double edge = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k)
        edge = std::min(edge, data_->density.to_render.vector(V3d(k == 0, k == 1, k == 2)).length());
    return edge;
}

Color GridMedium::sigma_t(const V3d& p) const
{
    const Sigma sigma = data_->sigma_of(data_->density.at(p));
    return {static_cast<Real>(sigma[0]), static_cast<Real>(sigma[1]), static_cast<Real>(sigma[2])};
}

Weight GridMedium::albedo(const V3d& p) const { return data_->albedo_at(p); }
double GridMedium::g(const V3d& p) const { return data_->g_at(p); }

} // namespace scree
