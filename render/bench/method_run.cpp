#include "render/bench/method_run.h"

#include "base/error.h"
#include "base/hash.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {

namespace {

/// Whether a part is made by computing rather than by reading.
bool is_precomputed(const std::string& part)
{
    for (const char* name :
         {"gsdf", "walk in the packing", "medium of the grains", "shells", "distance", "domain", "fill"}) {
        if (part.rfind(name, 0) == 0) return true;
    }
    return false;
}

SetupTime split(const std::vector<PartReport>& parts, const WorkTime& all)
{
    SetupTime time;
    for (const PartReport& part : parts) {
        if (part.part == "acceleration structure")
            time.build += part.seconds;
        else if (is_precomputed(part.part))
            time.precompute += part.seconds;
        const bool all_shells =
            part.built && part.part.rfind("shells", 0) == 0 && part.reason.find(", 0 made now") != std::string::npos;
        if (all_shells || part.reason.find("from the cache") != std::string::npos) time.cached.push_back(part.part);
    }
    time.read = std::max(0.0, all.wall - time.build - time.precompute);
    time.all = all;
    return time;
}

} // namespace

MethodRun::MethodRun(const BenchJob& job, const BenchMethod& method, uint64_t first_seed, size_t pictures,
                     const Progress& progress)
    : name_(method.name), first_seed_(first_seed)
{
    const MemoryMeter memory;
    const WorkMeter meter;
    const RenderJob render = render_job_of(job, method);
    builder_ = std::make_unique<WorldBuilder>(load_scene(render));
    if (job.frame >= builder_->frame_count()) {
        throw InputError("--frame", std::to_string(job.frame),
                         "0 to " + std::to_string(builder_->frame_count() - 1) + ": the frames that the dump has");
    }
    const BuiltFrame built = builder_->build(job.frame, progress);
    if (progress.cancelled()) throw Cancelled();
    setup_ = std::make_unique<RenderSetup>(*builder_, built, render);
    setup_time_ = split(setup_->parts(), meter.time());
    memory_ = memory.peak();
    plan_name_ = built.plan.name();
    scene_hash_ = built.hash;
    warnings_ = built.warnings;
    const IntegratorDescription& integrator = builder_->scene().integrator;
    if (integrator.kind == IntegratorKind::automatic) name_ = "auto " + accuracy_names[integrator.accuracy];
    films_.assign(pictures, empty_film());
    times_.resize(pictures);
}

Film MethodRun::empty_film() const
{
    const FilmDescription& film = builder_->scene().film;
    return {film.width, film.height, 0, 0, film.width, film.height};
}

RenderStatistics MethodRun::render_apart(Film& film, uint64_t seed, uint32_t spp, double error) const
{
    RenderOptions options = setup_->options();
    options.timeout = 0;
    options.seed = seed;
    options.spp = spp;
    options.error = error;
    return render(setup_->world(), setup_->tracer(), setup_->camera(), setup_->filter(), film, options, Progress());
}

void MethodRun::render_until(size_t picture, double processor_seconds, const Progress& progress)
{
    Film& film = films_[picture];
    const uint32_t done = samples(picture);
    const double each = samples_drawn_ > 0 ? total_time().processor / static_cast<double>(samples_drawn_) : 0;
    const double left = processor_seconds - times_[picture].processor;
    double more = each > 0 ? std::floor(left / each) : 1;
    if (done == 0) more = std::max(more, 1.0);
    if (more < 1) return;
    RenderOptions options = setup_->options();
    options.seed = mix64(first_seed_ + picture);
    options.timeout = 0;
    options.spp = done + static_cast<uint32_t>(std::min(more, 1e6));
    const WorkMeter meter;
    const RenderStatistics statistics =
        render(setup_->world(), setup_->tracer(), setup_->camera(), setup_->filter(), film, options, progress);
    if (statistics.cancelled) throw Cancelled();
    times_[picture] += meter.time();
    samples_drawn_ += options.spp - done;
    statistics_.add(statistics);
}

WorkTime MethodRun::total_time() const
{
    WorkTime total;
    for (const WorkTime& time : times_) total += time;
    return total;
}

uint32_t MethodRun::samples(size_t picture) const
{
    uint32_t least = std::numeric_limits<uint32_t>::max();
    for (const Pixel& pixel : films_[picture].pixels()) least = std::min(least, pixel.drawn);
    return least;
}

uint64_t MethodRun::total_samples() const
{
    uint64_t total = 0;
    for (size_t i = 0; i < films_.size(); ++i) total += samples(i);
    return total;
}

} // namespace scree
