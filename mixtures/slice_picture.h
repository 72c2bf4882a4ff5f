#pragma once

#include "base/drawing/picture.h"
#include "ingest/particles/particle_frame.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace scree {

struct SliceOptions {
    /// Where the three planes meet, in the dump's coordinates; empty: the mean of the centres.
    std::optional<Imath::V3d> at;
    int width = 1200; ///< approximate width of the picture in pixels
};

/// The colour of grain type number k in diagrams; most colour-blind people can distinguish the first eight.
ScreenColor type_color(size_t k);

/// Three orthogonal slices through spheres at one scale, coloured by type: z = const on top, y = const below it,
/// x = const to the right of y = const; with a legend of the types that occur (fractions by number and volume) and a
/// scale bar.
///
/// types[i] is the type of sphere i, names[type] the type's name. title: a line on top.
Picture slice_picture(const ParticleFrame& frame, std::span<const uint32_t> types,
                      const std::vector<std::string>& names, const std::string& title,
                      const SliceOptions& options = {});

} // namespace scree
