#pragma once

#include "base/progress.h"
#include "ingest/meshes/triangle_mesh.h"
#include "render/build/part_report.h"
#include "render/build/type_builder.h"
#include "render/media/grid_medium.h"
#include "render/scene/scene_description.h"
#include "render/trace/world.h"

#include <algorithm>
#include <map>
#include <vector>

namespace scree {

/// Makes the media that a scene names into regions of worlds; files are read once.
class MediumBuilder {
public:
    /// Throws InputError when there are more media than a path can tell apart.
    explicit MediumBuilder(const SceneDescription& scene);

    /// Reads what has not been read, and the points that bound it, scene coordinates. Throws InputError.
    std::vector<V3d> read();
    /// Whether any medium that was read is somewhere.
    bool has_any() const { return count() > 0; }
    /// How many of those that were read are somewhere.
    size_t count() const
    {
        return static_cast<size_t>(
            std::ranges::count_if(meshes_, [](const TriangleMesh& mesh) { return !mesh.triangles.empty(); }));
    }
    /// Adds the media to `world`, whose space is set, and a report on each. Returns `hash` with their files mixed in.
    uint64_t build(World& world, const BuildContext& context, uint64_t hash);

private:
    void refuse_overlaps(const World& world) const;

    struct Made {
        std::shared_ptr<const GridMedium> grid;
        RenderSpace space; ///< that it was made for
        uint64_t hash = 0; ///< of the file
    };
    const SceneDescription& scene_;
    std::map<size_t, Made> grids_; ///< by medium
    std::vector<TriangleMesh> meshes_; ///< by medium: its surface, or the box of its grids
};

} // namespace scree
