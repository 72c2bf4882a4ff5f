#pragma once

#include <map>
#include <string>
#include <vector>

namespace scree::test {

using Arguments = std::vector<std::string>;

/// A line that `scree render` prints for a scene: of the plan if the arguments contain `--plan`, else of the
/// statistics.
struct PlanRow {
    std::string name, scene;
    Arguments arguments;
    std::string part;
    bool built;
    std::string reason; ///< a substring of the reason
};

/// Scenes by name: their keys except camera and film. They name cube.obj, floor.obj, slab.obj, ball.obj, tile.vdb,
/// cloud.vdb, empty.vdb, sky.exr.
std::map<std::string, std::string> plan_scenes();

/// At least one row for every possible line. The order matters: later scenes find in the cache what earlier ones
/// traced.
std::vector<PlanRow> plan_rows();

/// The arguments of a, then those of b.
Arguments with(Arguments a, const Arguments& b);

// Ways to render.
inline const Arguments plan_only{"--plan"}, ept{"--integrator", "ept"},
    ppt{"--integrator", "ppt", "--accuracy", "draft"}, vpt{"--integrator", "vpt", "--accuracy", "draft"},
    stf{"--integrator", "stf", "--accuracy", "draft"}, draft{"--accuracy", "draft"},
    formula{"--medium-form", "formula"}, diffusion{"--stf-form", "diffusion"};

} // namespace scree::test
