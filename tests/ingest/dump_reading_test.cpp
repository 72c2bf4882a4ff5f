#include "ingest/particles/dump_series.h"
#include "tests/builders/test_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace scree {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

/// A dump of one frame with the given box lines (including their ITEM line), columns and rows.
std::string dump(const std::string& box, const std::string& columns, const std::vector<std::string>& rows,
                 const std::string& before = "", int step = 100)
{
    return fmt::format("{}ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n{}ITEM: ATOMS {}\n{}", before, step,
                       rows.size(), box, columns, test::join_lines(rows));
}

const std::string cube = "ITEM: BOX BOUNDS pp ff fs\n0 10\n-5 5\n2 4\n";

class DumpReading : public testing::Test {
protected:
    ParticleFrame read(const std::string& text, const ParticleReadOptions& options = {})
    {
        const DumpSeries series = DumpSeries::open(folder_.write("a.dump", text));
        warnings_ = series.warnings();
        return series.read(0, options);
    }
    ParticleFrame read_unit(const std::string& text)
    {
        ParticleReadOptions options;
        options.radius = 1;
        return read(text, options);
    }

    TemporaryFolder folder_;
    std::vector<std::string> warnings_;
};

void expect_near(const Imath::V3d& found, const Imath::V3d& expected, double tolerance = 1e-13)
{
    EXPECT_NEAR(found.x, expected.x, tolerance);
    EXPECT_NEAR(found.y, expected.y, tolerance);
    EXPECT_NEAR(found.z, expected.z, tolerance);
}

