#pragma once

#include "render/build/part_report.h"
#include "render/equivalent/continuous_equivalent.h"
#include "render/equivalent/packing_sample.h"
#include "render/scene/scene_description.h"
#include "render/trace/world.h"

#include <optional>
#include <vector>

namespace scree {

/// The medium that replaces a packing, and the data it is computed from; lengths in render coordinates.
struct GrainMedium {
    PackingSample sample;
    double pack_rate = 0; ///< of the moments and the medium: the sample's, or the walk's if there is one
    MixtureMoments moments; ///< of the whole packing
    std::optional<PackingWalk> walk; ///< if the form needs one
    ContinuousEquivalent medium;
};

/// The medium equivalent to all grains of a world, whose types all need a GSDF; nothing if there are no grains. Throws
/// InputError, Cancelled.
std::optional<GrainMedium> make_grain_medium(const World& world, EquivalentForm form, const Progress& progress);

/// Depth below every face of the grains' volume from which a medium replaces the grains.
struct GrainDepth {
    bool all = false; ///< the medium replaces all grains and begins one mean radius (by volume) below the faces
    double radii = 0; ///< if not all: mean radii,
    double flights = 0; ///< but no fewer mean free paths of the medium
};

/// Replaces the grains that are deep enough by a medium.
///
/// For listed grains the medium varies as the grains do; for a fill it varies as the mixture does. Reports what was
/// built, or why nothing was. Returns the depth at which the medium begins, in mean radii below every face; nothing if
/// no medium was made. Throws InputError, Cancelled.
std::optional<double> replace_grains(const GrainMedium& medium, const GrainDepth& depth, World& world,
                                     std::vector<PartReport>& parts, std::vector<std::string>& remarks,
                                     const Progress& progress);

/// make_grain_medium() and replace_grains() in one call; does no walk if no place is deep enough. Throws
/// InputError, Cancelled.
std::optional<double> replace_grains(EquivalentForm form, const GrainDepth& depth, World& world,
                                     std::vector<PartReport>& parts, std::vector<std::string>& remarks,
                                     const Progress& progress);

} // namespace scree
