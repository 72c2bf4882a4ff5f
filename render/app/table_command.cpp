#include "render/app/table_command.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "render/film/exr_output.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstdio>

namespace scree {

namespace {

constexpr int interrupted_status = 130;

} // namespace

void add_run_options(CLI::App& command, TableOutputs& outputs)
{
    command.add_option("-t,--threads", outputs.threads, "Threads (default: all cores)")->check(CLI::Range(1, 4096));
    command.add_flag("-q,--quiet", outputs.quiet, "Show no progress");
}

void check_outputs(const TableOutputs& outputs)
{
    if (!outputs.figure.empty()) {
        check_preview_format(outputs.figure);
        AtomicFile(outputs.figure);
    }
    if (!outputs.json.empty() && outputs.json != "-") AtomicFile(outputs.json);
}

void run_command(int threads, const std::function<void()>& work)
{
    std::optional<tbb::global_control> limit;
    if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
    try {
        work();
    } catch (const Cancelled&) {
        throw CLI::RuntimeError(interrupted_status);
    }
}

void print_line(const std::string& line)
{
    fmt::print("{}\n", line);
    std::fflush(stdout);
}

void write_json(const TableOutputs& outputs, const std::function<std::string()>& json)
{
    if (outputs.json == "-")
        fmt::print("{}", json());
    else if (!outputs.json.empty())
        write_whole(outputs.json, json());
}

std::string progress_prefix(const std::string& name, size_t i, size_t count)
{
    return count == 1 ? name : fmt::format("{} ({} of {})", name, i + 1, count);
}

std::shared_ptr<const Exemplar> SubjectBodies::body(const GsdfSubject& subject)
{
    if (!subject.shape.has_mesh()) return nullptr;
    if (!device_) device_.emplace();
    return make_exemplar(*device_, subject.shape, subject.material, place_, subject.name);
}

} // namespace scree
