#include "ingest/particles/vdb_points.h"
#include "packing/tiles/packing_tile.h"
#include "packing/tiles/tile_generator.h"
#include "packing/tiles/tile_sizes.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

namespace scree {
namespace {

using testing::HasSubstr;

const PackingTile& good_tile()
{
    static const PackingTile tile = [] {
        TileOptions options;
        options.size = {1, 1.5, 1};
        options.fraction = 0.5;
        options.sweeps = 50;
        options.variants = 3;
        return make_tile(draw_tile_radii(parse_tile_sizes({"lognormal"}), 300, 1), options, {}).tile;
    }();
    return tile;
}

class TileFile : public testing::Test {
protected:
    std::string path() { return folder_.path("tile.vdb").string(); }

    /// The error of reading grids that are the good tile's grids changed by `damage`.
    std::string error_of(const std::function<void(std::vector<NamedPoints>&)>& damage)
    {
        std::vector<NamedPoints> grids;
        for (size_t v = 0; v < 3; ++v)
            grids.push_back({v == 0 ? "points" : "variant_" + std::to_string(v), tile_frame(good_tile(), v)});
        damage(grids);
        write_vdb_points(grids, path());
        const auto error = test::input_error_of([&] { read_tile(path()); });
        return error ? std::string(error->what()) : "none";
    }

