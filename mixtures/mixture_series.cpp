#include "mixtures/mixture_series.h"

#include "base/error.h"
#include "mixtures/explicit_mixture.h"

#include <fmt/format.h>

namespace scree {

namespace {

/// The types of all spheres as a table.
std::unique_ptr<ExplicitMixture> evaluated(const Mixture& mixture, const ParticleFrame& frame)
{
    std::vector<uint32_t> types(frame.size());
    for (size_t i = 0; i < types.size(); ++i) types[i] = mixture.type(i, frame.relative_position(i));
    return std::make_unique<ExplicitMixture>(types);
}

} // namespace

MixtureSeries::MixtureSeries(MixtureDescription description, std::vector<std::string> types,
                             std::map<int32_t, std::string> file_types, std::string place)
    : description_(std::move(description)), types_(std::move(types)), file_types_(std::move(file_types)),
      place_(std::move(place))
{
}

std::optional<size_t> MixtureSeries::deciding_frame(size_t frame_count) const
{
    if (description_.decided.each || !depends_on_frame(description_) || frame_count < 2) return std::nullopt;
    const auto count = static_cast<int64_t>(frame_count);
    const int64_t frame = description_.decided.frame, at = frame < 0 ? frame + count : frame;
    if (at < 0 || at >= count)
        throw InputError(description_.place + "/frame", fmt::format("frame {}", frame),
                         fmt::format("one of {} frames, {}..{}", count, -count, count - 1));
    return static_cast<size_t>(at);
}

void MixtureSeries::decide(const ParticleFrame& frame)
{
    if (!frame.has_ids) return;
    kept_ = evaluated(*make_mixture(description_, context(frame)), frame);
    ids_ = frame.id;
    decided_ = true;
}

std::unique_ptr<Mixture> MixtureSeries::mixture(const ParticleFrame& frame) const
{
    if (!decided_) return make_mixture(description_, context(frame));
    std::vector<uint32_t> types(frame.size());
    std::unique_ptr<Mixture> here; // for spheres that the deciding frame lacks
    size_t k = 0;
    for (size_t i = 0; i < frame.size(); ++i) { // both ascend by id
        while (k < ids_.size() && ids_[k] < frame.id[i]) ++k;
        if (k < ids_.size() && ids_[k] == frame.id[i]) {
            types[i] = kept_->type(k, {});
        } else {
            if (!here) here = make_mixture(description_, context(frame));
            types[i] = here->type(i, frame.relative_position(i));
        }
    }
    return std::make_unique<ExplicitMixture>(types);
}

} // namespace scree
