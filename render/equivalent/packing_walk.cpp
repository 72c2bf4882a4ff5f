#include "render/equivalent/packing_walk.h"

#include "base/error.h"
#include "base/sampler.h"
#include "base/warp.h"
#include "render/embree/embree_device.h"
#include "render/gsdf/encounter.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <mutex>

namespace scree {

namespace {

constexpr uint32_t batch_count = 64;

/// Counts of a batch of walks that are not part of its statistics.
struct Tally {
    double void_chords = 0, void_chord = 0; // number of chords in voids, and their total length
    uint64_t walks = 0, left = 0, scatterings = 0;
};

/// A line of random position and direction, and its entries into proxies.
struct Line {
    V3d start, direction;
    std::vector<Hit> entries;
};

class Walker {
public:
    Walker(const World& world, const Tracer& tracer, const PackingWalkOptions& options)
        : world_(world), tracer_(tracer), options_(options)
    {
    }

    /// A random line of this length, on which walks start; 0: it ends at its first entry.
    Line line(Sampler& sampler, double length) const
    {
        Line line;
        double u = sampler.next();
        const double v = sampler.next(), radius = options_.start_radius * std::cbrt(sampler.next());
        line.start = options_.centre + radius * sample_sphere(u, v);
        u = sampler.next();
        line.direction = sample_sphere(u, sampler.next());
        double beyond = 0;
        while (true) {
            const Hit hit = tracer_.intersect(line.start, line.direction, {}, GrainDetail::proxy, beyond);
            if (hit.place.kind != HitKind::grain || (length > 0 && hit.t > length)) break;
            line.entries.push_back(hit);
            beyond = hit.t;
            if (length == 0) break;
        }
        return line;
    }

    /// Makes a walk from a proxy that a ray along d hits; false if the ray passes straight through the proxy.
    bool walk(const Hit& entry, const V3d& d, uint32_t length, Sampler& sampler, WalkTrail& trail, Tally& tally) const
    {
        trail.clear();
        V3d o, w = d, kept;
        if (passes(entry, d, sampler)) return false;
        Place from = scatter(entry, o, w, kept, sampler);
        ++tally.walks;
        trail.position.push_back(o);
        trail.direction.push_back(w);
        while (trail.scatterings() < length) {
            const Hit hit = fly(o, w, from, sampler, tally);
            if (hit.place.kind != HitKind::grain ||
                (o - options_.centre).length2() > options_.safe_radius * options_.safe_radius) {
                ++tally.left;
                break;
            }
            from = scatter(hit, o, w, kept, sampler);
            trail.flight.push_back(hit.t);
            trail.kept.push_back(kept);
            trail.position.push_back(o);
            trail.direction.push_back(w);
        }
        tally.scatterings += trail.scatterings();
        return true;
    }

private:
    const Gsdf& gsdf(const Hit& hit) const { return *world_.types[hit.place.type].gsdf; }

    bool passes(const Hit& hit, const V3d& d, Sampler& sampler) const
    {
        return !gsdf(hit).always_met() && sampler.next() < gsdf(hit).alpha0(Encounter(hit.normal, d).q);
    }

    /// The next hit that is not passed straight through.
    Hit fly(const V3d& o, const V3d& d, const Place& from, Sampler& sampler, Tally& tally) const
    {
        double beyond = 0, last_exit = 0;
        while (true) {
            const Hit hit = tracer_.intersect(o, d, from, GrainDetail::proxy, beyond);
            if (hit.place.kind != HitKind::grain) return hit;
            ++tally.void_chords;
            tally.void_chord += hit.t - last_exit;
            if (!passes(hit, d, sampler)) return hit;
            beyond = hit.t;
            last_exit = hit.t - 2 * world_.sphere(hit.place.index).radius * hit.normal.dot(d);
        }
    }

    Place scatter(const Hit& hit, V3d& o, V3d& d, V3d& kept, Sampler& sampler) const
    {
        const Encounter encounter(hit.normal, d);
        const Gsdf& scattering = gsdf(hit);
        const GrainSphere sphere = world_.sphere(hit.place.index);
        const uint32_t stratum = Gsdf::stratum(encounter.q, sampler.next());
        const uint32_t cell = scattering.sample_cell(stratum, sampler.next());
        const uint32_t number = scattering.pick(stratum, cell, sampler.next());
        const GsdfRecord& record = scattering.record(number);
        kept = V3d(scattering.weight(number, world_.types[hit.place.type].material, sphere.radius));
        o = sphere.centre + sphere.radius * encounter.to_world(record.point.unpack());
        d = encounter.to_world(record.direction.unpack()).normalized();
        return hit.place;
    }

