#include "render/app/info_command.h"

#include "base/text.h"
#include "ingest/info_report.h"
#include "render/app/radius_option.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

namespace scree {

namespace {

struct InfoOptions {
    std::vector<std::string> files, radii;
    bool as_json = false;
    size_t frame = 0;
};

nlohmann::json describe(const std::string& file, const InfoOptions& options, const ParticleReadOptions& reading)
{
    static constexpr std::array<std::string_view, 4> meshes{".obj", ".ply", ".stl", ".off"};
    const std::string extension = lower_case(std::filesystem::path(file).extension().string());
    if (std::ranges::find(meshes, extension) != meshes.end()) return describe_mesh(file);
    return describe_particles(file, options.frame, reading);
}

void run(InfoOptions options)
{
    take_radii_from_files(options.files, options.radii);
    const ParticleReadOptions reading = parse_radius_options(options.radii);
    for (const std::string& file : options.files) {
        const nlohmann::json description = describe(file, options, reading);
        // Each object takes one line, so that line-based tools can read the output for several files.
        if (options.as_json)
            fmt::print("{}\n", description.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
        else
            fmt::print("{}", text_of_description(description));
    }
}

} // namespace

void add_info_command(CLI::App& app)
{
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command = app.add_subcommand("info", "Describe a particle dump, a file of points or a mesh");
    command
        ->add_option(
            "FILE", options->files,
            "Dumps (also patterns: 'pour.*.dump.gz', pour.%04d.dump), .vdb points, and meshes (.obj .ply .stl .off)")
        ->required();
    command->add_flag("--json", options->as_json, "One JSON object for each file, on a line of its own");
    command->add_option("--frame", options->frame, "The frame to measure, from 0")->capture_default_str();
    command->add_option("--radius", options->radii, "Radius if the dump has none: R for all grains, or TYPE=R ...")
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false);
    command->callback([options] { run(*options); });
}

} // namespace scree
