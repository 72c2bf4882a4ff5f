#include "tests/builders/statistics.h"
#include "tests/render/media/medium_grids.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using Ray = TestRay;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int edge = 40;

/// A scene scaled by 2^k gives bit-identical walks; a scene scaled by 1e-6 or 1e6 gives the same numbers up to
/// rounding.
TEST(GridMediumKinds, Scaling)
{
    const auto density = [](int i, int j, int k) { return ((i / 4 + j / 3 + k / 5) % 3) * 0.5; };
    const auto flights = [&](double scale, int exponent) {
        MediumGrids grids;
        grids.density = make_grid(edge, 0.05, V3d(-1, -0.7, 3), density);
        grids.to_scene.setScale(V3d(scale));
        GridMediumOptions options;
        options.scale = Color(static_cast<float>(2 / scale));
        RenderSpace space;
        space.origin = V3d(0.1, 0.2, 4) * scale;
        space.exponent = exponent;
        const GridMedium medium = make_grid_medium(grids, options, space, {});
        std::vector<double> result;
        for (uint32_t i = 0; i < 2000; ++i) {
            Sampler sampler(7, i, 0, 0);
            SpectralState state;
            const double length = space.length(scale);
            const V3d o = V3d(-2, 0.1 * sampler.next(), 0.2) * length,
                      d = V3d(1, sampler.next() - 0.5, sampler.next() - 0.5).normalized();
            const MediumEvent event = medium.event(o, d, 0, infinity, state, sampler);
            result.push_back(event.t / length);
            result.push_back(double{medium.transmittance(o, d, 0, infinity, sampler).x});
        }
        return result;
    };
    const std::vector<double> one = flights(1, 0);
    EXPECT_EQ(flights(0x1p-20, -20), one);
    EXPECT_EQ(flights(0x1p20, 20), one);
    EXPECT_EQ(flights(0x1p3, -2), one);
    for (const double scale : {1e-6, 1e6}) {
        const std::vector<double> scaled = flights(scale, static_cast<int>(std::lround(std::log2(scale))));
        size_t different = 0;
        for (size_t i = 0; i < one.size(); ++i) different += std::abs(scaled[i] - one[i]) > 1e-5;
        EXPECT_LE(different, one.size() / 1000) << scale; // rounding may change a few decisions
    }
}

/// A constant chromatic medium: spectral MIS gives 1 - exp(-tau) and exp(-tau) in every channel.
TEST(GridMediumKinds, ChromaticClosedForms)
{
    const double h = 0.05;
    // Constant bricks; uneven ones by delta tracking; dense uneven ones in closed form.
    struct Case {
        Color scale;
        bool uneven;
    };
    for (const Case& c : {Case{{0.5f, 1.0f, 2.0f}, false}, Case{{0.0f, 1.0f, 3.0f}, false},
                          Case{{0.5f, 1.0f, 2.0f}, true}, Case{{300, 700, 900}, true}}) {
        GridMediumOptions options;
        options.scale = c.scale;
        const GridMedium medium = make_medium(
            make_grid(edge, h, V3d(-1), [&](int i, int j, int k) { return c.uneven ? ((i + j + k) % 3) * 0.5 : 1.0; }),
            options);
        ASSERT_FALSE(medium.is_achromatic());
        const double length = c.scale.z > 100 ? 0.008 : 0.8;
        const Ray ray{{-0.703, -0.3, -0.2}, V3d(1, 0.4, 0.3).normalized(), 0, length};
        std::array<Estimate, 3> scattered, passed, transmitted;
        for (uint32_t i = 0; i < 60000; ++i) {
            Sampler sampler(5, i, 0, 0);
            SpectralState state;
            state.hero = std::min(2u, static_cast<uint32_t>(3 * sampler.next()));
            const MediumEvent event = medium.event(ray.o, ray.d, ray.t0, ray.t1, state, sampler);
            const Color t = medium.transmittance(ray.o, ray.d, ray.t0, ray.t1, sampler);
            for (int k = 0; k < 3; ++k) {
                const size_t at = static_cast<size_t>(k);
                const double weight = double{state.weight()[k]};
                scattered[at].add(event.scattered ? weight : 0);
                passed[at].add(event.scattered ? 0 : weight);
                transmitted[at].add(double{t[k]});
            }
        }
        // sigma_t of a channel is its scale times one field: take the field from the largest, which is never 0.
        double depth_of_one = 0;
        for (int i = 0; i < 200000; ++i)
            depth_of_one += double{medium.sigma_t(ray.o + ray.d * (length * (i + 0.5) / 200000)).z} /
                            double{c.scale.z} * length / 200000;
        for (int k = 0; k < 3; ++k) {
            const size_t at = static_cast<size_t>(k);
            const double truth = std::exp(-depth_of_one * double{c.scale[k]});
            SCOPED_TRACE(testing::Message()
                         << "channel " << k << " of scale " << c.scale << (c.uneven ? ", uneven" : ""));
            EXPECT_LT(std::abs(scattered[at].mean() - (1 - truth)), 4 * scattered[at].standard_error() + 1e-6);
            EXPECT_LT(std::abs(passed[at].mean() - truth), 4 * passed[at].standard_error() + 1e-6);
            EXPECT_LT(std::abs(transmitted[at].mean() - truth), 4 * transmitted[at].standard_error() + 1e-6);
        }
    }
}

