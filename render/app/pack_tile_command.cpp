#include "render/app/pack_command.h"

#include "base/atomic_file.h"
#include "base/console_progress.h"
#include "base/error.h"
#include "base/text.h"
#include "ingest/particles/particle_series.h"
#include "packing/tiles/packing_tile.h"
#include "packing/tiles/tile_generator.h"
#include "packing/tiles/tile_sizes.h"
#include "render/app/radius_option.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace scree {

namespace {

struct TileJob {
    std::string output, fraction = "max", size = "1x1x1", radii_from, from, region;
    std::vector<std::string> sizes{"mono"}, radii;
    uint64_t spheres = 10000, seed = 0, sweeps = 0;
    std::optional<uint32_t> variants;
    int64_t frame = -1;
    int threads = 0;
    bool sweeps_given = false, quiet = false;
};

std::vector<double> parse_numbers(const std::string& flag, std::string text, char separator, size_t count,
                                  const std::string& expected)
{
    const std::string shown = in_quotes(text);
    std::ranges::replace(text, separator, ' ');
    std::vector<double> numbers;
    for (const std::string_view word : split_words(text)) {
        const auto number = to_double(word);
        if (!number || !std::isfinite(*number)) throw InputError(flag, shown, expected);
        numbers.push_back(*number);
    }
    if (numbers.size() != count) throw InputError(flag, shown, expected);
    return numbers;
}

ParticleFrame read_frame(const std::string& pattern, const TileJob& job)
{
    const OpenedParticles opened = open_particles(pattern);
    const ParticleSeries& series = *opened.series;
    for (const std::string& warning : series.warnings()) fmt::print(stderr, "scree pack tile: {}\n", warning);
    const auto count = static_cast<int64_t>(series.frame_count());
    const int64_t frame = job.frame < 0 ? count + job.frame : job.frame;
    if (frame < 0 || frame >= count)
        throw InputError("--frame", fmt::format("{}", job.frame),
                         fmt::format("a frame from 0 to {}, or from the end -1 to {}", count - 1, -count));
    return series.read(static_cast<size_t>(frame), parse_radius_options(job.radii));
}

TileOptions options_of(const TileJob& job)
{
    TileOptions options;
    const std::vector<double> size = parse_numbers("--size", job.size, 'x', 3, "AxBxC, e.g. 1x1x2");
    options.size = {size[0], size[1], size[2]};
    options.seed = job.seed;
    if (job.sweeps_given) options.sweeps = job.sweeps;
    if (job.fraction != "max") {
        options.fraction = to_double(job.fraction);
        if (!options.fraction)
            throw InputError("--fraction", in_quotes(job.fraction), "a number above 0 and below 1, or max");
    }
    // Each dense variant takes as long as a tile, because its boundary spheres are given: with 10,000 spheres, two
    // variants take 24 s and four 57 s.
    const bool dense = options.fraction.value_or(1) > 0.62 && job.from.empty();
    options.variants = job.variants.value_or(dense ? 1 : options.variants);
    return options;
}

TileSizes sizes_of(const TileJob& job)
{
    if (job.radii_from.empty()) return parse_tile_sizes(job.sizes);
    const ParticleFrame frame = read_frame(job.radii_from, job);
    TileSizes sizes;
    sizes.kind = TileSizes::Kind::sample;
    for (size_t i = 0; i < frame.size(); ++i) {
        if (!(frame.radius[i] > 0))
            throw InputError(job.radii_from, fmt::format("radius {} of particle {}", frame.radius[i], frame.id[i]),
                             "radii above 0");
        sizes.radii.push_back(frame.radius[i]);
    }
    if (sizes.radii.empty()) throw InputError(job.radii_from, "a frame without particles", "radii");
    return sizes;
}

MadeTile cut_tile(const TileJob& job, const Progress& progress)
{
    ParticleFrame frame = read_frame(job.from, job);
    if (!job.region.empty()) {
        const std::vector<double> r = parse_numbers("--region", job.region, ',', 6, "x0,x1,y0,y1,z0,z1");
        frame = cut_cuboid(frame, {r[0], r[2], r[4]}, {r[1], r[3], r[5]}, job.from);
    }
    return tile_from_frame(frame, job.from, options_of(job), progress);
}

void tell(const TileJob& job, const MadeTile& made, const std::string& what)
{
    const PackingTile& tile = made.tile;
    fmt::print("{}: {} spheres, {}, at fraction {:.6f} in a periodic cuboid of {:.6g} x {:.6g} x {:.6g}\n", job.output,
               tile.rows(), what, tile.fraction(), tile.size.x, tile.size.y, tile.size.z);
    fmt::print("  mean radius {:.6g}; {} variant{}, {} shared spheres at the faces\n", tile.mean_radius(),
               tile.variants.size(), tile.variants.size() == 1 ? "" : "s", tile.shared);
    if (!job.from.empty()) {
        if (made.largest_shift == 0)
            fmt::print("  every sphere is where the dump has it\n");
        else
            fmt::print(
                "  the dump's spheres overlapped: they were moved by {:.3g} mean radii on average, {:.3g} at most\n",
                made.mean_shift, made.largest_shift);
        fmt::print("  radii are {:.6f} of the dump's{}\n", made.radius_scale,
                   made.radius_scale < 1 - 1e-5 ? ": at the dump's radii the spheres jam" : "");
    } else if (made.jammed_fraction > 0) {
        fmt::print("  jammed; a single periodic packing jammed at fraction {:.6f}\n", made.jammed_fraction);
    }
    if (made.fluid && made.fluid_run.sweeps > 0)
        fmt::print("  hard-sphere fluid after {} sweeps: spheres moved by {:.2f} mean spacings\n",
                   made.fluid_run.sweeps,
                   made.fluid_run.displacement /
                       std::cbrt(tile.size.x * tile.size.y * tile.size.z / static_cast<double>(tile.rows())));
    double worst = -1;
    for (size_t v = 0; v < tile.variants.size(); ++v) worst = std::max(worst, largest_tile_overlap(tile, v).overlap);
    fmt::print("  {} {:.2g} of the smaller radius\n", worst > 0 ? "largest overlap" : "smallest gap", std::abs(worst));
}

void run(TileJob job)
{
    if (!job.from.empty() && !job.radii_from.empty())
        throw InputError("scree pack tile", "--from and --radii-from", "one of them",
                         "--from takes places and radii, --radii-from radii only");
    if (job.from.empty() && !job.region.empty())
        throw InputError("scree pack tile", "--region without --from", "--from DUMP --region x0,x1,y0,y1,z0,z1");
    const std::string extension = lower_case(std::filesystem::path(job.output).extension().string());
    if (extension != ".vdb")
        throw InputError(job.output, extension.empty() ? "no extension" : "extension " + extension,
                         "an output that ends in .vdb");
    std::optional<tbb::global_control> threads;
    if (job.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(job.threads));
    AtomicFile file(job.output);
    ConsoleProgress console(job.quiet);
    MadeTile made;
    std::string what;
    if (job.from.empty()) {
        const TileSizes sizes = sizes_of(job);
        const TileOptions options = options_of(job);
        what = words_of_sizes(sizes);
        made = make_tile(draw_tile_radii(sizes, job.spheres, job.seed), options, console.progress());
    } else {
        what = "cut from " + job.from;
        made = cut_tile(job, console.progress());
    }
    console.finish();
    write_tile(made.tile, file.temporary());
    // Report what readers of the file will get: files round places.
    made.tile = read_tile(file.temporary());
    file.commit();
    if (!job.quiet) tell(job, made, what);
}

} // namespace

