// Dumps that must be refused, each with the line that is wrong and what should stand there.

#include "ingest/particles/dump_series.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>

namespace scree {
namespace {

using testing::HasSubstr;

const std::vector<std::string> good{
    "ITEM: TIMESTEP", // 1
    "100", // 2
    "ITEM: NUMBER OF ATOMS", // 3
    "3", // 4
    "ITEM: BOX BOUNDS pp pp ff", // 5
    "0 10", // 6
    "0 10", // 7
    "0 10", // 8
    "ITEM: ATOMS id type x y z radius", // 9
    "1 1 1 2 3 0.5", // 10
    "2 2 4 5 6 0.25", // 11
    "3 1 7 8 9 0.5", // 12
};

/// The good dump with line `number` (from 1) replaced (with), removed (without), or with one more line before it.
std::string with(size_t number, const std::string& text)
{
    auto lines = good;
    lines.at(number - 1) = text;
    return test::join_lines(lines);
}
std::string without(size_t number)
{
    auto lines = good;
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(number - 1));
    return test::join_lines(lines);
}
std::string before(size_t number, const std::string& text)
{
    auto lines = good;
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(number - 1), text);
    return test::join_lines(lines);
}
const std::string whole = test::join_lines(good);

struct Hostile {
    std::string name;
    std::string bytes;
    int line; ///< 0: the file as a whole
    std::string found, expected;
};

std::ostream& operator<<(std::ostream& out, const Hostile& hostile) { return out << hostile.name; }

