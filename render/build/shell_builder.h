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

/// With the number of walks that an accuracy asks for.
StfOptions stf_options(Accuracy accuracy);

/// Distances within the media of a world from all that a ray may meet there, or null where nothing is known: no media,
/// or grains among them.
std::shared_ptr<const ClearanceField> make_clearance(const World& world, const Progress& progress);

/// Which shells media get.
struct ShellChoice {
    StfForm form = StfForm::full;
    double least = 1; ///< radius of the largest shell, in mean free paths, below which a medium gets none
    bool must_pay = false; ///< a medium of grids gets none where walks in it do not show that they save work
};

/// Gives the media of a world the shells that light may go through in them, after make_clearance(): of each no more
/// than fit.
///
/// Reports what was built, or why nothing was. Throws Cancelled.
void add_shells(const ShellChoice& choice, StfCache& cache, World& world, std::vector<PartReport>& parts,
                std::vector<std::string>& remarks, const Progress& progress);

} // namespace scree
