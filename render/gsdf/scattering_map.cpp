#include "render/gsdf/scattering_map.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/warp.h"
#include "render/embree/embree_device.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <span>

namespace scree {

namespace {

using Map = ScatteringMap;
using Counts = std::vector<uint64_t>; // rows * row_cells

constexpr uint32_t batch_size = 3 * 4096;
// Radii. Strata are up to 0.25 wide in cos beta_o, so nearer to the entry they can move an exit across it.
constexpr double near_entry = 0.3;

/// The azimuth of v about n_o from the plane of incidence, in -pi..pi; see Encounter.
double azimuth(const V3d& v, double sin_beta, double cos_beta)
{
    return std::atan2(v.y, cos_beta * v.x + sin_beta * v.z);
}

/// The bin of an angle among `bins` equal ones, the first centred on 0.
uint32_t bin(double angle, uint32_t bins)
{
    const int n = static_cast<int>(bins), nearest = static_cast<int>(std::floor(angle / (2 * pi) * n + 0.5));
    return static_cast<uint32_t>((nearest % n + n) % n);
}

struct Tally {
    std::array<Counts, 3> sets;
    std::array<std::array<uint64_t, Map::rows>, 3> paths{}, scattered{};

    Tally()
    {
        for (Counts& set : sets) set.resize(static_cast<size_t>(Map::rows) * Map::row_cells);
    }
    void add(const Tally& other)
    {
        for (size_t set = 0; set < 3; ++set) {
            for (size_t i = 0; i < sets[set].size(); ++i) sets[set][i] += other.sets[set][i];
            for (size_t row = 0; row < Map::rows; ++row) {
                paths[set][row] += other.paths[set][row];
                scattered[set][row] += other.scattered[set][row];
            }
        }
    }
};

/// Traces one batch, whose paths serve the rows and sets in turn.
void trace_batch(const GrainBody& body, uint64_t seed, uint64_t batch, Tally& tally)
{
    for (uint32_t i = 0; i < batch_size; ++i) {
        Sampler sampler(seed, static_cast<uint32_t>(batch), static_cast<uint32_t>(batch >> 32), i);
        const uint32_t row = i % Map::rows, set = i / Map::rows % 3;
        const double low = Map::lowest_q(row), q = low + sampler.next() * (Map::highest_q(row) - low);
        const double u1 = sampler.next(), u2 = sampler.next(), roll = 2 * pi * sampler.next();
        const V3d d = sample_sphere(u1, u2);
        const Frame frame(d);
        const V3d entry = std::sqrt(q) * (std::cos(roll) * frame.s + std::sin(roll) * frame.t) - std::sqrt(1 - q) * d;
        const GrainExit exit = walk_grain(body, entry, d, sampler);
        if (exit.lost) continue;
        ++tally.paths[set][row];
        if (exit.events == 0) continue;
        ++tally.scattered[set][row];
        const Encounter encounter(entry, d);
        const uint32_t cell = Map::cell_of(q, encounter.to_local(exit.point), encounter.to_local(exit.direction));
        ++tally.sets[set][static_cast<size_t>(row) * Map::row_cells + cell];
    }
}

/// The map of one set, or of two together.
Map map_of(const Tally& tally, const std::vector<size_t>& sets)
{
    Map map;
    double total = 0;
    for (uint32_t row = 0; row < Map::rows; ++row) {
        double paths = 0, scattered = 0;
        for (const size_t set : sets) {
            paths += static_cast<double>(tally.paths[set][row]);
            scattered += static_cast<double>(tally.scattered[set][row]);
            for (size_t i = Map::index(row, 0, 0); i < Map::index(row + 1, 0, 0); ++i)
                map.mass[i] += static_cast<double>(tally.sets[set][i]);
        }
        for (size_t i = Map::index(row, 0, 0); i < Map::index(row + 1, 0, 0) && scattered > 0; ++i)
            map.mass[i] /= scattered;
        if (paths > 0) map.row_mass[row] = scattered / paths * (Map::highest_q(row) - Map::lowest_q(row));
        total += map.row_mass[row];
    }
    for (double& mass : map.row_mass) mass = total > 0 ? mass / total : 0;
    return map;
}

/// Adds the distribution that the GSDF samples at impact q, with total weight `weight`.
void add_impact(const Gsdf& gsdf, double q, double weight, std::span<double> row)
{
    const double low = q * Gsdf::strata - 0.5, fraction = low - std::floor(low);
    for (const bool next : {false, true}) {
        const double share = weight * (next ? fraction : 1 - fraction);
        const uint32_t stratum = Gsdf::stratum(q, next ? 1 : 0); // the lower and the upper one
        if (!(share > 0)) continue;
        for (uint32_t c = 0; c < Gsdf::cells; ++c) {
            const double mass = gsdf.cell_mass(stratum, c);
            if (!(mass > 0)) continue;
            const auto records = gsdf.records(stratum, c);
            const double each = share * mass / static_cast<double>(records.size());
            for (const GsdfRecord& record : records)
                row[Map::cell_of(q, record.point.unpack(), record.direction.unpack())] += each;
        }
    }
}

} // namespace

double ScatteringMap::lowest_q(uint32_t row)
{
    const double cosine = (row + 1.0) / rows;
    return 1 - cosine * cosine;
}

double ScatteringMap::highest_q(uint32_t row)
{
    const double cosine = static_cast<double>(row) / rows;
    return 1 - cosine * cosine;
}

uint32_t ScatteringMap::cell_of(double q, const V3d& point, const V3d& w)
{
    const double b = std::sqrt(q), c = safe_sqrt(1 - q);
    const V3d normal(-b, 0, c), entry = -normal;
    const double delta = azimuth(w, b, c);
    const double of_exit = (point - entry).length2() < near_entry * near_entry ? 0 : azimuth(point, b, c);
    const double beta = std::acos(std::clamp(normal.dot(w), -1.0, 1.0));
    const uint32_t of_beta = std::min(polar - 1, static_cast<uint32_t>(beta / pi * polar));
    return bin(-of_exit, turns) * directions + of_beta * azimuths + bin(delta, azimuths);
}

double ScatteringMap::solid_angle_share(uint32_t direction)
{
    const double low = pi * (direction / azimuths) / polar, high = pi * (direction / azimuths + 1) / polar;
    return 0.5 * (std::cos(low) - std::cos(high)) / azimuths;
}

std::vector<double> ScatteringMap::direction_mass() const
{
    std::vector<double> sums(static_cast<size_t>(rows) * directions);
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t turn = 0; turn < turns; ++turn) {
            for (uint32_t d = 0; d < directions; ++d)
                sums[static_cast<size_t>(row) * directions + d] += mass[index(row, turn, d)];
        }
    }
    return sums;
}

