#include "ingest/particles/vdb_points.h"
#include "mixtures/type_table.h"
#include "tests/builders/test_files.h"
#include "tests/mixtures/mixture_builders.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace scree {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class TypeTables : public testing::Test {
protected:
    TypeTable read(const std::string& text, const std::string& name = "t.csv")
    {
        return read_type_table(folder_.write(name, text));
    }
    std::string error(const std::string& text)
    {
        const auto found = test::input_error_of([&] { read(text); });
        return found ? found->what() : "none";
    }
    std::vector<uint32_t> types(const std::string& json, const ParticleFrame& frame)
    {
        return test::types_of(*test::mixture_of(json, &frame, folder_.path()), frame);
    }
    test::TemporaryFolder folder_;
};

TEST_F(TypeTables, ReadsRowsWithAndWithoutIds)
{
    const TypeTable rows = read("type\n1\n2\n1\n");
    EXPECT_TRUE(rows.ids.empty());
    EXPECT_THAT(rows.code, ElementsAre(0, 1, 0));
    EXPECT_THAT(rows.words, ElementsAre("1", "2"));
    const TypeTable ids =
        read("\xef\xbb\xbfx;id;type\r\n0.5;7;glass\r\n0.25;3;\"sugar\"\r\n\r\n0;18446744073709551615;glass");
    EXPECT_THAT(ids.ids, ElementsAre(7u, 3u, 18446744073709551615u));
    EXPECT_THAT(ids.code, ElementsAre(0, 1, 0));
    EXPECT_THAT(ids.words, ElementsAre("glass", "sugar"));
    EXPECT_THAT(read("type\n1.0\n1\n-1\n").words, ElementsAre("1", "-1"));
    EXPECT_THAT(read(test::gzip("id\ttype\n4\t9\n"), "t.csv.gz").words, ElementsAre("9"));
}

TEST_F(TypeTables, ErrorsNameFileAndLine)
{
    EXPECT_THAT(error(""), HasSubstr("t.csv:1"));
    EXPECT_THAT(error("id,tpye\n1,2\n"), HasSubstr("did you mean 'tpye'"));
    EXPECT_THAT(error("id,type\n1,2\n2\n"), HasSubstr("t.csv:3"));
    EXPECT_THAT(error("id,type\n1,2\n-2,3\n"), HasSubstr("t.csv:3"));
    EXPECT_THAT(error("id,type\n1,2\n2,\n"), HasSubstr("t.csv:3"));
    EXPECT_TRUE(test::input_error_of([] { read_type_table("/nowhere/t.csv"); }));
    EXPECT_TRUE(test::input_error_of([&] { read("no points", "t.vdb"); }));
}

TEST_F(TypeTables, ExplicitMixtureById)
{
    ParticleFrame frame = test::random_spheres(4, 1);
    frame.id = {3, 5, 6, 1000000000000};
    folder_.write("t.csv", "id,type\n6,2\n1000000000000,b\n5,3\n3,1\n8,1\n");
    EXPECT_THAT(types(R"({"kind": "explicit", "table": "t.csv", "types": {"1": "d", "2": "c", "3": "a"}})", frame),
                ElementsAre(3, 0, 2, 1));
    // Without its own map, the mixture uses the assembly's map.
    EXPECT_THAT(types(R"({"kind": "explicit", "table": "t.csv"})", frame), ElementsAre(0, 2, 1, 1));
    frame.id[0] = 4;
    const auto missing = test::input_error_of([&] { types(R"({"kind": "explicit", "table": "t.csv"})", frame); });
    ASSERT_TRUE(missing);
    EXPECT_THAT(missing->what(), HasSubstr("id 4"));
    folder_.write("t.csv", "id,type\n6,2\n6,1\n");
    EXPECT_THAT(test::input_error_of([&] { types(R"({"kind": "explicit", "table": "t.csv"})", frame); })->what(),
                HasSubstr("id 6 twice"));
    folder_.write("t.csv", "id,type\n6,zz\n");
    EXPECT_THAT(test::input_error_of([&] { types(R"({"kind": "explicit", "table": "t.csv"})", frame); })->what(),
                HasSubstr("zz"));
    folder_.write("t.csv", "type\n1\n2\n");
    EXPECT_THAT(test::input_error_of([&] { types(R"({"kind": "explicit", "table": "t.csv"})", frame); })->what(),
                HasSubstr("as many rows as spheres, 4"));
}

TEST_F(TypeTables, OpenVdbPointsByIdAndByRow)
{
    ParticleFrame frame = test::random_spheres(5000, 100);
    write_vdb_points(frame, folder_.path("p.vdb"));
    const auto by_dump = types(R"({"kind": "explicit"})", frame);
    EXPECT_EQ(types(R"({"kind": "explicit", "table": "p.vdb"})", frame), by_dump);
    frame.has_ids = false;
    write_vdb_points(frame, folder_.path("q.vdb"));
    const ParticleFrame same = read_vdb_points(folder_.path("q.vdb"));
    EXPECT_EQ(types(R"({"kind": "explicit", "table": "q.vdb"})", same), types(R"({"kind": "explicit"})", same));
    EXPECT_TRUE(
        test::input_error_of([&] { types(R"({"kind": "explicit", "table": "q.vdb", "column": "kind"})", same); }));
}

TEST_F(TypeTables, ManyTypesTakeTwoBytes)
{
    ParticleFrame frame = test::random_spheres(3, 1);
    TypeTable table;
    std::vector<uint32_t> map;
    for (uint16_t k = 0; k < 300; ++k) {
        table.words.push_back(std::to_string(k));
        map.push_back(k);
    }
    table.code = {299, 5, 256};
    const auto mixture = mixture_from_table(table, map, frame, "table");
    EXPECT_THAT(test::types_of(*mixture, frame), ElementsAre(299, 5, 256));
}

} // namespace
} // namespace scree
