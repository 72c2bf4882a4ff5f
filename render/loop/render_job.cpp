#include "render/loop/render_job.h"

#include "base/atomic_file.h"
#include "base/console_progress.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/interrupt.h"
#include "render/film/checkpoint.h"
#include "render/film/exr_output.h"
#include "render/loop/job_report.h"
#include "render/loop/render_setup.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <bit>
#include <chrono>
#include <fstream>

namespace scree {

namespace {

constexpr int interrupted_status = 130;

/// The name of a frame's picture: %d and %04d become the frame number; without them, several frames get ".0007".
std::string frame_path(const std::string& output, size_t frame, bool many)
{
    const size_t percent = output.find('%');
    if (percent != std::string::npos) {
        const size_t end = output.find('d', percent);
        const std::string width = end == std::string::npos ? "x" : output.substr(percent + 1, end - percent - 1);
        const bool digits = width.find_first_not_of("0123456789") == std::string::npos && width.size() < 4;
        if (!digits) throw InputError("--output", "'" + output + "'", "%d or a form such as %04d for the frame number");
        const int count = width.empty() ? 1 : std::stoi(width);
        return output.substr(0, percent) + fmt::format("{:0{}}", frame, count) + output.substr(end + 1);
    }
    if (!many) return output;
    std::filesystem::path path(output);
    const std::string extension = path.extension().string();
    return path.replace_extension().string() + fmt::format(".{:04}", frame) + extension;
}

/// A film of the pixels whose middle lies in the crop, so that adjacent crops share no pixel.
Film make_film(const RenderJob& job, const FilmDescription& film)
{
    const int w = film.width, h = film.height;
    int x0 = 0, x1 = w, y0 = 0, y1 = h;
    if (job.crop) {
        const auto pixel = [](double fraction, int n) { return static_cast<int>(std::ceil(fraction * n - 0.5)); };
        x0 = pixel((*job.crop)[0], w);
        x1 = pixel((*job.crop)[1], w);
        y0 = pixel((*job.crop)[2], h);
        y1 = pixel((*job.crop)[3], h);
    }
    if (job.pixel_bounds) {
        const auto& b = *job.pixel_bounds;
        x0 = std::max(0, b[0]);
        x1 = std::min(w, b[1]);
        y0 = std::max(0, b[2]);
        y1 = std::min(h, b[3]);
    }
    if (x0 >= x1 || y0 >= y1) {
        throw InputError(job.crop ? "--cropwindow" : "--pixelbounds", "no pixel inside",
                         fmt::format("part of the {}x{} picture", w, h));
    }
    return Film(w, h, x0, y0, x1, y1);
}

PictureMetadata make_metadata(const RenderJob& job, const BuiltFrame& built, const Camera& camera,
                              const RenderStatistics& statistics)
{
    const TransportPlan& plan = built.plan;
    const World& world = *built.world;
    PictureMetadata metadata;
    metadata.texts = {{"software", "Scree"},
                      {"version", SCREE_VERSION},
                      {"integrator", plan.name()},
                      {"sceneHash", fmt::format("{:016x}", built.hash)},
                      {"seed", std::to_string(job.options.seed)}};
    metadata.numbers = {{"spp", statistics.spp},
                        {"renderTime", statistics.seconds},
                        {"frame", static_cast<double>(built.frame)},
                        {"nonFiniteSamples", static_cast<double>(statistics.non_finite)}};
    if (statistics.error) {
        metadata.numbers["relativeError"] = statistics.error->picture;
        metadata.numbers["worstTileError"] = statistics.error->worst_tile;
        metadata.numbers["meanSpp"] = statistics.mean_spp;
    }
    if (const std::optional<double> depth = built.medium_depth) {
        metadata.texts["mediumForm"] = medium_form_names[plan.medium_form];
        if (!plan.replaces_all) metadata.numbers["grainDepth"] = *depth;
    }
    if (plan.has_shells) metadata.texts["stfForm"] = stf_form_names[plan.stf_form];
    if (plan.has_proxies()) metadata.numbers["explicitGrains"] = plan.explicit_grains;
    if (plan.kind != IntegratorKind::ept) metadata.texts["accuracy"] = accuracy_names[plan.accuracy];
    if (!built.name.empty()) metadata.texts["particles"] = built.name;
    std::vector<std::string> types;
    for (size_t i = 0; i < world.types.size(); ++i) types.push_back(fmt::format("{}={}", i, world.types[i].name));
    if (!types.empty()) metadata.texts["grainTypes"] = fmt::format("{}", fmt::join(types, ","));
    const V3d o = world.space.origin;
    const double scale = world.space.length(1);
    const Imath::M44d to_render(scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, -o.x * scale, -o.y * scale,
                                -o.z * scale, 1);
    const double back = world.space.world_length(1);
    // Camera space is in the scene's unit again; NDC has no unit.
    metadata.world_to_camera =
        to_render * camera.world_to_camera() * Imath::M44d(back, 0, 0, 0, 0, back, 0, 0, 0, 0, back, 0, 0, 0, 0, 1);
    metadata.world_to_ndc = to_render * camera.world_to_ndc();
    metadata.depth_scale = back;
    return metadata;
}

/// Whether a picture's name asks for EXR.
bool is_exr(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".exr";
}

void check_outputs(const std::vector<std::string>& outputs)
{
    for (const std::string& output : outputs) {
        const std::filesystem::path path(output);
        if (path.extension().empty())
            throw InputError("--output", "'" + output + "'", "a name with an extension: .exr, .png, .jpg");
        if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path())) {
            throw InputError("--output", "no folder '" + path.parent_path().string() + "'", "a folder that exists");
        }
        if (!is_exr(path)) check_preview_format(path);
    }
}

