#include "render/app/bench_command.h"

#include "base/console_progress.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "render/app/option_values.h"
#include "render/app/stress_command.h"
#include "render/bench/bench_suite.h"
#include "render/bench/bench_table.h"
#include "render/bench/bench_words.h"
#include "render/bench/suite_run.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace scree {

namespace {

constexpr int interrupted_status = 130;

struct Arguments {
    std::string integrators = "auto,ept,ppt,vpt,stf", accuracy;
    BenchJob job;
    bool suite = false;
    std::filesystem::path suite_file; ///< empty: the default one
    std::optional<double> scale; ///< of the suite's times
    std::filesystem::path readme;
};

void take_over(Arguments& a)
{
    BenchJob& job = a.job;
    if (a.suite) {
        if (!job.scene.scene.empty())
            throw InputError("scree bench", "a scene and --suite", "one of them",
                             "name the suite's file as --suite=FILE");
        if (job.folder.empty()) job.folder = "bench";
        return;
    }
    if (job.scene.scene.empty()) throw InputError("scree bench", "no scene", "a scene file, or --suite");
    if (job.folder.empty())
        throw InputError("--output", "nothing", "a folder for the page, bench.json and the reference");
    if (a.scale)
        throw InputError("--suite-scale", "one scene", "--suite: it scales the times of a suite",
                         "the times of one scene are --time and --reference-time");
    if (!a.readme.empty()) throw InputError("--readme", "one scene", "--suite: the file receives the table of a suite");
    job.methods = parse_methods(a.integrators, a.accuracy);
    job.title = job.scene.scene.stem().string();
    if (job.title == "scene" && job.scene.scene.has_parent_path())
        job.title = std::filesystem::absolute(job.scene.scene).parent_path().filename().string();
}

/// The command that repeats the run.
std::string suite_command(const Arguments& a, const std::filesystem::path& file)
{
    std::string text = "scree bench --suite=" + file.lexically_proximate(std::filesystem::current_path()).string();
    if (a.scale) text += fmt::format(" --suite-scale {:g}", *a.scale);
    if (a.job.scene.threads > 0) text += fmt::format(" -t {}", a.job.scene.threads);
    if (a.job.scene.options.seed != 0) text += fmt::format(" --seed {}", a.job.scene.options.seed);
    return text;
}

void run_work(const Arguments& a, const Progress& progress, ConsoleProgress& console)
{
    std::string text;
    if (a.suite) {
        const std::filesystem::path file = a.suite_file.empty() ? usual_suite() : a.suite_file;
        SuiteResult suite{suite_command(a, file), a.scale.value_or(1), 0, {}};
        std::vector<BenchJob> jobs = read_suite(file, suite.scale);
        for (BenchJob& job : jobs) {
            job.scene.threads = a.job.scene.threads;
            job.scene.options.seed = a.job.scene.options.seed;
        }
        run_suite(jobs, suite, a.job.folder, a.readme, progress);
        text = suite_table(suite);
    } else {
        const BenchResult result = run_and_write(a.job, progress);
        text = scene_words(result) + "\n" + machine_words(result.machine, result.processor_share()) + "\n" +
               terminal_table({result});
    }
    console.finish();
    fmt::print("{}  page: {}\n", text, (a.job.folder / "index.html").string());
}

int run(const Arguments& arguments)
{
    const BenchJob& job = arguments.job;
    ConsoleProgress console(job.quiet);
    // One progress bar for all the work: the reports of single slices are left out.
    Progress progress([&](const std::string& stage, double fraction) {
        if (stage != "rendering") console.progress().update(stage, fraction);
    });
    const InterruptGuard guard(progress);
    std::optional<tbb::global_control> threads;
    if (job.scene.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(job.scene.threads));
    try {
        run_work(arguments, progress, console);
    } catch (const Cancelled&) {
        console.finish();
        const std::filesystem::path kept = job.folder / (arguments.suite ? "details" : "reference.exr");
        const char* what = arguments.suite ? "finished scenes, and references that the next run continues, are in"
                                           : "the next run continues the reference";
        fmt::print(stderr, "scree: interrupted; pages and numbers are unchanged{}\n",
                   std::filesystem::exists(kept) ? fmt::format("; {} {}", what, kept.string()) : "");
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
    CLI::App* command = app.add_subcommand("bench", "Compare the ways to render a scene: error against time");
    command->add_option("scene", job.scene.scene, "Scene file (JSON)");
    command->add_option("-o,--output", job.folder,
                        "Folder for the page, bench.json and the reference (with --suite: bench)");
    command->add_option("--integrators", a.integrators,
                        "Ways to render, separated by commas: any of auto, ept, ppt, vpt, stf (default: all)");
    command->add_option("--accuracy", a.accuracy,
                        "With auto: how far its approximations may go: any of reference, high, standard, draft, "
                        "separated by commas; each makes its own method");
    command
        ->add_option("--time", job.seconds,
                     "Seconds of rendering for each method, on a machine that does nothing else (default 20)")
        ->check(CLI::Range(1e-3, 1e7));
    command->add_option("--seeds", job.seeds, "Independent pictures of each method (default 4)")
        ->check(CLI::Range(2, 1024));
    auto* const file =
        command->add_option("--reference", job.reference, "Picture (EXR) to compare with, instead of rendering one");
    command
        ->add_option("--reference-time", job.reference_seconds,
                     "Seconds of rendering for the reference, by ept (default 60); continues one in the folder")
        ->check(CLI::Range(1e-3, 1e7))
        ->excludes(file);
    const auto size = std::ranges::find(scene_switches(), "--size", &SceneSwitch::flag);
    add_scene_switch(*command, *size, job.scene.switches);
    command->add_option("--frame", job.frame, "Frame of the dump, counted from 0 (default: the first)");
    command->add_option("--seed", job.scene.options.seed, "Seed of the random numbers")->check(CLI::NonNegativeNumber);
    command->add_option("-t,--threads", job.scene.threads, "Threads (default: all cores)")->check(CLI::Range(1, 4096));
    add_override_option(*command, job.scene.overrides);
    CLI::Option* const suite =
        command
            ->add_option(
                "--suite", a.suite_file,
                "Run all scenes listed in this JSON file (default: examples/bench/suite.json) and print one table")
            ->expected(0, 1);
    command->add_option("--suite-scale", a.scale, "Factor of all times of the suite")->check(CLI::Range(1e-4, 1e4));
    command->add_option(
        "--readme", a.readme,
        "With --suite: also put the table into this file, between <!-- scree bench --> and <!-- /scree bench -->");
    command->add_flag("-q,--quiet", job.quiet, "No progress");
    for (const char* name : {"--integrators", "--accuracy", "--time", "--seeds", "--reference", "--reference-time",
                             "--size", "--frame", "-D"})
        suite->excludes(command->get_option(name));
    add_stress_option(*command);
    command->callback([arguments, suite] {
        arguments->suite = suite->count() > 0;
        take_over(*arguments);
        const int status = run(*arguments);
        if (status != 0) throw CLI::RuntimeError(status);
    });
}

} // namespace scree