/// A straight path with up to n events, each weighted by the albedo a: summed over all orders, exp(-(1 - a) tau) of the
/// light escapes per channel.
TEST(GridMediumKinds, ChromaticPathsWithAlbedo)
{
    GridMediumOptions options;
    options.scale = Color(1, 2, 4);
    options.albedo = Color(0.9f, 0.7f, 0.5f);
    const GridMedium medium = make_medium(
        make_grid(edge, 0.05, V3d(-1), [](int i, int j, int k) { return 0.3 + ((i + 2 * j + k) % 5) * 0.3; }), options);
    const Ray ray{{-0.8, -0.3, -0.4}, V3d(1, 0.3, 0.4).normalized(), 0, 1};
    double depth = 0;
    for (int i = 0; i < 200000; ++i) depth += double{medium.sigma_t(ray.o + ray.d * ((i + 0.5) / 200000)).x} / 200000;
    std::array<Estimate, 3> escaped;
    for (uint32_t i = 0; i < 60000; ++i) {
        Sampler sampler(6, i, 0, 0);
        SpectralState state;
        state.hero = std::min(2u, static_cast<uint32_t>(3 * sampler.next()));
        double t = 0;
        Color kept(1);
        for (;;) {
            const MediumEvent event = medium.event(ray.o, ray.d, t, 1, state, sampler);
            if (!event.scattered) break;
            kept *= event.albedo;
            t = event.t;
        }
        for (int k = 0; k < 3; ++k) escaped[static_cast<size_t>(k)].add(double{kept[k]} * double{state.weight()[k]});
    }
    for (int k = 0; k < 3; ++k)
        EXPECT_LT(std::abs(escaped[static_cast<size_t>(k)].z(
                      std::exp(-(1 - double{options.albedo[k]}) * double{options.scale[k]} * depth))),
                  4)
            << "channel " << k;
}

/// A grid of vectors as density is the same as three channels.
TEST(GridMediumKinds, VectorsOfDensity)
{
    openvdb::initialize();
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0));
    auto accessor = grid->getAccessor();
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            for (int k = 0; k < 20; ++k)
                accessor.setValue(Coord(i, j, k),
                                  openvdb::Vec3s(0.02f * static_cast<float>(i), 0.01f * static_cast<float>(j), 0.1f));
    const GridMedium medium = make_medium(grid);
    EXPECT_FALSE(medium.is_achromatic());
    const V3d a(3, 2.5, 4), b(17, 15, 11);
    const V3d d = (b - a).normalized();
    const double length = (b - a).length();
    const V3d depth(0.02 * 10 * length, 0.01 * 8.75 * length, 0.1 * length);
    std::array<Estimate, 3> passed, transmitted;
    for (uint32_t i = 0; i < 60000; ++i) {
        Sampler sampler(8, i, 0, 0);
        SpectralState state;
        state.hero = std::min(2u, static_cast<uint32_t>(3 * sampler.next()));
        const bool scattered = medium.event(a, d, 0, length, state, sampler).scattered;
        const Color t = medium.transmittance(a, d, 0, length, sampler);
        for (int k = 0; k < 3; ++k) {
            passed[static_cast<size_t>(k)].add(scattered ? 0 : double{state.weight()[k]});
            transmitted[static_cast<size_t>(k)].add(double{t[k]});
        }
    }
    for (int k = 0; k < 3; ++k) {
        EXPECT_LT(std::abs(passed[static_cast<size_t>(k)].z(std::exp(-depth[k]))), 4) << "channel " << k;
        EXPECT_LT(std::abs(transmitted[static_cast<size_t>(k)].z(std::exp(-depth[k]))), 4) << "channel " << k;
    }
}

