#include "render/app/pack_command.h"

#include "base/atomic_file.h"
#include "base/console_progress.h"
#include "base/error.h"
#include "base/text.h"
#include "ingest/particles/vdb_point_stream.h"
#include "packing/fill/list_fill.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <numbers>

namespace scree {

namespace {

struct FillArguments {
    std::filesystem::path mesh, tile, output;
    FillOptions fill;
    bool repair = false, quiet = false;
};

void run_fill(const FillArguments& a)
{
    if (lower_case(a.output.extension().string()) != ".vdb")
        throw InputError("--output", "'" + a.output.string() + "'", "a name that ends in .vdb");
    AtomicFile file(a.output); // before the work: throws if it cannot be written
    ConsoleProgress console(a.quiet);
    TriangleMesh mesh = read_mesh(a.mesh);
    std::vector<std::string> changes;
    if (a.repair) mesh = repair_mesh(mesh, changes);
    for (const std::string& change : changes) fmt::print("{}: {}\n", a.mesh.string(), change);
    const auto domain = std::make_shared<const Domain>(std::move(mesh), a.mesh.string());
    const auto tile = std::make_shared<const PackingTile>(read_tile(a.tile));
    const ProceduralFill fill(domain, tile, a.fill);

    VdbPointStream stream(file.temporary(), fill.voxel());
    uint64_t count = 0;
    double volume = 0;
    list_fill(
        fill, uint64_t{1} << 22,
        [&](const ParticleFrame& batch) {
            stream.add(batch);
            count += batch.size();
            for (const double r : batch.radius) volume += 4.0 / 3 * std::numbers::pi * r * r * r;
        },
        console.progress());
    stream.finish();
    file.commit();
    console.finish();
    if (a.quiet) return;
    fmt::print("{}: {} spheres fill {:.4f} of the mesh's volume of {:g} (the tile: {:.4f})\n", a.output.string(), count,
               volume / domain->volume(), domain->volume(), tile->fraction());
}

} // namespace

void add_pack_fill_command(CLI::App& pack)
{
    auto arguments = std::make_shared<FillArguments>();
    FillArguments& a = *arguments;
    CLI::App* command =
        pack.add_subcommand("fill", "Fill a mesh with the spheres of a tile, and write them as OpenVDB points");
    command->add_option("mesh", a.mesh, "Mesh to fill: OBJ, PLY, STL or OFF; closed, oriented, no self-intersections")
        ->required();
    command->add_option("tile", a.tile, "Periodic packing, as `scree pack tile` writes it (.vdb)")->required();
    command->add_option("-o,--output", a.output, "Points to write (.vdb)")->required();
    command->add_option("--radius", a.fill.radius, "Mean radius of the spheres, in the mesh's unit")
        ->required()
        ->check(CLI::PositiveNumber);
    command->add_option("--seed", a.fill.seed, "Chooses which variant of the tile is used in each place")
        ->check(CLI::NonNegativeNumber);
    command->add_flag("--repair", a.repair, "Repair the mesh first where it is broken, and list the changes");
    command->add_flag("-q,--quiet", a.quiet, "No progress, no summary");
    command->callback([arguments] { run_fill(*arguments); });
}

} // namespace scree