TEST_F(DumpReading, AllOfAPlainFrame)
{
    const ParticleFrame frame = read(dump(cube, "id type x y z radius", {"3 2 1.5 -2 3 0.5", "1 1 9 4 2.5 0.25"}));
    ASSERT_EQ(frame.size(), 2u);
    EXPECT_TRUE(frame.has_ids);
    EXPECT_EQ(frame.id, (std::vector<uint64_t>{1, 3}));
    EXPECT_EQ(frame.type, (std::vector<int32_t>{1, 2}));
    EXPECT_EQ(frame.radius, (std::vector<float>{0.25f, 0.5f}));
    EXPECT_EQ(frame.position[0], Imath::V3d(9, 4, 2.5));
    EXPECT_EQ(frame.position[1], Imath::V3d(1.5, -2, 3));
    EXPECT_EQ(frame.origin, Imath::V3d(5.25, 1, 2.75));
    EXPECT_TRUE(frame.orientation.empty());
    EXPECT_EQ(frame.step, 100);
    EXPECT_FALSE(frame.time);
    EXPECT_EQ(frame.units, "");
    ASSERT_TRUE(frame.box);
    EXPECT_EQ(frame.box->lo, Imath::V3d(0, -5, 2));
    EXPECT_EQ(frame.box->edges[1], Imath::V3d(0, 10, 0));
    EXPECT_EQ(frame.box->periodic, (std::array<bool, 3>{true, false, false}));
    EXPECT_FALSE(frame.box->triclinic);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(DumpReading, BoxWithoutBoundaryWordsIsNotPeriodic)
{
    const ParticleFrame frame = read_unit(dump("ITEM: BOX BOUNDS\n0 1\n0 1\n0 1\n", "x y z", {"0 0 0"}));
    EXPECT_EQ(frame.box->periodic, (std::array<bool, 3>{false, false, false}));
}

TEST_F(DumpReading, UnitsHoldForTheFramesAfterToo)
{
    const std::string frame = dump(cube, "x y z radius", {"0 0 0 1"}, "ITEM: TIME\n0.25\n");
    const DumpSeries series = DumpSeries::open(folder_.write("a.dump", "ITEM: UNITS\nsi\n" + frame + frame));
    ASSERT_EQ(series.frame_count(), 2u);
    EXPECT_EQ(series.read(1).units, "si");
    EXPECT_EQ(series.read(1).time, 0.25);
    EXPECT_EQ(series.time(0), 0.25);
}

TEST_F(DumpReading, ScaledCoordinatesInAnOrthogonalBox)
{
    const ParticleFrame frame = read_unit(dump(cube, "xs ys zs", {"0.25 0.5 1"}));
    expect_near(frame.position[0], {2.5, 0, 4});
}

TEST_F(DumpReading, UnwrappedAndMixedCoordinates)
{
    expect_near(read_unit(dump(cube, "xu yu zu", {"12 -20 30"})).position[0], {12, -20, 30});
    expect_near(read_unit(dump(cube, "xsu ysu zsu", {"1.5 -1 2"})).position[0], {15, -15, 6});
    expect_near(read_unit(dump(cube, "zu ys x", {"3 0.25 7"})).position[0], {7, -2.5, 3});
}

TEST_F(DumpReading, PlacesWinOverFractions)
{
    expect_near(read_unit(dump(cube, "xs ys zs xu yu zu x y z", {"0 0 0 11 11 11 1 2 3"})).position[0], {1, 2, 3});
}

/// A tilted box; the LAMMPS manual's relation: bounds = cell corner plus the extremes of the tilts.
const std::string tilted = "ITEM: BOX BOUNDS xy xz yz pp pp pp\n-1 14 3\n0 9 -2\n0 5 -1\n";

TEST_F(DumpReading, TiltedBoxIsRecoveredFromItsBoundingBox)
{
    // xlo = -1 - min(0,3,-2,1) = 1; xhi = 14 - max(0,3,-2,1) = 11; ylo = 0 - (-1) = 1; yhi = 9.
    const ParticleFrame frame = read_unit(dump(tilted, "xs ys zs", {"0 0 0", "1 1 1", "0.5 0.25 0.5"}));
    const SimulationBox& box = *frame.box;
    EXPECT_TRUE(box.triclinic);
    expect_near(box.lo, {1, 1, 0});
    expect_near(box.edges[0], {10, 0, 0});
    expect_near(box.edges[1], {3, 8, 0});
    expect_near(box.edges[2], {-2, -1, 5});
    expect_near(frame.position[0], {1, 1, 0});
    expect_near(frame.position[1], {12, 8, 5});
    expect_near(frame.position[2], {1 + 5 + 0.75 - 1, 1 + 2 - 0.5, 2.5});
}

TEST_F(DumpReading, MixedCoordinatesInATiltedBox)
{
    // The same position in all notations: fractions (0.5, 0.25, 0.5) are (5.75, 2.5, 2.5).
    for (const auto& [columns, row] : {std::pair{"x ys zs", "5.75 0.25 0.5"},
                                       {"xs y zs", "0.5 2.5 0.5"},
                                       {"xs ys z", "0.5 0.25 2.5"},
                                       {"xs yu zu", "0.5 2.5 2.5"},
                                       {"xu ysu z", "5.75 0.25 2.5"},
                                       {"x y zsu", "5.75 2.5 0.5"}}) {
        SCOPED_TRACE(columns);
        expect_near(read_unit(dump(tilted, columns, {row})).position[0], {5.75, 2.5, 2.5});
    }
}

TEST_F(DumpReading, GeneralTriclinicBox)
{
    const std::string general = "ITEM: BOX BOUNDS abc origin pp ff pp\n0 2 0 10\n-3 0 0 20\n1 1 4 30\n";
    const ParticleFrame frame = read_unit(dump(general, "xs ys zs", {"0.5 0.5 0.5"}));
    EXPECT_TRUE(frame.box->triclinic);
    expect_near(frame.box->lo, {10, 20, 30});
    expect_near(frame.box->edges[1], {-3, 0, 0});
    EXPECT_EQ(frame.box->periodic, (std::array<bool, 3>{true, false, true}));
    expect_near(frame.position[0], {10 - 1.5 + 0.5, 20 + 1 + 0.5, 32});
    // y = 20 + 2 u + w does not depend on v, so v cannot be computed from it.
    EXPECT_THROW(read_unit(dump(general, "xs y zs", {"0.5 21.5 0.5"})), InputError);
    expect_near(read_unit(dump(general, "x y zs", {"9 21.5 0.5"})).position[0], {9, 21.5, 32});
}

TEST_F(DumpReading, RadiusAndDiameterUnderTheirNames)
{
    for (const auto& [column, value] : {std::pair{"radius", "0.5"},
                                        {"Radius", "0.5"},
                                        {"RADIUS", "+0.5"},
                                        {"diameter", "1"},
                                        {"Diameter", "1e0"},
                                        {"c_radius", "0.5"},
                                        {"f_radius", "5e-1"},
                                        {"v_radius", "0.5"},
                                        {"d_radius", "0.5"},
                                        {"v_diameter", "1.0"},
                                        {"c_diameter[1]", "1"},
                                        {"v_rad", ".5"}}) {
        SCOPED_TRACE(column);
        const ParticleFrame frame = read(dump(cube, std::string("x y z ") + column, {std::string("0 0 0 ") + value}));
        EXPECT_EQ(frame.radius[0], 0.5f);
    }
    EXPECT_EQ(read(dump(cube, "x y z diameter radius", {"0 0 0 9 2"})).radius[0], 2.0f);
}

TEST_F(DumpReading, RadiusFromOptions)
{
    const std::string text = dump(cube, "id type x y z", {"1 1 0 0 0", "2 2 1 1 1", "3 7 1 1 1"});
    ParticleReadOptions options;
    options.radius = 0.5;
    options.radius_of_type[2] = 0.75;
    EXPECT_EQ(read(text, options).radius, (std::vector<float>{0.5f, 0.75f, 0.5f}));

    const auto error = test::input_error_of([&] {
        ParticleReadOptions partial;
        partial.radius_of_type[2] = 0.75;
        read(text, partial);
    });
    ASSERT_TRUE(error);
    EXPECT_THAT(error->place(), testing::EndsWith("a.dump:9"));
    EXPECT_THAT(error->found(), HasSubstr("types 1, 7"));
    EXPECT_THAT(error->hint(), HasSubstr("--radius 1=R 7=R"));

    options.radius = -1;
    EXPECT_THROW(read(text, options), InputError);
}

TEST_F(DumpReading, OptionsDoNotReplaceAColumn)
{
    ParticleReadOptions options;
    options.radius = 9;
    EXPECT_EQ(read(dump(cube, "x y z radius", {"0 0 0 1"}), options).radius[0], 1.0f);
}

TEST_F(DumpReading, Orientations)
{
    for (const std::string columns :
         {"quatw quati quatj quatk", "c_quat[1] c_quat[2] c_quat[3] c_quat[4]", "c_q[1] c_q[2] c_q[3] c_q[4]",
          "c_quatw c_quati c_quatj c_quatk", "C_MyQuat[1] c_myquat[2] c_myquat[3] c_myquat[4]"}) {
        SCOPED_TRACE(columns);
        const ParticleFrame frame = read(dump(cube, "x y z radius " + columns, {"0 0 0 1 2 0 0 2", "0 0 0 1 0 0 0 0"}));
        ASSERT_EQ(frame.orientation.size(), 2u);
        EXPECT_NEAR(frame.orientation[0].r, std::sqrt(0.5), 1e-7);
        EXPECT_NEAR(frame.orientation[0].v.z, std::sqrt(0.5), 1e-7);
        EXPECT_EQ(frame.orientation[1], Imath::Quatf());
    }
    const ParticleFrame swapped = read(dump(cube, "c_q[4] x y z radius c_q[3] c_q[2] c_q[1]", {"1 0 0 0 1 0 0 0"}));
    EXPECT_EQ(swapped.orientation[0], Imath::Quatf(0, 0, 0, 1));
}

TEST_F(DumpReading, HalfAnOrientationIsToldAndLeftOut)
{
    EXPECT_TRUE(read(dump(cube, "x y z radius quatw quati", {"0 0 0 1 1 0"})).orientation.empty());
    EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("only 2 of the four")));
}

