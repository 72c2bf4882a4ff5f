#include "render/app/grains_command.h"

#include "base/error.h"
#include "base/text.h"
#include "ingest/meshes/write_mesh.h"
#include "render/grains/library/grain_library.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace scree {

namespace {

struct Arguments {
    std::string name, output;
    std::vector<std::string> settings;
    ShapeOptions shape;
};

void export_mesh(Arguments& a)
{
    const LibraryGrain& grain = require_library_grain(a.name, "scree grains export");
    check_mesh_extension(a.output);
    for (const std::string& setting : a.settings) {
        const size_t equals = setting.find('=');
        const auto value =
            equals == std::string::npos ? std::nullopt : to_double(std::string_view(setting).substr(equals + 1));
        if (!value)
            throw InputError("--set", in_quotes(setting), "name=value, e.g. rounding=0.05",
                             "scree grains list " + a.name + " lists the names");
        a.shape.parameters[setting.substr(0, equals)] = *value;
    }
    const TriangleMesh mesh = make_grain_shape(grain, a.shape, "scree grains export");
    write_mesh(a.output, mesh);
    fmt::print("{}: {}, {} triangles, {} vertices, volume {:.4g} of the bounding sphere's\n", a.output, grain.name,
               mesh.triangles.size(), mesh.positions.size(), signed_volume(mesh) / (4.0 / 3.0 * 3.14159265358979));
}

} // namespace

void add_grains_export_command(CLI::App& grains)
{
    auto arguments = std::make_shared<Arguments>();
    Arguments& a = *arguments;
    CLI::App* command = grains.add_subcommand("export", "Write the mesh of a grain type, scaled into the unit sphere");
    command->add_option("name", a.name, "Grain type")->required();
    command->add_option("-o,--output", a.output, "Mesh to write: .obj, .ply, .stl or .off")->required();
    command->add_option("--triangles", a.shape.triangles, "About how many triangles (default: the type's)")
        ->check(CLI::Range(least_shape_triangles, most_shape_triangles));
    command->add_option("--seed", a.shape.seed, "Seed of the individual shape")->check(CLI::NonNegativeNumber);
    command->add_option("--set", a.settings, "A parameter of the shape, name=value; repeatable")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->callback([arguments] { export_mesh(*arguments); });
}

} // namespace scree
