#include "packing/tiles/tile_fluid.h"

#include "base/error.h"
#include "packing/tiles/tile_cells.h"
#include "packing/tiles/tile_random.h"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr uint64_t tuning_sweeps = 40, tuning_every = 4;
constexpr uint64_t least_sweeps = 200, most_sweeps = 5000;
constexpr double spacings = 2;

class Fluid {
public:
    Fluid(TileSpheres& spheres, uint64_t fixed, uint64_t seed)
        : spheres_(spheres), fixed_(fixed), cells_(spheres.size, spheres.radius), random_(seed, 0x666c756964),
          gap_(storage_gap(spheres)), travel_(spheres.count(), Imath::V3d(0)), steps_(cells_.level_count()),
          tried_(cells_.level_count()), moved_(cells_.level_count())
    {
        cells_.fill(spheres.place);
        const double volume = spheres.size.x * spheres.size.y * spheres.size.z;
        spacing_ = cube_root(volume / static_cast<double>(spheres.count()));
        std::ranges::fill(steps_, 0.2 * spacing_);
    }

    void sweep()
    {
        for (auto i = static_cast<uint32_t>(fixed_); i < spheres_.count(); ++i) {
            const size_t level = cells_.level_of(i);
            const Imath::V3d jump = steps_[level] * (2.0 * random_.cube() - Imath::V3d(1));
            ++tried_[level];
            if (!move(i, jump)) continue;
            travel_[i] += jump;
            ++moved_[level];
        }
    }

    /// Steers the acceptance of each level to 0.4.
    void tune()
    {
        const double longest = std::min({spheres_.size.x, spheres_.size.y, spheres_.size.z}) / 4;
        for (size_t level = 0; level < steps_.size(); ++level) {
            if (tried_[level] == 0) continue;
            const double acceptance = static_cast<double>(moved_[level]) / static_cast<double>(tried_[level]);
            steps_[level] = std::min(longest, steps_[level] * std::clamp(acceptance / 0.4, 0.5, 1.6));
        }
        forget();
    }
    void forget()
    {
        std::ranges::fill(tried_, 0);
        std::ranges::fill(moved_, 0);
    }

    double displacement() const
    {
        double sum = 0;
        for (uint64_t i = fixed_; i < spheres_.count(); ++i) sum += travel_[i].length2();
        return std::sqrt(sum / static_cast<double>(spheres_.count() - fixed_));
    }
    double acceptance() const
    {
        uint64_t tried = 0, moved = 0;
        for (size_t level = 0; level < tried_.size(); ++level) tried += tried_[level], moved += moved_[level];
        return tried > 0 ? static_cast<double>(moved) / static_cast<double>(tried) : 0;
    }
    double spacing() const { return spacing_; }

private:
    bool move(uint32_t i, const Imath::V3d& jump)
    {
        const double r = spheres_.radius[i];
        Imath::V3d to = spheres_.place[i] + jump;
        if (fixed_ > 0) {
            for (int axis = 0; axis < 3; ++axis)
                if (to[axis] < r + gap_ || to[axis] > spheres_.size[axis] - r - gap_) return false;
        } else {
            to = wrapped_into(to, spheres_.size);
        }
        const Imath::V3d& size = spheres_.size;
        for (size_t level = 0; level < cells_.level_count(); ++level) {
            const bool free = cells_.visit_near(
                level, to, r + cells_.level_radius(level) + gap_, [&](uint32_t j, int x, int y, int z) {
                    if (j == i) return true;
                    const Imath::V3d d = spheres_.place[j] + Imath::V3d(x * size.x, y * size.y, z * size.z) - to;
                    const double least = r + spheres_.radius[j] + gap_;
                    return d.length2() >= least * least;
                });
            if (!free) return false;
        }
        spheres_.place[i] = to;
        cells_.move(i, to);
        return true;
    }

    TileSpheres& spheres_;
    uint64_t fixed_;
    TileCells cells_;
    TileRandom random_;
    double gap_, spacing_;
    std::vector<Imath::V3d> travel_;
    std::vector<double> steps_;
    std::vector<uint64_t> tried_, moved_;
};

} // namespace

FluidRun equilibrate_spheres(TileSpheres& spheres, uint64_t fixed, std::optional<uint64_t> sweeps, uint64_t seed,
                             const TileStep& step, const Progress& progress)
{
    FluidRun run;
    if (fixed == spheres.count() || sweeps == 0) return run;
    Fluid fluid(spheres, fixed, seed);
    for (bool done = false; !done; ++run.sweeps) {
        if (progress.cancelled()) throw Cancelled();
        fluid.sweep();
        if (run.sweeps < tuning_sweeps && (run.sweeps + 1) % tuning_every == 0) fluid.tune();
        const uint64_t count = run.sweeps + 1;
        const double travelled = fluid.displacement() / (spacings * fluid.spacing());
        // In a random walk the displacement grows with the square root of the sweeps.
        const double part = sweeps
                                ? static_cast<double>(count) / static_cast<double>(*sweeps)
                                : std::max(std::min(travelled * travelled, static_cast<double>(count) / least_sweeps),
                                           static_cast<double>(count) / most_sweeps);
        step(std::min(part, 1.0));
        done = part >= 1;
    }
    run.acceptance = fluid.acceptance();
    run.displacement = fluid.displacement();
    return run;
}

} // namespace scree
