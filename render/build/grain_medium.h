#pragma once

#include "render/build/part_report.h"
#include "render/equivalent/continuous_equivalent.h"
#include "render/equivalent/packing_sample.h"
#include "render/scene/scene_description.h"
#include "render/trace/world.h"

#include <optional>
#include <vector>

namespace scree {

/// What stands for a packing, and what it follows from; lengths in render coordinates.
struct GrainMedium {
    PackingSample sample;
    double pack_rate = 0; ///< of what follows: the sample's, or that of the walk
    MixtureMoments moments; ///< of the whole
    std::optional<PackingWalk> walk; ///< where the form needs one
    ContinuousEquivalent medium;
};

/// The equivalent of all a world's grains; every type that it has needs a GSDF. Nothing where there are no grains.
/// Throws InputError, Cancelled.
std::optional<GrainMedium> make_grain_medium(const World& world, EquivalentForm form, const Progress& progress);

/// Below every face of what the grains fill: where on a medium stands for them.
struct GrainDepth {
    bool all = false; ///< for all grains, beginning one mean radius (by volume) within the faces
    double radii = 0; ///< else from so many mean radii on,
    double flights = 0; ///< but not less than so many mean free paths of the medium
};

/// Puts a medium in the place of the grains that are deep enough.
///
/// Of a list of grains the medium varies as they do, of a fill as its mixture does. Reports what was built, or why
/// nothing was. Throws InputError, Cancelled. Returns from where on it does, in mean radii below every face; nothing
/// where no medium was made.
std::optional<double> replace_grains(const GrainMedium& medium, const GrainDepth& depth, World& world,
                                     std::vector<PartReport>& parts, std::vector<std::string>& remarks,
                                     const Progress& progress);

/// Makes the medium of a form and puts it in the place of the grains; where no place is deep enough it walks nowhere.
/// As the two above.
std::optional<double> replace_grains(EquivalentForm form, const GrainDepth& depth, World& world,
                                     std::vector<PartReport>& parts, std::vector<std::string>& remarks,
                                     const Progress& progress);

} // namespace scree
