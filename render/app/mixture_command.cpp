#include "render/app/mixture_command.h"

#include "base/error.h"
#include "base/text.h"
#include "mixtures/describe_mixture.h"
#include "mixtures/pattern_statistics.h"
#include "mixtures/read_mixture.h"
#include "mixtures/slice_picture.h"
#include "render/app/mixture_inputs.h"
#include "render/app/radius_option.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace scree {

namespace {

struct PreviewOptions {
    std::vector<std::string> files, radii;
    std::string output, at;
    int64_t frame = -1;
    int width = 1200;
    bool statistics = false;
};

void show(const std::string& file)
{
    const MixtureDescription mixture = read_mixture_file(file);
    fmt::print("{}", words_of_mixture(mixture));
    const auto fractions = expected_fractions(mixture);
    if (!fractions) {
        fmt::print("fractions depend on the spheres; to measure them: scree mixture preview {} DUMP --stat\n", file);
        return;
    }
    fmt::print("expected fractions\n");
    size_t width = 0;
    for (const auto& [type, fraction] : *fractions) width = std::max(width, type.size());
    for (const auto& [type, fraction] : *fractions) fmt::print("  {:{}}  {:.3f} %\n", type, width, 100 * fraction);
}

std::string interval(const FractionEstimate& f)
{
    return fmt::format("{:7.3f} % ({:.3f} .. {:.3f})", 100 * f.value, 100 * f.low, 100 * f.high);
}

void print_statistics(const TypedFrame& typed)
{
    const PatternStatistics s = pattern_statistics(typed.frame, typed.types, typed.names.size());
    fmt::print("{}: {} spheres; 95 % intervals by the jackknife over boxes of space\n", typed.title, s.spheres);
    size_t width = 4;
    for (const std::string& name : typed.names) width = std::max(width, name.size());
    fmt::print("{:{}}  {:>10}  {:<30}  {}\n", "type", width, "spheres", "by number", "by volume");
    for (size_t k = 0; k < s.types.size(); ++k) {
        const auto& type = s.types[k];
        const std::string number = interval(type.by_number), volume = interval(type.by_volume);
        fmt::print("{:{}}  {:>10}  {:<30}  {}\n", typed.names[k], width, type.count, number, volume);
    }
    if (s.correlation.empty()) {
        fmt::print("correlation length: not measurable\n");
        return;
    }
    if (s.correlation_length == 0) {
        const auto& first = s.correlation[0];
        fmt::print("correlation length: none; neighbours ({:.4g} apart) have a correlation of {:.3f} +- {:.3f}\n",
                   first.distance, first.value, 1.96 * first.standard_error);
    } else if (std::isinf(s.correlation_length)) {
        fmt::print("correlation length: beyond {:.4g}, half of the spheres' extent\n", s.correlation.back().distance);
    } else {
        fmt::print("correlation length: {:.4g} (to 1/e), {:.2g} mean spacings\n", s.correlation_length,
                   s.correlation_length / s.mean_spacing);
    }
}

Imath::V3d parse_place(const std::string& text)
{
    std::string spaced = text;
    std::ranges::replace(spaced, ',', ' ');
    const auto words = split_words(spaced);
    Imath::V3d place(0);
    for (size_t a = 0; a < 3; ++a) {
        const auto number = words.size() == 3 ? to_double(words[a]) : std::nullopt;
        if (!number || !std::isfinite(*number)) throw InputError("--at", in_quotes(text), "x,y,z");
        place[static_cast<int>(a)] = *number;
    }
    return place;
}

void preview(PreviewOptions options)
{
    take_radii_from_files(options.files, options.radii);
    if (options.files.size() > 2)
        throw InputError("scree mixture preview", fmt::format("{} names", options.files.size()), "MIXTURE and DUMP",
                         "put patterns in quotes, so that the shell does not expand them; --frame chooses the frame");
    const std::string& file = options.files[0];
    std::optional<SceneGrains> scene;
    if (is_scene(file)) scene = read_scene_grains(file);
    const std::string dump = options.files.size() > 1 ? options.files[1] : scene ? scene->dump : "";
    if (dump.empty()) throw InputError("scree mixture preview", "no dump", "MIXTURE and DUMP, or a scene that has one");
    const std::vector<std::string> any;
    const MixtureDescription mixture = read_mixture_file(file, scene ? scene->types : any);
    const ParticleReadOptions reading =
        options.radii.empty() && scene ? scene->reading : parse_radius_options(options.radii);
    SliceOptions slices;
    if (!options.at.empty()) slices.at = parse_place(options.at);
    slices.width = options.width;

    const TypedFrame typed = evaluate_mixture(mixture, scene, dump, reading, options.frame);
    if (options.statistics) print_statistics(typed);
    if (options.output.empty() && options.statistics) return;
    const std::string output =
        options.output.empty() ? std::filesystem::path(file).stem().string() + ".png" : options.output;
    const std::string title = std::filesystem::path(file).filename().string() + " on " + typed.title;
    slice_picture(typed.frame, typed.types, typed.names, title, slices).write(output);
    fmt::print("{}: slices of {} spheres\n", output, typed.frame.size());
}

void check(const std::string& file, const std::string& scene_file)
{
    const SceneGrains scene = read_scene_grains(scene_file);
    const MixtureDescription mixture = read_mixture_file(file);
    std::vector<std::string> unknown;
    for (const std::string& type : types_named(mixture)) {
        if (std::ranges::find(scene.types, type) != scene.types.end()) continue;
        unknown.push_back("'" + type + "'" + did_you_mean(type, scene.types));
    }
    if (!unknown.empty()) {
        throw InputError(file, fmt::format("grain types that {} lacks: {}", scene_file, fmt::join(unknown, " ")),
                         fmt::format("only types of the scene: {}", fmt::join(scene.types, ", ")));
    }

    std::vector<std::string> can = types_named(mixture, true);
    if (needs_dump_types(mixture))
        for (const auto& [number, type] : scene.file_types) can.push_back(type);
    std::vector<std::string> never;
    for (const std::string& type : scene.types)
        if (std::ranges::find(can, type) == can.end()) never.push_back(type);
    if (!never.empty()) fmt::print("never chosen: {}\n", fmt::join(never, ", "));
    if (scene.dump.empty()) {
        fmt::print("{} fits {}\n", file, scene_file);
        return;
    }
    const TypedFrame typed = evaluate_mixture(mixture, scene, scene.dump, scene.reading, -1);
    std::vector<uint64_t> count(typed.names.size(), 0);
    for (const uint32_t type : typed.types) ++count[type];
    fmt::print("{} fits {}; spheres by type in {}:\n", file, scene_file, typed.title);
    for (size_t k = 0; k < count.size(); ++k) {
        const bool possible = std::ranges::find(never, typed.names[k]) == never.end();
        fmt::print("  {}: {} spheres{}\n", typed.names[k], count[k],
                   count[k] == 0 && possible ? ", although it can be chosen" : "");
    }
}

} // namespace

