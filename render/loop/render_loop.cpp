#include "render/loop/render_loop.h"

#include "base/warp.h"

#include <tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <optional>

namespace scree {

namespace {

constexpr double wave_seconds = 2; // target duration of a wave, and so the longest wait after Ctrl-C

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

bool finite(const Color& c) { return std::isfinite(c.x + c.y + c.z); }

/// The cost of a sample, in rays. A scattering in a medium, with its light sample and the media that the light passes,
/// takes as long as 4 rays, and a shell as long as 8. On the bench suite's cloud and statue these add up to the time of
/// a pixel within 9 %.
uint64_t work_of(const PathResult& path)
{
    return uint64_t{path.segments} + path.shadow_rays + 4 * uint64_t{path.events} + 8 * uint64_t{path.shells};
}

void count(const PathResult& path, RenderStatistics& part)
{
    ++part.paths;
    part.segments += path.segments;
    part.shadow_rays += path.shadow_rays;
    part.events += path.events;
    part.shells += path.shells;
    part.leaks += path.leaks;
    part.cut += path.cut;
    part.longest = std::max(part.longest, path.segments);
}

/// One call of `render`.
class Loop {
public:
    Loop(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter, Film& film,
         const RenderOptions& options, const Progress& progress)
        : world_(world), tracer_(tracer), camera_(camera), filter_(filter), film_(film), options_(options),
          path_options_(options), progress_(progress)
    {
        path_options_.path.stop = [this] { return progress_.cancelled() || out_of_time(); };
    }

    RenderStatistics run()
    {
        if (options_.error > 0)
            run_to_error();
        else
            run_to_spp();
        uint64_t drawn = 0;
        for (const Pixel& pixel : film_.pixels()) drawn += pixel.drawn;
        total_.mean_spp = static_cast<double>(drawn) / static_cast<double>(std::max<size_t>(1, film_.pixels().size()));
        total_.cancelled = progress_.cancelled();
        total_.timed_out = !total_.cancelled && !total_.error_reached && !exhausted_;
        total_.seconds = seconds_since(start_);
        return total_;
    }

private:
    bool out_of_time() const { return options_.timeout > 0 && seconds_since(start_) > options_.timeout; }
    uint32_t least_drawn() const
    {
        uint32_t least = options_.spp;
        for (const Pixel& pixel : film_.pixels()) least = std::min(least, pixel.drawn);
        return least;
    }

    void run_to_spp()
    {
        uint32_t done = least_drawn(), wave = 1;
        std::vector<int> tiles(static_cast<size_t>(film_.tile_columns() * film_.tile_rows()));
        std::iota(tiles.begin(), tiles.end(), 0);
        while (done < options_.spp && !tiles.empty()) {
            const uint32_t target = done + std::min(wave, options_.spp - done);
            const auto wave_start = Clock::now();
            const bool complete = run_wave(
                tiles, done == 0, [&](double wave_done) { return (done + wave_done * (target - done)) / options_.spp; },
                [&](int tile, const auto& stop, RenderStatistics& part) { return run_tile(tile, target, stop, part); });
            if (!complete) break;
            done = target;
            if (progress_.cancelled() || out_of_time()) break;
            const double rate = std::max(1e-9, seconds_since(wave_start) / wave);
            wave = static_cast<uint32_t>(std::clamp(wave_seconds / rate, 1.0, std::min(2.0 * wave, 65536.0)));
        }
        total_.spp = done;
        exhausted_ = done >= options_.spp;
    }

    /// One wave for each level of the plan.
    void run_to_error()
    {
        if (film_.halves().empty()) film_.keep_halves();
        TileStates& states = film_.tile_states();
        AdaptivePlan plan(states, film_.tile_columns(), options_.error);
        const uint32_t most = options_.spp / 2;
        bool first = least_drawn() == 0, complete = true;
        while (complete && !plan.finished()) {
            std::vector<int> going;
            bool limited = false;
            for (size_t i = 0; i < states.tiles.size(); ++i) {
                const std::array<uint32_t, 2> asked = plan.asked(i);
                if (std::max(asked[0], asked[1]) > states.done) going.push_back(static_cast<int>(i));
                limited = limited || std::max(asked[0], asked[1]) > most;
            }
            const double before = plan.progress();
            const auto run = [&](int tile, const auto& stop, RenderStatistics& part) {
                std::array<uint32_t, 2> each = plan.asked(static_cast<size_t>(tile));
                for (uint32_t& n : each) n = std::min(n, most);
                return run_halves(tile, each, stop, part);
            };
            complete = run_wave(
                going, first, [&](double wave_done) { return before + wave_done * 0.2 * (1 - before); }, run);
            first = false;
            if (!complete) break;
            exhausted_ = limited;
            if (limited) break; // below the level nothing is decided: a later call may draw more
            estimate_tiles(film_, plan);
            plan.decide();
            if (progress_.cancelled() || out_of_time()) break;
        }
        total_.error_reached = plan.finished();
        film_.take_halves();
        total_.error = claimed_error(film_);
        total_.spp = least_drawn();
    }

