#include "render/app/render_command.h"

#include "base/error.h"
#include "render/app/option_values.h"
#include "render/loop/render_job.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace scree {

namespace {

/// Numbers of "a<separator>b...": exactly `count`, or an InputError that names the option.
std::vector<double> split_numbers(const std::string& text, char separator, size_t count, const std::string& option,
                                  const std::string& expected)
{
    std::vector<double> numbers;
    size_t begin = 0;
    while (begin <= text.size()) {
        const size_t end = std::min(text.find(separator, begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        char* rest = nullptr;
        const double x = std::strtod(part.c_str(), &rest);
        if (part.empty() || *rest != 0 || !std::isfinite(x)) throw InputError(option, "'" + text + "'", expected);
        numbers.push_back(x);
        begin = end + 1;
    }
    if (numbers.size() != count) throw InputError(option, "'" + text + "'", expected);
    return numbers;
}

/// As split_numbers, for whole numbers in lo..hi.
std::vector<int64_t> split_whole_numbers(const std::string& text, char separator, size_t count, double lo, double hi,
                                         const std::string& option, const std::string& expected)
{
    std::vector<int64_t> whole;
    for (const double x : split_numbers(text, separator, count, option, expected)) {
        if (x != std::floor(x) || x < lo || x > hi)
            throw InputError(option, "'" + text + "'",
                             fmt::format("{}, whole numbers in {:.0f}..{:.0f}", expected, lo, hi));
        whole.push_back(static_cast<int64_t>(x));
    }
    return whole;
}

/// "A:B" or "A:B:STEP" or "A", frames counted from 0, B included.
FrameRange parse_frames(const std::string& text)
{
    const auto colons = static_cast<size_t>(std::count(text.begin(), text.end(), ':'));
    const auto n = split_whole_numbers(text, ':', std::min<size_t>(colons, 2) + 1, 0, 1e9, "--frames",
                                       "A, A:B or A:B:STEP, counted from 0");
    FrameRange range{static_cast<size_t>(n[0]), static_cast<size_t>(n.size() > 1 ? n[1] : n[0]),
                     n.size() > 2 ? static_cast<size_t>(n[2]) : 1};
    if (range.step == 0 || range.last < range.first)
        throw InputError("--frames", "'" + text + "'", "A <= B and a STEP of at least 1");
    return range;
}

struct Arguments {
    std::string crop, pixels, frames, debug, strategy = direct_light_names[DirectLight::both];
    std::optional<double> error;
    RenderJob job;
};

void take_over(Arguments& a)
{
    RenderJob& job = a.job;
    if (!a.crop.empty()) {
        const auto n = split_numbers(a.crop, ',', 4, "--cropwindow", "x0,x1,y0,y1 in 0..1");
        if (n[0] < 0 || n[1] > 1 || n[0] >= n[1] || n[2] < 0 || n[3] > 1 || n[2] >= n[3]) {
            throw InputError("--cropwindow", "'" + a.crop + "'", "0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1");
        }
        job.crop = {n[0], n[1], n[2], n[3]};
    }
    if (!a.pixels.empty()) {
        const auto n = split_whole_numbers(a.pixels, ',', 4, -1e6, 1e6, "--pixelbounds", "x0,x1,y0,y1 in pixels");
        job.pixel_bounds = std::array<int, 4>{static_cast<int>(n[0]), static_cast<int>(n[1]), static_cast<int>(n[2]),
                                              static_cast<int>(n[3])};
    }
    // Negated, so that NaN fails too.
    if (a.error && !(*a.error > 0 && *a.error <= 1)) {
        throw InputError("--error", fmt::format("{}", *a.error), "a relative error in (0, 1]", "2 % is --error 0.02");
    }
    job.options.error = a.error.value_or(0);
    if (a.error && job.spp && *job.spp < 4) {
        throw InputError("--spp", std::to_string(*job.spp), "at least 4 with --error",
                         "the error is estimated from the spread of two halves of the samples");
    }
    if (!a.frames.empty()) job.frames = parse_frames(a.frames);
    if (!a.debug.empty()) {
        const auto n = split_whole_numbers(a.debug, ',', 3, 0, 0x1p32 - 1, "--debug-sample", "x,y,sample");
        if (n[0] > 65535 || n[1] > 65535)
            throw InputError("--debug-sample", "'" + a.debug + "'", "a pixel of the picture");
        job.debug_sample = SamplePlace{static_cast<int>(n[0]), static_cast<int>(n[1]), static_cast<uint32_t>(n[2])};
    }
    job.options.path.direct_light = *direct_light_names.find(a.strategy);
}

} // namespace

void add_render_command(CLI::App& app)
{
    auto arguments = std::make_shared<Arguments>();
    Arguments& a = *arguments;
    RenderJob& job = a.job;
    CLI::App* command = app.add_subcommand("render", "Render a scene to pictures");
    command->add_option("scene", job.scene, "Scene file (JSON)")->required();
    command->add_option(
        "-o,--output", job.outputs,
        "Picture to write: .exr, or .png or .jpg as a preview; repeatable; %04d becomes the frame number "
        "(default: the scene's name with .exr)");
    command->add_option("--spp", job.spp, "Samples per pixel (default 64, or what --timeout allows or --error needs)")
        ->check(CLI::Range(1u, 1u << 30));
    command->add_option(
        "--error", a.error,
        "Stop at this relative error of the picture, 0.02 for 2 %; noisy parts get more samples, up to --spp");
    command->add_option("--timeout", job.options.timeout, "Stop after this many seconds of rendering a frame")
        ->check(CLI::PositiveNumber);
    for (const SceneSwitch& scene_switch : scene_switches()) add_scene_switch(*command, scene_switch, job.switches);
    command->add_option("--frames", a.frames,
                        "Frames to render, counted from 0: A, A:B or A:B:STEP, B included (default: the first)");
    command->add_option("--cropwindow", a.crop, "Render only x0,x1,y0,y1 of the picture, in 0..1");
    command->add_option("--pixelbounds", a.pixels, "Render only pixels x0,x1,y0,y1 (x1 and y1 excluded)");
    command->add_option("-t,--threads", job.threads, "Threads (default: all cores)")->check(CLI::Range(1, 4096));
    command->add_option("--seed", job.options.seed, "Seed of the random numbers")->check(CLI::NonNegativeNumber);
    command
        ->add_option("--direct-light", a.strategy, "How direct light is sampled: both, lights or scattering; for tests")
        ->check(CLI::IsMember(direct_light_names.words()));
    command->add_flag("--resume", job.resume,
                      "Continue from the checkpoint of an interrupted render of the same picture");
    command->add_flag("--plan", job.plan_only, "Print what would be built and what is skipped; render nothing");
    command->add_flag("--stats", job.stats, "Print statistics at the end");
    command->add_option("--stats-json", job.stats_json, "Write statistics to a JSON file");
    command->add_option("--debug-sample", a.debug, "Trace one sample (x,y,sample) again and print every vertex");
    add_override_option(*command, job.overrides);
    command->add_flag("-q,--quiet", job.quiet, "No progress, no remarks");
    command->callback([arguments] {
        take_over(*arguments);
        const int status = run_render_job(arguments->job);
        if (status != 0) throw CLI::RuntimeError(status);
    });
}

} // namespace scree
