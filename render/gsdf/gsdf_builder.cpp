#include "render/gsdf/gsdf_builder.h"

#include "base/error.h"
#include "base/stopwatch.h"
#include "base/warp.h"
#include "render/embree/embree_device.h"
#include "render/gsdf/density_fit.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr uint32_t batch_size = 4096;
constexpr uint64_t recorded_batches = 128; // 2^19 paths
constexpr uint32_t most_of_a_cell = 256; // records kept per cell

/// A record, and the stratum and cell it belongs to.
struct Scattered {
    uint32_t stratum, cell;
    GsdfRecord record;
    Color weight;
};

/// The counts; sums are integers, so that their order does not matter.
struct Counts {
    std::array<DirectionCounts, 2> directions;
    std::vector<uint64_t> paths = std::vector<uint64_t>(Gsdf::alpha_bins), missed = paths;
    uint64_t lost = 0;
    // Sums of the cosine in steps of 2^-30, and of its square in steps of 2^-20.
    int64_t scattered = 0, cosines = 0, squares = 0;

    Counts()
    {
        for (auto& half : directions) half.resize(static_cast<size_t>(Gsdf::strata) * Gsdf::cells);
    }
    void add(const Counts& other)
    {
        const auto sum = [](auto& a, const auto& b) {
            for (size_t i = 0; i < a.size(); ++i) a[i] += b[i];
        };
        for (size_t half = 0; half < 2; ++half) sum(directions[half], other.directions[half]);
        sum(paths, other.paths);
        sum(missed, other.missed);
        lost += other.lost;
        scattered += other.scattered;
        cosines += other.cosines;
        squares += other.squares;
    }
};

/// The record of a path that comes in at `entry` along `incoming` and leaves at `point` along `direction`.
Scattered describe(const V3d& entry, const V3d& incoming, const V3d& point, const V3d& direction, const GrainExit& exit)
{
    const Encounter encounter(entry, incoming);
    const V3d w = encounter.to_local(direction);
    Scattered s;
    s.stratum = std::min(Gsdf::strata - 1, static_cast<uint32_t>(encounter.q * Gsdf::strata));
    s.cell = DirectionGrid::cell(DirectionGrid::angles(w));
    s.record = {PackedDirection(encounter.to_local(point)), PackedDirection(w), static_cast<float>(exit.length),
                exit.events};
    s.weight = exit.weight;
    return s;
}

/// i with its twelve bits reversed: successive paths lie far apart in q, so that the first records of a cell represent
/// all of them.
uint32_t scattered_order(uint32_t i)
{
    uint32_t reversed = 0;
    for (uint32_t bit = 1; bit < batch_size; bit *= 2) reversed = 2 * reversed + ((i & bit) != 0);
    return reversed;
}

/// Traces one batch, stratified in q.
void trace_batch(const GrainBody& body, uint64_t seed, uint64_t batch, Counts& counts, std::vector<Scattered>* recorded)
{
    DirectionCounts& directions = counts.directions[batch % 2];
    for (uint32_t i = 0; i < batch_size; ++i) {
        Sampler sampler(seed, static_cast<uint32_t>(batch), static_cast<uint32_t>(batch >> 32), i);
        const double q = (scattered_order(i) + sampler.next()) / batch_size;
        const double u1 = sampler.next(), u2 = sampler.next(), roll = 2 * pi * sampler.next();
        const V3d d = sample_sphere(u1, u2);
        const Frame frame(d);
        const V3d entry = std::sqrt(q) * (std::cos(roll) * frame.s + std::sin(roll) * frame.t) - std::sqrt(1 - q) * d;
        const GrainExit exit = walk_grain(body, entry, d, sampler);
        const auto bin = static_cast<size_t>(q * Gsdf::alpha_bins);
        if (exit.lost) {
            ++counts.lost;
            continue;
        }
        ++counts.paths[bin];
        if (exit.events == 0) {
            ++counts.missed[bin];
            continue;
        }
        const double cosine = exit.direction.dot(d);
        ++counts.scattered;
        counts.cosines += std::llround(cosine * 0x1p30);
        counts.squares += std::llround(cosine * cosine * 0x1p20);
        for (const bool back : {false, true}) {
            const Scattered s = back ? describe(exit.point, -exit.direction, entry, -d, exit)
                                     : describe(entry, d, exit.point, exit.direction, exit);
            ++directions[static_cast<size_t>(s.stratum) * Gsdf::cells + s.cell];
            if (recorded) recorded->push_back(s);
        }
    }
}

