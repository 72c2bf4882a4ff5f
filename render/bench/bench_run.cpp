#include "render/bench/bench_run.h"

#include "base/error.h"
#include "base/hash.h"
#include "render/bench/bench_maps.h"
#include "render/bench/flip.h"

#include <fmt/format.h>

#include <memory>

namespace scree {

namespace {

constexpr int levels = 7; // slices double: errors are measured after 1/64, 1/32, ... and all of the time

/// The seed of the methods (which = 0) or of the reference (1): the two differ from each other and from the seed that
/// `scree render` uses with the same --seed.
uint64_t seed_of(const BenchJob& job, uint64_t which)
{
    return mix64(mix64(job.scene.options.seed + 0x9e3779b97f4a7c15ull) + which);
}

std::vector<V3d> means_of(const Film& film)
{
    std::vector<V3d> means;
    means.reserve(film.pixels().size());
    for (const Pixel& pixel : film.pixels()) means.push_back(pixel.samples > 0 ? pixel.sum / pixel.samples : V3d(0));
    return means;
}

ConvergencePoint point_of(const MethodRun& run, const HalfPictures& reference)
{
    ConvergencePoint point;
    std::vector<std::vector<V3d>> pictures;
    const auto n = static_cast<double>(run.pictures());
    for (size_t s = 0; s < run.pictures(); ++s) {
        pictures.push_back(means_of(run.films()[s]));
        point.time.wall += run.time(s).wall / n;
        point.time.processor += run.time(s).processor / n;
        point.samples += run.samples(s) / n;
    }
    point.squared_error = squared_error(pictures, reference);
    return point;
}

MethodResult result_of(const MethodRun& run, std::vector<ConvergencePoint> points, const HalfPictures& reference)
{
    MethodResult result{run.name(),
                        run.plan_name(),
                        run.setup_time(),
                        run.memory(),
                        run.grains(),
                        run.warnings(),
                        run.total_time(),
                        run.total_samples(),
                        run.statistics(),
                        std::move(points),
                        {},
                        make_halves(run.films()),
                        {}};
    result.estimate = estimate_error(result.picture, reference);
    result.flip = flip_difference(screen_picture(reference), screen_picture(result.picture));
    return result;
}

ReferencePicture find_reference(const BenchJob& job, double threads, const Progress& progress)
{
    if (!job.reference.empty()) {
        const SceneDescription scene = load_scene(job.scene);
        return read_reference(job.reference, scene.film.width, scene.film.height);
    }
    MethodRun run(job, job.reference_method, seed_of(job, 1), 2, progress); // shares no sample with the methods
    return render_reference(run, job.folder / "reference.exr", job.scene.options.seed, job.reference_seconds * threads,
                            progress);
}

} // namespace

BenchResult run_bench(const BenchJob& job, const Progress& progress)
{
    BenchResult result;
    result.job = job;
    result.machine = this_machine(job.scene.threads);
    result.reference = find_reference(job, result.machine.threads, progress);
    if (!result.reference.note.empty()) result.notes.push_back(result.reference.note);
    const HalfPictures& reference = result.reference.picture;
    if (reference.halved)
        result.reference_flip =
            mean_flip(flip_difference(screen_picture(reference, reference.a), screen_picture(reference, reference.b)));

    std::vector<std::unique_ptr<MethodRun>> runs;
    for (const BenchMethod& method : job.methods)
        runs.push_back(std::make_unique<MethodRun>(job, method, seed_of(job, 0), job.seeds, progress));
    result.scene_hash = runs.front()->scene_hash();
    const std::string& key = result.reference.key;
    if (!key.empty() && key.rfind(fmt::format("{:016x} ", result.scene_hash), 0) != 0)
        result.notes.push_back("the reference shows another scene, or this scene before it was changed");
    if (!reference.has_noise())
        result.notes.push_back("the reference's noise is not known: errors include it, and no bias can be measured");

    std::vector<std::vector<ConvergencePoint>> points(runs.size());
    const double whole =
        job.seconds * result.machine.threads / static_cast<double>(job.seeds); // processor seconds a picture
    for (int level = 1; level <= levels; ++level) {
        const double until = whole * std::exp2(level - levels);
        std::vector<uint64_t> before;
        for (const auto& run : runs) before.push_back(run->total_samples());
        for (size_t s = 0; s < job.seeds; ++s) {
            for (const auto& run : runs) run->render_until(s, until, progress);
            progress.update("methods in turns", std::exp2(level - levels) * (0.5 + 0.5 * static_cast<double>(s + 1) /
                                                                                       static_cast<double>(job.seeds)));
        }
        for (size_t m = 0; m < runs.size(); ++m) {
            if (runs[m]->total_samples() == before[m]) continue; // the slice was too short for another sample
            points[m].push_back(point_of(*runs[m], reference));
        }
    }
    for (size_t m = 0; m < runs.size(); ++m) {
        result.methods.push_back(result_of(*runs[m], std::move(points[m]), reference));
        result.reference_noise = result.methods.back().estimate.reference_noise;
        for (ConvergencePoint& point : result.methods.back().points)
            point.below_reference = reference.has_noise() && point.squared_error.value < result.reference_noise.value;
    }
    result.peak_memory = peak_bytes();
    return result;
}

} // namespace scree
