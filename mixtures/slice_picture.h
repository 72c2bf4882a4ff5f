#pragma once

#include "base/drawing/picture.h"
#include "ingest/particles/particle_frame.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace scree {

struct SliceOptions {
    std::optional<Imath::V3d> at; ///< where the three planes meet, in the dump's frame; else the mean of the centres
    int width = 1200; ///< of the picture in pixels, about
};

/// The colour of grain type number k in diagrams; the first eight differ also for most who see colours otherwise.
ScreenColor type_color(size_t k);

/// Three orthogonal slices through spheres, coloured by type, of one scale: z = const above y = const, x = const beside
/// it; with a legend of the types that occur (fractions by number and volume) and a scale bar.
///
/// types[i] is the type of sphere i, names[type] its name. title: a line on top.
Picture slice_picture(const ParticleFrame& frame, std::span<const uint32_t> types,
                      const std::vector<std::string>& names, const std::string& title,
                      const SliceOptions& options = {});

} // namespace scree