std::vector<Hostile> hostile_dumps()
{
    const std::string garbage("\x00\x01\xff\xfe\n\x80\x81", 7);
    std::string damaged = test::gzip(whole + whole + whole);
    damaged[damaged.size() / 2] ^= 0x55;
    std::string wrong_sum = test::gzip(whole);
    wrong_sum[wrong_sum.size() - 6] ^= 0x55;
    std::string damaged_zstd = test::zstd(whole + whole + whole);
    damaged_zstd[damaged_zstd.size() / 2] ^= 0x55;
    damaged_zstd[12] ^= 0x55;

    return {
        {"empty_file", "", 0, "an empty file", "ITEM: TIMESTEP"},
        {"blank_file", "\n \n\n", 0, "an empty file", "ITEM: TIMESTEP"},
        {"some_text", "hello world\nmore\n", 1, "'hello world'", "ITEM: TIMESTEP"},
        {"xyz_file", "3\ncomment\nAr 0 0 0\n", 1, "'3'", "ITEM: TIMESTEP"},
        {"json", "{\"frames\": 3}\n", 1, "frames", "ITEM: TIMESTEP"},
        {"binary", garbage, 1, "\\x00\\x01\\xff", "ITEM: TIMESTEP"},
        {"binary_without_lines", std::string(3 << 20, '\x01'), 1, "a line of more than", "lines of text"},
        {"zip_file", "PK\x03\x04 and so on", 0, "zip", "gzip or Zstandard"},
        {"xz_file",
         std::string("\xfd"
                     "7zXZ\0\0\0\0",
                     10),
         0, "xz", "gzip or Zstandard"},
        {"damaged_gzip", damaged, 0, "damaged gzip data", "an intact gzip file"},
        {"gzip_with_wrong_sum", wrong_sum, 0, "damaged gzip data", "an intact gzip file"},
        {"gzip_then_foreign", test::gzip(whole) + "hello", 0, "damaged gzip data", "an intact gzip file"},
        {"damaged_zstd", damaged_zstd, 0, "damaged Zstandard data", "an intact Zstandard file"},
        {"gzip_of_text", test::gzip("hello\n"), 1, "'hello'", "ITEM: TIMESTEP"},
        {"unknown_item", with(1, "ITEM: DUMMY"), 1, "'ITEM: DUMMY'", "TIMESTEP"},
        {"misspelt_item", with(3, "ITEM: NUMBER OF ATOM"), 3, "NUMBER OF ATOM'", "did you mean 'NUMBER OF ATOMS'"},
        {"local_dump", with(3, "ITEM: NUMBER OF ENTRIES"), 3, "NUMBER OF ENTRIES", "a dump of atoms"},
        {"step_not_a_number", with(2, "ten"), 2, "'ten'", "an integer"},
        {"step_not_an_integer", with(2, "10.5"), 2, "'10.5'", "an integer"},
        {"step_missing", without(2), 2, "'ITEM: NUMBER OF ATOMS'", "an integer"},
        {"two_steps_in_a_line", with(2, "1 2"), 2, "'1 2'", "an integer"},
        {"no_timestep", test::join_lines({good.begin() + 2, good.end()}), 7, "without ITEM: TIMESTEP", "every frame"},
        {"no_count", test::join_lines({good[0], good[1], good[4], good[5], good[6], good[7], good[8], good[9]}), 7,
         "without ITEM: NUMBER OF ATOMS", "every frame"},
        {"negative_count", with(4, "-3"), 4, "-3 atoms", "0 or more"},
        {"count_not_an_integer", with(4, "3.5"), 4, "'3.5'", "0 or more"},
        {"count_too_large_for_64_bits", with(4, "99999999999999999999999"), 4, "'9999", "0 or more"},
        {"count_above_the_lines", with(4, "4"), 13, "after 3 lines", "4 lines of atoms"},
        {"count_far_above_the_lines", with(4, "9000000000000000000"), 13, "after 3 lines", "9000000000000000000 lines"},
        {"count_below_the_lines", with(4, "2"), 12, "'3 1 7 8 9 0.5'", "ITEM: TIMESTEP"},
        {"frame_with_a_line_less_before_another", without(12) + whole, 12, "after 2 lines", "3 lines of atoms"},
        {"two_headers", before(5, "ITEM: TIMESTEP\n7"), 5, "ITEM: TIMESTEP twice", "ITEM: ATOMS"},
        {"stray_text_in_the_header", before(5, "hello"), 5, "'hello'", "ITEM:"},
        {"boundaries_unknown", with(5, "ITEM: BOX BOUNDS pp pp qq"), 5, "pp pp qq", "three boundary words"},
        {"boundaries_too_few", with(5, "ITEM: BOX BOUNDS pp pp"), 5, "pp pp", "three boundary words"},
        {"box_line_short", with(7, "0"), 7, "1 numbers", "lo hi"},
        {"box_line_long", with(7, "0 1 2"), 7, "3 numbers", "lo hi"},
        {"box_without_tilt", with(5, "ITEM: BOX BOUNDS xy xz yz pp pp pp"), 6, "2 numbers", "lo hi tilt"},
        {"box_not_a_number", with(8, "0 ten"), 8, "'ten'", "a finite number"},
        {"box_not_finite", with(8, "0 inf"), 8, "'inf'", "a finite number"},
        {"box_negative", with(6, "10 0"), 6, "from 10 to 0 in x", "a lower bound below"},
        {"box_negative_by_its_tilt",
         test::replace_all(test::replace_all(whole, "BOUNDS pp pp ff", "BOUNDS xy xz yz pp pp pp"), "0 10\n",
                           "0 10 20\n"),
         6, "in x", "a lower bound below"},
        {"box_line_missing", without(8), 8, "'ITEM: ATOMS", "three lines of box bounds"},
        {"general_box_left_handed",
         test::replace_all(whole, "BOX BOUNDS pp pp ff\n0 10\n0 10\n0 10\n",
                           "BOX BOUNDS abc origin pp pp pp\n0 1 0 0\n1 0 0 0\n0 0 1 0\n"),
         6, "do not span a right-handed box", "right-handed"},
        {"scaled_without_box", test::join_lines({good[0], good[1], good[2], "0", "ITEM: ATOMS xs ys zs"}), 5,
         "without ITEM: BOX BOUNDS", "the box"},
        {"no_columns", with(9, "ITEM: ATOMS"), 9, "without column names", "ITEM: ATOMS id type x y z radius"},
        {"no_z_column", with(9, "ITEM: ATOMS id type x y w radius"), 9, "no column for z", "x, y and z"},
        {"no_coordinates", with(9, "ITEM: ATOMS id type vx vy vz radius"), 9, "no column for x and y and z",
         "x, y and z"},
        {"column_twice", with(9, "ITEM: ATOMS id id x y z radius"), 9, "'id' twice", "once"},
        {"units_missing", before(1, "ITEM: UNITS"), 2, "'ITEM: TIMESTEP'", "unit style"},
        {"time_not_a_number", before(1, "ITEM: TIME\nnoon"), 2, "'noon'", "the time"},
        {"time_not_finite", before(1, "ITEM: TIME\nnan"), 2, "'nan'", "the time"},
        {"atom_line_short", with(11, "2 2 4 5 6"), 11, "5 columns", "6 columns: id, type, x, y, z, radius"},
        {"atom_line_long", with(11, "2 2 4 5 6 0.25 7"), 11, "7 columns", "6 columns"},
        {"atom_line_blank", with(11, ""), 11, "0 columns", "6 columns"},
        {"place_not_a_number", with(11, "2 2 4 five 6 0.25"), 11, "'five' in column 4 ('y')", "a number"},
        {"place_with_a_tail", with(11, "2 2 4 5x 6 0.25"), 11, "'5x' in column 4 ('y')", "a number"},
        {"place_in_hexadecimal", with(11, "2 2 4 0x5 6 0.25"), 11, "'0x5'", "a number"},
        {"place_with_a_comma", with(11, "2 2 4 5,5 6 0.25"), 11, "'5,5'", "a number"},
        {"place_nan", with(11, "2 2 4 5 nan 0.25"), 11, "'nan' in column 5 ('z')", "a finite number"},
        {"place_inf", with(11, "2 2 -inf 5 6 0.25"), 11, "'-inf' in column 3 ('x')", "a finite number"},
        {"place_too_far", with(11, "2 2 4 5 1e300 0.25"), 11, "'1e300' in column 5 ('z')", "a finite number"},
        {"radius_negative", with(11, "2 2 4 5 6 -0.25"), 11, "'-0.25' in column 6 ('radius')", "0 or more"},
        {"radius_nan", with(11, "2 2 4 5 6 nan"), 11, "'nan' in column 6", "0 or more"},
        {"radius_inf", with(11, "2 2 4 5 6 1e40"), 11, "'1e40' in column 6", "0 or more"},
        {"diameter_negative", test::replace_all(with(12, "3 1 7 8 9 -1"), "radius", "diameter"), 12, "('diameter')",
         "a diameter"},
        {"id_negative", with(11, "-2 2 4 5 6 0.25"), 11, "'-2' in column 1 ('id')", "an id"},
        {"id_not_an_integer", with(11, "2.5 2 4 5 6 0.25"), 11, "'2.5' in column 1", "an id"},
        {"id_too_large", with(11, "99999999999999999999 2 4 5 6 0.25"), 11, "in column 1", "an id"},
        {"id_twice", with(12, "1 1 7 8 9 0.5"), 12, "id 1 again: line 10 has it already", "once"},
        {"id_twice_far_apart", test::replace_all(with(12, "1000000 1 7 8 9 0.5"), "\n1 1", "\n1000000 1"), 12,
         "id 1000000 again", "once"},
        {"type_a_word", with(11, "2 sand 4 5 6 0.25"), 11, "'sand' in column 2 ('type')", "an integer"},
        {"type_too_large", with(11, "2 3000000000 4 5 6 0.25"), 11, "'3000000000'", "32 bits"},
        {"quaternion_nan",
         test::replace_all(test::replace_all(whole, "radius", "radius quatw quati quatj quatk"), "0.5\n",
                           "0.5 1 0 nan 0\n"),
         10, "'nan' in column 9 ('quatj')", "a finite number"},
        {"binary_among_atoms", with(11, std::string("2 2 \x00\xff\x07 5 6 0.25", 15)), 11, "\\xff", "a number"},
        {"no_radius",
         test::join_lines({good[0], good[1], good[2], "1", good[4], good[5], good[6], good[7],
                           "ITEM: ATOMS id type x y z", "1 4 0 0 0"}),
         9, "type 4", "radius"},
        {"trailing_text", whole + "the end\n", 13, "'the end'", "the end of the file"},
    };
}

