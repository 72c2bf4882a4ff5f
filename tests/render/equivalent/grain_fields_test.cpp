#include "render/equivalent/grain_fields.h"

#include "base/error.h"
#include "render/equivalent/grain_field_grids.h"
#include "tests/builders/packings.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

namespace scree {
namespace {

struct Heap {
    std::vector<GrainStore::Sphere> spheres;
    std::vector<uint8_t> codes;

    void add(double x, double y, double z, double r, uint8_t code = 0)
    {
        spheres.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(r)});
        codes.push_back(code);
    }
    MomentDensity sum(int code = -1) const
    {
        MomentDensity m;
        for (size_t i = 0; i < spheres.size(); ++i) {
            if (code >= 0 && codes[i] != code) continue;
            const double r = spheres[i].r;
            m.m2 += r * r;
            m.m3 += r * r * r;
            m.m4 += r * r * r * r;
        }
        return m;
    }
};

GrainFields fields(const Heap& heap, const GrainFieldOptions& options = {})
{
    return make_grain_fields(heap.spheres, heap.codes, 200, options, Progress());
}

/// A lattice of cells of edge 2, each with a sphere of radius up to 1 somewhere in it.
Heap lattice(int edge, double smallest, uint32_t types, uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    Heap heap;
    for (int x = 0; x < edge; ++x)
        for (int y = 0; y < edge; ++y)
            for (int z = 0; z < edge; ++z) {
                const double r = smallest + (1 - smallest) * uniform(random), play = 2 - 2 * r;
                const V3d at(uniform(random), uniform(random), uniform(random));
                const auto code = static_cast<uint8_t>(3 * (random() % types));
                heap.add(2 * x - edge + r + play * at.x, 2 * y - edge + r + play * at.y, 2 * z - edge + r + play * at.z,
                         r, code);
            }
    return heap;
}

/// A repeated tile of equal spheres of radius 1, pushed apart: a block of a bed around the origin.
Heap bed(double fraction, int cells)
{
    const auto tile = push_apart(400, fraction, 1, 0.01, 5);
    const double edge = packing_edge(tile, fraction);
    Heap heap;
    for (const PackedSphere& s :
         repeat_packing(tile, edge, cells, tile.size() * static_cast<uint64_t>(cells * cells * cells)))
        heap.add(s.center.x, s.center.y, s.center.z, s.radius);
    return heap;
}

void expect_conserved(const Heap& heap, const GrainFields& f)
{
    double volume = 0;
    for (const uint8_t code : f.types()) {
        const MomentDensity is = f.totals(code), should = heap.sum(code);
        EXPECT_NEAR(is.m2 / should.m2, 1, 1e-6);
        EXPECT_NEAR(is.m3 / should.m3, 1, 1e-6);
        EXPECT_NEAR(is.m4 / should.m4, 1, 1e-6);
        volume += should.pack_rate();
    }
    EXPECT_NEAR(f.sphere_volume() / volume, 1, 1e-6);
}

double largest_pack_rate(const GrainFields& f)
{
    float largest = 0;
    for (auto value = f.grids().pack_rate->cbeginValueOn(); value; ++value) largest = std::max(largest, *value);
    return largest;
}

bool same(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b, double factor)
{
    if (a.activeVoxelCount() != b.activeVoxelCount()) return false;
    for (auto value = a.cbeginValueOn(); value; ++value)
        if (static_cast<float>(*value * factor) != b.tree().getValue(value.getCoord())) return false;
    return true;
}

TEST(GrainFields, ConserveAMillionSpheres)
{
    const Heap heap = lattice(100, 0.2, 3, 1);
    ASSERT_EQ(heap.spheres.size(), 1000000u);
    const GrainFields f = fields(heap);
    ASSERT_EQ(std::vector<uint8_t>(f.types().begin(), f.types().end()), (std::vector<uint8_t>{0, 3, 6}));
    expect_conserved(heap, f);
}

TEST(GrainFields, TellThePackRateInsideOfABed)
{
    const Heap heap = bed(0.6, 4);
    const GrainFields f = fields(heap);
    EXPECT_NEAR(f.voxel(), 2.5, 1e-6);
    expect_conserved(heap, f);
    EXPECT_LT(largest_pack_rate(f), 1);
    // The mean over a cube of the tile's size inside the bed is that of the tile; values at single points vary.
    const double edge = std::cbrt(400 * 4 * pi / 3 / 0.6);
    double sum = 0, squares = 0;
    const int n = 20;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z) {
                const double value = f.pack_rate(V3d(x + 0.5, y + 0.5, z + 0.5) * (edge / n));
                sum += value;
                squares += value * value;
            }
    const double mean = sum / (n * n * n), deviation = std::sqrt(squares / (n * n * n) - mean * mean);
    EXPECT_NEAR(mean, 0.6, 0.004);
    EXPECT_LT(deviation, 0.06);
    const MomentDensity at = f.moments(0, V3d(1, 2, 3));
    EXPECT_NEAR(at.m2 / at.m3, 1, 1e-6);
    EXPECT_NEAR(at.m4 / at.m3, 1, 1e-6);
    EXPECT_NEAR(at.pack_rate(), f.pack_rate(V3d(1, 2, 3)), 1e-6);
}

