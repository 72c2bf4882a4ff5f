#include "render/equivalent/packing_sample.h"

#include "base/hash.h"
#include "render/equivalent/grain_fields.h"

#include <map>

namespace scree {

namespace {

double moment(const std::vector<PackingSample::Grain>& grains, int power)
{
    double sum = 0;
    for (const PackingSample::Grain& grain : grains) sum += std::pow(grain.radius, power);
    return sum;
}

PackingSample sample_fill(const GrainFill& fill, uint64_t most)
{
    const ProceduralFill& spheres = fill.fill();
    PackingSample sample;
    sample.pack_rate = spheres.tile().fraction();
    // Rows and cells by hash. Cells outside the domain have no grains; they are used only if no grain is found inside,
    // as the mixture gives types for them too.
    for (const bool everywhere : {false, true}) {
        for (uint64_t i = 0; i < 8 * most && sample.grains.size() < most; ++i) {
            const uint64_t cell = hash_index(i, 0) % spheres.cell_count(),
                           row = hash_index(i, 1) % spheres.tile().rows();
            if (!everywhere && spheres.kind(cell) == ProceduralFill::CellKind::outside) continue;
            const ProceduralFill::Sphere sphere = spheres.sphere(spheres.id(cell, row));
            if (!everywhere && !spheres.domain().contains(sphere.centre)) continue;
            sample.grains.push_back({row, fill.to_render(sphere).radius, fill.type(spheres.id(cell, row), sphere)});
        }
        if (!sample.grains.empty()) break;
    }
    return sample;
}

PackingSample sample_list(const GrainStore& grains, size_t types, uint64_t most, const Progress& progress)
{
    PackingSample sample;
    const uint64_t count = std::min<uint64_t>(grains.size(), most);
    for (uint64_t n = 0; n < count; ++n) { // one of each group of consecutive grains, by hash: lists may be periodic
        const uint64_t first = n * grains.size() / count, next = (n + 1) * grains.size() / count;
        const uint64_t i = first + hash_index(n, 0) % (next - first);
        sample.grains.push_back({i, grains.radius(i), grains.type_codes[i]});
    }
    const GrainFieldOptions options{.margin = grains.margin};
    const GrainFields fields = make_grain_fields({grains.spheres.data(), grains.size()}, grains.type_codes,
                                                 static_cast<uint32_t>(types), options, progress);
    std::vector<double> rates;
    for (const PackingSample::Grain& grain : sample.grains) rates.push_back(fields.pack_rate(grains.centre(grain.row)));
    if (rates.empty()) return sample;
    const auto upper = rates.begin() + static_cast<std::ptrdiff_t>(3 * rates.size() / 4);
    std::ranges::nth_element(rates, upper);
    sample.pack_rate = *upper;
    return sample;
}

} // namespace

double PackingSample::mean_radius() const { return moment(grains, 1) / static_cast<double>(grains.size()); }
double PackingSample::volume_weighted_radius() const { return moment(grains, 4) / moment(grains, 3); }

PackingSample sample_packing(const World& world, uint64_t most, const Progress& progress)
{
    return world.fill ? sample_fill(*world.fill, most) : sample_list(world.grains, world.types.size(), most, progress);
}

MomentTable::MomentTable(const std::vector<GrainType>& types, const PackingSample& sample)
{
    for (const GrainType& type : types) {
        types_.push_back({type.gsdf.get(), type.material, {}, 0, 0, {}});
        if (type.gsdf) types_.back().moments = grain_moments(*type.gsdf);
    }
    std::vector<double> least(types.size(), std::numeric_limits<double>::infinity()), most(types.size(), 0);
    for (const PackingSample::Grain& grain : sample.grains) {
        least[grain.type] = std::min(least[grain.type], grain.radius);
        most[grain.type] = std::max(most[grain.type], grain.radius);
    }
    for (size_t i = 0; i < types_.size(); ++i) {
        Type& type = types_[i];
        if (!type.gsdf) continue;
        if (!(most[i] > 0)) { // the sample has no grain of this type
            least[i] = std::ranges::min(least);
            most[i] = std::ranges::max(most);
        }
        // margin: shares of two radii reach beyond the sample's range; finest: step of the logarithm
        constexpr double margin = 2, finest = 0.1;
        type.least = std::log(least[i] / margin);
        const double range = std::log(most[i] * margin) - type.least;
        const auto steps = is_black(type.material.absorption) ? 0 : static_cast<size_t>(std::ceil(range / finest));
        type.step = steps > 0 ? range / static_cast<double>(steps) : 0;
        type.albedo.resize(steps + 1);
        const GrainAlbedoByRadius by_radius(*type.gsdf, type.material);
        for (size_t k = 0; k <= steps; ++k)
            type.albedo[k] = by_radius.at(std::exp(type.least + static_cast<double>(k) * type.step));
    }
}

GrainAlbedo MomentTable::albedo_at(const Type& type, double radius)
{
    if (type.albedo.size() == 1) return type.albedo[0];
    const double place =
        std::clamp((std::log(radius) - type.least) / type.step, 0.0, static_cast<double>(type.albedo.size() - 1));
    const auto below = std::min(static_cast<size_t>(place), type.albedo.size() - 2);
    const double part = place - static_cast<double>(below);
    const GrainAlbedo &a = type.albedo[below], &b = type.albedo[below + 1];
    return {(1 - part) * a.weight + part * b.weight, (1 - part) * a.weighted_cosine + part * b.weighted_cosine};
}

void MomentTable::add_shares(uint8_t type, double m2, double m3, double m4, std::vector<GrainShare>& shares) const
{
    if (!(m2 > 0)) return;
    const Type& kind = types_[type];
    // mean and deviation of the radius, weighted by cross-section
    const double mean = m3 / m2, deviation = safe_sqrt(m4 / m2 - mean * mean);
    constexpr double same = 1e-3; // deviation, as a part of the mean, below which one radius is enough
    if (deviation < same * mean) {
        shares.push_back({kind.gsdf, &kind.moments, kind.material, mean, m2 / (mean * mean), albedo_at(kind, mean)});
        return;
    }
    // A part u of the cross-section gets the radius mean - deviation sqrt((1 - u) / u), the rest the larger radius. Any
    // u keeps mean and deviation; this u keeps the radii above 0.
    const double u = std::max(0.5, 1 / (1 + 0.25 * mean * mean / (deviation * deviation)));
    const double small = mean - deviation * std::sqrt((1 - u) / u), large = mean + deviation * std::sqrt(u / (1 - u));
    shares.push_back(
        {kind.gsdf, &kind.moments, kind.material, small, u * m2 / (small * small), albedo_at(kind, small)});
    shares.push_back(
        {kind.gsdf, &kind.moments, kind.material, large, (1 - u) * m2 / (large * large), albedo_at(kind, large)});
}

std::vector<GrainShare> shares_of(const PackingSample& sample, const MomentTable& table)
{
    struct Sums {
        double m2 = 0, m3 = 0, m4 = 0;
    };
    std::map<uint8_t, Sums> by_type;
    for (const PackingSample::Grain& grain : sample.grains) {
        Sums& sums = by_type[grain.type];
        const double r2 = grain.radius * grain.radius;
        sums.m2 += r2;
        sums.m3 += r2 * grain.radius;
        sums.m4 += r2 * r2;
    }
    std::vector<GrainShare> shares;
    for (const auto& [type, sums] : by_type) table.add_shares(type, sums.m2, sums.m3, sums.m4, shares);
    return shares;
}

} // namespace scree