class Job {
public:
    explicit Job(const RenderJob& job)
        : job_(job), console_(job.quiet), builder_(load_scene(job)), scene_(builder_.scene()),
          integrator_(integrator_names[scene_.integrator.kind])
    {
        outputs_ = job.outputs;
        if (outputs_.empty()) outputs_ = {scene_.file.stem().string() + ".exr"};
        check_outputs(outputs_);
        range_ = job.frames.value_or(FrameRange{});
        if (range_.last >= builder_.frame_count()) {
            throw InputError(
                "--frames", std::to_string(range_.last),
                fmt::format("0 to {}: the dump has {} frames", builder_.frame_count() - 1, builder_.frame_count()));
        }
    }

    int run()
    {
        const InterruptGuard guard(console_.progress());
        const bool stats_file = !job_.stats_json.empty() && !job_.plan_only;
        if (stats_file) AtomicFile(job_.stats_json); // fails now rather than after hours of rendering
        try {
            for (size_t frame = range_.first; frame <= range_.last && !interrupted_; frame += range_.step)
                run_frame(frame);
        } catch (const Cancelled&) {
            interrupted_ = true;
            say("interrupted before the first sample");
        }
        console_.finish();
        if (stats_file) {
            AtomicFile file(job_.stats_json);
            std::ofstream out(file.temporary());
            out << statistics_json(reports_, integrator_);
            out.close();
            if (!out)
                throw InputError(job_.stats_json.string(), "a disk that is full or cannot be written",
                                 "room for the statistics");
            file.commit();
        }
        return interrupted_ ? interrupted_status : 0;
    }

private:
    void run_frame(size_t frame)
    {
        const bool many = range_.first != range_.last;
        if (many) console_.set_prefix(fmt::format("frame {}", frame));
        if (!job_.plan_only && !job_.debug_sample) {
            for (const std::string& output : outputs_)
                AtomicFile(frame_path(output, frame, many)); // fails before the work if it cannot be written
        }
        const auto start = std::chrono::steady_clock::now();
        Progress& progress = console_.progress();
        const BuiltFrame built = builder_.build(frame, progress, job_.plan_only ? Precompute::never : Precompute::now);
        const World& world = *built.world;
        integrator_ = built.plan.name();
        say_warnings(built.warnings);
        if (progress.cancelled()) {
            interrupted_ = true;
            return;
        }
        if (job_.plan_only) {
            fmt::print("{}", plan_text(scene_, built, builder_.frame_count(), job_.crop || job_.pixel_bounds));
            return;
        }
        FrameReport report;
        report.frame = frame;
        report.name = built.name;
        const RenderSetup setup(builder_, built, job_);
        report.parts = setup.parts();
        report.setup_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        report.grains = world.grain_count() + world.replaced_grains;

        const RenderOptions& options = setup.options();
        if (job_.debug_sample) {
            if (job_.debug_sample->x >= scene_.film.width || job_.debug_sample->y >= scene_.film.height) {
                throw InputError("--debug-sample",
                                 fmt::format("pixel {},{}", job_.debug_sample->x, job_.debug_sample->y),
                                 fmt::format("a pixel of the {}x{} picture", scene_.film.width, scene_.film.height));
            }
            fmt::print("{}",
                       debug_text(world, setup.tracer(), setup.camera(), setup.filter(), *job_.debug_sample, options));
            return;
        }
        Film film = make_film(job_, scene_.film);
        if (options.error > 0) film.keep_halves();
        const std::filesystem::path checkpoint = frame_path(outputs_[0], frame, many) + ".checkpoint";
        const uint64_t approximation = hash_plan(built.plan);
        const uint64_t estimator = mix64(approximation ^ mix64(options.path.max_depth * uint64_t{4} +
                                                               static_cast<uint64_t>(options.path.direct_light)));
        const CheckpointKey key{mix64(built.hash ^ estimator ^ std::bit_cast<uint64_t>(options.error)), options.seed};
        if (job_.resume && std::filesystem::exists(checkpoint)) read_checkpoint(checkpoint, film, key);

        report.statistics = render(world, setup.tracer(), setup.camera(), setup.filter(), film, options, progress);
        interrupted_ = report.statistics.cancelled;
        const PictureMetadata metadata = make_metadata(job_, built, setup.camera(), report.statistics);
        for (const std::string& output : outputs_) {
            const std::string path = frame_path(output, frame, many);
            if (is_exr(path))
                write_exr(path, film, scene_.film.aov, metadata);
            else
                write_preview(path, film);
        }
        if (interrupted_ || (report.statistics.timed_out && (job_.spp || options.error > 0 || job_.resume)))
            write_checkpoint(checkpoint, film, key);
        else
            std::filesystem::remove(checkpoint);
        console_.finish();
        if (job_.stats) fmt::print("{}", statistics_text(report));
        say_oddities(report.statistics);
        reports_.push_back(std::move(report));
    }

