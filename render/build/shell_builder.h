#pragma once

#include "render/build/part_report.h"
#include "render/scene/scene_description.h"
#include "render/stf/stf_cache.h"
#include "render/stf/stf_form.h"
#include "render/trace/world.h"

#include <memory>
#include <string>
#include <vector>

namespace scree {

/// STF options with the number of walks of an accuracy.
StfOptions stf_options(Accuracy accuracy);

/// Distances from points inside a world's media to everything that a ray can hit there. Null if there are no media, or
/// if grains or a sphere light may lie inside a medium. Throws Cancelled.
std::shared_ptr<const ClearanceField> make_clearance(const World& world, const Progress& progress);

/// Which shells media get.
struct ShellChoice {
    StfForm form = StfForm::full;
    double least = 1; ///< radius of the largest shell, in mean free paths, below which a medium gets none
    bool must_pay = false; ///< a medium of grids gets shells only if trial walks show that shells save work
};

/// Gives the media of a world their shells, up to the largest that fits; needs the clearance of make_clearance().
///
/// Reports what was built, or why nothing was. Throws Cancelled.
void add_shells(const ShellChoice& choice, StfCache& cache, World& world, std::vector<PartReport>& parts,
                std::vector<std::string>& remarks, const Progress& progress);

} // namespace scree
