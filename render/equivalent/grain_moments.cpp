#include "render/equivalent/grain_moments.h"

namespace scree {

namespace {

/// Integrals over q for one stratum, weighted by the probability of choosing it: (1 - alpha0(q)) times the tent of
/// Gsdf::stratum.
struct StratumImpact {
    double mass = 0, b = 0, cosine = 0; ///< integrals of 1, sin beta_o, cos beta_o
};

std::array<StratumImpact, Gsdf::strata> stratum_impacts(const Gsdf& gsdf)
{
    // Midpoints: alpha0 is linear between the middles of its 512 bins, and a stratum is 16 of those wide.
    constexpr uint32_t steps = 8 * Gsdf::alpha_bins;
    std::array<StratumImpact, Gsdf::strata> impacts{};
    double total = 0;
    for (uint32_t i = 0; i < steps; ++i) {
        const double q = (i + 0.5) / steps, met = (1 - gsdf.alpha0(q)) / steps;
        const double place = std::clamp(q * Gsdf::strata - 0.5, 0.0, Gsdf::strata - 1.0);
        const auto low = static_cast<uint32_t>(place);
        for (const uint32_t s : {low, low + 1}) {
            const double tent = s == low ? 1 - (place - low) : place - low;
            if (s == Gsdf::strata || tent == 0) continue;
            impacts[s].mass += tent * met;
            impacts[s].b += tent * met * std::sqrt(q);
            impacts[s].cosine += tent * met * std::sqrt(1 - q);
        }
        total += met;
    }
    if (total > 0) {
        for (StratumImpact& impact : impacts) impact = {impact.mass / total, impact.b / total, impact.cosine / total};
    }
    return impacts;
}

/// Calls each(number, record, probability of the record in its stratum).
template <class Each>
void for_each_record(const Gsdf& gsdf, uint32_t stratum, const Each& each)
{
    double total = 0;
    for (uint32_t cell = 0; cell < Gsdf::cells; ++cell) total += gsdf.cell_mass(stratum, cell);
    for (uint32_t cell = 0; cell < Gsdf::cells; ++cell) {
        const auto records = gsdf.records(stratum, cell);
        if (records.empty()) continue;
        const double mass = gsdf.cell_mass(stratum, cell) / (total * static_cast<double>(records.size()));
        if (!(mass > 0)) continue;
        const auto first = static_cast<uint32_t>(records.data() - gsdf.data().records.data());
        for (uint32_t i = 0; i < records.size(); ++i) each(first + i, records[i], mass);
    }
}

void add_passes(const Gsdf& gsdf, GrainMoments& moments)
{
    constexpr uint32_t steps = 8 * Gsdf::alpha_bins;
    double passes = 0;
    for (uint32_t i = 0; i < steps; ++i) {
        const double q = (i + 0.5) / steps, pass = gsdf.alpha0(q) / steps;
        passes += pass;
        moments.pass_chord += pass * 2 * std::sqrt(1 - q);
        moments.pass_chord2 += pass * 4 * (1 - q);
    }
    moments.alpha0 = passes;
    if (passes > 0) {
        moments.pass_chord /= passes;
        moments.pass_chord2 /= passes;
    }
}

} // namespace

GrainMoments grain_moments(const Gsdf& gsdf)
{
    GrainMoments moments;
    add_passes(gsdf, moments);
    const auto impacts = stratum_impacts(gsdf);
    double total = 0;
    for (uint32_t s = 0; s < Gsdf::strata; ++s) {
        const StratumImpact& impact = impacts[s];
        if (!(impact.mass > 0)) continue;
        for_each_record(gsdf, s, [&](uint32_t, const GsdfRecord& record, double mass) {
            // The entry is (sin beta_o, 0, -cos beta_o) and the exit a unit vector, so all moments are linear in the
            // entry.
            const V3d p = record.point.unpack(), w = record.direction.unpack();
            const double all = mass * impact.mass;
            total += all;
            moments.g += all * w.z;
            moments.along_in += all * p.z + mass * impact.cosine;
            moments.along_out += all * p.dot(w) - mass * (impact.b * w.x - impact.cosine * w.z);
            moments.delta2 += 2 * all - 2 * mass * (impact.b * p.x - impact.cosine * p.z);
            moments.phase.density[CosineTable::bin(w.z)] += all;
        });
    }
    for (double& density : moments.phase.density) density /= CosineTable::width() * (total > 0 ? total : 1);
    return moments;
}

GrainAlbedo grain_albedo(const Gsdf& gsdf, const Material& material, double radius)
{
    // Sums the losses, so that the albedo is exactly 1 without losses.
    GrainAlbedo albedo{V3d(1), V3d(0)};
    const auto impacts = stratum_impacts(gsdf);
    for (uint32_t s = 0; s < Gsdf::strata; ++s) {
        if (!(impacts[s].mass > 0)) continue;
        for_each_record(gsdf, s, [&](uint32_t number, const GsdfRecord& record, double mass) {
            const V3d kept(gsdf.weight(number, material, radius));
            albedo.weight -= mass * impacts[s].mass * (V3d(1) - kept);
            albedo.weighted_cosine += mass * impacts[s].mass * record.direction.unpack().z * kept;
        });
    }
    return albedo;
}

GrainAlbedoByRadius::GrainAlbedoByRadius(const Gsdf& gsdf, const Material& material)
    : absorption_(material.transmits() ? V3d(material.absorption) : V3d(0))
{
    constexpr size_t bins = 1000;
    float longest = 0;
    for (const GsdfRecord& record : gsdf.data().records) longest = std::max(longest, record.length);
    width_ = longest > 0 ? double{longest} / bins : 1;
    bins_.resize(bins + 1);
    Material clear = material;
    clear.absorption = Color(0);
    const auto impacts = stratum_impacts(gsdf);
    for (uint32_t s = 0; s < Gsdf::strata; ++s) {
        if (!(impacts[s].mass > 0)) continue;
        for_each_record(gsdf, s, [&](uint32_t number, const GsdfRecord& record, double mass) {
            const V3d kept(gsdf.weight(number, clear, 1));
            const double all = mass * impacts[s].mass, cosine = record.direction.unpack().z,
                         place = record.length / width_;
            const auto below = std::min(static_cast<size_t>(place), bins - 1);
            lost_ += all * (V3d(1) - kept);
            for (const size_t bin : {below, below + 1}) {
                const double share = all * (bin == below ? 1 - (place - static_cast<double>(below))
                                                         : place - static_cast<double>(below));
                bins_[bin].weight += share * kept;
                bins_[bin].weighted_cosine += share * cosine * kept;
            }
        });
    }
}

GrainAlbedo GrainAlbedoByRadius::at(double radius) const
{
    GrainAlbedo albedo{V3d(1) - lost_, V3d(0)};
    for (size_t i = 0; i < bins_.size(); ++i) {
        const V3d depth = static_cast<double>(i) * width_ * radius * absorption_,
                  absorbed(-std::expm1(-depth.x), -std::expm1(-depth.y), -std::expm1(-depth.z));
        albedo.weight -= bins_[i].weight * absorbed;
        albedo.weighted_cosine += bins_[i].weighted_cosine * (V3d(1) - absorbed);
    }
    return albedo;
}

} // namespace scree