    test::TemporaryFolder folder_;
};

TEST_F(TileFile, RoundTrip)
{
    const PackingTile& tile = good_tile();
    write_tile(tile, path());
    const PackingTile back = read_tile(path());
    EXPECT_EQ(back.size, tile.size);
    EXPECT_EQ(back.radius, tile.radius);
    EXPECT_EQ(back.type, tile.type);
    EXPECT_EQ(back.shared, tile.shared);
    ASSERT_EQ(back.variants.size(), 3u);
    for (size_t v = 0; v < 3; ++v) {
        for (uint64_t row = 0; row < tile.rows(); ++row)
            EXPECT_LT((back.variants[v][row] - tile.variants[v][row]).length(), 2.5e-7 * tile.mean_radius());
        // The generator leaves room for the rounding, so the spheres do not even touch.
        EXPECT_LE(largest_tile_overlap(back, v).overlap, 0);
    }
}

TEST_F(TileFile, PlainReadersFindTheFirstVariant)
{
    write_tile(good_tile(), path());
    const ParticleFrame frame = read_vdb_points(path());
    ASSERT_EQ(frame.size(), good_tile().rows());
    EXPECT_LT((frame.position[250] - good_tile().variants[0][250]).length(), 1e-6);
    EXPECT_EQ(list_vdb_points(path()), (std::vector<std::string>{"points", "variant_1", "variant_2"}));
    EXPECT_THAT(test::input_error_of([&] { read_vdb_points(path(), "variant_3"); }).value().what(),
                HasSubstr("did you mean 'variant_"));
}

TEST_F(TileFile, APlainPeriodicPackingWillDo)
{
    ParticleFrame frame = tile_frame(good_tile(), 0);
    // The frame has its own ids, a corner that is not 0, and some spheres outside the cuboid.
    for (size_t i = 0; i < frame.size(); ++i) {
        frame.id[i] = 1000 - 3 * i;
        frame.position[i] += Imath::V3d(100, 0, -7) + (i % 3 == 0 ? Imath::V3d(0, 1.5, 0) : Imath::V3d(0));
    }
    frame.box->lo = {100, 0, -7};
    write_vdb_points(frame, path());
    const PackingTile tile = read_tile(path());
    EXPECT_EQ(tile.variants.size(), 1u);
    EXPECT_NEAR(tile.fraction(), good_tile().fraction(), 1e-6);
    EXPECT_LE(tile.shared, tile.rows());
    for (uint64_t row = tile.shared; row < tile.rows(); ++row)
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(tile.variants[0][row][axis], tile.radius[row] * (1 - 1e-5));
            EXPECT_LE(tile.variants[0][row][axis], tile.size[axis] - tile.radius[row] * (1 - 1e-5));
        }
}

TEST_F(TileFile, OneVariantHasItsFacesInOrder)
{
    PackingTile one = good_tile();
    one.variants.resize(1);
    write_tile(one, path());
    EXPECT_LE(read_tile(path()).shared, one.shared);
    EXPECT_GE(read_tile(path()).shared + 3, one.shared); // the generator also counts rows that nearly touch a face
}

TEST_F(TileFile, DamageIsNamed)
{
    const uint64_t shared = good_tile().shared;
    EXPECT_EQ(error_of([](auto&) {}), "none");
    EXPECT_THAT(error_of([](auto& g) { g[0].frame.box.reset(); }), HasSubstr("points without a box"));
    EXPECT_THAT(error_of([](auto& g) { g[0].frame.box->periodic[1] = false; }), HasSubstr("not periodic along y"));
    EXPECT_THAT(error_of([](auto& g) { g[0].frame.box->edges[1].x = 0.1; }), HasSubstr("a cuboid"));
    EXPECT_THAT(error_of([](auto& g) { g[0].frame.box->edges[2].z = 0; }), HasSubstr("a cuboid"));
    EXPECT_THAT(error_of([](auto& g) { g[1].frame.box->edges[2].z = 2; }), HasSubstr("a box of its own"));
    EXPECT_THAT(error_of([](auto& g) { g[0].frame.box->edges[0].x *= 0.9; }), HasSubstr("overlap by"));
    EXPECT_THAT(error_of([](auto& g) { g[0].frame.radius[17] *= 1.5f; }), HasSubstr("overlap by"));
    EXPECT_THAT(error_of([](auto& g) { g[0].frame.radius[17] = 0; }), HasSubstr("radius 0"));
    EXPECT_THAT(error_of([](auto& g) { g[1].frame.radius[17] *= 0.5f; }), HasSubstr("has radius"));
    EXPECT_THAT(error_of([](auto& g) { g[2].frame.type[17] = 5; }), HasSubstr("has type 5"));
    EXPECT_THAT(error_of([](auto& g) { g[2].frame.id[17] = 5000; }), HasSubstr("has id"));
    EXPECT_THAT(error_of([&](auto& g) { g[1].frame.position[shared] = g[1].frame.position[shared + 1]; }),
                HasSubstr("variant_1: spheres"));
    EXPECT_THAT(error_of([](auto& g) {
                    for (auto* all : {&g[2].frame.position}) all->pop_back();
                    g[2].frame.radius.pop_back(), g[2].frame.type.pop_back(), g[2].frame.id.pop_back();
                }),
                HasSubstr("299 spheres, but 300"));
    // Places and box are scaled by 0.8 but radii are not: overlaps are above 1e-6 of a radius.
    EXPECT_THAT(error_of([](auto& g) {
                    for (auto& grid : g)
                        for (Imath::V3d& p : grid.frame.position) p *= 0.8;
                    for (auto& grid : g)
                        for (int a = 0; a < 3; ++a) grid.frame.box->edges[static_cast<size_t>(a)][a] *= 0.8;
                }),
                HasSubstr("overlap by"));
}

TEST_F(TileFile, AShiftedVariantDoesNotFit)
{
    // All spheres of one variant are moved together: a valid packing on its own, but it does not fit beside the others.
    const std::string error = error_of([](auto& g) {
        for (Imath::V3d& p : g[1].frame.position) p += Imath::V3d(0.21, 0, 0);
    });
    EXPECT_THAT(error, HasSubstr("reaches through a face, but its place differs between variants"));
}

TEST_F(TileFile, NoPointsAtAll)
{
    EXPECT_TRUE(test::input_error_of([&] { read_tile(folder_.path("none.vdb")); }));
    EXPECT_TRUE(test::input_error_of([&] { read_tile(folder_.write("text.vdb", "hello")); }));
}

} // namespace
} // namespace scree
