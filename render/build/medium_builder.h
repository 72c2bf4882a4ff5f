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

/// Adds the media that a scene names to worlds, as regions; reads each file once.
class MediumBuilder {
public:
    /// Throws InputError for RegionTracer::most_regions or more media (grains need one region).
    explicit MediumBuilder(const SceneDescription& scene);

    /// Reads media not read so far; returns points that bound all media, in scene coordinates. Throws InputError.
    std::vector<V3d> read();
    /// Whether any medium that was read is not empty.
    bool has_any() const { return count() > 0; }
    /// Number of media that were read and are not empty.
    size_t count() const
    {
        return static_cast<size_t>(
            std::ranges::count_if(meshes_, [](const TriangleMesh& mesh) { return !mesh.triangles.empty(); }));
    }
    /// Adds the media to `world`, whose space is set, and a report on each. Returns `hash` combined with their files.
    uint64_t build(World& world, const BuildContext& context, uint64_t hash);

private:
    void refuse_overlaps(const World& world) const;

    struct Made {
        std::shared_ptr<const GridMedium> grid;
        RenderSpace space; ///< that the grid was made for
        uint64_t hash = 0; ///< of the file
    };
    const SceneDescription& scene_;
    std::map<size_t, Made> grids_; ///< by medium
    std::vector<TriangleMesh> meshes_; ///< by medium: its surface, or the box around its grids
};

} // namespace scree
