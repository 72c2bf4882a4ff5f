#include "ingest/frame_statistics.h"

#include "base/error.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

namespace scree {
namespace {

ParticleFrame frame_of(std::vector<Imath::V3d> positions, std::vector<float> radii)
{
    ParticleFrame frame;
    frame.position = std::move(positions);
    frame.radius = std::move(radii);
    frame.type.assign(frame.size(), 1);
    for (size_t i = 0; i < frame.size(); ++i) frame.id.push_back(100 + i);
    return frame;
}

SimulationBox box_of(const Imath::V3d& lo, const Imath::V3d& a, const Imath::V3d& b, const Imath::V3d& c,
                     std::array<bool, 3> periodic)
{
    SimulationBox box;
    box.lo = lo;
    box.edges = {a, b, c};
    box.periodic = periodic;
    return box;
}

struct BruteForce {
    double greatest = 0;
    uint64_t pairs = 0;
};

/// Overlaps by testing all pairs over all 27 images.
BruteForce brute_force(const ParticleFrame& frame)
{
    BruteForce result;
    const auto range = [&](size_t axis) { return frame.box && frame.box->periodic[axis] ? 1 : 0; };
    for (size_t i = 0; i < frame.size(); ++i)
        for (size_t j = i; j < frame.size(); ++j) {
            const double ri = frame.radius[i], rj = frame.radius[j];
            if (!(ri > 0) || !(rj > 0)) continue;
            double overlap = 0;
            for (int u = -range(0); u <= range(0); ++u)
                for (int v = -range(1); v <= range(1); ++v)
                    for (int w = -range(2); w <= range(2); ++w) {
                        if (i == j && u == 0 && v == 0 && w == 0) continue;
                        Imath::V3d d = frame.position[i] - frame.position[j];
                        if (frame.box)
                            d += double(u) * frame.box->edges[0] + double(v) * frame.box->edges[1] +
                                 double(w) * frame.box->edges[2];
                        overlap = std::max(overlap, (ri + rj - d.length()) / std::min(ri, rj));
                    }
            if (overlap > 0) ++result.pairs;
            result.greatest = std::max(result.greatest, overlap);
        }
    return result;
}

void expect_as_brute_force(const ParticleFrame& frame)
{
    const FrameStatistics statistics = measure_frame(frame);
    const BruteForce expected = brute_force(frame);
    EXPECT_EQ(statistics.overlapping_pairs, expected.pairs);
    EXPECT_NEAR(statistics.max_overlap, expected.greatest, 1e-9 * (1 + expected.greatest));
    EXPECT_EQ(statistics.max_overlap_ids.has_value(), expected.pairs > 0);
    EXPECT_TRUE(statistics.overlaps_complete);
}

TEST(FrameStatistics, SizesTypesAndPackRate)
{
    ParticleFrame frame = frame_of({{1, 1, 1}, {3, 3, 3}, {1, 3, 1}}, {0.5f, 1.0f, 0.0f});
    frame.type = {1, 5, 1};
    frame.box = box_of({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {false, false, false});
    const FrameStatistics statistics = measure_frame(frame);
    EXPECT_EQ(statistics.particles, 3u);
    EXPECT_EQ(statistics.radius_min, 0);
    EXPECT_EQ(statistics.radius_max, 1);
    EXPECT_EQ(statistics.radius_mean, 0.5);
    EXPECT_EQ(statistics.count_of_type, (std::map<int32_t, uint64_t>{{1, 2}, {5, 1}}));
    EXPECT_NEAR(*statistics.pack_rate, 4.0 / 3.0 * std::numbers::pi * 1.125 / 64, 1e-12);
    EXPECT_EQ(statistics.max_overlap, 0);
    EXPECT_FALSE(statistics.max_overlap_ids);
    EXPECT_EQ(statistics.lo, Imath::V3d(1, 1, 1));
    EXPECT_EQ(statistics.hi, Imath::V3d(3, 3, 3));
}

TEST(FrameStatistics, EmptyFrameAndNoBox)
{
    EXPECT_EQ(measure_frame(frame_of({}, {})).particles, 0u);
    EXPECT_FALSE(measure_frame(frame_of({{0, 0, 0}}, {1})).pack_rate);
}

TEST(FrameStatistics, OneOverlapIsMeasuredInSmallerRadii)
{
    const FrameStatistics statistics =
        measure_frame(frame_of({{0, 0, 0}, {10, 0, 0}, {11.75f, 0, 0}, {-3, 0, 0}}, {1, 1.5f, 0.5f, 2}));
    // 1 and 3 just touch: no overlap. 1.5 + 0.5 - 1.75 = 0.25 of 0.5.
    EXPECT_EQ(statistics.overlapping_pairs, 1u);
    EXPECT_DOUBLE_EQ(statistics.max_overlap, 0.5);
    EXPECT_EQ(*statistics.max_overlap_ids, (std::array<uint64_t, 2>{101, 102}));
}

class RandomFrames : public testing::TestWithParam<int> {
protected:
    std::mt19937_64 random_{static_cast<uint64_t>(GetParam())};
    double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }

    ParticleFrame make(size_t count, double extent, double least, double greatest)
    {
        std::vector<Imath::V3d> positions;
        std::vector<float> radii;
        for (size_t i = 0; i < count; ++i) {
            positions.emplace_back(uniform(0, extent), uniform(0, extent), uniform(0, extent));
            radii.push_back(static_cast<float>(least * std::pow(greatest / least, uniform(0, 1))));
        }
        return frame_of(positions, radii);
    }
};
INSTANTIATE_TEST_SUITE_P(Seeds, RandomFrames, testing::Range(0, 6));

TEST_P(RandomFrames, EqualSizes) { expect_as_brute_force(make(400, 10, 0.5, 0.5)); }

TEST_P(RandomFrames, SizesOverSixDecades)
{
    ParticleFrame frame = make(600, 10, 1e-6, 1);
    for (size_t i = 0; i < 20; ++i) frame.radius[i * 7] = 0;
    // Small spheres are put near large ones; otherwise hardly any pair would overlap.
    for (size_t i = 0; i < 200; ++i)
        frame.position[i] = frame.position[i + 200] + Imath::V3d(frame.radius[i + 200] + 0.5 * frame.radius[i], 0, 0);
    expect_as_brute_force(frame);
}

TEST_P(RandomFrames, FarFromTheOriginAndWithOutliers)
{
    ParticleFrame frame = make(300, 10, 0.1, 1);
    for (Imath::V3d& p : frame.position) p += Imath::V3d(1e7, -1e7, 1e7);
    frame.position[5] = {1e30, 0, 0};
    frame.position[6] = {1e30, 0, 0};
    frame.position[7] = {-1e35, 1e35, 1};
    expect_as_brute_force(frame);
}

TEST_P(RandomFrames, PeriodicBox)
{
    ParticleFrame frame = make(300, 10, 0.1, 1);
    frame.box = box_of({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {true, GetParam() % 2 == 0, true});
    expect_as_brute_force(frame);
}

TEST_P(RandomFrames, PeriodicTiltedBox)
{
    ParticleFrame frame = make(300, 1, 0.1, 1);
    frame.box = box_of({5, -3, 1}, {10, 0, 0}, {3, 9, 0}, {-4, 2, 8}, {true, true, GetParam() % 2 == 0});
    const auto& e = frame.box->edges;
    for (Imath::V3d& p : frame.position) p = frame.box->lo + p.x * e[0] + p.y * e[1] + p.z * e[2];
    expect_as_brute_force(frame);
}

TEST_P(RandomFrames, SmallPeriodicBoxOfLargeSpheres)
{
    // Pairs overlap through several images, and spheres overlap their own images.
    ParticleFrame frame = make(5, 2, 0.5, 1.5);
    frame.box = box_of({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {true, true, true});
    expect_as_brute_force(frame);
}

TEST(FrameStatistics, UnwrappedPlacesAreWrapped)
{
    ParticleFrame frame = frame_of({{0.5, 5, 5}, {109.75, 5, -5}}, {1, 1});
    frame.box = box_of({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {true, true, true});
    const FrameStatistics statistics = measure_frame(frame);
    EXPECT_EQ(statistics.overlapping_pairs, 1u);
    EXPECT_NEAR(statistics.max_overlap, 2 - 0.75, 1e-12);
}

TEST(FrameStatistics, CoincidentAndSizelessGrains)
{
    ParticleFrame frame = frame_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {-0.0, 0, 0}, {0, 0, 0}}, {0.5f, 0.25f, 0, 0, 0});
    const FrameStatistics statistics = measure_frame(frame);
    EXPECT_EQ(statistics.duplicates, 3u);
    EXPECT_EQ(statistics.overlapping_pairs, 1u);
    EXPECT_DOUBLE_EQ(statistics.max_overlap, 3);
    EXPECT_EQ(measure_frame(frame_of({{0, 0, 0}, {0, 0, 0}}, {0, 0})).overlapping_pairs, 0u);
}

TEST(FrameStatistics, AHundredThousandGrainsInOnePlaceEnd)
{
    const FrameStatistics statistics =
        measure_frame(frame_of(std::vector<Imath::V3d>(100000, {1, 2, 3}), std::vector<float>(100000, 1.0f)));
    EXPECT_FALSE(statistics.overlaps_complete);
    EXPECT_EQ(statistics.duplicates, 99999u);
    EXPECT_DOUBLE_EQ(statistics.max_overlap, 2);
}

TEST(FrameStatistics, BedPackRateOfALattice)
{
    std::vector<Imath::V3d> positions;
    for (int x = 0; x < 21; ++x)
        for (int y = 0; y < 21; ++y)
            for (int z = 0; z < 21; ++z) positions.emplace_back(x, y, z);
    const FrameStatistics statistics = measure_frame(frame_of(positions, std::vector<float>(positions.size(), 0.5f)));
    // The middle of the bed goes from lattice plane to lattice plane: whole cells of a simple cubic packing.
    EXPECT_NEAR(*statistics.bed_pack_rate, std::numbers::pi / 6, 4 * 0.002);
    EXPECT_EQ(statistics.overlapping_pairs, 0u);
}

TEST(FrameStatistics, SameOnAnyNumberOfThreads)
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(0, 20);
    std::vector<Imath::V3d> positions(20000);
    for (Imath::V3d& p : positions) p = {place(random), place(random), place(random)};
    const ParticleFrame frame = frame_of(positions, std::vector<float>(positions.size(), 0.5f));
    const FrameStatistics many = measure_frame(frame);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const FrameStatistics single = measure_frame(frame);
    EXPECT_EQ(single.max_overlap, many.max_overlap);
    EXPECT_EQ(single.max_overlap_ids, many.max_overlap_ids);
    EXPECT_EQ(single.overlapping_pairs, many.overlapping_pairs);
    EXPECT_EQ(single.bed_pack_rate, many.bed_pack_rate);
}

TEST(FrameStatistics, CanBeCancelled)
{
    Progress progress;
    progress.cancel();
    EXPECT_THROW(measure_frame(frame_of({{0, 0, 0}}, {1}), progress), Cancelled);
}

} // namespace
} // namespace scree
