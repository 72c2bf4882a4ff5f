#include "render/medium/grid_uniformity.h"

#include "render/medium/grid_medium_data.h"
#include "render/medium/range_pyramid.h"

#include <optional>

namespace scree {

namespace {

/// A field's ranges over balls.
struct BallRanges {
    const PlacedField& placed;
    std::vector<RangePyramid> planes;
    V3d per_length; ///< how far a ball of radius 1 reaches along the field's axes

    explicit BallRanges(const PlacedField& field) : placed(field)
    {
        for (size_t plane = 0; plane < static_cast<size_t>(field.field.planes); ++plane) planes.emplace_back(field.field, plane);
        for (int k = 0; k < 3; ++k) per_length[k] = field.to_field.rows[static_cast<size_t>(k)].length();
    }
    /// Whether plane `plane` is within low..high everywhere in the ball.
    bool within(size_t plane, const V3d& centre, double radius, double low, double high) const
    {
        const V3d middle = placed.to_field.point(centre), reach = radius * per_length;
        const RangePyramid::Range range = planes[plane].over({middle - reach, middle + reach});
        return range.low >= low && range.high <= high;
    }
};

} // namespace

struct GridUniformity::Impl {
    std::shared_ptr<const GridMediumData> data;
    double tolerance;
    BallRanges density;
    std::optional<BallRanges> albedo, g;

    Impl(std::shared_ptr<const GridMediumData> data_, double tolerance_) : data(std::move(data_)), tolerance(tolerance_), density(data->density)
    {
        if (data->has_albedo) albedo.emplace(data->albedo);
        if (data->has_g) g.emplace(data->g);
    }
};

GridUniformity::GridUniformity(const GridMedium& medium, double tolerance) : impl_(std::make_unique<Impl>(medium.data(), tolerance)) {}
GridUniformity::~GridUniformity() = default;

GridUniformity::Extremes GridUniformity::extremes() const
{
    const GridMediumData& data = *impl_->data;
    const float albedo = max_component(data.options.albedo), g = static_cast<float>(data.options.g);
    Extremes extremes{albedo, albedo, g, g};
    const auto range = [](const BrickField& field, float& low, float& high) {
        low = std::numeric_limits<float>::infinity();
        high = -low;
        for (const BrickField::Content& content : field.contents) {
            float least = -std::numeric_limits<float>::infinity(), most = least;
            for (size_t plane = 0; plane < static_cast<size_t>(field.planes); ++plane) {
                least = std::max(least, content.low[plane]);
                most = std::max(most, content.high[plane]);
            }
            low = std::min(low, least);
            high = std::max(high, most);
        }
        if (field.contents.empty()) low = high = field.background[0];
    };
    if (data.has_albedo) range(data.albedo.field, extremes.albedo_low, extremes.albedo_high);
    if (data.has_g) range(data.g.field, extremes.g_low, extremes.g_high);
    return extremes;
}

bool GridUniformity::holds(const V3d& centre, double radius, double sigma_t, const C3f& albedo, double g) const
{
    const Impl& impl = *impl_;
    const double density = sigma_t / impl.data->scale[0], t = impl.tolerance;
    if (!impl.density.within(0, centre, radius, density * (1 - t), density * (1 + t))) return false;
    if (impl.g && !impl.g->within(0, centre, radius, g - t * (1 - g), g + t * (1 - g))) return false;
    if (!impl.albedo) return true;
    for (size_t plane = 0; plane < impl.albedo->planes.size(); ++plane) {
        const double a = albedo[static_cast<unsigned>(plane)];
        if (!impl.albedo->within(plane, centre, radius, a - t * (1 - a), a + t * (1 - a))) return false;
    }
    return true;
}

uint64_t GridUniformity::bytes() const
{
    uint64_t sum = 0;
    for (const BallRanges* ranges : {&impl_->density, impl_->albedo ? &*impl_->albedo : nullptr, impl_->g ? &*impl_->g : nullptr}) {
        if (!ranges) continue;
        for (const RangePyramid& plane : ranges->planes) sum += plane.bytes();
    }
    return sum;
}

} // namespace scree
