#include "render/app/pack_command.h"

#include "base/atomic_file.h"
#include "base/console_progress.h"
#include "base/error.h"
#include "base/text.h"
#include "ingest/particles/particle_series.h"
#include "ingest/particles/vdb_points.h"
#include "packing/report/packing_report.h"
#include "packing/report/report_page.h"
#include "packing/solids/distance_field.h"
#include "packing/solids/domain.h"
#include "packing/solids/interior_sampler.h"
#include "render/app/radius_option.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

namespace scree {

namespace {

struct ReportArguments {
    std::vector<std::string> packing, radii, outputs;
    std::string mesh, json;
    int64_t frame = -1;
    bool repair = false, quiet = false;
};

/// A file for the report, opened for writing before the work begins.
struct Output {
    std::filesystem::path path;
    bool as_json = false;
    std::unique_ptr<AtomicFile> file;
};

std::vector<Output> open_outputs(const ReportArguments& a)
{
    std::vector<Output> outputs;
    for (const std::string& name : a.outputs) {
        const std::string extension = lower_case(std::filesystem::path(name).extension().string());
        if (extension != ".html" && extension != ".json")
            throw InputError("--output", in_quotes(name), "a name that ends in .html or .json");
        outputs.push_back({name, extension == ".json", nullptr});
    }
    if (!a.json.empty()) outputs.push_back({a.json, true, nullptr});
    for (Output& output : outputs) output.file = std::make_unique<AtomicFile>(output.path);
    return outputs;
}

void write_output(const Output& output, const std::string& text)
{
    std::ofstream stream(output.file->temporary(), std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) throw InputError(output.path.string(), "a write that failed", "room for the report");
}

ParticleFrame read_points(const std::string& file, PackingSource& source)
{
    const std::vector<std::string> grids = list_vdb_points(file);
    const auto variants =
        std::ranges::count_if(grids, [](const std::string& name) { return name.starts_with("variant_"); });
    ParticleFrame frame = read_vdb_points(file);
    source.facts.emplace_back("format", "OpenVDB points");
    if (variants > 0)
        source.notes.push_back(
            fmt::format("a tile of {} variants: the report is on variant 0, and ids are rows", variants + 1));
    const bool periodic = frame.box && std::ranges::count(frame.box->periodic, true) == 3;
    source.hard = periodic;
    return frame;
}

ParticleFrame read_dump(const ReportArguments& a, PackingSource& source, const Progress& progress)
{
    const OpenedParticles opened = open_particles(a.packing[0], progress);
    const ParticleSeries& series = *opened.series;
    const int64_t count = static_cast<int64_t>(series.frame_count()), wanted = a.frame < 0 ? count + a.frame : a.frame;
    if (wanted < 0 || wanted >= count)
        throw InputError("--frame", fmt::format("{}", a.frame),
                         fmt::format("-{}..{}: {} has {} frames", count, count - 1, a.packing[0], count));
    const size_t frame = static_cast<size_t>(wanted);
    for (const std::string& warning : series.warnings()) source.notes.push_back(warning);
    ParticleFrame particles = series.read(frame, parse_radius_options(a.radii), progress);
    source.facts.emplace_back("format", opened.format->title);
    source.facts.emplace_back("frame", fmt::format("{} of {}, step {}", frame, count, particles.step));
    if (particles.time) source.facts.emplace_back("time", fmt::format("{:g}", *particles.time));
    if (!particles.units.empty()) source.facts.emplace_back("units", particles.units);
    return particles;
}

/// The mesh, with what answers questions about it.
struct Solid {
    std::unique_ptr<Domain> domain;
    std::unique_ptr<InteriorSampler> sampler;
    std::unique_ptr<DistanceField> field;
};

Solid read_solid(const ReportArguments& a, const ParticleFrame& frame, PackingSource& source, const Progress& progress)
{
    progress.update("mesh", 0);
    TriangleMesh mesh = read_mesh(a.mesh);
    std::vector<std::string> changes;
    if (a.repair) mesh = repair_mesh(mesh, changes);
    for (const std::string& change : changes) source.notes.push_back("the mesh was repaired: " + change);
    Solid solid;
    solid.domain = std::make_unique<Domain>(std::move(mesh), a.mesh);
    solid.sampler = std::make_unique<InteriorSampler>(*solid.domain);
    // Voxels of half a radius decide most questions about spheres.
    double radius = 0;
    for (const float r : frame.radius) radius += double(r) / double(frame.size());
    const Imath::V3d size = solid.domain->bounds().size();
    const double cells = radius > 0 ? std::clamp(2 * std::max({size.x, size.y, size.z}) / radius, 64.0, 512.0) : 64;
    solid.field = std::make_unique<DistanceField>(*solid.domain, static_cast<int>(cells));
    progress.update("mesh", 1);
    source.mesh = a.mesh;
    source.facts.emplace_back("mesh volume",
                              fmt::format("{:.9g} by {}; {:.9g} by the divergence theorem", solid.sampler->volume(),
                                          solid.sampler->method(), solid.domain->volume()));
    return solid;
}

void run_report(ReportArguments a)
{
    take_radii_from_files(a.packing, a.radii);
    if (a.packing.size() != 1)
        throw InputError("scree pack report", fmt::format("{} names", a.packing.size()), "one packing",
                         "quote patterns, so that the shell does not expand them; --frame chooses the frame");
    const std::vector<Output> outputs = open_outputs(a);
    ConsoleProgress console(a.quiet);
    const Progress& progress = console.progress();
    PackingSource source;
    source.file = a.packing[0];
    const bool points = std::filesystem::is_regular_file(a.packing[0]) &&
                        std::string_view(format_of(a.packing[0]).name) == "vdb"; // it may be a tile
    const ParticleFrame frame = points ? read_points(a.packing[0], source) : read_dump(a, source, progress);
    Solid solid;
    MeshContainer container;
    if (!a.mesh.empty()) {
        solid = read_solid(a, frame, source, progress);
        container = {solid.domain.get(), solid.sampler.get(), solid.field.get()};
        if (frame.box && std::ranges::count(frame.box->periodic, true) > 0)
            source.notes.push_back("the mesh bounds the packing: periodic images are left out");
        source.hard = points;
    }
    const PackedSpheres spheres(frame, a.packing[0], container, progress);
    const PackingReport report = make_packing_report(spheres, std::move(source), progress);
    for (const Output& output : outputs)
        write_output(output, output.as_json
                                 ? json_of(report).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"
                                 : html_of(report));
    for (const Output& output : outputs) output.file->commit();
    console.finish();
    if (a.quiet) return;
    for (const Claim& claim : report.claims)
        fmt::print("{}  {:<13}  {}\n", word_of(claim.verdict), claim.key, claim.text);
    for (const std::string& note : report.source.notes) fmt::print("note: {}\n", note);
}

} // namespace

void add_pack_report_command(CLI::App& pack)
{
    auto arguments = std::make_shared<ReportArguments>();
    ReportArguments& a = *arguments;
    CLI::App* command = pack.add_subcommand(
        "report",
        "Measure a packing and compare it with theory: fraction, overlaps, containment, g(r), contacts, chords, order");
    command->add_option("PACKING", a.packing, "A LAMMPS dump, .vdb points, or a tile")->required();
    command->add_option("--mesh", a.mesh, "The solid that the packing fills: OBJ, PLY, STL or OFF");
    command->add_flag("--repair", a.repair, "Repair the mesh first where it is broken, and list the changes");
    command
        ->add_option("-o,--output", a.outputs,
                     "The report: .html (one page with plots) or .json (all numbers); may be given more than once")
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false);
    command->add_option("--json", a.json, "Also write the numbers as JSON to this file, whatever its extension");
    command->add_option("--frame", a.frame, "Frame of a dump, from 0; negative numbers count from the end")
        ->capture_default_str();
    command->add_option("--radius", a.radii, "Radius if the dump has none: R for all, or TYPE=R ...")
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false);
    command->add_flag("-q,--quiet", a.quiet, "No progress, no summary");
    command->callback([arguments] { run_report(*arguments); });
}

} // namespace scree
