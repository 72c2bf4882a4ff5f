// The spheres of a fill are the spheres of the repeated tile that lie wholly in the domain, each once, for any caller
// and any order of calls.

#include "packing/fill/list_fill.h"

#include "base/hash.h"
#include "ingest/frame_statistics.h"
#include "ingest/particles/vdb_point_stream.h"
#include "ingest/particles/vdb_points.h"
#include "packing/tiles/tile_generator.h"
#include "tests/builders/shapes.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>

#include <map>

namespace scree {
namespace {

using Imath::V3d;

std::shared_ptr<const PackingTile> make_test_tile(double fraction, const V3d& size = V3d(1))
{
    std::vector<double> radii;
    for (int i = 0; i < 200; ++i) radii.push_back(i % 3 == 0 ? 1.4 : 1.0);
    TileOptions options;
    options.fraction = fraction;
    options.variants = 3;
    options.size = size;
    return std::make_shared<const PackingTile>(make_tile(radii, options, {}).tile);
}

std::shared_ptr<const Domain> make_domain(double scale, const V3d& at)
{
    TriangleMesh mesh = cube();
    const TriangleMesh ball = icosphere(3);
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (V3d& p : mesh.positions) p *= 1.5;
    for (const V3d& p : ball.positions) mesh.positions.push_back(p + V3d(4, 0.5, 0.25)); // and a ball beside the cube
    for (auto t : ball.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (V3d& p : mesh.positions) p = at + scale * p;
    return std::make_shared<const Domain>(std::move(mesh), "cube and ball");
}

ParticleFrame list(const ProceduralFill& fill, uint64_t batch = uint64_t{1} << 40)
{
    ParticleFrame all;
    list_fill(fill, batch,
              [&](const ParticleFrame& frame) {
                  all.position.insert(all.position.end(), frame.position.begin(), frame.position.end());
                  all.radius.insert(all.radius.end(), frame.radius.begin(), frame.radius.end());
                  all.type.insert(all.type.end(), frame.type.begin(), frame.type.end());
                  all.id.insert(all.id.end(), frame.id.begin(), frame.id.end());
              },
              {});
    all.has_ids = true;
    return all;
}

TEST(ProceduralFill, HasExactlyTheWholeSpheresOfTheRepeatedTile)
{
    const auto domain = make_domain(1, V3d(7, -3, 2));
    const auto tile = make_test_tile(0.45, V3d(1, 1.5, 0.8));
    const ProceduralFill fill(domain, tile, {0.11, 3});
    const ParticleFrame all = list(fill);
    std::map<uint64_t, V3d> listed;
    for (size_t i = 0; i < all.size(); ++i)
        ASSERT_TRUE(listed.emplace(all.id[i], all.position[i]).second) << "twice " << all.id[i];

    // Every sphere of every numbered cell, tested with the domain alone.
    uint64_t whole = 0;
    for (uint64_t cell = 0; cell < fill.cell_count(); ++cell) {
        for (uint64_t row = 0; row < tile->rows(); ++row) {
            const auto sphere = fill.sphere(fill.id(cell, row));
            const bool inside = domain->contains_sphere(sphere.centre, sphere.radius);
            whole += inside;
            ASSERT_EQ(listed.count(fill.id(cell, row)), inside ? 1u : 0u);
        }
    }
    EXPECT_EQ(whole, listed.size());
    EXPECT_GT(whole, 500u);
    // Since only whole spheres count, part of the boundary is empty: less than a layer of one diameter.
    EXPECT_LT(static_cast<double>(whole), fill.expected_count());
    EXPECT_GT(static_cast<double>(whole), 0.6 * fill.expected_count());

    // The list is a packing: variants fit beside each other across every face, edge and corner.
    const FrameStatistics statistics = measure_frame(all);
    EXPECT_LE(statistics.max_overlap, 1e-6) << statistics.max_overlap_ids.value_or(std::array<uint64_t, 2>{})[0];
    EXPECT_EQ(statistics.duplicates, 0u);
}

TEST(ProceduralFill, EveryVariantStandsSomewhere)
{
    const ProceduralFill fill(make_domain(1, V3d(0)), make_test_tile(0.3), {0.05, 3});
    std::map<uint32_t, int> met;
    for (uint64_t cell = 0; cell < fill.cell_count(); ++cell) ++met[fill.variant(cell)];
    ASSERT_EQ(met.size(), 3u);
    // Cells are independent: chi-square with 2 degrees of freedom, 13.8 at p = 0.001.
    double chi2 = 0;
    const double expected = static_cast<double>(fill.cell_count()) / 3;
    for (const auto& [variant, count] : met) chi2 += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi2, 13.8);
    EXPECT_GT(fill.cell_count(), 300u);
}

TEST(ProceduralFill, CellsAndIdsGoBackAndForth)
{
    const ProceduralFill fill(make_domain(1, V3d(0)), make_test_tile(0.3), {0.05, 3});
    for (uint64_t cell = 0; cell < fill.cell_count(); cell += 7) {
        const FillCell c = fill.cell(cell);
        ASSERT_TRUE(fill.has(c));
        ASSERT_EQ(fill.number(c), cell);
        const auto sphere = fill.sphere(fill.id(cell, 11));
        const FillCell owner = fill.cell_at(fill.to_lattice(sphere.centre - fill.origin()));
        ASSERT_TRUE(owner.x == c.x && owner.y == c.y && owner.z == c.z);
    }
    EXPECT_FALSE(fill.has({1000, 0, 0}));
    EXPECT_FALSE(fill.has({0, -1000, 0}));
}

TEST(ProceduralFill, KindsOfCellsNeverLie)
{
    const auto domain = make_domain(1, V3d(0));
    const auto tile = make_test_tile(0.3);
    const ProceduralFill fill(domain, tile, {0.03, 3});
    uint64_t inside = 0, outside = 0;
    for (uint64_t cell = 0; cell < fill.cell_count(); ++cell) {
        const auto kind = fill.kind(cell);
        inside += kind == ProceduralFill::CellKind::inside;
        outside += kind == ProceduralFill::CellKind::outside;
        if (kind == ProceduralFill::CellKind::boundary) continue;
        for (uint64_t row = cell % 5; row < tile->rows(); row += 5) {
            const auto sphere = fill.sphere(fill.id(cell, row));
            ASSERT_EQ(domain->contains_sphere(sphere.centre, sphere.radius), kind == ProceduralFill::CellKind::inside);
        }
    }
    EXPECT_GT(inside, 10u);
    EXPECT_GT(outside, 10u);
}

TEST(ProceduralFill, IsTheSameAtAnyScaleOfTwo)
{
    const auto tile = make_test_tile(0.4);
    const ParticleFrame one = list(ProceduralFill(make_domain(1, V3d(0.3, 0.2, 0.7)), tile, {0.11, 3}));
    for (const int exponent : {-40, 40}) {
        const double scale = std::ldexp(1, exponent);
        const ParticleFrame other =
            list(ProceduralFill(make_domain(scale, scale * V3d(0.3, 0.2, 0.7)), tile, {0.11 * scale, 3}));
        ASSERT_EQ(other.id, one.id);
        for (size_t i = 0; i < one.size(); ++i) {
            ASSERT_EQ(other.position[i], scale * one.position[i]);
            ASSERT_EQ(other.radius[i], static_cast<float>(scale) * one.radius[i]);
        }
    }
}

TEST(ProceduralFill, IsTheSameWrittenInPartsAndReadBack)
{
    const test::TemporaryFolder folder;
    const auto domain = make_domain(1, V3d(1e4, -0.3, 0.1));
    const ProceduralFill fill(domain, make_test_tile(0.4), {0.06, 3});
    const ParticleFrame all = list(fill);
    VdbPointStream stream(folder.path("fill.vdb"), fill.voxel());
    int parts = 0;
    list_fill(fill, 300,
              [&](const ParticleFrame& frame) {
                  stream.add(frame);
                  ++parts;
              },
              {});
    stream.finish();
    EXPECT_GT(parts, 5);
    const ParticleFrame back = read_vdb_points(folder.path("fill.vdb"));
    EXPECT_EQ(back.id, all.id);
    EXPECT_EQ(back.position, all.position) << "to the bit";
    EXPECT_EQ(back.radius, all.radius);
    EXPECT_EQ(back.type, all.type);
    EXPECT_EQ(back.origin, fill.origin());
    ASSERT_TRUE(back.domain);
    EXPECT_EQ(back.domain->min, domain->bounds().min);
    EXPECT_EQ(back.domain->max, domain->bounds().max);
}

TEST(ProceduralFill, OfTooManySpheresToCountIsRefused)
{
    try {
        const ProceduralFill fill(make_domain(1, V3d(0)), make_test_tile(0.4), {1e-9, 3});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("1e-09"));
        EXPECT_THAT(error.hint(), testing::HasSubstr("unit of the mesh"));
    }
}

} // namespace
} // namespace scree
