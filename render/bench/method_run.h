#pragma once

#include "base/work_meter.h"
#include "render/bench/bench_job.h"
#include "render/bench/half_pictures.h"
#include "render/loop/render_setup.h"

#include <memory>
#include <string>
#include <vector>

namespace scree {

/// Where the time before the first sample went, seconds by the clock.
struct SetupTime {
    double read = 0; ///< files: scene, grains, meshes, exemplars, environment maps
    double precompute = 0; ///< scattering of grains, media in their place, shells, distances, checks of what is filled
    double build = 0; ///< acceleration structures
    WorkTime all;
    std::vector<std::string> cached; ///< parts that were read from a cache of earlier runs
};

/// One method at work on a scene: its world, built once, and pictures of several seeds that grow slice by slice.
class MethodRun {
public:
    /// Reads and builds all. first_seed: of picture 0; the others have those after it. Throws InputError, Cancelled.
    MethodRun(const BenchJob& job, const BenchMethod& method, uint64_t first_seed, size_t pictures,
              const Progress& progress);

    const std::string& name() const { return name_; } ///< of auto with its accuracy
    const std::string& plan_name() const { return plan_name_; } ///< what the integrator does, in a word
    uint64_t scene_hash() const { return scene_hash_; }
    const SetupTime& setup_time() const { return setup_time_; }
    uint64_t memory() const { return memory_; } ///< bytes at its peak, above what there was before
    uint64_t grains() const { return setup_->world().grain_count() + setup_->world().replaced_grains; }
    const std::vector<std::string>& warnings() const { return warnings_; }

    size_t pictures() const { return films_.size(); }
    const std::vector<Film>& films() const { return films_; }
    /// Takes the place of a picture that was rendered before with the same seed.
    void restore(size_t picture, Film film) { films_[picture] = std::move(film); }
    /// Renders picture `picture` on, until its rendering has taken about so many seconds of processors in all, or one
    /// sample a pixel. How many samples that is, is decided beforehand, so that no sample is left out for taking long.
    /// Throws Cancelled.
    void render_until(size_t picture, double processor_seconds, const Progress& progress);

    Film empty_film() const;
    /// Renders a film on that is not one of the pictures, nor counted: as it is by default, to so many samples a pixel
    /// or to an error.
    RenderStatistics render_apart(Film& film, uint64_t seed, uint32_t spp, double error) const;

    const WorkTime& time(size_t picture) const { return times_[picture]; }
    WorkTime total_time() const;
    uint32_t samples(size_t picture) const; ///< a pixel
    uint64_t total_samples() const;
    const RenderStatistics& statistics() const { return statistics_; } ///< of all slices

private:
    std::string name_, plan_name_;
    std::vector<std::string> warnings_;
    uint64_t first_seed_, scene_hash_ = 0;
    std::unique_ptr<WorldBuilder> builder_;
    std::unique_ptr<RenderSetup> setup_;
    SetupTime setup_time_;
    uint64_t memory_ = 0;
    std::vector<Film> films_;
    std::vector<WorkTime> times_;
    uint64_t samples_drawn_ = 0; ///< a pixel, in the slices timed here
    RenderStatistics statistics_;
};

} // namespace scree
