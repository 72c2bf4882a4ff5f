#pragma once

#include "ingest/particles/particle_frame.h"
#include "mixtures/mixture.h"
#include "mixtures/mixture_description.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace scree {

/// What a mixture is made for: the grain types, and the spheres it will be asked about.
struct MixtureContext {
    std::vector<std::string> types; ///< the answers are places in this list
    std::map<int32_t, std::string> file_types; ///< the assembly's map from the dump's type numbers; may be empty
    const ParticleFrame* frame = nullptr; ///< the spheres by row, used while making only; null: index is id
    bool tiled = false; ///< the frame is one tile of a fill: index = copy * frame size + row
    std::string place; ///< the assembly, for messages
};

/// The mixture of a description. Positions asked about are relative to the frame's origin (to 0 without a frame).
///
/// Randomness goes by the spheres' ids. In a blend every mixture has a hash stream of its own: the root has stream 0,
/// `by` that of its blend, mixture k of a blend with stream s has mix64(s + (k + 1) 0x9e3779b97f4a7c15); so equal seeds
/// inside each other are independent. Without a frame, or in a tile, by volume is drawn by number.
/// Throws InputError where names, files and spheres do not fit the description.
std::unique_ptr<Mixture> make_mixture(const MixtureDescription& description, const MixtureContext& context);

} // namespace scree
