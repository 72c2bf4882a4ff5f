#include "render/bench/bench_command.h"

#include "ingest/support/atomic_file.h"
#include "ingest/support/console_progress.h"
#include "ingest/support/error.h"
#include "render/bench/bench_page.h"
#include "render/bench/bench_report.h"
#include "render/bench/bench_run.h"
#include "render/interrupt.h"
#include "render/option_values.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <memory>

namespace scree {

namespace {

constexpr int interrupted_status = 130;

struct Arguments {
    std::string integrators = "auto,ept,ppt,vpt,stf", accuracy, size;
    std::vector<std::string> overrides;
    BenchJob job;
};

void take_over(Arguments& a)
{
    BenchJob& job = a.job;
    job.methods = parse_methods(a.integrators, a.accuracy);
    if (!a.size.empty()) job.scene.size = parse_picture_size(a.size);
    for (const std::string& item : a.overrides) job.scene.overrides.push_back(parse_override(item));
    job.title = job.scene.scene.stem().string();
    if (job.title == "scene" && job.scene.scene.has_parent_path()) job.title = std::filesystem::absolute(job.scene.scene).parent_path().filename().string();
}

void make_folder(const std::filesystem::path& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!std::filesystem::is_directory(folder)) throw InputError("--output", "'" + folder.string() + "' cannot be made", "a folder that can be written");
    for (const char* name : {"bench.json", "index.html"}) AtomicFile(folder / name); // can be written, before the work
}

int run(const Arguments& arguments)
{
    const BenchJob& job = arguments.job;
    make_folder(job.folder);
    ConsoleProgress console(job.quiet);
    // One bar for the whole: what single slices report is left out.
    Progress progress([&](const std::string& stage, double fraction) {
        if (stage != "rendering") console.progress().update(stage, fraction);
    });
    const InterruptGuard guard(progress);
    std::optional<tbb::global_control> threads;
    if (job.scene.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(job.scene.threads));
    try {
        const BenchResult result = run_bench(job, progress);
        console.finish();
        write_whole(job.folder / "bench.json", json_of(result));
        write_whole(job.folder / "index.html", page_of(result));
        fmt::print("{}  page: {}\n", table_of(result), (job.folder / "index.html").string());
    } catch (const Cancelled&) {
        console.finish();
        fmt::print(stderr, "scree: interrupted; nothing is written but what there is of the reference\n");
        return interrupted_status;
    }
    return 0;
}

} // namespace

void add_bench_command(CLI::App& app)
{
    auto arguments = std::make_shared<Arguments>();
    Arguments& a = *arguments;
    BenchJob& job = a.job;
    CLI::App* command = app.add_subcommand("bench", "Hold the ways to render a scene against each other: time against error");
    command->add_option("scene", job.scene.scene, "Scene file (JSON)")->required();
    command->add_option("-o,--output", job.folder, "Folder for the page, bench.json and the reference")->required();
    command->add_option("--integrators", a.integrators, "Ways to render, separated by commas: of auto, ept, ppt, vpt, stf (default: all)");
    command->add_option("--accuracy", a.accuracy, "How far auto's approximations may go: of reference, high, standard, draft; several make several methods");
    command->add_option("--time", job.seconds, "Seconds of rendering for each method, on a machine that does nothing else (default 20)")->check(CLI::Range(1e-3, 1e7));
    command->add_option("--seeds", job.seeds, "Independent pictures of each method (default 4)")->check(CLI::Range(2, 1024));
    auto* const file = command->add_option("--reference", job.reference, "Picture (EXR) to compare with, in place of rendering one");
    command->add_option("--reference-time", job.reference_seconds, "Seconds of rendering for the reference, by ept (default 60); one in the folder is gone on with")
        ->check(CLI::Range(1e-3, 1e7))->excludes(file);
    command->add_option("--size", a.size, "Size of the picture, WIDTHxHEIGHT");
    command->add_option("--frame", job.frame, "Frame of the dump, counted from 0 (default: the first)");
    command->add_option("--seed", job.scene.options.seed, "Seed of the random numbers")->check(CLI::NonNegativeNumber);
    command->add_option("-t,--threads", job.scene.threads, "Threads (default: all cores)")->check(CLI::Range(1, 4096));
    command->add_option("-D", a.overrides, "Replace a value of the scene: -D camera.fov=40");
    command->add_flag("-q,--quiet", job.quiet, "No progress");
    command->callback([arguments] {
        take_over(*arguments);
        const int status = run(*arguments);
        if (status != 0) throw CLI::RuntimeError(status);
    });
}

} // namespace scree
