#include "render/scene/medium_builder.h"

#include "ingest/support/error.h"
#include "render/scene/content_hash.h"
#include "render/scene/region_tracer.h"

#include <fmt/format.h>

namespace scree {

MediumBuilder::MediumBuilder(const SceneDescription& scene) : scene_(scene)
{
    if (scene.media.size() >= RegionTracer::most_regions) { // one is left for grains
        throw InputError(scene.file.string() + ": /medium", fmt::format("{} media", scene.media.size()), fmt::format("fewer than {}", RegionTracer::most_regions));
    }
}

std::vector<V3d> MediumBuilder::read()
{
    std::vector<V3d> points;
    for (size_t i = meshes_.size(); i < scene_.media.size(); ++i) meshes_.push_back(read_closed_mesh(scene_.media[i].mesh, "as a medium is inside it"));
    for (const TriangleMesh& mesh : meshes_) points.insert(points.end(), mesh.positions.begin(), mesh.positions.end());
    return points;
}

uint64_t MediumBuilder::build(World& world, std::vector<PartReport>& parts, uint64_t hash) const
{
    for (size_t i = 0; i < scene_.media.size(); ++i) {
        const MediumDescription& medium = scene_.media[i];
        const Stopwatch watch;
        MediumRegion region;
        region.name = medium.mesh.filename().string();
        region.triangles = meshes_[i].triangles;
        for (const V3d& p : meshes_[i].positions) region.positions.emplace_back(world.space.point(p));
        const double unit = world.space.world_length(1);
        region.homogeneous = std::make_shared<HomogeneousMedium>(unit * V3d(medium.sigma_t.x, medium.sigma_t.y, medium.sigma_t.z), medium.albedo, medium.g);
        const uint64_t bytes = region.triangles.size() * sizeof(region.triangles[0]) + region.positions.size() * sizeof(V3f);
        parts.push_back({"medium '" + region.name + "'", true, fmt::format("the same everywhere within {} triangles", region.triangles.size()), watch.seconds(), bytes});
        hash = hash_mesh(meshes_[i], hash);
        world.regions.push_back(std::move(region));
    }
    return hash;
}

} // namespace scree