TEST_F(DumpReading, MissingIdsAndTypes)
{
    const ParticleFrame frame = read(dump(cube, "x y z radius", {"3 0 0 1", "1 0 0 1"}));
    EXPECT_FALSE(frame.has_ids);
    EXPECT_EQ(frame.id, (std::vector<uint64_t>{0, 1}));
    EXPECT_EQ(frame.type, (std::vector<int32_t>{1, 1}));
    EXPECT_EQ(frame.position[0].x, 3);
}

TEST_F(DumpReading, NamesOfTypesAreNumberedOverAllFrames)
{
    const std::string first = dump(cube, "id element x y z radius", {"1 Si 0 0 0 1", "2 Si 0 0 0 1"});
    const std::string second = dump(cube, "id element x y z radius", {"1 O 0 0 0 1", "2 Si 0 0 0 1"}, "", 200);
    const DumpSeries series = DumpSeries::open(folder_.write("a.dump", first + second));
    EXPECT_EQ(series.type_names(), (std::vector<std::string>{"O", "Si"}));
    EXPECT_EQ(series.read(0).type, (std::vector<int32_t>{2, 2}));
    EXPECT_EQ(series.read(1).type, (std::vector<int32_t>{1, 2}));
    EXPECT_THAT(series.warnings(), testing::ElementsAre(HasSubstr("1 = O, 2 = Si")));
}

