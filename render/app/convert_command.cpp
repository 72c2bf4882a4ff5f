#include "render/app/convert_command.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "ingest/particles/csv_points.h"
#include "ingest/particles/particle_series.h"
#include "ingest/particles/vdb_points.h"
#include "render/app/radius_option.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>

namespace scree {

namespace {

struct ConvertOptions {
    std::vector<std::string> files, radii;
    size_t frame = 0;
};

void run(ConvertOptions options)
{
    take_radii_from_files(options.files, options.radii);
    if (options.files.size() != 2)
        throw InputError("scree convert", fmt::format("{} names", options.files.size()), "IN and OUT",
                         options.files.size() > 2 ? "quote patterns from the shell; --frame chooses the frame" : "");
    const std::filesystem::path out = options.files[1];
    const std::string extension = lower_case(out.extension().string());
    if (extension != ".csv" && extension != ".vdb")
        throw InputError(out.string(), extension.empty() ? "no extension" : "extension " + extension,
                         "an output that ends in .csv or .vdb");
    AtomicFile file(out);

    const OpenedParticles opened = open_particles(options.files[0]);
    const ParticleFrame frame = opened.series->read(options.frame, parse_radius_options(options.radii));
    if (extension == ".csv")
        write_csv_points(frame, file.temporary());
    else
        write_vdb_points(frame, file.temporary());
    file.commit();
    for (const std::string& warning : opened.series->warnings()) fmt::print(stderr, "scree convert: {}\n", warning);
    fmt::print("{}: {} particles of step {}\n", out.string(), frame.size(), frame.step);
}

} // namespace

void add_convert_command(CLI::App& app)
{
    auto options = std::make_shared<ConvertOptions>();
    CLI::App* command = app.add_subcommand("convert", "Write one frame of a dump as .csv or as .vdb points");
    command->add_option("FILE", options->files, "IN: a dump or a pattern of dumps; OUT: a .csv or .vdb file")
        ->required();
    command->add_option("--frame", options->frame, "The frame to convert, from 0")->capture_default_str();
    command->add_option("--radius", options->radii, "Radius where the dump has none: R for all, or TYPE=R ...")
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false);
    command->callback([options] { run(*options); });
}

} // namespace scree