    void say(const std::string& text)
    {
        console_.finish();
        if (!job_.quiet) fmt::print(stderr, "scree: {}\n", text);
    }
    void say_warnings(const std::vector<std::string>& warnings)
    {
        for (const std::string& warning : warnings) {
            if (std::find(said_.begin(), said_.end(), warning) == said_.end()) say("note: " + warning);
            said_.push_back(warning);
        }
    }
    void say_oddities(const RenderStatistics& s)
    {
        if (s.non_finite > 0) {
            const SamplePlace& p = *s.first_non_finite;
            say(fmt::format(
                "{} samples were not finite and are left out; to trace the first again: --debug-sample {},{},{}",
                s.non_finite, p.x, p.y, p.sample));
        }
        if (s.cancelled)
            say(fmt::format("interrupted: the picture holds at least {} samples a pixel; continue with --resume",
                            s.spp));
        else if (s.timed_out)
            say(fmt::format("stopped by --timeout at {} samples a pixel", s.spp));
        if (job_.options.error > 0 && !s.error_reached) {
            say("--error was not reached: " +
                (s.error ? fmt::format("{:.3g}, in the worst tile {:.3g}", s.error->picture, s.error->worst_tile)
                         : std::string("pixels have too few samples to estimate it")));
        }
        if (s.stopped > 0) say(fmt::format("{} paths were unfinished when time ran out and are left out", s.stopped));
        if (s.cut > 0)
            say(fmt::format("{} of {} paths were cut by the depth limit: the picture is too dark", s.cut, s.paths));
    }

    const RenderJob& job_;
    ConsoleProgress console_;
    WorldBuilder builder_;
    const SceneDescription& scene_;
    std::vector<std::string> outputs_, said_;
    FrameRange range_;
    std::vector<FrameReport> reports_;
    std::string integrator_; ///< TransportPlan::name() of the last frame
    bool interrupted_ = false;
};

} // namespace

void RenderJob::set(const std::string& flag, const std::string& text)
{
    for (const SceneOverride& value : switch_overrides(flag, text)) switches.push_back(value);
}

int run_render_job(const RenderJob& job)
{
    std::optional<tbb::global_control> threads;
    if (job.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(job.threads));
    return Job(job).run();
}

} // namespace scree
