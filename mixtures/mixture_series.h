#pragma once

#include "mixtures/make_mixture.h"

#include <map>
#include <optional>

namespace scree {

/// A mixture over the frames of a film: no sphere changes its type while it moves.
///
/// Types that follow from places (or from which spheres there are) are decided in one frame, by default the last, and
/// kept by id from then on; spheres that are not in that frame are decided where they are.
class MixtureSeries {
public:
    /// types, file_types, place: as in MixtureContext.
    MixtureSeries(MixtureDescription description, std::vector<std::string> types,
                  std::map<int32_t, std::string> file_types = {}, std::string place = "");

    /// Which of `frame_count` frames decides, when one does and there are several. Throws InputError when it does not
    /// exist.
    std::optional<size_t> deciding_frame(size_t frame_count) const;

    /// Hands in that frame; without it every frame decides for itself. Spheres without ids from the file are not
    /// followed.
    void decide(const ParticleFrame& frame);
    bool decided() const { return decided_; }

    /// The mixture of a frame's spheres. Throws InputError.
    std::unique_ptr<Mixture> mixture(const ParticleFrame& frame) const;

    const MixtureDescription& description() const { return description_; }
    const std::vector<std::string>& types() const { return types_; }

private:
    MixtureContext context(const ParticleFrame& frame) const { return {types_, file_types_, &frame, false, place_}; }

    MixtureDescription description_;
    std::vector<std::string> types_;
    std::map<int32_t, std::string> file_types_;
    std::string place_;
    bool decided_ = false;
    std::vector<uint64_t> ids_; // ascending
    std::unique_ptr<const Mixture> kept_; // types of ids_, by row
};

} // namespace scree