    /// Calls `run` for each tile. Returns false if time runs out or the user stops; time does not stop the first wave,
    /// so that every pixel has a sample. fraction_done: progress of the picture as a function of the wave's progress.
    template <class Fraction, class Run>
    bool run_wave(const std::vector<int>& tiles, bool first, const Fraction& fraction_done, const Run& run)
    {
        std::atomic<int> finished{0};
        std::atomic<bool> complete{true};
        const auto stop = [&] { return progress_.cancelled() || (!first && out_of_time()); };
        tbb::parallel_for(
            size_t{0}, tiles.size(),
            [&](size_t i) {
                flush_subnormals();
                RenderStatistics part;
                if (stop() || !run(tiles[i], stop, part)) complete = false;
                const int count = ++finished;
                const std::lock_guard lock(mutex_);
                total_.add(part);
                const double by_samples = fraction_done(static_cast<double>(count) / static_cast<double>(tiles.size()));
                const double by_time = options_.timeout > 0 ? seconds_since(start_) / options_.timeout : 0;
                progress_.update("rendering", std::min(1.0, std::max(by_samples, by_time)));
            },
            tbb::simple_partitioner());
        return complete;
    }

    /// Calls f with every pixel of a tile; returns false as soon as f returns false or `stop` returns true.
    template <class Stop, class F>
    bool each_pixel(int tile, const Stop& stop, const F& f) const
    {
        const int x0 = film_.x0() + tile % film_.tile_columns() * Film::tile_size,
                  y0 = film_.y0() + tile / film_.tile_columns() * Film::tile_size;
        for (int y = y0; y < std::min(y0 + Film::tile_size, film_.y1()); ++y) {
            if (stop()) return false;
            for (int x = x0; x < std::min(x0 + Film::tile_size, film_.x1()); ++x) {
                if (!f(x, y)) return false;
            }
        }
        return true;
    }

    /// Brings every pixel of a tile to `target` samples; false if stopped earlier.
    template <class Stop>
    bool run_tile(int tile, uint32_t target, const Stop& stop, RenderStatistics& part)
    {
        return each_pixel(tile, stop, [&](int x, int y) {
            while (film_.at(x, y).drawn < target) {
                if (!draw(x, y, film_.at(x, y).drawn, part)) return false;
            }
            return true;
        });
    }

    /// Brings every pixel of a tile to these numbers of samples in its halves; false if stopped earlier.
    template <class Stop>
    bool run_halves(int tile, const std::array<uint32_t, 2>& each, const Stop& stop, RenderStatistics& part)
    {
        TileState& state = film_.tile_states().tiles[static_cast<size_t>(tile)];
        return each_pixel(tile, stop, [&](int x, int y) {
            PixelHalves& halves = film_.halves_at(x, y);
            while (const std::optional<uint32_t> s = halves.next(each)) {
                const std::optional<PathResult> path = draw(x, y, *s, part);
                if (!path) return false;
                halves.note_drawn(*s);
                state.work[*s & 1] += work_of(*path);
                if (finite(path->radiance)) halves.add(*s, path->radiance, state.counts);
            }
            return true;
        });
    }

    /// Draws one sample of a pixel; nothing if the path was stopped.
    std::optional<PathResult> draw(int x, int y, uint32_t s, RenderStatistics& part)
    {
        const PathResult path = render_sample(world_, tracer_, camera_, filter_, x, y, s, path_options_);
        if (path.stopped) {
            ++part.stopped;
            return std::nullopt;
        }
        count(path, part);
        Pixel& pixel = film_.at(x, y);
        ++pixel.drawn;
        if (finite(path.radiance)) {
            pixel.add(path.radiance, path.first);
        } else {
            ++part.non_finite;
            if (!part.first_non_finite) part.first_non_finite = SamplePlace{x, y, s};
        }
        return path;
    }

    const World& world_;
    const Tracer& tracer_;
    const Camera& camera_;
    const Filter& filter_;
    Film& film_;
    const RenderOptions& options_;
    RenderOptions path_options_; ///< with the loop's own PathOptions::stop
    const Progress& progress_;
    const Clock::time_point start_ = Clock::now();
    RenderStatistics total_;
    std::mutex mutex_;
    bool exhausted_ = false; ///< spp was reached
};

} // namespace

void RenderStatistics::add(const RenderStatistics& part)
{
    paths += part.paths;
    segments += part.segments;
    shadow_rays += part.shadow_rays;
    events += part.events;
    shells += part.shells;
    non_finite += part.non_finite;
    leaks += part.leaks;
    cut += part.cut;
    stopped += part.stopped;
    longest = std::max(longest, part.longest);
    seconds += part.seconds;
    if (!first_non_finite) first_non_finite = part.first_non_finite;
}

PathResult render_sample(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter, int x,
                         int y, uint32_t sample, const RenderOptions& options, std::vector<PathVertex>* trail)
{
    Sampler sampler(options.seed, static_cast<uint32_t>(x), static_cast<uint32_t>(y), sample);
    const double u1 = sampler.next(), u2 = sampler.next(), u3 = sampler.next(), u4 = sampler.next();
    const V2d film = V2d(x + 0.5, y + 0.5) + filter.sample(u1, u2);
    const CameraRay ray = camera.ray(film, sample_disk(u3, u4));
    PathResult result = trace_path(world, tracer, ray.o, ray.d, sampler, options.path, trail);
    if (result.first.hit) result.first.depth = camera.depth(ray.o + result.first.depth * ray.d);
    return result;
}

RenderStatistics render(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter,
                        Film& film, const RenderOptions& options, const Progress& progress)
{
    return Loop(world, tracer, camera, filter, film, options, progress).run();
}

} // namespace scree