    const World& world_;
    const Tracer& tracer_;
    const PackingWalkOptions& options_;
};

struct Walked {
    std::vector<WalkBatch> batches;
    std::vector<Tally> tallies;
};

Walked run(const Walker& walker, uint64_t seed, uint64_t scatterings, double line_length, uint32_t length,
           uint32_t memory, const Progress& progress)
{
    Walked walked{std::vector<WalkBatch>(batch_count, WalkBatch(memory)), std::vector<Tally>(batch_count)};
    const uint64_t enough = scatterings / batch_count + 1;
    const auto most_lines = static_cast<uint32_t>(std::min<uint64_t>(1000 + 100 * (enough / length + 1), 1u << 31));
    std::mutex told;
    double done = 0;
    tbb::parallel_for(uint32_t{0}, batch_count, [&](uint32_t b) {
        flush_subnormals();
        WalkTrail trail;
        Tally& tally = walked.tallies[b];
        for (uint32_t i = 0; i < most_lines && tally.scatterings < enough && !progress.cancelled(); ++i) {
            Sampler sampler(seed, b, i, length);
            const Line line = walker.line(sampler, line_length);
            for (const Hit& entry : line.entries) {
                if (walker.walk(entry, line.direction, length, sampler, trail, tally)) walked.batches[b].add(trail);
            }
        }
        const std::lock_guard lock(told);
        progress.update("walks in the packing", ++done / batch_count);
    });
    if (progress.cancelled()) throw Cancelled();
    return walked;
}

/// The mean distance to the first grain along random lines: a line of this length hits about one grain.
double mean_entry_distance(const Walker& walker, const PackingWalkOptions& options)
{
    double sum = 0, count = 0;
    for (uint32_t i = 0; i < 256; ++i) {
        Sampler sampler(options.seed, ~0u, i, 0);
        const Line line = walker.line(sampler, 0);
        if (line.entries.empty()) continue;
        sum += line.entries.front().t;
        ++count;
    }
    if (count < 128) {
        throw InputError("walk in a packing",
                         fmt::format("only {} of 256 rays that start within {:g} of the walk's centre hit a grain",
                                     count, options.start_radius),
                         "a centre deep inside a packing", "start where grains are on all sides");
    }
    return sum / count;
}

} // namespace

PackingWalk walk_packing(const World& world, const Tracer& tracer, const PackingWalkOptions& options,
                         const Progress& progress)
{
    const auto begin = std::chrono::steady_clock::now();
    for (const GrainType& type : world.types) {
        if (!type.gsdf)
            throw InputError("walk in a packing", fmt::format("grain type {} has no GSDF", type.name),
                             "a GSDF for every grain type");
    }
    const Walker walker(world, tracer, options);
    const double line_length = mean_entry_distance(walker, options);

    const Walked pilot = run(walker, options.seed, 8192, line_length, 16, 8, progress);
    const WalkStatistics first(pilot.batches);
    if (first.scatterings() == 0) throw InputError("walk in a packing", "no grain that scatters", "at least one");
    PackingWalk result;
    result.memory = options.memory > 0 ? options.memory : walk_memory(first.cosine().value);
    result.length = options.length > 0 ? options.length : 8 * result.memory;
    const Walked walked =
        run(walker, options.seed, options.scatterings, line_length, result.length, result.memory, progress);
    const WalkStatistics statistics(walked.batches);
    result.scatterings = statistics.scatterings();
    result.flight = statistics.flight();
    result.cosine = statistics.cosine();
    result.diffusivity = statistics.diffusivity();
    result.transport_length = statistics.transport_length();
    result.half_diffusivity = statistics.half_diffusivity();
    result.half_transport_length = statistics.half_transport_length();
    const V3d albedo = statistics.albedo();
    for (int c = 0; c < 3; ++c) {
        int same = 0; // channels with equal albedo share their result
        while (albedo[same] != albedo[c]) ++same;
        result.decay[static_cast<size_t>(c)] = same < c ? result.decay[static_cast<size_t>(same)] : statistics.decay(c);
    }
    std::vector<double> chords, lengths;
    for (const Tally& tally : walked.tallies) {
        result.walks += tally.walks;
        result.left += tally.left;
        chords.push_back(tally.void_chords);
        lengths.push_back(tally.void_chord);
    }
    result.void_flight = measured_ratio(lengths, chords);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

} // namespace scree