void add_pack_tile_command(CLI::App& pack)
{
    auto job = std::make_shared<TileJob>();
    CLI::App* command = pack.add_subcommand(
        "tile", "Make a tile: a periodic packing of spheres that repeats without end, in variants that fit each other");
    command->add_option("-o,--output", job->output, "The tile, a .vdb file of points")->required();
    command->add_option("--spheres", job->spheres, "Number of spheres")
        ->check(CLI::Range(uint64_t{0}, uint64_t{10'000'000}))
        ->capture_default_str();
    command
        ->add_option("--fraction", job->fraction,
                     "Part of the volume that spheres fill, or max: pack until the spheres jam. Up to 0.52 the tile is "
                     "a hard-sphere fluid in equilibrium")
        ->capture_default_str();
    command
        ->add_option("--sizes", job->sizes,
                     "mono, bidisperse [ratio=1.4 share=0.5], lognormal [sigma=0.3], or power [exponent=3 ratio=10, or "
                     "min= max=]")
        ->expected(1, 4)
        ->capture_default_str();
    command->add_option("--radii-from", job->radii_from, "Draw the radii from those of a dump");
    command->add_option("--size", job->size, "Edges of the cuboid")->capture_default_str();
    command
        ->add_option("--variants", job->variants,
                     "Number of variants: the same spheres, alike at the faces, different inside (default 4; above "
                     "fraction 0.62, where each takes as long as a tile, 1)")
        ->check(CLI::Range(0u, 64u));
    command->add_option("--seed", job->seed, "The same seed makes the same tile")->capture_default_str();
    CLI::Option* sweeps = command->add_option("--sweeps", job->sweeps,
                                              "Number of Monte Carlo sweeps (default: as many as a fluid needs)");
    command->add_option("--from", job->from,
                        "Make the tile from the spheres in a dump's periodic box, with their places and types");
    command->add_option("--region", job->region,
                        "x0,x1,y0,y1,z0,z1: cut this cuboid out of the dump and make it periodic");
    command->add_option("--frame", job->frame, "Frame of the dump, from 0; negative numbers count from the end")
        ->capture_default_str();
    command->add_option("--radius", job->radii, "Radius if the dump has none: R for all, or TYPE=R ...")
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false);
    command->add_option("-t,--threads", job->threads, "Threads (default: all cores)")->check(CLI::Range(1, 4096));
    command->add_flag("-q,--quiet", job->quiet, "Show nothing");
    command->callback([job, sweeps] {
        job->sweeps_given = sweeps->count() > 0;
        run(*job);
    });
}

} // namespace scree