/// Turns a record so that it leaves along w.
GsdfRecord turned(const GsdfRecord& record, const V3d& w)
{
    const V3d from = record.direction.unpack();
    const V3d axis = from.cross(w);
    const double sine = axis.length(), cosine = from.dot(w);
    V3d p = record.point.unpack();
    if (sine > 0) { // Rodrigues
        const V3d n = axis / sine;
        p = cosine * p + sine * n.cross(p) + (1 - cosine) * n.dot(p) * n;
    }
    GsdfRecord result = record;
    result.point = PackedDirection(p);
    result.direction = PackedDirection(w);
    return result;
}

class Builder {
public:
    Builder(const GrainBody& body, const GsdfOptions& options, const Progress& progress)
        : body_{body.exemplar, lossless(body.material)}, options_(options), progress_(progress)
    {
    }

    std::shared_ptr<const Gsdf> build()
    {
        const Stopwatch watch;
        const uint64_t most_batches = std::max<uint64_t>(2, options_.most_paths / batch_size);
        uint64_t wanted = std::min(recorded_batches, most_batches);
        DensityFit fit;
        for (;;) {
            trace(wanted);
            fit = fit_density(lent_to_empty_strata(), stratum_mass(), fit.smoothing);
            if (fit.error <= options_.error || done_ >= most_batches) break;
            // Noise falls as 1 / sqrt(n), and the estimate's own uncertainty faster.
            const double ratio = std::clamp(std::pow(fit.error / options_.error, 1.6), 1.2, 2.5);
            wanted = std::min(most_batches, static_cast<uint64_t>(std::ceil(static_cast<double>(done_) * ratio)));
            stage_ = fmt::format("tracing grains, error {:.2g} % so far,", 100 * fit.error);
        }
        Gsdf::Data data;
        data.alpha0 = alpha0();
        data.density = std::move(fit.density);
        group_records(data);
        data.quality = quality(fit.error);
        data.quality.seconds = watch.seconds();
        return std::make_shared<const Gsdf>(std::move(data));
    }

private:
    void trace(uint64_t batches)
    {
        recorded_.resize(recorded_batches);
        tbb::enumerable_thread_specific<Counts> parts;
        std::atomic<uint64_t> finished{done_};
        tbb::parallel_for(done_, batches, [&](uint64_t batch) {
            if (progress_.cancelled()) return;
            flush_subnormals();
            trace_batch(body_, options_.seed, batch, parts.local(),
                        batch < recorded_batches ? &recorded_[batch] : nullptr);
            progress_.update(stage_, static_cast<double>(++finished) / static_cast<double>(batches));
        });
        if (progress_.cancelled()) throw Cancelled();
        for (const Counts& part : parts) counts_.add(part);
        done_ = batches;
    }

    /// The counts; a stratum in which no path met the grain gets those of the nearest stratum that has some, because
    /// rays between the two strata sample both.
    std::array<DirectionCounts, 2> lent_to_empty_strata()
    {
        std::array<DirectionCounts, 2> lent = counts_.directions;
        std::array<bool, Gsdf::strata> has{};
        for (uint32_t s = 0; s < Gsdf::strata; ++s) {
            const auto counted = [&](const DirectionCounts& counts) {
                const auto begin = counts.begin() + static_cast<std::ptrdiff_t>(s) * Gsdf::cells;
                return std::any_of(begin, begin + Gsdf::cells, [](uint64_t n) { return n > 0; });
            };
            has[s] = counted(counts_.directions[0]) && counted(counts_.directions[1]);
        }
        for (uint32_t s = 0; s < Gsdf::strata; ++s) {
            lender_[s] = s;
            for (uint32_t away = 1; away < Gsdf::strata && !has[lender_[s]]; ++away) {
                if (s >= away && has[s - away])
                    lender_[s] = s - away;
                else if (s + away < Gsdf::strata && has[s + away])
                    lender_[s] = s + away;
            }
            if (lender_[s] == s) continue;
            for (DirectionCounts& counts : lent) {
                const auto from = counts.begin() + static_cast<std::ptrdiff_t>(lender_[s]) * Gsdf::cells;
                std::copy(from, from + Gsdf::cells, counts.begin() + static_cast<std::ptrdiff_t>(s) * Gsdf::cells);
            }
        }
        return lent;
    }