TEST_F(DumpReading, ElementsThatLookLikeAnItemStayAtoms)
{
    EXPECT_EQ(read(dump(cube, "element x y z radius", {"I 0 0 0 1", "ITEM 0 0 0 1", "In 0 0 0 1"})).type,
              (std::vector<int32_t>{1, 2, 3}));
}

TEST_F(DumpReading, LineEndsBlanksAndABom)
{
    const std::string text = dump(cube, "id type x y z radius", {"2 1 1 2 3 0.5", "1 2 4 5 6 0.25"});
    const ParticleFrame plain = read(text);
    for (const std::string& variant :
         {test::replace_all(text, "\n", "\r\n"), test::replace_all(text, "\n", " \t\n"), "\xef\xbb\xbf" + text,
          "\n\n" + text + "\n \n", test::replace_all(text, " ", "   "), test::replace_all(text, "\n2 1", "\n  2\t1")}) {
        const ParticleFrame frame = read(variant);
        EXPECT_EQ(frame.position, plain.position);
        EXPECT_EQ(frame.radius, plain.radius);
        EXPECT_EQ(frame.id, plain.id);
        EXPECT_EQ(frame.box->edges, plain.box->edges);
        EXPECT_TRUE(warnings_.empty());
    }
}

TEST_F(DumpReading, EmptyFrames)
{
    const std::string columns = "id x y z radius";
    const DumpSeries series = DumpSeries::open(folder_.write("a.dump", dump(cube, columns, {}, "", 1) +
                                                                           dump(cube, columns, {"1 0 0 0 1"}, "", 2) +
                                                                           dump(cube, columns, {}, "", 3)));
    ASSERT_EQ(series.frame_count(), 3u);
    EXPECT_EQ(series.read(0).size(), 0u);
    EXPECT_EQ(series.read(1).size(), 1u);
    EXPECT_EQ(series.read(2).size(), 0u);
    EXPECT_TRUE(series.warnings().empty());
}

TEST_F(DumpReading, FrameWithoutABox)
{
    EXPECT_FALSE(read(dump("", "x y z radius", {"0 0 0 1"})).box);
    EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("no ITEM: BOX BOUNDS")));
}

TEST_F(DumpReading, NumbersAsOtherProgramsWriteThem)
{
    const ParticleFrame frame =
        read(dump(cube, "id type x y z radius", {"9007199254740993 1 1e-3 -.5 +2.5E+0 1", "2.0 3.000e+00 1 1 1 0"}));
    EXPECT_EQ(frame.id, (std::vector<uint64_t>{2, 9007199254740993u}));
    EXPECT_EQ(frame.type[0], 3);
    EXPECT_EQ(frame.radius[0], 0.0f);
    EXPECT_EQ(frame.position[1], Imath::V3d(1e-3, -0.5, 2.5));
}

TEST_F(DumpReading, ScatteredIdsAreSorted)
{
    const ParticleFrame frame =
        read(dump(cube, "id x y z radius", {"1000000000000 1 0 0 1", "5 2 0 0 1", "70 3 0 0 1", "0 4 0 0 1"}));
    EXPECT_EQ(frame.id, (std::vector<uint64_t>{0, 5, 70, 1000000000000u}));
    EXPECT_EQ(frame.position[3].x, 1);
    EXPECT_EQ(frame.position[0].x, 4);
}

TEST_F(DumpReading, FarAwayPlacesKeepTheirDigits)
{
    const ParticleFrame frame = read(dump(cube, "x y z radius", {"10000000.001 0 0 1", "10000000.003 0 0 1"}));
    EXPECT_NEAR(frame.relative_position(1).x - frame.relative_position(0).x, 0.002, 1e-8);
}

TEST_F(DumpReading, LastLineWithoutLineEnd)
{
    std::string text = dump(cube, "x y z radius", {"0 0 0 1", "1 2 3 0.5"});
    text.pop_back();
    EXPECT_EQ(read(text).radius[1], 0.5f);
    EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("no line end")));
}

} // namespace
} // namespace scree
