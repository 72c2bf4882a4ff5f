#include "render/app/stf_command.h"

#include "base/console_progress.h"
#include "base/drawing/figure_drawing.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/text.h"
#include "render/app/subject_options.h"
#include "render/app/table_command.h"
#include "render/build/shell_builder.h"
#include "render/build/type_builder.h"
#include "render/equivalent/grain_moments.h"
#include "render/gsdf/gsdf_cache.h"
#include "render/stf/stf_figure.h"
#include "render/stf/stf_report.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>

namespace scree {

namespace {

constexpr double largest_g = 0.999, largest_radius = 1024;
const std::string place = "scree grains stf";

struct Arguments {
    std::vector<std::string> words;
    std::vector<double> g;
    SubjectOptions subject;
    std::string accuracy = "standard";
    double radius = 256, albedo = 0.99;
    TableOutputs out{.figure = {}, .size = "1600x1600", .json = {}};
    uint64_t figure_walks = 2'000'000, figure_seed = 1;
};

/// A phase function asked for: of a grain, or Henyey and Greenstein's.
struct Subject {
    std::string name;
    std::optional<GsdfSubject> grain;
    double g = 0; ///< without a grain
    uint64_t shape_hash = 0;
};

Accuracy read_accuracy(const std::string& name)
{
    const std::optional<Accuracy> accuracy = accuracy_names.find(name);
    const std::vector<std::string> words = accuracy_names.words();
    if (!accuracy) throw InputError("--accuracy", in_quotes(name), join_words(words), did_you_mean(name, words));
    return *accuracy;
}

void check_numbers(const Arguments& a)
{
    for (const double g : a.g) {
        if (!(std::abs(g) <= largest_g))
            throw InputError("--g", fmt::format("{:g}", g),
                             fmt::format("a mean cosine from -{0:g} to {0:g}", largest_g),
                             "0.75 scatters mostly forwards, 0 equally forwards and backwards");
    }
    if (!(a.radius >= 1 && a.radius <= largest_radius)) {
        throw InputError("--radius", fmt::format("{:g}", a.radius),
                         fmt::format("mean free paths, from 1 to {:g}", largest_radius),
                         "this is the largest shell; all shells from radius 1 up to it are made");
    }
    if (!(a.albedo >= 0 && a.albedo <= 1))
        throw InputError("--albedo", fmt::format("{:g}", a.albedo), "a number from 0 to 1", "1 absorbs nothing");
}

std::vector<Subject> read_subjects(const Arguments& a)
{
    if (a.words.empty() && a.g.empty()) {
        throw InputError(place, "no phase function", "grains of the library, 'sphere', mesh files, or --g",
                         "as in: scree grains stf --g 0.75");
    }
    const SubjectOptions& o = a.subject;
    if (a.words.empty() && (o.material || o.ior || o.roughness || !o.eta.empty() || !o.k.empty())) {
        throw InputError("--material, --ior, --roughness, --eta, --k", "no grain", "a grain to apply it to",
                         "name a grain beside --g, or leave the option out");
    }
    std::vector<Subject> subjects;
    for (const GsdfSubject& grain : gsdf_subjects(a.words, o, place))
        subjects.push_back({grain.name, grain, 0, hash_shape(grain.shape)});
    for (const double g : a.g) subjects.push_back({fmt::format("g={:g}", g), std::nullopt, g, 0});
    if (!a.out.figure.empty() && subjects.size() > 1)
        throw InputError("--figure", fmt::format("{} phase functions", subjects.size()), "one per figure",
                         "run the command once for each, with a file of its own");
    return subjects;
}

class Command {
public:
    explicit Command(const Arguments& arguments)
        : a_(arguments), accuracy_(read_accuracy(a_.accuracy)), size_(read_figure_size(a_.out.size)),
          console_(a_.out.quiet)
    {
    }

