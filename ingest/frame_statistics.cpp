#include "ingest/frame_statistics.h"

#include "base/error.h"
#include "ingest/sphere_grid.h"

#include <Imath/ImathMatrix.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace scree {

namespace {

// A sphere of a real bed has a few hundred others in the cells around it. If there are more, the radii are wrong or
// grains lie on top of each other, and testing all pairs would take too long.
constexpr size_t most_candidates = 2048;

/// Periodic images: the box's edges along the axes that repeat.
class Periodicity {
public:
    explicit Periodicity(const std::optional<SimulationBox>& box)
    {
        if (!box || !(box->volume() > 0)) return;
        const auto& e = box->edges;
        const double volume = box->volume();
        for (size_t k = 0; k < 3; ++k) {
            const Imath::V3d normal = e[(k + 1) % 3].cross(e[(k + 2) % 3]);
            to_fraction_[k] = normal / (e[k].dot(normal));
            height_[k] = volume / normal.length();
            periodic_[k] = box->periodic[k];
            any_ = any_ || periodic_[k];
        }
        edges_ = e;
        lo_ = box->lo;
    }

    bool any() const { return any_; }

    /// The place's periodic image inside the box.
    Imath::V3d wrapped(Imath::V3d place) const
    {
        for (size_t k = 0; k < 3; ++k)
            if (periodic_[k]) place -= std::floor((place - lo_).dot(to_fraction_[k])) * edges_[k];
        return place;
    }

    /// Distance of the (wrapped) place from the nearest periodic face.
    double clearance(const Imath::V3d& place) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (size_t k = 0; k < 3; ++k) {
            if (!periodic_[k]) continue;
            const double depth = (place - lo_).dot(to_fraction_[k]) * height_[k];
            least = std::min({least, depth, height_[k] - depth});
        }
        return least;
    }

    /// The periodic shifts that bring the (wrapped) place into the box or within `reach` of it; the first shift is 0.
    void shifts(const Imath::V3d& place, double reach, std::vector<Imath::V3d>& out) const
    {
        out.assign(1, Imath::V3d(0));
        for (size_t k = 0; k < 3; ++k) {
            if (!periodic_[k]) continue;
            const double depth = (place - lo_).dot(to_fraction_[k]) * height_[k];
            const size_t count = out.size();
            for (size_t i = 0; i < count; ++i) {
                if (depth <= reach) out.push_back(out[i] + edges_[k]);
                if (height_[k] - depth <= reach) out.push_back(out[i] - edges_[k]);
            }
        }
    }

private:
    bool any_ = false;
    std::array<bool, 3> periodic_{false, false, false};
    std::array<Imath::V3d, 3> to_fraction_{Imath::V3d(0), Imath::V3d(0), Imath::V3d(0)}, edges_ = to_fraction_;
    std::array<double, 3> height_{0, 0, 0};
    Imath::V3d lo_{0};
};

struct Overlaps {
    double greatest = 0;
    uint64_t first = 0, second = 0; ///< indices of that pair, first <= second
    uint64_t pairs = 0;
    bool complete = true;

    void add(double overlap, uint64_t i, uint64_t j)
    {
        if (i > j) std::swap(i, j);
        // Of equal overlaps the pair with the lowest indices counts, so that the result does not depend on threads.
        const bool earlier = i != first ? i < first : j < second;
        if (overlap > greatest || (overlap == greatest && earlier)) {
            greatest = overlap;
            first = i;
            second = j;
        }
    }
    void join(const Overlaps& other)
    {
        if (other.pairs > 0) add(other.greatest, other.first, other.second);
        pairs += other.pairs;
        complete = complete && other.complete;
    }
};

