#pragma once

// Private to the medium: the data of a GridMedium.

#include "render/media/brick_field.h"
#include "render/media/grid_medium.h"

namespace scree {

/// p -> m p + b.
struct Affine {
    std::array<V3d, 3> rows{V3d(1, 0, 0), V3d(0, 1, 0), V3d(0, 0, 1)};
    V3d b{0};

    V3d point(const V3d& p) const { return vector(p) + b; }
    V3d vector(const V3d& v) const { return V3d(rows[0].dot(v), rows[1].dot(v), rows[2].dot(v)); }
};

/// A field and its transform.
struct PlacedField {
    BrickField field;
    Affine to_field; ///< from render to field coordinates
    Affine to_render; ///< and back

    std::array<double, 3> at(const V3d& p) const { return field.at(to_field.point(p)); }
};

/// How a walk traverses one content of the density field: constant, by tracking, or cell by cell in closed form.
struct DensityRegion {
    enum class Kind : uint64_t { constant, delta, exact };
    double majorant = 0; ///< largest sigma_t of any channel
    double least = 0; ///< smallest sigma_t of the first channel
    double residual_majorant = 0; ///< largest sigma_t minus smallest sigma_t, maximum over channels
    uint64_t offset : 62 = 0; ///< Content::offset
    Kind kind : 2 = Kind::constant;
};

struct GridMediumData {
    PlacedField density;
    std::vector<DensityRegion> regions; ///< one for each content of the density
    std::vector<std::array<double, 3>> least; ///< smallest sigma_t of each channel in each region, if not achromatic
    std::array<double, 3> scale{}; ///< sigma_t of density 1, per unit of render length
    bool achromatic = true;
    bool has_albedo = false, has_g = false;
    PlacedField albedo, g;
    GridMediumOptions options;

    /// Computes `regions`, `least` and `achromatic` from the other members.
    void prepare();

    using Sigma = std::array<double, 3>;
    Sigma sigma_of(const std::array<double, 3>& density_there) const
    {
        const bool one = density.field.planes == 1;
        return {scale[0] * density_there[0], scale[1] * density_there[one ? 0 : 1],
                scale[2] * density_there[one ? 0 : 2]};
    }
    Weight albedo_at(const V3d& p) const;
    double g_at(const V3d& p) const;
};

} // namespace scree
