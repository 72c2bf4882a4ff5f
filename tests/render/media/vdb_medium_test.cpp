#include "render/media/vdb_medium.h"

#include "base/error.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

namespace scree {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using testing::HasSubstr;

template <class GridType = FloatGrid>
typename GridType::Ptr block(const std::string& name, const typename GridType::ValueType& value)
{
    openvdb::initialize();
    auto grid = GridType::create(openvdb::zeroVal<typename GridType::ValueType>());
    grid->setName(name);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grid->fill(openvdb::CoordBBox(Coord(0), Coord(9)), value);
    return grid;
}

class VdbMedium : public testing::Test {
protected:
    std::filesystem::path write(const openvdb::GridCPtrVec& grids) const
    {
        const std::filesystem::path path = folder_.path("cloud.vdb");
        openvdb::io::File(path.string()).write(grids);
        return path;
    }
    std::optional<InputError> error_of(const openvdb::GridCPtrVec& grids, const VdbMediumOptions& options = {}) const
    {
        const std::filesystem::path path = write(grids);
        return test::input_error_of([&] { read_vdb_medium(path, options, {}, {}); });
    }
    static VdbMediumOptions with(const std::string& albedo, const std::string& g = "")
    {
        VdbMediumOptions options;
        options.albedo = albedo;
        options.g = g;
        return options;
    }