/// A tile of the tree becomes one region: a large box needs memory only for its faces.
TEST(GridMediumKinds, TilesStaySmall)
{
    openvdb::initialize();
    auto grid = FloatGrid::create(0);
    grid->fill(openvdb::CoordBBox(Coord(0), Coord(511)), 0.001f);
    const GridMedium medium = make_medium(grid);
    // 6 (64 + 1)^2 bricks at the faces, 2.9 kB each; a dense grid would need 0.8 GB
    EXPECT_LT(medium.bytes(), 90u << 20);
    EXPECT_EQ(medium.bounds(), Imath::Box3d(V3d(-1), V3d(512)));
    expect_depth(medium, {{-50, 200.3, 300.7}, V3d(1, 0.1, 0.2).normalized(), 100, 500}, 0.4, 40000);
    // Distant voxels need no dense table between them.
    auto far = FloatGrid::create(0);
    for (const int x : {-4000000, 0, 4000000}) far->fill(openvdb::CoordBBox(Coord(x), Coord(x + 7)), 0.05f);
    const GridMedium sparse = make_medium(far);
    EXPECT_LT(sparse.bytes(), 2u << 20);
    // Cells 0..7 and the ramps on both sides: the density of 8 voxels.
    expect_depth(sparse, {{-1000, 3, 3}, {1, 0, 0}}, 0.4, 100000);
    // Along the diagonal the ramps are cubic.
    const V3d d = V3d(1, 1, 1).normalized();
    expect_depth(sparse, {V3d(-4000100.0), d}, 3 * (7 * 0.05 + 2 * 0.05 / 4) * std::sqrt(3.0), 100000);
}

/// Albedo and g have their own grids, coarser than the density; near their faces no background is mixed in.
TEST(GridMediumKinds, AlbedoAndAsymmetryGrids)
{
    openvdb::initialize();
    MediumGrids grids;
    grids.density = make_grid(20, 0.1, V3d(0), [](int, int, int) { return 1.0; });
    auto albedo = openvdb::Vec3SGrid::create(openvdb::Vec3s(0));
    albedo->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    auto accessor = albedo->getAccessor();
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            for (int k = 0; k < 5; ++k)
                accessor.setValue(Coord(i, j, k), openvdb::Vec3s(0.2f * static_cast<float>(i), 0.5f, 0.9f));
    grids.albedo = albedo;
    grids.g = make_grid(20, 0.1, V3d(0), [](int, int j, int) { return 0.04 * j - 0.5; });
    const GridMedium medium = make_grid_medium(grids, {}, {}, {});
    const Color a = medium.albedo({0.75, 1, 1});
    EXPECT_NEAR(a.x, 0.3f, 1e-6f);
    EXPECT_NEAR(a.y, 0.5f, 1e-6f);
    EXPECT_NEAR(medium.albedo({1, 1, -0.05}).z, 0.9f, 1e-6f);
    EXPECT_NEAR(medium.g({1, 0.55, 1}), 0.04 * 5.5 - 0.5, 1e-6);
    EXPECT_NEAR(medium.g({1, -0.05, 1}), -0.5, 1e-6);
    Sampler sampler(1, 0, 0, 0);
    SpectralState state;
    const MediumEvent event = medium.event({1, 0.55, 1}, {0, 0, 1}, 0, infinity, state, sampler);
    if (event.scattered) {
        EXPECT_NEAR(event.phase.mean_cosine(), 0.04 * 5.5 - 0.5, 1e-6);
    }
}

/// A rotated, sheared, mirrored and shifted grid: values are where its transform puts them.
TEST(GridMediumKinds, AffineTransforms)
{
    auto grid = make_grid(20, 1, V3d(0), [](int i, int j, int k) { return 0.01 * i + 0.02 * j + 0.03 * k; });
    const openvdb::Mat4d m(0.3, 0.1, 0.0, 0.0, -0.2, 0.25, 0.05, 0.0, 0.02, 0.1, -0.4, 0.0, 5.0, -7.0, 11.0, 1.0);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(m));
    RenderSpace space;
    space.origin = V3d(5, -6, 10);
    space.exponent = 2;
    const GridMedium medium = make_medium(grid, {}, space);
    const openvdb::Vec3d voxel(7.3, 4.6, 11.9);
    const openvdb::Vec3d world = grid->indexToWorld(voxel);
    EXPECT_NEAR(medium.sigma_t(space.point(V3d(world.x(), world.y(), world.z()))).x, 4 * (0.073 + 0.092 + 0.357), 1e-5);
    const openvdb::Vec3d end = grid->indexToWorld(openvdb::Vec3d(15.1, 9.2, 3.3));
    const V3d a = space.point(V3d(world.x(), world.y(), world.z())), b = space.point(V3d(end.x(), end.y(), end.z()));
    const double length = (b - a).length();
    expect_depth(medium, {a, (b - a) / length, 0, length},
                 4 * 0.5 * (0.073 + 0.092 + 0.357 + 0.151 + 0.184 + 0.099) * length, 40000);
    for (int corner = 0; corner < 8; ++corner) {
        const openvdb::Vec3d p =
            grid->indexToWorld(openvdb::Vec3d(corner & 1 ? 19 : 1, corner & 2 ? 19 : 1, corner & 4 ? 19 : 1));
        EXPECT_TRUE(medium.bounds().intersects(space.point(V3d(p.x(), p.y(), p.z()))));
    }
}

} // namespace
} // namespace scree