class DumpHostile : public testing::TestWithParam<Hostile> {};
INSTANTIATE_TEST_SUITE_P(Table, DumpHostile, testing::ValuesIn(hostile_dumps()),
                         [](const auto& test) { return test.param.name; });

TEST_P(DumpHostile, IsRefusedWithPlaceFoundAndExpected)
{
    const test::TemporaryFolder folder;
    const Hostile& hostile = GetParam();
    const std::string file = folder.write("a.dump", hostile.bytes);
    const auto error = test::input_error_of([&] { DumpSeries::open(file).read(0); });
    ASSERT_TRUE(error) << "was read";
    EXPECT_EQ(error->place(), hostile.line == 0 ? file : file + ":" + std::to_string(hostile.line)) << error->what();
    EXPECT_THAT(error->found(), HasSubstr(hostile.found));
    EXPECT_THAT(error->expected(), HasSubstr(hostile.expected));
    // A message is for a terminal: short, and of printable characters.
    const std::string message = error->what();
    EXPECT_LT(message.size(), 400 + file.size());
    EXPECT_EQ(std::count_if(
                  message.begin(), message.end(),
                  [](char c) { return static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~'; }),
              0);
}

TEST(DumpHostileTable, TheDumpTheyAreMadeFromIsGood)
{
    const test::TemporaryFolder folder;
    const DumpSeries series = DumpSeries::open(folder.write("a.dump", whole));
    EXPECT_EQ(series.read(0).size(), 3u);
    EXPECT_TRUE(series.warnings().empty());
}

TEST(DumpHostileTable, OfSeveralDefectsTheFirstIsTold)
{
    const test::TemporaryFolder folder;
    std::string text =
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n100000\nITEM: BOX BOUNDS\n0 1\n0 1\n0 1\nITEM: ATOMS x y z radius\n";
    for (int i = 0; i < 100000; ++i) text += i == 60000 || i % 30000 == 29999 ? "0 0 bad 1\n" : "0 0 0 1\n";
    const std::string file = folder.write("a.dump", text);
    const auto error = test::input_error_of([&] { DumpSeries::open(file).read(0); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->place(), file + ":" + std::to_string(9 + 30000));
}

} // namespace
} // namespace scree
