#include "render/app/stress_command.h"

#include "base/atomic_file.h"
#include "base/console_progress.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "render/stress/stress.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <fstream>
#include <memory>
#include <optional>

namespace scree {

namespace {

constexpr int interrupted_status = 130;

struct Arguments {
    bool wanted = false;
    StressOptions options;
    std::string json;
};

void write_json(const std::string& path, const StressReport& report)
{
    AtomicFile file(path);
    std::ofstream out(file.temporary());
    out << stress_json(report).dump(1) << "\n";
    out.close();
    if (!out)
        throw InputError(path, "a disk that is full or cannot be written", "room for the results of the stress test");
    file.commit();
}

int run(const Arguments& arguments, bool quiet)
{
    if (!arguments.json.empty()) AtomicFile(arguments.json); // throws before the work if it cannot be written
    ConsoleProgress console(quiet);
    const InterruptGuard guard(console.progress());
    StressReport report;
    try {
        report = run_stress(arguments.options, console.progress());
    } catch (const Cancelled&) {
        return interrupted_status;
    }
    console.finish();
    fmt::print("{}", stress_text(report));
    if (!arguments.json.empty()) write_json(arguments.json, report);
    return report.passed() ? 0 : 1;
}

} // namespace

void add_stress_option(CLI::App& bench)
{
    auto arguments = std::make_shared<Arguments>();
    Arguments& a = *arguments;
    CLI::Option* stress = bench.add_flag("--stress", a.wanted,
                                         "Stress-test the numerics with built-in scenes: scale, place, turn, "
                                         "sizes, materials, media, packings, long paths");
    bench.add_flag("--quick", a.options.quick, "With --stress: only some of the cases, in under a minute")
        ->needs(stress);
    bench
        .add_option("--only", a.options.only,
                    "With --stress: only cases with this text in their own or their family's name")
        ->needs(stress);
    bench.add_option("--stress-json", a.json, "With --stress: also write the results to this file")->needs(stress);
    bench.parse_complete_callback([arguments, app = &bench] {
        if (!arguments->wanted) return;
        const CLI::Option* quiet = app->get_option_no_throw("--quiet");
        const CLI::Option* threads = app->get_option_no_throw("--threads");
        std::optional<tbb::global_control> limit;
        if (threads && *threads)
            limit.emplace(tbb::global_control::max_allowed_parallelism,
                          static_cast<size_t>(std::max(1, threads->as<int>())));
        throw CLI::RuntimeError(run(*arguments, quiet && *quiet));
    });
}

} // namespace scree
