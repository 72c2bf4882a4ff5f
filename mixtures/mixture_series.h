#pragma once

#include "mixtures/make_mixture.h"

#include <map>
#include <optional>

namespace scree {

/// A mixture over the frames of a film: no sphere changes its type while it moves.
///
/// Types that depend on positions (or on the set of spheres) are decided in one frame, by default the last, and kept by
/// sphere id. A sphere that is not in that frame is decided at its position in the current frame.
class MixtureSeries {
public:
    /// types, file_types, place: as in MixtureContext.
    MixtureSeries(MixtureDescription description, std::vector<std::string> types,
                  std::map<int32_t, std::string> file_types = {}, std::string place = "");

    /// The index of the frame that decides; nothing if every frame decides anew, if frames make no difference, or if
    /// frame_count < 2. Throws InputError when that frame does not exist.
    std::optional<size_t> deciding_frame(size_t frame_count) const;

    /// Decides the types in this frame; without this call every frame decides for itself. Does nothing when the file
    /// gives no ids.
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
