#include "render/media/grid_medium_data.h"

namespace scree {

namespace {

/// A brick is traversed cell by cell if delta tracking could take more steps than this, most of them null collisions. A
/// lower limit is slower: in a cloud whose bricks have optical depth 60, delta tracking was still faster by half.
constexpr double most_steps = 256;

} // namespace

void GridMediumData::prepare()
{
    const BrickField& field = density.field;
    achromatic = field.planes == 1 && scale[0] == scale[1] && scale[0] == scale[2];
    double edge = 0; // longest edge of a cell
    for (int k = 0; k < 3; ++k) edge = std::max(edge, density.to_render.vector(V3d(k == 0, k == 1, k == 2)).length());
    regions.clear();
    least.clear();
    regions.reserve(field.contents.size());
    for (const BrickField::Content& content : field.contents) {
        DensityRegion region;
        const auto wide = [](const std::array<float, 3>& v) {
            return std::array<double, 3>{double{v[0]}, double{v[1]}, double{v[2]}};
        };
        const Sigma low = sigma_of(wide(content.low)), high = sigma_of(wide(content.high));
        region.least = low[0];
        region.offset = content.offset & ((uint64_t{1} << 62) - 1);
        for (size_t c = 0; c < 3; ++c) {
            region.majorant = std::max(region.majorant, high[c]);
            region.residual_majorant = std::max(region.residual_majorant, high[c] - low[c]);
        }
        using Kind = DensityRegion::Kind;
        // In a brick that is even enough, a good part of the collisions are real, so tracking is fast at any density.
        const double smallest = achromatic ? low[0] : std::min({low[0], low[1], low[2]});
        const bool is_long =
            region.majorant * edge * BrickField::width > most_steps && smallest < 0.25 * region.majorant;
        region.kind = content.constant ? Kind::constant : is_long ? Kind::exact : Kind::delta;
        if (!achromatic) least.push_back(low);
        regions.push_back(region);
    }
}

Weight GridMediumData::albedo_at(const V3d& p) const
{
    if (!has_albedo) return options.albedo;
    const std::array<double, 3> a = albedo.at(p);
    const bool one = albedo.field.planes == 1;
    const auto clamped = [](double x) { return std::min(std::max(x, 0.0), 1.0); };
    return {clamped(a[0]), clamped(a[one ? 0 : 1]), clamped(a[one ? 0 : 2])};
}

double GridMediumData::g_at(const V3d& p) const { return has_g ? g.at(p)[0] : options.g; }

} // namespace scree
