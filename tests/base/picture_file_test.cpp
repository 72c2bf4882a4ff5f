// Picture files are read and written through OpenImageIO; only commands that need a picture file load it.

#include "base/drawing/picture.h"
#include "base/drawing/picture_file.h"
#include "tests/builders/scree_process.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

namespace scree {
namespace {

using testing::HasSubstr;
using testing::Not;
using namespace test;

TEST(PictureFile, EightBitValuesComeBackExactly)
{
    const TemporaryFolder folder;
    Picture drawn(256, 3, {});
    std::vector<float> values;
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 256; ++x) {
            const ScreenColor c{static_cast<uint8_t>(x), static_cast<uint8_t>(255 - x),
                                static_cast<uint8_t>(x * 85 * y)};
            drawn.fill_rectangle(x, y, 1, 1, c);
            for (const uint8_t v : {c.r, c.g, c.b}) values.push_back(static_cast<float>(v) / 255);
        }
    }
    drawn.write(folder.path("drawn.png"));
    write_picture_file(folder.path("values.png"), 256, 3, values);
    for (const char* name : {"drawn.png", "values.png"}) {
        SCOPED_TRACE(name);
        const PictureFile picture = read_picture_file(folder.path(name));
        EXPECT_EQ(picture.width, 256u);
        EXPECT_EQ(picture.height, 3u);
        ASSERT_EQ(picture.channels, 3u);
        EXPECT_TRUE(picture.whole);
        EXPECT_TRUE(picture.eight_bit);
        for (size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(std::lround(255 * picture.values[i]), std::lround(255 * values[i])) << i;
    }
}

// Rounded to the nearest of the 256 values, not down.
TEST(PictureFile, ValuesAreRounded)
{
    const TemporaryFolder folder;
    write_picture_file(folder.path("a.png"), 1, 1, std::vector{100.49f / 255, 100.51f / 255, 2.0f});
    const PictureFile picture = read_picture_file(folder.path("a.png"));
    EXPECT_EQ(std::lround(255 * picture.values[0]), 100);
    EXPECT_EQ(std::lround(255 * picture.values[1]), 101);
    EXPECT_EQ(picture.values[2], 1);
}

TEST(PictureFile, FormatWithoutEightBitIsTold)
{
    const TemporaryFolder folder;
    write_picture_file(folder.path("a.exr"), 1, 2, std::vector<float>(6, 0.25f));
    const PictureFile picture = read_picture_file(folder.path("a.exr"));
    EXPECT_FALSE(picture.eight_bit);
    EXPECT_EQ(picture.height, 2u);
    EXPECT_EQ(picture.values, std::vector<float>(6, 0.25f));
}

TEST(PictureFile, KnowsItsFormats)
{
    for (const char* name : {"a.png", "a.jpg", "no/such/folder/a.exr", "a.tif"})
        EXPECT_TRUE(can_write_picture_file(name)) << name;
    for (const char* name : {"a.doc", "a", ""}) EXPECT_FALSE(can_write_picture_file(name)) << name;
}

TEST(PictureFile, WhatFailsIsTold)
{
    const TemporaryFolder folder;
    const std::string text = folder.write("a.png", "no picture");
    for (const std::string& file : {text, folder.path("none.png").string()}) {
        const auto error = input_error_of([&] { read_picture_file(file); });
        ASSERT_TRUE(error) << file;
        EXPECT_EQ(error->place(), file);
        EXPECT_NE(error->found(), "");
    }
    const std::vector<float> values(3);
    for (const char* name : {"a.doc", "no/a.png"}) {
        const auto error = input_error_of([&] { write_picture_file(folder.path(name), 1, 1, values); });
        ASSERT_TRUE(error) << name;
        EXPECT_THAT(error->place(), HasSubstr(folder.path("").string()));
        EXPECT_NE(error->found(), "");
    }
    EXPECT_EQ(read_bytes(text), "no picture");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

// Otherwise most of the time of a short command would be spent on loading it.
TEST(PictureModule, ProgramStartsWithoutOpenImageIO)
{
    setenv("LD_TRACE_LOADED_OBJECTS", "1", 1); // what ldd does
    const ProgramRun run = run_scree({});
    unsetenv("LD_TRACE_LOADED_OBJECTS");
    EXPECT_THAT(run.out, HasSubstr("libstdc++"));
    EXPECT_THAT(run.out, Not(HasSubstr("libOpenImageIO")));
}

TEST(PictureModule, MissingIsToldWhereItIsNeeded)
{
    const TemporaryFolder folder;
    const std::string alone = folder.path("scree").string();
    std::filesystem::copy_file(scree_program(), alone);
    EXPECT_EQ(run_scree({"--version"}, "", 0, alone).status, 0);
    const auto show = [&] { return run_scree({"grains", "show", "-o", folder.path("a.png").string()}, "", 0, alone); };
    const ProgramRun without = show();
    EXPECT_EQ(without.status, 2);
    EXPECT_THAT(without.err, HasSubstr(folder.path("scree_pictures.so").string()));
    EXPECT_THAT(without.err, HasSubstr("scree's folder"));

    folder.write("scree_pictures.so", "no library");
    const ProgramRun broken = show();
    EXPECT_EQ(broken.status, 2);
    EXPECT_THAT(broken.err, HasSubstr("the part of scree that reads and writes pictures"));
    EXPECT_FALSE(std::filesystem::exists(folder.path("a.png")));
}

} // namespace
} // namespace scree