/// The overlaps of the spheres begin..end of one level with spheres of the same level and of levels of larger spheres.
Overlaps overlaps_of(const SphereGrid& grid, const Periodicity& periodicity, size_t level, size_t begin, size_t end)
{
    Overlaps result;
    std::vector<Imath::V3d> shifts;
    std::vector<std::pair<uint64_t, double>> hits; // sphere, overlap
    for (size_t k = begin; k < end; ++k) {
        const SphereGrid::Entry& self = grid.entries(level)[k];
        if (!(self.radius > 0)) continue;
        hits.clear();
        size_t candidates = 0;
        const double clearance = periodicity.clearance(self.position);
        for (size_t other = level; other < grid.level_count(); ++other) {
            const double reach = self.radius + grid.level_radius(other);
            if (reach < clearance)
                shifts.assign(1, Imath::V3d(0));
            else
                periodicity.shifts(self.position, reach, shifts);
            for (size_t s = 0; s < shifts.size(); ++s) {
                const Imath::V3d place = self.position + shifts[s];
                const bool done = grid.visit_near(other, place, reach, [&](const SphereGrid::Entry& entry) {
                    if (++candidates > most_candidates) return false;
                    // Within a level the lower index tests the pair; a sphere also tests its own images, not itself.
                    if (other == level && (entry.index < self.index || (entry.index == self.index && s == 0)))
                        return true;
                    const double touch = double(self.radius) + double(entry.radius);
                    const double distance2 = (entry.position - place).length2();
                    if (distance2 >= touch * touch) return true;
                    const double overlap =
                        (touch - std::sqrt(distance2)) / std::min(double(self.radius), double(entry.radius));
                    if (overlap > 0) hits.emplace_back(entry.index, overlap);
                    return true;
                });
                result.complete = result.complete && done;
            }
        }
        // In a small box one pair may overlap through several images; it counts once.
        std::ranges::sort(hits);
        for (size_t i = 0; i < hits.size(); ++i) {
            if (i + 1 < hits.size() && hits[i + 1].first == hits[i].first) continue;
            ++result.pairs;
            result.add(hits[i].second, self.index, hits[i].first);
        }
    }
    return result;
}

Overlaps find_overlaps(const SphereGrid& grid, const Periodicity& periodicity, const Progress& progress)
{
    Overlaps all;
    for (size_t level = 0; level < grid.level_count(); ++level) {
        progress.update("find overlaps", double(level) / double(grid.level_count()));
        const size_t count = grid.entries(level).size();
        all.join(tbb::parallel_reduce(
            tbb::blocked_range<size_t>(0, count, 1024), Overlaps{},
            [&](const tbb::blocked_range<size_t>& range, Overlaps sum) {
                if (progress.cancelled()) return sum;
                sum.join(overlaps_of(grid, periodicity, level, range.begin(), range.end()));
                return sum;
            },
            [](Overlaps a, const Overlaps& b) {
                a.join(b);
                return a;
            }));
        if (progress.cancelled()) throw Cancelled();
    }
    return all;
}

uint64_t count_duplicates(const std::vector<Imath::V3d>& positions)
{
    std::vector<uint64_t> keys(positions.size());
    tbb::parallel_for(size_t{0}, positions.size(), [&](size_t i) {
        uint64_t h = 0;
        for (int axis = 0; axis < 3; ++axis) {
            // Adding 0 makes -0 into 0.
            h = (h ^ std::bit_cast<uint64_t>(positions[i][axis] + 0.0)) * 0x9e3779b97f4a7c15u;
            h ^= h >> 29;
        }
        keys[i] = h * 0xbf58476d1ce4e5b9u;
    });
    tbb::parallel_sort(keys.begin(), keys.end());
    uint64_t count = 0;
    for (size_t i = 1; i < keys.size(); ++i) count += keys[i] == keys[i - 1];
    return count;
}