    void run()
    {
        check_numbers(a_);
        const std::vector<Subject> subjects = read_subjects(a_);
        check_outputs(a_.out);

        const InterruptGuard guard(console_.progress());
        const bool table = a_.out.prints_table();
        if (table) print_line(stf_table_head(a_.albedo));
        std::vector<StfReport> reports;
        for (size_t i = 0; i < subjects.size(); ++i) {
            console_.set_prefix(progress_prefix(subjects[i].name, i, subjects.size()));
            reports.push_back(report_on(subjects[i]));
            console_.finish();
            const StfReport& report = reports.back();
            if (!report.remark.empty()) fmt::print(stderr, "scree: {}\n", report.remark);
            for (size_t shell = 0; table && shell < report.shells.size(); ++shell)
                print_line(stf_table_line(report, shell));
        }
        if (!a_.out.figure.empty()) draw(reports.front());
        write_json(a_.out, [&] { return stf_json(reports); });
    }

private:
    /// The phase function of a medium of such grains, from the grain's GSDF.
    std::shared_ptr<const PhaseTable> phase_table(const Subject& subject, StfReport& report)
    {
        const GsdfSource source{subject.shape_hash, subject.grain->material,
                                [&] { return bodies_.body(*subject.grain); }};
        const GsdfOptions options = gsdf_options(accuracy_);
        const FoundGsdf found = find_gsdf(source, options, cache_folder(), console_.progress());
        const GsdfQuality& quality = found.gsdf->data().quality;
        report.remark = found.remark;
        const std::string doubt = doubt_of(quality, options.error);
        if (!doubt.empty() && report.remark.empty())
            report.remark = fmt::format("the scattering of '{}': {}", subject.name, doubt);
        report.gsdf_error = quality.density_error;
        return std::make_shared<PhaseTable>(grain_moments(*found.gsdf).phase);
    }

    StfReport report_on(const Subject& subject)
    {
        StfReport report;
        report.name = subject.name;
        report.grain = subject.grain;
        report.albedo = a_.albedo;
        const std::shared_ptr<const PhaseTable> table = subject.grain ? phase_table(subject, report) : nullptr;
        const StfOptions options = stf_options(accuracy_);
        const auto count = static_cast<size_t>(Stf::largest(a_.radius, 64) + 1);
        const StfCache::Found found =
            StfCache(cache_folder(), options).find(subject.g, table, count, console_.progress());
        if (!found.remark.empty()) report.remark += (report.remark.empty() ? "" : "; ") + found.remark;
        report.stf = found.stf;
        report.walks = options.walks;
        for (size_t i = 0; i < count; ++i) {
            report.shells.push_back(shell_numbers(found.stf->shells[i], a_.albedo));
            const size_t kept = found.stf->shells.size() - found.computed;
            report.seconds.push_back(i < kept ? 0 : found.seconds[i - kept]);
        }
        return report;
    }

    void draw(StfReport& report)
    {
        StfReport::Figure figure{a_.out.figure, {}};
        for (size_t shell = 0; shell < report.shells.size(); shell += 2 * Stf::steps_per_octave) { // 1, 4, 16, ...
            figure.maps.push_back(map_shell(*report.stf, shell, a_.figure_walks, a_.figure_seed, console_.progress()));
        }
        console_.finish();
        const std::string title = fmt::format("{}, mean cosine {:.3f}: directions after two scatterings and more",
                                              report.name, report.stf->phase.mean_cosine());
        draw_stf_figure(figure.maps, size_.width, size_.height, title).write(a_.out.figure);
        report.figure = std::move(figure);
    }

    const Arguments& a_;
    Accuracy accuracy_;
    FigureSize size_;
    ConsoleProgress console_;
    SubjectBodies bodies_{place};
};

void add_options(CLI::App& command, Arguments& a)
{
    command.add_option("what", a.words,
                       "Grains whose phase function to use: library grains, 'all' for all of these, 'sphere', or mesh "
                       "files (.obj .ply .stl .off)");
    command.add_option("--g", a.g, "Mean cosine of a Henyey-Greenstein phase function; repeatable")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command.add_option("--radius", a.radius,
                       "Radius of the largest shell, in mean free paths, 1 to 1024 (default 256)");
    command.add_option("--albedo", a.albedo, "Albedo at which to report the shares of light, 0 to 1 (default 0.99)");
    command.add_option(
        "--accuracy", a.accuracy,
        "Accuracy of GSDFs and shells, as in the renderer: reference, high, standard (default) or draft");
    add_subject_options(command, a.subject);
    command.add_option(
        "--figure", a.out.figure,
        "Write a picture (.png, ...) of the directions in which light leaves shells of one phase function");
    command.add_option("--size", a.out.size, "Size of that picture, WIDTHxHEIGHT pixels (default 1600x1600)");
    command
        .add_option("--figure-walks", a.figure_walks,
                    "Walks of two or more scatterings, per shell of the picture (default 2000000)")
        ->check(CLI::Range(uint64_t{1000}, uint64_t{1} << 32));
    command.add_option("--figure-seed", a.figure_seed, "Seed of these walks (default 1)");
    command.add_option(
        "--json", a.out.json,
        "Write all numbers, also the picture's, to this file as JSON; - for standard output, without the table");
    add_run_options(command, a.out);
}

} // namespace

void add_stf_command(CLI::App& grains)
{
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = grains.add_subcommand(
        "stf", "Report how shells of a grain medium scatter light (shell transport functions); draw its directions");
    add_options(*command, *arguments);
    command->callback([arguments] { run_command(arguments->out.threads, [&] { Command(*arguments).run(); }); });
}

} // namespace scree
