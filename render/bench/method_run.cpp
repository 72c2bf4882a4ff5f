#include "render/bench/method_run.h"

#include "ingest/support/error.h"
#include "mixtures/hash.h"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

/// Whether a part is made by computing rather than by reading.
bool is_precomputed(const std::string& part)
{
    for (const char* name : {"gsdf", "walk in the packing", "medium of the grains", "shells", "distances"}) {
        if (part.rfind(name, 0) == 0) return true;
    }
    return false;
}

SetupTime split(const std::vector<PartReport>& parts, double all)
{
    SetupTime time;
    for (const PartReport& part : parts) {
        if (part.part == "acceleration structure") time.build += part.seconds;
        else if (is_precomputed(part.part)) time.precompute += part.seconds;
    }
    time.read = std::max(0.0, all - time.build - time.precompute);
    return time;
}

} // namespace

MethodRun::MethodRun(const BenchJob& job, const BenchMethod& method, uint64_t first_seed, size_t pictures, const Progress& progress)
    : name_(method.name), first_seed_(first_seed), builder_(load_scene(render_job_of(job, method)))
{
    if (job.frame >= builder_.frame_count()) {
        throw InputError("--frame", std::to_string(job.frame), "0 to " + std::to_string(builder_.frame_count() - 1) + ": the frames that the dump has");
    }
    const MemoryMeter memory;
    const Stopwatch watch;
    std::shared_ptr<const World> world = builder_.build(job.frame, progress);
    if (progress.cancelled()) throw Cancelled();
    setup_ = std::make_unique<RenderSetup>(builder_, std::move(world), render_job_of(job, method));
    setup_time_ = split(setup_->parts(), watch.seconds());
    memory_ = memory.peak();
    plan_name_ = builder_.plan().name();
    warnings_ = builder_.warnings();
    const FilmDescription& film = builder_.scene().film;
    films_.assign(pictures, Film(film.width, film.height, 0, 0, film.width, film.height));
    times_.resize(pictures);
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
    const RenderStatistics statistics = render(setup_->world(), setup_->tracer(), setup_->camera(), setup_->filter(), film, options, progress);
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
