#include "render/stf/shell_maps.h"

#include "base/error.h"
#include "render/stf/shell_walk.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>

namespace scree {

namespace {

constexpr uint32_t side = DirectionMap::side;

/// From the disc to the square -1..1.
V2d to_square(double x, double y)
{
    const double r = std::hypot(x, y);
    if (r == 0) return V2d(0);
    double phi = std::atan2(y, x);
    if (phi < -pi / 4) phi += 2 * pi;
    const int quarter = std::min(3, static_cast<int>((phi + pi / 4) / (pi / 2)));
    const double across = r * (phi - quarter * (pi / 2)) / (pi / 4);
    switch (quarter) {
    case 0: return {r, across};
    case 1: return {-across, r};
    case 2: return {-r, -across};
    default: return {across, -r};
    }
}

V2d to_disc(double a, double b)
{
    if (a == 0 && b == 0) return V2d(0);
    const bool upright = std::abs(b) > std::abs(a);
    const double r = upright ? b : a, phi = upright ? pi / 2 - pi / 4 * a / b : pi / 4 * b / a;
    return {r * std::cos(phi), r * std::sin(phi)};
}

uint32_t step_of(double at) { return std::min(side - 1, static_cast<uint32_t>(std::max(0.0, 0.5 * (at + 1) * side))); }

/// What a block of walks counts.
struct Tally {
    std::array<std::array<uint64_t, DirectionMap::cells>, ShellMaps::rows> counts{};
    CosineDistance distance;
    double cosine = 0;

    void add(const ShellExit& exit)
    {
        const double x = exit.away, y = exit.across, squared = std::max(0.0, 1 - x * x - y * y);
        const auto row =
            std::min(ShellMaps::rows - 1, static_cast<uint32_t>(0.5 * (1 - double{exit.cos_t}) * ShellMaps::rows));
        ++counts[row][DirectionMap::cell(x, y)];
        distance.add(squared, 1);
        cosine += std::sqrt(squared);
    }
    void add(const Tally& other)
    {
        for (size_t row = 0; row < counts.size(); ++row) {
            for (size_t cell = 0; cell < counts[row].size(); ++cell) counts[row][cell] += other.counts[row][cell];
        }
        distance.add(other.distance);
        cosine += other.cosine;
    }
};

} // namespace

double CosineDistance::distance() const
{
    double sum = 0;
    for (uint32_t bin = 0; bin < bins; ++bin) sum += std::abs(share(bin) - 1.0 / bins);
    return sum;
}

double CosineDistance::noise() const
{
    // The error of each bin's share is nearly normal: its mean magnitude is sqrt(2 / pi) of its standard deviation.
    return weights_ > 0 ? std::sqrt(2 / pi * (bins - 1) * squares_) / weights_ : 0;
}

void CosineDistance::add(const CosineDistance& other)
{
    for (uint32_t bin = 0; bin < bins; ++bin) share_[bin] += other.share_[bin];
    weights_ += other.weights_;
    squares_ += other.squares_;
}

DirectionMap::DirectionMap(const std::array<uint64_t, cells>& counts)
{
    for (const uint64_t count : counts) count_ += count;
    if (count_ == 0) return;
    for (uint32_t i = 0; i < cells; ++i) {
        const uint32_t mirrored = (side - 1 - i / side) * side + i % side;
        density_[i] =
            0.5 * static_cast<double>(counts[i] + counts[mirrored]) / static_cast<double>(count_) * cells / pi;
    }
}

uint32_t DirectionMap::cell(double x, double y)
{
    const V2d at = to_square(x, y);
    return step_of(at.y) * side + step_of(at.x);
}

V2d DirectionMap::centre(uint32_t cell)
{
    return to_disc((cell % side + 0.5) * 2 / side - 1, (cell / side + 0.5) * 2 / side - 1);
}

double DirectionMap::density_at(double x, double y) const
{
    const V2d at = to_square(x, y);
    const auto between = [](double p, uint32_t& low, double& part) {
        const double place = std::clamp(0.5 * (p + 1) * side - 0.5, 0.0, side - 1.0);
        low = std::min(side - 2, static_cast<uint32_t>(place));
        part = place - low;
    };
    uint32_t i, j;
    double u, v;
    between(at.x, i, u);
    between(at.y, j, v);
    const double* low = &density_[j * side + i];
    const double* high = low + side;
    return (1 - v) * ((1 - u) * low[0] + u * low[1]) + v * ((1 - u) * high[0] + u * high[1]);
}

double DirectionMap::peak() const
{
    double peak = 0;
    for (uint32_t i = 0; i < cells; ++i) peak = std::max(peak, density_[i] * safe_sqrt(1 - centre(i).length2()));
    return peak * pi;
}

ShellMaps map_shell(const Stf& stf, size_t number, uint64_t walks, uint64_t seed, const Progress& progress)
{
    constexpr uint64_t blocks = 128; // fixed, so that the result does not depend on the number of threads
    constexpr uint32_t stream = 0x6d617073u;
    std::vector<ShellSampler> smaller;
    for (size_t i = 0; i < number; ++i) smaller.emplace_back(stf.shells[i], 1.0);
    std::vector<Tally> tallies(blocks);
    std::atomic<uint64_t> finished = 0;
    const std::string stage = fmt::format("directions at {:.3g} mean free paths", Stf::radius(number));
    progress.update(stage, 0);
    tbb::parallel_for(uint64_t{0}, blocks, [&](uint64_t block) {
        for (uint64_t i = walks * block / blocks; i < walks * (block + 1) / blocks; ++i) {
            if (i % 64 == 0 && progress.cancelled()) return;
            Sampler sampler(seed, static_cast<uint32_t>(i), static_cast<uint32_t>(number), stream);
            ShellWalk walk;
            do walk = walk_in_shell(stf.phase, Stf::radius(number), smaller, sampler);
            while (walk.exit.events < 2);
            tallies[block].add(walk.exit);
        }
        progress.update(stage, static_cast<double>(++finished) / blocks);
    });
    if (progress.cancelled()) throw Cancelled();
    for (uint64_t block = 1; block < blocks; ++block) tallies[0].add(tallies[block]);
    const Tally& all = tallies[0];
    ShellMaps maps{Stf::radius(number), walks, all.cosine / static_cast<double>(walks), all.distance, {}};
    for (uint32_t row = 0; row < ShellMaps::rows; ++row) maps.by_theta[row] = DirectionMap(all.counts[row]);
    return maps;
}

} // namespace scree