    std::vector<float> alpha0() const
    {
        std::vector<float> alpha(Gsdf::alpha_bins);
        for (size_t i = 0; i < alpha.size(); ++i) {
            alpha[i] = static_cast<float>(static_cast<double>(counts_.missed[i]) /
                                          static_cast<double>(std::max<uint64_t>(1, counts_.paths[i])));
        }
        return alpha;
    }

    std::array<double, Gsdf::strata> stratum_mass() const
    {
        std::array<double, Gsdf::strata> mass{};
        uint64_t total = 0;
        for (size_t i = 0; i < Gsdf::alpha_bins; ++i) {
            const uint64_t met = counts_.paths[i] - counts_.missed[i];
            mass[i * Gsdf::strata / Gsdf::alpha_bins] += static_cast<double>(met);
            total += met;
        }
        for (double& m : mass) m /= static_cast<double>(std::max<uint64_t>(1, total));
        return mass;
    }

    /// Sorts records into cells; a cell with a density but no record gets the nearest record of its stratum, turned
    /// into the cell.
    void group_records(Gsdf::Data& data)
    {
        constexpr size_t all = static_cast<size_t>(Gsdf::strata) * Gsdf::cells;
        std::vector<std::vector<const Scattered*>> of_cell(all);
        for (const auto& batch : recorded_) {
            for (const Scattered& s : batch) {
                auto& cell = of_cell[static_cast<size_t>(s.stratum) * Gsdf::cells + s.cell];
                if (cell.size() < most_of_a_cell) cell.push_back(&s);
            }
        }
        const bool weighted = body_.material.kind == MaterialKind::conductor;
        data.first.assign(1, 0);
        for (uint32_t s = 0; s < Gsdf::strata; ++s) {
            const size_t begin = static_cast<size_t>(s) * Gsdf::cells,
                         lent = static_cast<size_t>(lender_[s]) * Gsdf::cells;
            for (uint32_t c = 0; c < Gsdf::cells; ++c) {
                for (const Scattered* found : of_cell[lent + c]) {
                    data.records.push_back(found->record);
                    if (weighted) data.weights.push_back(found->weight);
                }
                if (of_cell[lent + c].empty() && data.density[begin + c] > 0) {
                    const Scattered* near = nearest(of_cell, lender_[s], c);
                    const V3d centre = DirectionGrid::centre(c);
                    data.records.push_back(near ? turned(near->record, centre) : straight_back(centre));
                    if (weighted) data.weights.push_back(Imath::C3f(near ? near->weight : Color(1)));
                }
                data.first.push_back(static_cast<uint32_t>(data.records.size()));
            }
        }
        recorded_ = {};
    }

    static const Scattered* nearest(const std::vector<std::vector<const Scattered*>>& of_cell, uint32_t stratum,
                                    uint32_t cell)
    {
        const V3d centre = DirectionGrid::centre(cell);
        const Scattered* best = nullptr;
        double cosine = -2;
        for (uint32_t c = 0; c < Gsdf::cells; ++c) {
            const auto& candidates = of_cell[static_cast<size_t>(stratum) * Gsdf::cells + c];
            if (candidates.empty()) continue;
            const double at = DirectionGrid::centre(c).dot(centre);
            if (at <= cosine) continue;
            cosine = at;
            best = candidates.front();
        }
        return best;
    }
    /// For a grain that no path has met.
    static GsdfRecord straight_back(const V3d& w) { return {PackedDirection(w), PackedDirection(w), 0, 1}; }

    GsdfQuality quality(double error) const
    {
        GsdfQuality q;
        q.paths = done_ * batch_size;
        q.lost = counts_.lost;
        q.density_error = error;
        const auto n = static_cast<double>(std::max<int64_t>(1, counts_.scattered));
        q.mean_cosine = static_cast<double>(counts_.cosines) * 0x1p-30 / n;
        q.mean_cosine_error = std::sqrt(
            std::max(0.0, static_cast<double>(counts_.squares) * 0x1p-20 / n - q.mean_cosine * q.mean_cosine) / n);
        return q;
    }

    GrainBody body_;
    const GsdfOptions& options_;
    const Progress& progress_;
    std::string stage_ = "tracing grains";
    Counts counts_;
    std::vector<std::vector<Scattered>> recorded_; // by batch
    uint64_t done_ = 0; // batches
    std::array<uint32_t, Gsdf::strata> lender_{}; // the stratum whose counts each stratum uses: itself, if it has any
};

} // namespace

std::shared_ptr<const Gsdf> build_gsdf(const GrainBody& body, const GsdfOptions& options, const Progress& progress)
{
    return Builder(body, options, progress).build();
}

} // namespace scree
