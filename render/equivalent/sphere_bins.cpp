#include "render/equivalent/sphere_bins.h"

#include "base/error.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

namespace scree {

namespace {

constexpr uint32_t chunk = 1 << 14; ///< spheres per task; fixed, as the rounding of sums depends on it
constexpr int64_t farthest = int64_t{1} << 20;

uint64_t key_of(int64_t x, int64_t y, int64_t z)
{
    const auto part = [](int64_t k) { return static_cast<uint64_t>(k + farthest); };
    return part(x) << 42 | part(y) << 21 | part(z);
}

SphereBins::Voxel block_of(uint64_t key)
{
    const auto part = [key](int shift) {
        return static_cast<int64_t>(key >> shift & ((uint64_t{1} << 21) - 1)) - farthest;
    };
    return {part(42), part(21), part(0)};
}

int64_t divide_down(int64_t a, int64_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// Calls visit(x, y, z) for every block of a sphere.
template <class Visit>
void for_blocks(uint32_t sphere, int edge, const SphereBins::Range& range, const Visit& visit)
{
    SphereBins::Voxel first, last;
    if (!range(sphere, first, last)) return;
    for (size_t k = 0; k < 3; ++k) {
        first[k] = divide_down(first[k], edge);
        last[k] = divide_down(last[k], edge);
        if (first[k] < -farthest || last[k] >= farthest)
            throw InputError("grains",
                             fmt::format("grain {} (in order of the list) {} voxels from the middle of the scene",
                                         sphere, std::abs(first[k]) * edge),
                             fmt::format("at most {}", farthest * edge),
                             "is it a stray grain, or is the voxel too small?");
    }
    for (int64_t x = first[0]; x <= last[0]; ++x)
        for (int64_t y = first[1]; y <= last[1]; ++y)
            for (int64_t z = first[2]; z <= last[2]; ++z) visit(x, y, z);
}

} // namespace

double volume_weighted_radius(std::span<const GrainStore::Sphere> spheres, const FloatMargin& margin)
{
    struct Sums {
        double cubes = 0, fourths = 0;
    };
    // Powers of the radii could overflow or underflow, so the radii are scaled by a power of two near the largest.
    float largest = 0;
    for (const auto& s : spheres) largest = std::max(largest, s.r);
    if (!(largest > 0)) return 0;
    const int exponent = std::ilogb(largest);
    std::vector<Sums> parts((spheres.size() + chunk - 1) / chunk);
    tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
        const size_t end = std::min(spheres.size(), (part + 1) * chunk);
        for (size_t i = part * chunk; i < end; ++i) {
            const double r = std::ldexp(static_cast<double>(margin.narrow(spheres[i].r)), -exponent);
            parts[part].cubes += r * r * r;
            parts[part].fourths += r * r * r * r;
        }
    });
    Sums sums;
    for (const Sums& part : parts) {
        sums.cubes += part.cubes;
        sums.fourths += part.fourths;
    }
    return sums.cubes > 0 ? std::ldexp(sums.fourths / sums.cubes, exponent) : 0;
}

SphereBins::SphereBins(uint32_t count, int edge, const Range& range)
{
    const uint32_t chunks = count / chunk + (count % chunk > 0);
    const auto spheres_of = [&](uint32_t part) {
        return std::pair{part * chunk, part + 1 == chunks ? count : (part + 1) * chunk};
    };
    std::vector<uint64_t> starts(size_t{chunks} + 1, 0);
    tbb::parallel_for(uint32_t{0}, chunks, [&](uint32_t part) {
        const auto [begin, end] = spheres_of(part);
        uint64_t entries = 0;
        for (uint32_t i = begin; i < end; ++i)
            for_blocks(i, edge, range, [&](int64_t, int64_t, int64_t) { ++entries; });
        starts[part + 1] = entries;
    });
    for (uint32_t part = 0; part < chunks; ++part) starts[part + 1] += starts[part];
    entries_.resize(starts.back());
    tbb::parallel_for(uint32_t{0}, chunks, [&](uint32_t part) {
        const auto [begin, end] = spheres_of(part);
        uint64_t next = starts[part];
        for (uint32_t i = begin; i < end; ++i)
            for_blocks(i, edge, range, [&](int64_t x, int64_t y, int64_t z) {
                entries_[next++] = {key_of(x, y, z), i};
            });
    });
    tbb::parallel_sort(entries_.begin(), entries_.end());
    for (size_t begin = 0; begin < entries_.size();) {
        size_t end = begin;
        while (end < entries_.size() && entries_[end].key == entries_[begin].key) ++end;
        bins_.push_back({block_of(entries_[begin].key), std::span(entries_).subspan(begin, end - begin)});
        begin = end;
    }
}

} // namespace scree