TEST(GrainFields, AreTheSameInAUnitThatIsAPowerOfTwo)
{
    const Heap heap = lattice(20, 0.1, 2, 2);
    Heap larger = heap;
    for (auto& s : larger.spheres) s = {s.x * 0x1p20f, s.y * 0x1p20f, s.z * 0x1p20f, s.r * 0x1p20f};
    const GrainFields a = fields(heap), b = fields(larger);
    EXPECT_EQ(a.voxel() * 0x1p20, b.voxel());
    EXPECT_TRUE(same(*a.grids().pack_rate, *b.grids().pack_rate, 1));
    ASSERT_EQ(b.grids().types.size(), 2u);
    for (size_t t = 0; t < 2; ++t) {
        EXPECT_TRUE(same(*a.grids().types[t].m2, *b.grids().types[t].m2, 0x1p-20));
        EXPECT_TRUE(same(*a.grids().types[t].m3, *b.grids().types[t].m3, 1));
        EXPECT_TRUE(same(*a.grids().types[t].m4, *b.grids().types[t].m4, 0x1p20));
    }
}

TEST(GrainFields, AreTheSameOnAnyNumberOfThreads)
{
    const Heap heap = lattice(40, 0.05, 2, 3);
    const GrainFields many = fields(heap);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const GrainFields alone = fields(heap);
    EXPECT_EQ(many.voxel(), alone.voxel());
    EXPECT_TRUE(same(*many.grids().pack_rate, *alone.grids().pack_rate, 1));
    EXPECT_TRUE(same(*many.grids().types[1].m4, *alone.grids().types[1].m4, 1));
}

TEST(GrainFields, FillASingleSphereOfManyVoxels)
{
    for (const double r : {0.3, 0.51, 0.74, 0.76, 1.0, 3.0, 20.0}) {
        Heap heap;
        heap.add(0.3, -0.4, 0.2, r, 7);
        const GrainFields f = fields(heap, {.voxel = 1});
        expect_conserved(heap, f);
        EXPECT_LT(largest_pack_rate(f), 1.02) << r;
        if (r < 3) continue;
        EXPECT_NEAR(f.pack_rate({0.3, -0.4, 0.2}), 1, 0.02) << r;
        EXPECT_NEAR(f.pack_rate({0.3 + r, -0.4, 0.2}), 0.5, 0.2) << r;
        EXPECT_EQ(f.pack_rate({0.3 + r + 2.6, -0.4, 0.2}), 0) << r;
        EXPECT_EQ(f.moments(6, {0.3, -0.4, 0.2}).m2, 0);
    }
}

TEST(GrainFields, TakeRadiiOfARatioOfAThousand)
{
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Heap heap;
    for (int i = 0; i < 100000; ++i) heap.add(uniform(random), uniform(random), uniform(random), 0.001, 1);
    heap.add(2.5, 0, 0, 1, 2);
    expect_conserved(heap, fields(heap));
    // The voxel fits the small spheres: the large sphere is spread from millions of points.
    const GrainFields fine = fields(heap, {.voxel = 0.02});
    expect_conserved(heap, fine);
    EXPECT_NEAR(fine.pack_rate({2.5, 0.3, 0.3}), 1, 0.01);
}

TEST(GrainFields, TakeStrayAndCoincidentSpheresAndNone)
{
    const GrainFields nothing = fields(Heap());
    EXPECT_EQ(nothing.voxel(), 0);
    EXPECT_EQ(nothing.pack_rate({1, 2, 3}), 0);
    EXPECT_EQ(nothing.sphere_volume(), 0);
    EXPECT_TRUE(nothing.types().empty());

    Heap heap = lattice(10, 0.9, 1, 5);
    const uint64_t bytes = fields(heap).bytes();
    heap.add(1e6, -1e6, 1e6, 1);
    for (int i = 0; i < 10; ++i) heap.add(30, 0, 0, 0.5);
    heap.add(3, 0, 0, 0);
    const GrainFields f = fields(heap);
    expect_conserved(heap, f);
    EXPECT_LT(f.bytes(), 3 * bytes + 1000000);
}

TEST(GrainFields, TakeTheMarginOffRadii)
{
    GrainStore store;
    Heap heap = lattice(10, 0.5, 1, 6);
    store.spheres = heap.spheres;
    store.spheres.emplace_back();
    store.type_codes = heap.codes;
    store.widen();
    ASSERT_NE(store.spheres[0].r, heap.spheres[0].r);
    const GrainFields f = make_grain_fields({store.spheres.data(), store.size()}, store.type_codes, 1,
                                            {.margin = store.margin}, Progress());
    EXPECT_EQ(f.voxel(), fields(heap).voxel());
    EXPECT_TRUE(same(*f.grids().pack_rate, *fields(heap).grids().pack_rate, 1));
}

TEST(GrainFields, RefuseWhatTheyCannotHold)
{
    Heap heap;
    heap.add(0, 0, 0, 1e-30);
    heap.add(1, 0, 0, 1e-30);
    EXPECT_THROW(fields(heap), InputError);
    Heap stray;
    stray.add(NAN, 0, 0, 1);
    EXPECT_THROW(fields(stray), InputError);
    Heap type;
    type.add(0, 0, 0, 1, 200);
    EXPECT_THROW(fields(type), InputError);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(make_grain_fields(lattice(5, 0.5, 1, 7).spheres, std::vector<uint8_t>(125), 1, {}, progress),
                 Cancelled);
}

} // namespace
} // namespace scree