BruteForceMaps brute_force_maps(const GrainBody& body, uint64_t paths, uint64_t seed, const Progress& progress)
{
    const GrainBody pure{body.exemplar, lossless(body.material)};
    const uint64_t batches = std::max<uint64_t>(1, (paths + batch_size - 1) / batch_size);
    const uint64_t own_seed = mix64(seed ^ 0x62727574652d6634ull); // unlike any seed one would choose for a GSDF
    tbb::enumerable_thread_specific<Tally> parts;
    std::atomic<uint64_t> finished{0};
    tbb::parallel_for(uint64_t{0}, batches, [&](uint64_t batch) {
        if (progress.cancelled()) return;
        flush_subnormals();
        trace_batch(pure, own_seed, batch, parts.local());
        progress.update("brute force for the figure", static_cast<double>(++finished) / static_cast<double>(batches));
    });
    if (progress.cancelled()) throw Cancelled();
    Tally tally;
    for (const Tally& part : parts) tally.add(part);
    return {{map_of(tally, {0}), map_of(tally, {1})}, map_of(tally, {0, 1}), map_of(tally, {2}), batches * batch_size};
}

ScatteringMap map_of_gsdf(const Gsdf& gsdf)
{
    Map map;
    std::array<double, Map::rows> met{};
    tbb::parallel_for(0u, Map::rows, [&](uint32_t row) {
        const double low = Map::lowest_q(row), width = Map::highest_q(row) - low;
        const int impacts = std::max(8, static_cast<int>(std::ceil(4 * width * Gsdf::strata)));
        const std::span<double> cells(map.mass.data() + Map::index(row, 0, 0), Map::row_cells);
        for (int i = 0; i < impacts; ++i) {
            const double q = low + (i + 0.5) / impacts * width, weight = (1 - gsdf.alpha0(q)) * width / impacts;
            add_impact(gsdf, q, weight, cells);
            met[row] += weight;
        }
        for (double& mass : cells) mass = met[row] > 0 ? mass / met[row] : 0;
    });
    double total = 0;
    for (const double m : met) total += m;
    for (uint32_t row = 0; row < Map::rows; ++row) map.row_mass[row] = total > 0 ? met[row] / total : 0;
    return map;
}

} // namespace scree
