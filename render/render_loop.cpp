#include "render/render_loop.h"

#include "render/warp.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <mutex>

namespace scree {

namespace {

constexpr int tile_size = 16;
constexpr double wave_seconds = 2; // what a wave may take: how long a user waits for Ctrl-C

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

bool finite(const C3f& c) { return std::isfinite(c.x + c.y + c.z); }

void add(RenderStatistics& total, const RenderStatistics& part)
{
    total.paths += part.paths;
    total.segments += part.segments;
    total.shadow_rays += part.shadow_rays;
    total.events += part.events;
    total.shells += part.shells;
    total.non_finite += part.non_finite;
    total.leaks += part.leaks;
    total.cut += part.cut;
    total.stopped += part.stopped;
    total.longest = std::max(total.longest, part.longest);
    if (!total.first_non_finite) total.first_non_finite = part.first_non_finite;
}

/// Brings every pixel of a tile up to `target` samples; false when stopped in between.
template <class Stop>
bool render_tile(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter, Film& film, int x0,
                 int y0, uint32_t target, const RenderOptions& options, const Stop& stop, RenderStatistics& part)
{
    for (int y = y0; y < std::min(y0 + tile_size, film.y1()); ++y) {
        if (stop()) return false;
        for (int x = x0; x < std::min(x0 + tile_size, film.x1()); ++x) {
            Pixel& pixel = film.at(x, y);
            while (pixel.drawn < target) {
                const uint32_t s = pixel.drawn++;
                const PathResult path = render_sample(world, tracer, camera, filter, x, y, s, options);
                if (path.stopped) {
                    --pixel.drawn;
                    ++part.stopped;
                    return false;
                }
                ++part.paths;
                part.segments += path.segments;
                part.shadow_rays += path.shadow_rays;
                part.events += path.events;
                part.shells += path.shells;
                part.leaks += path.leaks;
                part.cut += path.cut;
                part.longest = std::max(part.longest, path.segments);
                if (finite(path.radiance)) {
                    pixel.add(path.radiance, path.first);
                } else {
                    ++part.non_finite;
                    if (!part.first_non_finite) part.first_non_finite = SamplePlace{x, y, s};
                }
            }
        }
    }
    return true;
}

} // namespace

PathResult render_sample(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter, int x, int y,
                         uint32_t sample, const RenderOptions& options, std::vector<PathVertex>* trail)
{
    Sampler sampler(options.seed, static_cast<uint32_t>(x), static_cast<uint32_t>(y), sample);
    const double u1 = sampler.next(), u2 = sampler.next(), u3 = sampler.next(), u4 = sampler.next();
    const V2d film = V2d(x + 0.5, y + 0.5) + filter.sample(u1, u2);
    const CameraRay ray = camera.ray(film, sample_disk(u3, u4));
    PathResult result = trace_path(world, tracer, ray.o, ray.d, sampler, options.path, trail);
    if (result.first.hit) result.first.depth = camera.depth(ray.o + result.first.depth * ray.d);
    return result;
}

RenderStatistics render(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter, Film& film,
                        const RenderOptions& options, const Progress& progress)
{
    const auto start = Clock::now();
    const int columns = (film.x1() - film.x0() + tile_size - 1) / tile_size, rows = (film.y1() - film.y0() + tile_size - 1) / tile_size;
    const int tiles = columns * rows;
    RenderStatistics total;
    std::mutex mutex;
    uint32_t done = options.spp, wave = 1;
    for (const Pixel& pixel : film.pixels()) done = std::min(done, pixel.drawn);
    while (done < options.spp && tiles > 0) {
        const uint32_t target = done + std::min(wave, options.spp - done);
        const auto wave_start = Clock::now();
        std::atomic<int> finished{0};
        std::atomic<bool> complete{true};
        // The first wave is finished whatever the time: a picture has a sample everywhere, unless the user stops it.
        const auto stop = [&] {
            return progress.cancelled() || (done > 0 && options.timeout > 0 && seconds_since(start) > options.timeout);
        };
        RenderOptions wave_options = options;
        wave_options.path.stop = [&] { return progress.cancelled() || (options.timeout > 0 && seconds_since(start) > options.timeout); };
        tbb::parallel_for(0, tiles, [&](int tile) {
            flush_subnormals();
            RenderStatistics part;
            const int x0 = film.x0() + tile % columns * tile_size, y0 = film.y0() + tile / columns * tile_size;
            if (stop() || !render_tile(world, tracer, camera, filter, film, x0, y0, target, wave_options, stop, part)) {
                complete = false;
            }
            const int count = ++finished;
            const std::lock_guard lock(mutex);
            add(total, part);
            const double wave_done = static_cast<double>(count) / tiles;
            const double by_samples = (done + wave_done * (target - done)) / options.spp;
            const double by_time = options.timeout > 0 ? seconds_since(start) / options.timeout : 0;
            progress.update("rendering", std::min(1.0, std::max(by_samples, by_time)));
        }, tbb::simple_partitioner());
        if (!complete) break;
        done = target;
        if (stop()) break;
        const double rate = std::max(1e-9, seconds_since(wave_start) / wave);
        wave = static_cast<uint32_t>(std::clamp(wave_seconds / rate, 1.0, std::min(2.0 * wave, 65536.0)));
    }
    total.spp = done;
    total.cancelled = progress.cancelled();
    total.timed_out = !total.cancelled && done < options.spp;
    total.seconds = seconds_since(start);
    return total;
}

} // namespace scree
