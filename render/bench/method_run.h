#pragma once

#include "base/work_meter.h"
#include "render/bench/bench_job.h"
#include "render/bench/half_pictures.h"
#include "render/loop/render_setup.h"

#include <memory>
#include <string>
#include <vector>

namespace scree {

/// Where the time before the first sample went, in wall-clock seconds.
struct SetupTime {
    double read = 0; ///< files: scene, grains, meshes, exemplars, environment maps
    double precompute = 0; ///< scattering of grains, media that replace them, shells, distances, checks of fills
    double build = 0; ///< acceleration structures
    WorkTime all;
    std::vector<std::string> cached; ///< parts that were read from a cache of earlier runs
};

/// Renders a scene with one method: builds the world once, then renders pictures of several seeds slice by slice.
class MethodRun {
public:
    /// Reads and builds everything. first_seed: picture i renders with a seed made of first_seed + i. Throws
    /// InputError, Cancelled.
    MethodRun(const BenchJob& job, const BenchMethod& method, uint64_t first_seed, size_t pictures,
              const Progress& progress);

    const std::string& name() const { return name_; } ///< for auto with the accuracy
    const std::string& plan_name() const { return plan_name_; } ///< what the integrator does, in a word
    uint64_t scene_hash() const { return scene_hash_; }
    const SetupTime& setup_time() const { return setup_time_; }
    uint64_t memory() const { return memory_; } ///< peak bytes of the set-up, minus those used before it
    uint64_t grains() const { return setup_->world().grain_count() + setup_->world().replaced_grains; }
    const std::vector<std::string>& warnings() const { return warnings_; }

    size_t pictures() const { return films_.size(); }
    const std::vector<Film>& films() const { return films_; }
    /// Replaces a picture by one that an earlier run rendered with the same seed.
    void restore(size_t picture, Film film) { films_[picture] = std::move(film); }
    /// Continues picture `picture` until its rendering has taken about `processor_seconds` in all, and to at least one
    /// sample a pixel. The number of samples is fixed before they are rendered, so that slow samples are not left out.
    /// Throws Cancelled.
    void render_until(size_t picture, double processor_seconds, const Progress& progress);

    Film empty_film() const;
    /// Continues a film that is not one of the pictures and does not count in times or statistics, to `spp` samples a
    /// pixel or to `error`; all other options are the scene's.
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