/// The part of the box between the quartiles of the centres that lies inside spheres.
std::optional<double> measure_bed(const SphereGrid& grid, const std::vector<Imath::V3d>& positions)
{
    if (positions.size() < 1000) return std::nullopt;
    Imath::V3d lo, hi;
    std::vector<double> axis_values(positions.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(positions, axis_values.begin(), [&](const Imath::V3d& p) { return p[axis]; });
        const auto quartile = [&](size_t quarters) {
            const auto nth = axis_values.begin() + static_cast<std::ptrdiff_t>(axis_values.size() * quarters / 4);
            std::nth_element(axis_values.begin(), nth, axis_values.end());
            return *nth;
        };
        lo[axis] = quartile(1);
        hi[axis] = quartile(3);
        if (!(hi[axis] > lo[axis])) return std::nullopt;
    }

    constexpr uint64_t points = uint64_t{1} << 16;
    const uint64_t inside = tbb::parallel_reduce(
        tbb::blocked_range<uint64_t>(0, points), uint64_t{0},
        [&](const tbb::blocked_range<uint64_t>& range, uint64_t sum) {
            for (uint64_t i = range.begin(); i < range.end(); ++i) {
                // The R3 sequence (Roberts 2018): evenly spread, the same on every machine.
                constexpr std::array<double, 3> step{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
                Imath::V3d place;
                for (int axis = 0; axis < 3; ++axis) {
                    const double u = 0.5 + double(i + 1) * step[static_cast<size_t>(axis)];
                    place[axis] = lo[axis] + (u - std::floor(u)) * (hi[axis] - lo[axis]);
                }
                bool hit = false;
                size_t candidates = 0;
                for (size_t level = 0; level < grid.level_count() && !hit; ++level)
                    grid.visit_near(level, place, grid.level_radius(level), [&](const SphereGrid::Entry& entry) {
                        hit = (entry.position - place).length2() < double(entry.radius) * double(entry.radius);
                        return !hit && ++candidates < most_candidates;
                    });
                sum += hit;
            }
            return sum;
        },
        std::plus<uint64_t>());
    return double(inside) / double(points);
}

void measure_sizes(const ParticleFrame& frame, FrameStatistics& result)
{
    result.lo = result.hi = frame.position[0];
    result.radius_min = result.radius_max = frame.radius[0];
    double sum = 0, volume = 0;
    int32_t type = frame.type[0];
    uint64_t* count = &result.count_of_type[type];
    for (size_t i = 0; i < frame.size(); ++i) {
        const double r = frame.radius[i];
        sum += r;
        volume += r * r * r;
        result.radius_min = std::min(result.radius_min, r);
        result.radius_max = std::max(result.radius_max, r);
        if (frame.type[i] != type) {
            type = frame.type[i];
            count = &result.count_of_type[type];
        }
        ++*count;
        for (int axis = 0; axis < 3; ++axis) {
            result.lo[axis] = std::min(result.lo[axis], frame.position[i][axis]);
            result.hi[axis] = std::max(result.hi[axis], frame.position[i][axis]);
        }
    }
    result.radius_mean = sum / double(frame.size());
    if (frame.box && frame.box->volume() > 0)
        result.pack_rate = 4.0 / 3.0 * std::numbers::pi * volume / frame.box->volume();
}

} // namespace

FrameStatistics measure_frame(const ParticleFrame& frame, const Progress& progress)
{
    FrameStatistics result;
    result.particles = frame.size();
    if (frame.size() == 0) {
        if (frame.box && frame.box->volume() > 0) result.pack_rate = 0;
        return result;
    }
    measure_sizes(frame, result);
    result.duplicates = count_duplicates(frame.position);
    if (!(result.radius_max > 0)) return result;

    const Periodicity periodicity(frame.box);
    std::vector<Imath::V3d> wrapped;
    if (periodicity.any()) {
        wrapped.resize(frame.size());
        for (size_t i = 0; i < frame.size(); ++i) wrapped[i] = periodicity.wrapped(frame.position[i]);
    }
    const std::vector<Imath::V3d>& positions = periodicity.any() ? wrapped : frame.position;
    const SphereGrid grid(positions, frame.radius);
    const Overlaps overlaps = find_overlaps(grid, periodicity, progress);
    result.max_overlap = overlaps.greatest;
    result.overlapping_pairs = overlaps.pairs;
    result.overlaps_complete = overlaps.complete;
    if (overlaps.pairs > 0) result.max_overlap_ids = {{frame.id[overlaps.first], frame.id[overlaps.second]}};
    result.bed_pack_rate = measure_bed(grid, positions);
    return result;
}

} // namespace scree
