#include "render/build/fill_builder.h"

#include "mixtures/make_mixture.h"

#include <fmt/format.h>

namespace scree {

namespace {

std::shared_ptr<const Domain> read_domain(const AssemblyDescription::Fill& description, BuiltFill& built)
{
    const Stopwatch watch;
    TriangleMesh mesh = read_mesh(description.mesh);
    if (description.repair) mesh = repair_mesh(mesh, built.remarks);
    auto domain = std::make_shared<Domain>(std::move(mesh), description.mesh.string());
    const TriangleMesh& used = domain->mesh();
    built.parts.push_back(
        {"domain", true,
         fmt::format("{}: {} triangles, checked", description.mesh.filename().string(), used.triangles.size()),
         watch.seconds(),
         used.positions.size() * sizeof(used.positions[0]) + used.triangles.size() * sizeof(used.triangles[0])});
    return domain;
}

/// One tile for the mixture: its rows, with their radii in the scene.
ParticleFrame tile_frame(const ProceduralFill& fill)
{
    ParticleFrame frame;
    const PackingTile& tile = fill.tile();
    for (uint64_t row = 0; row < tile.rows(); ++row) {
        frame.id.push_back(row);
        frame.radius.push_back(fill.radius(row));
    }
    frame.position = tile.variants[0];
    frame.type = tile.type;
    frame.origin = fill.origin();
    return frame;
}

} // namespace

BuiltFill build_fill(const SceneDescription& scene)
{
    BuiltFill built;
    const AssemblyDescription::Fill& description = *scene.assembly->fill;
    const auto domain = read_domain(description, built);
    const Stopwatch tile_watch;
    const auto tile = std::make_shared<PackingTile>(read_tile(description.tile));
    built.parts.push_back(
        {"tile", true,
         fmt::format("{}: {} spheres, {} variants", description.tile.filename().string(), tile->rows(),
                     tile->variants.size()),
         tile_watch.seconds(),
         tile->rows() * (tile->variants.size() * sizeof(Imath::V3d) + sizeof(float) + sizeof(int32_t))});
    const Stopwatch fill_watch;
    auto fill = std::make_shared<ProceduralFill>(domain, tile, FillOptions{description.radius, description.seed});
    built.parts.push_back({"fill", true,
                           fmt::format("about {:.3g} spheres of mean radius {:g}, none listed; distance field",
                                       fill->expected_count(), description.radius),
                           fill_watch.seconds(), fill->bytes()});
    std::vector<std::string> names;
    for (const GrainTypeDescription& type : scene.types) names.push_back(type.name);
    const ParticleFrame frame = tile_frame(*fill);
    built.mixture =
        make_mixture(scene.mixture, {names, scene.assembly->types, &frame, true, scene.assembly->place + "/types"});
    built.fill = std::move(fill);
    return built;
}

} // namespace scree
