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

/// What a mixture is made for: the grain types, and the spheres whose types it will decide.
struct MixtureContext {
    std::vector<std::string> types; ///< the mixture returns indices into this list
    std::map<int32_t, std::string> file_types; ///< the assembly's map: dump's number -> grain type; may be empty
    const ParticleFrame* frame = nullptr; ///< the spheres by row, used only by make_mixture; null: index is id
    bool tiled = false; ///< the frame is one tile of a fill: index = copy * frame size + row
    std::string place; ///< the assembly, for messages
};

/// Makes the mixture of a description. Its positions are relative to the frame's origin (to 0 without a frame).
///
/// Random choices depend on the spheres' ids. Every mixture in a blend has its own hash stream: the root has stream 0,
/// `by` has the stream of its blend, and mixture k of a blend with stream s has mix64(s + (k + 1) 0x9e3779b97f4a7c15).
/// So nested mixtures with equal seeds are independent. Without a frame, or in a tile, a random mixture by volume draws
/// by number. Throws InputError where names, files and spheres do not fit the description.
std::unique_ptr<Mixture> make_mixture(const MixtureDescription& description, const MixtureContext& context);

} // namespace scree
