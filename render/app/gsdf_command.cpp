#include "render/app/gsdf_command.h"

#include "base/console_progress.h"
#include "base/drawing/figure_drawing.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "render/app/subject_options.h"
#include "render/app/table_command.h"
#include "render/build/part_report.h"
#include "render/gsdf/error_figure.h"
#include "render/gsdf/gsdf_report.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>

namespace scree {

namespace {

const std::string place = "scree grains gsdf";

struct Arguments {
    std::vector<std::string> words;
    SubjectOptions subject;
    GsdfOptions gsdf{.error = 0.03}; // the renderer's at standard accuracy
    bool again = false;
    TableOutputs out{.figure = {}, .size = "1600x1130", .json = {}};
    uint64_t figure_paths = 12'000'000;
};

class Command {
public:
    explicit Command(const Arguments& arguments)
        : a_(arguments), size_(read_figure_size(a_.out.size)), console_(a_.out.quiet)
    {
    }

    void run()
    {
        const std::vector<GsdfSubject> subjects = gsdf_subjects(a_.words, a_.subject, place);
        if (!a_.out.figure.empty() && subjects.size() > 1)
            throw InputError("--figure", fmt::format("{} grains", subjects.size()), "one grain per figure");
        check_outputs(a_.out);
        std::vector<uint64_t> hashes; // of the shapes; reading them first reports a missing file before the work
        for (const GsdfSubject& subject : subjects) hashes.push_back(hash_shape(subject.shape));

        const InterruptGuard guard(console_.progress());
        const bool table = a_.out.prints_table();
        if (table) print_line(gsdf_table_head());
        std::vector<GsdfReport> reports;
        for (size_t i = 0; i < subjects.size(); ++i) {
            console_.set_prefix(progress_prefix(subjects[i].name, i, subjects.size()));
            reports.push_back(report_on(subjects[i], hashes[i]));
            console_.finish();
            if (!reports.back().found.remark.empty()) fmt::print(stderr, "scree: {}\n", reports.back().found.remark);
            if (table) print_line(gsdf_table_line(reports.back()));
        }
        if (!a_.out.figure.empty()) draw(reports.front(), table);
        write_json(a_.out, [&] { return gsdf_json(reports); });
    }

private:
    GsdfReport report_on(const GsdfSubject& subject, uint64_t hash)
    {
        const Stopwatch watch;
        const GsdfSource source{hash, subject.material, [&] { return bodies_.body(subject); }};
        const auto work = a_.again ? make_gsdf : find_gsdf;
        GsdfReport report{subject, work(source, a_.gsdf, cache_folder(), console_.progress()), 0, a_.gsdf.error, {}};
        report.seconds = watch.seconds();
        const std::string doubt = doubt_of(report.found.gsdf->data().quality, a_.gsdf.error);
        if (!doubt.empty() && report.found.remark.empty())
            report.found.remark = fmt::format("the scattering of '{}': {}", subject.name, doubt);
        return report;
    }

    void draw(GsdfReport& report, bool table)
    {
        const std::shared_ptr<const Exemplar> shape = bodies_.body(report.subject);
        const BruteForceMaps truth = brute_force_maps({shape.get(), report.subject.material}, a_.figure_paths,
                                                      a_.gsdf.seed, console_.progress());
        console_.finish();
        const ScatteringMap map = map_of_gsdf(*report.found.gsdf);
        report.figure = {a_.out.figure, truth.paths, map_errors(map, truth)};
        const std::vector<std::string> lines = form_table(report.figure->errors, report.subject.name);
        const std::string title = fmt::format("{}: error of the GSDF against {:.2g} paths traced through the grain",
                                              report.subject.name, static_cast<double>(truth.paths) * 2 / 3);
        draw_error_figure(map, truth.both, size_.width, size_.height, title, lines).write(a_.out.figure);
        if (!table) return;
        print_line("");
        for (const std::string& line : lines) print_line(line);
    }

    const Arguments& a_;
    FigureSize size_;
    ConsoleProgress console_;
    SubjectBodies bodies_{place};
};

void add_options(CLI::App& command, Arguments& a)
{
    command
        .add_option("what", a.words,
                    "Library grains, 'all' for all of these, 'sphere', or mesh files (.obj .ply .stl .off)")
        ->required();
    add_subject_options(command, a.subject);
    command
        .add_option("--error", a.gsdf.error,
                    "Wanted mean relative error of the directional density (default 0.03; the renderer asks for "
                    "0.005, 0.01, 0.03, 0.08 at accuracy reference, high, standard, draft)")
        ->check(number_in(1e-4, 1));
    command.add_flag("--force", a.again, "Trace again even if the result is in the cache");
    command.add_option(
        "--figure", a.out.figure,
        "Write a picture (.png, ...) of the error maps of one grain, and print the errors of simpler forms");
    command.add_option("--size", a.out.size, "Size of that picture, WIDTHxHEIGHT pixels (default 1600x1130)");
    command
        .add_option("--figure-paths", a.figure_paths,
                    "Paths traced through the grain, to compare the GSDF with (default 12000000)")
        ->check(CLI::Range(uint64_t{10'000}, uint64_t{1} << 36));
    command.add_option("--json", a.out.json,
                       "Write all numbers to this file as JSON; - for standard output, without the table");
    add_run_options(command, a.out);
}

} // namespace

void add_gsdf_command(CLI::App& grains)
{
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        grains.add_subcommand("gsdf", "Find the scattering (GSDF) of grains in the cache or trace it; draw its errors");
    add_options(*command, *arguments);
    command->callback([arguments] { run_command(arguments->out.threads, [&] { Command(*arguments).run(); }); });
}

} // namespace scree