    test::TemporaryFolder folder_;
};

TEST_F(VdbMedium, ReadsWhatWasWritten)
{
    const auto path =
        write({block("density", 2.0f), block<openvdb::Vec3SGrid>("colour", openvdb::Vec3s(0.9f, 0.8f, 0.7f)),
               block("lobe", 0.6f)});
    VdbMediumOptions options = with("colour", "lobe");
    options.medium.scale = Color(3);
    RenderSpace space;
    space.origin = V3d(1);
    space.exponent = 1;
    const GridMedium medium = read_vdb_medium(path, options, space, {});
    const V3d middle = space.point(V3d(2.2));
    EXPECT_FLOAT_EQ(medium.sigma_t(middle).x, 12); // 2 * 3 per unit, and two units in a render unit
    EXPECT_EQ(medium.albedo(middle), Color(0.9f, 0.8f, 0.7f));
    EXPECT_FLOAT_EQ(static_cast<float>(medium.g(middle)), 0.6f);
    EXPECT_TRUE(medium.is_achromatic());
    // Interpolation reaches one voxel farther: -0.5 to 5.
    EXPECT_EQ(medium.bounds(), Imath::Box3d(space.point(V3d(-0.5)), space.point(V3d(5))));
    EXPECT_EQ(vdb_medium_bounds(path, options), Imath::Box3d(V3d(-0.5), V3d(5)));
}

TEST_F(VdbMedium, DoublesAndPlacement)
{
    const auto path = write({block<openvdb::DoubleGrid>("smoke", 0.25)});
    VdbMediumOptions options;
    options.density = "smoke";
    options.to_scene.setScale(V3d(1e-6)); // smaller than OpenVDB's own transforms may be
    options.to_scene[3][0] = 7;
    RenderSpace space;
    space.origin = V3d(7, 0, 0);
    space.exponent = -20;
    const GridMedium medium = read_vdb_medium(path, options, space, {});
    EXPECT_FLOAT_EQ(medium.sigma_t(space.point(V3d(7 + 2e-6, 2e-6, 2e-6))).x, 0.25f * 0x1p-20f);
    EXPECT_EQ(medium.sigma_t(space.point(V3d(7 + 2e-6, 2e-6, 6e-6))).x, 0);
    EXPECT_NEAR(vdb_medium_bounds(path, options).max.x, 7 + 5e-6, 1e-14);
}

TEST_F(VdbMedium, NamesTheGridsThereAre)
{
    const auto error = error_of({block("Density", 1.0f), block<openvdb::Vec3SGrid>("vel", openvdb::Vec3s(0))});
    ASSERT_TRUE(error);
    EXPECT_THAT(error->place(), HasSubstr("cloud.vdb"));
    EXPECT_THAT(error->found(), HasSubstr("no grid 'density', but 'Density' (float), 'vel' (vec3s)"));
    EXPECT_THAT(error->hint(), HasSubstr("did you mean 'Density'?"));
    const auto albedo = error_of({block("density", 1.0f), block("g", 0.1f)}, with("colour"));
    ASSERT_TRUE(albedo);
    EXPECT_THAT(albedo->expected(), HasSubstr("'colour' for \"albedo\""));
}

TEST_F(VdbMedium, RefusesWhatNoMediumHas)
{
    struct Case {
        openvdb::GridCPtrVec grids;
        VdbMediumOptions options;
        std::string found, expected;
    };
    const auto density = block("density", 1.0f);
    auto negative = block("density", 1.0f);
    negative->tree().setValue(Coord(3, 4, 5), -0.5f);
    auto nan = block("density", 1.0f);
    nan->tree().setValue(Coord(1, 2, 3), std::numeric_limits<float>::quiet_NaN());
    auto background = FloatGrid::create(0.5f);
    background->setName("density");
    auto far_lobe = FloatGrid::create(1);
    far_lobe->setName("lobe");
    auto sphere = openvdb::tools::createLevelSetSphere<FloatGrid>(2, openvdb::Vec3f(0), 0.5f);
    sphere->setName("density");
    auto frustum = block("density", 1.0f);
    frustum->setTransform(
        openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(9)), 0.5, 4));
    auto whole = openvdb::Int32Grid::create(0);
    whole->setName("density");
    std::vector<Case> cases{
        {{negative}, {}, "density of -0.5 at voxel (3, 4, 5)", "0 or more"},
        {{nan}, {}, "density of nan at voxel (1, 2, 3)", "finite"},
        {{block("density", std::numeric_limits<float>::infinity())}, {}, "density of inf", "finite"},
        {{background}, {}, "density of 0.5 as background", "background of 0"},
        {{sphere}, {}, "a level set", "fog volume"},
        {{frustum}, {}, "transform", "linear"},
        {{whole}, {}, "density as a grid of int32", "float, double, vec3s or vec3d"},
        {{density, block("a", 1.5f)}, with("a"), "albedo of 1.5", "0..1"},
        {{density, block("a", -0.1f)}, with("a"), "albedo of -0.1", "0..1"},
        {{density, block("lobe", 1.0f)}, with("", "lobe"), "g of 1 at", "between -1 and 1"},
        {{density, far_lobe}, with("", "lobe"), "g of 1 as background", "between -1 and 1"},
        {{density, block<openvdb::Vec3SGrid>("lobe", openvdb::Vec3s(0.1f))},
         with("", "lobe"),
         "g as a grid of vec3s",
         "float or double"},
    };
    VdbMediumOptions options;
    options.medium.scale = Color(1, -1, 1);
    cases.push_back({{density}, options, "a scale of -1", "0 or more"});
    options = {};
    options.medium.albedo = Color(1.01f);
    cases.push_back({{density}, options, "an albedo of 1.01", "0..1"});
    options = {};
    options.medium.g = -1;
    cases.push_back({{density}, options, "a g of -1", "between -1 and 1"});
    options = {};
    options.to_scene.setScale(V3d(1, 0, 1));
    cases.push_back({{density}, options, "cannot be inverted", "volume"});
    for (const Case& c : cases) {
        const auto error = error_of(c.grids, c.options);
        ASSERT_TRUE(error) << c.found;
        EXPECT_THAT(error->place(), HasSubstr("cloud.vdb"));
        EXPECT_THAT(error->found(), HasSubstr(c.found));
        EXPECT_THAT(error->expected(), HasSubstr(c.expected));
    }
}

TEST_F(VdbMedium, RefusesOtherFiles)
{
    const auto text =
        test::input_error_of([&] { read_vdb_medium(folder_.write("a.vdb", "no grids here"), {}, {}, {}); });
    ASSERT_TRUE(text);
    EXPECT_THAT(text->place(), HasSubstr("a.vdb"));
    const auto missing = test::input_error_of([&] { read_vdb_medium(folder_.path("b.vdb"), {}, {}, {}); });
    ASSERT_TRUE(missing);
    EXPECT_THAT(missing->place(), HasSubstr("b.vdb"));
    const auto cut = [&] {
        const std::string bytes = test::read_bytes(write({block("density", 1.0f)}));
        return folder_.write("c.vdb", bytes.substr(0, bytes.size() * 2 / 3));
    }();
    EXPECT_TRUE(test::input_error_of([&] { read_vdb_medium(cut, {}, {}, {}); }));
}

TEST_F(VdbMedium, StopsWhenCancelled)
{
    auto grid = block("density", 1.0f);
    grid->tree().setValue(Coord(3, 4, 5), 0.5f);
    const auto path = write({grid});
    Progress progress;
    progress.cancel();
    EXPECT_THROW(read_vdb_medium(path, {}, {}, progress), Cancelled);
}

} // namespace
} // namespace scree