void add_mixture_command(CLI::App& app)
{
    CLI::App* mixture =
        app.add_subcommand("mixture", "Write a mixture of grain types, look at it, check it against a scene");
    mixture->require_subcommand(1);
    add_mixture_new_command(*mixture);

    auto names = std::make_shared<std::vector<std::string>>(3);
    CLI::App* command = mixture->add_subcommand("show", "Describe a mixture in words, with its expected fractions");
    command->add_option("MIXTURE", (*names)[0], "A mixture file or a scene")->required();
    command->callback([names] { show((*names)[0]); });

    auto options = std::make_shared<PreviewOptions>();
    command = mixture->add_subcommand(
        "preview", "Draw three slices through a dump's spheres, coloured by type, or print statistics");
    command->add_option("FILE", options->files, "MIXTURE (or a scene), and DUMP unless the scene has one")->required();
    command->add_option("--frame", options->frame, "The frame, counted from 0, or from the end when negative")
        ->capture_default_str();
    command->add_option("-o,--output", options->output, "The picture (the mixture's name with .png when left out)");
    command->add_flag("--stat", options->statistics,
                      "Print fractions by number and volume with 95 % intervals, and the correlation length");
    command->add_option("--at", options->at,
                        "x,y,z: the point where the three slices meet (the mean of the centres when left out)");
    command->add_option("--width", options->width, "Approximate width of the picture in pixels")
        ->check(CLI::Range(300, 8000))
        ->capture_default_str();
    command->add_option("--radius", options->radii, "Radius where the dump has none: R for all, or TYPE=R ...")
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false);
    command->callback([options] { preview(*options); });

    command = mixture->add_subcommand(
        "check", "Check whether a mixture fits a scene: finds types that are missing, misspelt or never chosen");
    command->add_option("MIXTURE", (*names)[1], "A mixture file")->required();
    command->add_option("SCENE", (*names)[2], "The scene")->required();
    command->callback([names] { check((*names)[1], (*names)[2]); });
}

} // namespace scree
