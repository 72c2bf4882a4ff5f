#include "render/build/medium_builder.h"

#include "base/error.h"
#include "ingest/meshes/mesh_hash.h"
#include "render/media/homogeneous_medium.h"
#include "render/media/vdb_medium.h"
#include "render/trace/region_tracer.h"

#include <fmt/format.h>

namespace scree {

namespace {

VdbMediumOptions vdb_options(const MediumDescription& medium)
{
    return {medium.density,
            medium.albedo_grid,
            medium.g_grid,
            {medium.sigma_t, medium.albedo, medium.g, medium.nearest},
            {}};
}

/// The file's name, for messages.
std::string name_of(const MediumDescription& medium)
{
    return (medium.mesh.empty() ? medium.vdb : medium.mesh).filename().string();
}

/// Coordinates are doubles of about the region's size: a distance much below 2^-53 of this size rounds to 0, and light
/// leaves too soon.
void warn_if_too_dense(const MediumDescription& medium, const Imath::Box3d& bounds, double unit,
                       std::vector<std::string>& warnings)
{
    constexpr double least = 0x1p-46; // mean free path over the region's size; at 2^-47 no error was seen yet
    const double size = bounds.size().length(), sigma_t = max_component(medium.sigma_t) * unit;
    if (!(sigma_t * size * least > 1)) return;
    warnings.push_back(fmt::format(
        "the mean free path of '{}' is {:.2g} of its size: coordinates cannot resolve such a short distance, and the "
        "medium looks too bright",
        name_of(medium), 1 / (sigma_t * size)));
}

} // namespace

void MediumBuilder::refuse_overlaps(const World& world) const
{
    // A path samples overlapping media one after the other. Two media whose sigma_t depends on the channel would not
    // account for each other.
    for (size_t i = 0; i < world.regions.size(); ++i) {
        for (size_t j = 0; j < i; ++j) {
            const MediumRegion &a = world.regions[i], &b = world.regions[j];
            const Imath::Box3d x = a.bounds(), y = b.bounds();
            bool overlap = true; // touching faces do not count
            for (int axis = 0; axis < 3; ++axis)
                overlap = overlap && x.min[axis] < y.max[axis] && y.min[axis] < x.max[axis];
            if (a.is_achromatic() || b.is_achromatic() || !overlap) continue;
            throw InputError(
                scene_.file.string() + ": /medium",
                fmt::format(
                    "the boxes of '{}' and '{}' overlap, and in both media the extinction depends on the channel",
                    a.name, b.name),
                "media whose boxes do not overlap, or one of them with the same extinction in all channels");
        }
    }
}

MediumBuilder::MediumBuilder(const SceneDescription& scene) : scene_(scene)
{
    if (scene.media.size() >= RegionTracer::most_regions) { // grains need one more region
        throw InputError(scene.file.string() + ": /medium", fmt::format("{} media", scene.media.size()),
                         fmt::format("fewer than {}", RegionTracer::most_regions));
    }
}

std::vector<V3d> MediumBuilder::read()
{
    std::vector<V3d> points;
    for (size_t i = meshes_.size(); i < scene_.media.size(); ++i) {
        const MediumDescription& medium = scene_.media[i];
        if (!medium.mesh.empty()) {
            meshes_.push_back(read_closed_mesh(medium.mesh, "as a medium is inside it"));
            continue;
        }
        const Imath::Box3d box = vdb_medium_bounds(medium.vdb, vdb_options(medium));
        meshes_.push_back(box.isEmpty() ? TriangleMesh{} : box_mesh(box.min, box.max));
    }
    for (const TriangleMesh& mesh : meshes_) points.insert(points.end(), mesh.positions.begin(), mesh.positions.end());
    return points;
}

uint64_t MediumBuilder::build(World& world, const BuildContext& context, uint64_t hash)
{
    std::vector<PartReport>& parts = context.parts;
    for (size_t i = 0; i < scene_.media.size(); ++i) {
        const MediumDescription& medium = scene_.media[i];
        const std::string part = "medium '" + name_of(medium) + "'";
        if (meshes_[i].triangles.empty()) {
            parts.push_back({part, false, "its grid is empty"});
            continue;
        }
        const Stopwatch watch;
        MediumRegion region;
        region.name = name_of(medium);
        region.triangles = meshes_[i].triangles;
        for (const V3d& p : meshes_[i].positions) region.positions.emplace_back(world.space.point(p));
        uint64_t bytes = region.triangles.size() * sizeof(region.triangles[0]) + region.positions.size() * sizeof(V3f);
        std::string what = "the same everywhere";
        if (medium.mesh.empty()) {
            if (context.precompute == Precompute::never) {
                parts.push_back({part, true, "to be read"});
                continue;
            }
            Made& made = grids_[i]; // frames of a dump mostly share one space
            if (!made.grid || made.space.origin != world.space.origin || made.space.exponent != world.space.exponent) {
                made = {std::make_shared<GridMedium>(
                            read_vdb_medium(medium.vdb, vdb_options(medium), world.space, context.progress)),
                        world.space, made.hash};
            }
            region.medium = made.grid;
            bytes += region.medium->bytes();
            what = "from grids";
            if (made.hash == 0) made.hash = hash_file(medium.vdb, 1);
            hash = mix64(hash ^ made.hash);
        } else {
            const double unit = world.space.world_length(1);
            warn_if_too_dense(medium, region.bounds(), unit, context.warnings);
            region.medium = std::make_shared<HomogeneousMedium>(
                unit * V3d(medium.sigma_t.x, medium.sigma_t.y, medium.sigma_t.z), medium.albedo, medium.g);
        }
        parts.push_back({part, true, fmt::format("{}, within {} triangles", what, region.triangles.size()),
                         watch.seconds(), bytes});
        hash = hash_mesh(meshes_[i], hash);
        world.regions.push_back(std::move(region));
    }
    refuse_overlaps(world);
    return hash;
}

} // namespace scree
