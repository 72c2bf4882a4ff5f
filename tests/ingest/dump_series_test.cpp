#include "ingest/particles/dump_series.h"
#include "tests/builders/test_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <thread>

namespace scree {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

/// A frame of `count` spheres; sphere i of step s is at (s, i, 0).
std::string frame_text(int64_t step, int count)
{
    std::string text = fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 "
                                   "1\n0 1\nITEM: ATOMS id x y z radius\n",
                                   step, count);
    for (int i = count; i > 0; --i) text += fmt::format("{} {} {} 0 0.5\n", i, step, i);
    return text;
}

std::vector<int64_t> steps_of(const DumpSeries& series)
{
    std::vector<int64_t> steps;
    for (size_t i = 0; i < series.frame_count(); ++i) steps.push_back(series.step(i));
    return steps;
}

void expect_frame(const DumpSeries& series, size_t index, int64_t step, size_t count)
{
    SCOPED_TRACE(index);
    EXPECT_EQ(series.particle_count(index), count);
    const ParticleFrame frame = series.read(index);
    EXPECT_EQ(frame.step, step);
    ASSERT_EQ(frame.size(), count);
    for (size_t i = 0; i < count; ++i) {
        EXPECT_EQ(frame.id[i], i + 1);
        EXPECT_EQ(frame.position[i], Imath::V3d(double(step), double(i + 1), 0));
    }
}

struct Packing {
    const char* name;
    std::string (*pack)(const std::string&);
};
std::ostream& operator<<(std::ostream& out, const Packing& packing) { return out << packing.name; }
std::string as_it_is(const std::string& bytes) { return bytes; }

class DumpSeriesPacked : public testing::TestWithParam<Packing> {
protected:
    TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Packings, DumpSeriesPacked,
                         testing::Values(Packing{"plain", as_it_is}, Packing{"gzip", test::gzip},
                                         Packing{"zstd", test::zstd}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(DumpSeriesPacked, ManyFramesInAnyOrder)
{
    std::string text;
    for (int i = 0; i < 20; ++i) text += frame_text(100 * i, 3 + i);
    // The name says nothing; the first bytes show how a file is compressed.
    const DumpSeries series = DumpSeries::open(folder_.write("run.dump", GetParam().pack(text)));
    ASSERT_EQ(series.frame_count(), 20u);
    for (size_t i = 0; i < 20; ++i) expect_frame(series, i, int64_t(100 * i), 3 + i);
    for (const size_t i : {19u, 0u, 7u, 7u, 6u, 8u, 18u}) expect_frame(series, i, int64_t(100 * i), 3 + i);
}

TEST_P(DumpSeriesPacked, FilePerFrameByGlobAndByPrintf)
{
    for (const int step : {900, 1000, 10, 0})
        folder_.write(fmt::format("pour.{:04d}.dump", step), GetParam().pack(frame_text(step, 4)));
    folder_.write("pour.last.dump", "not of this series");
    folder_.write("other.dump", "not a dump");
    for (const char* pattern : {"pour.[01]*.dump", "pour.????.dump", "pour.%04d.dump", "pour.%d.dump"}) {
        SCOPED_TRACE(pattern);
        if (std::string(pattern) == "pour.????.dump") std::filesystem::remove(folder_.path("pour.last.dump"));
        const DumpSeries series = DumpSeries::open(folder_.path(pattern).string());
        const bool only_unpadded = std::string(pattern) == "pour.%d.dump";
        EXPECT_EQ(steps_of(series),
                  only_unpadded ? (std::vector<int64_t>{1000}) : (std::vector<int64_t>{0, 10, 900, 1000}));
        expect_frame(series, 0, only_unpadded ? 1000 : 0, 4);
        EXPECT_EQ(series.file(0).filename(), only_unpadded ? "pour.1000.dump" : "pour.0000.dump");
    }
}

TEST_P(DumpSeriesPacked, LargeFrameAcrossManyBlocks)
{
    const int count = 150000; // several of the reader's buffers
    const DumpSeries series = DumpSeries::open(
        folder_.write("a.dump", GetParam().pack(frame_text(1, count) + frame_text(2, 5) + frame_text(3, count))));
    for (const size_t i : {0u, 2u, 1u}) {
        const ParticleFrame frame = series.read(i);
        ASSERT_EQ(frame.size(), i == 1 ? 5u : size_t(count));
        EXPECT_EQ(frame.position.back(), Imath::V3d(double(i + 1), double(frame.size()), 0));
        EXPECT_EQ(frame.id.front(), 1u);
    }
}

TEST_P(DumpSeriesPacked, CutInTheLastFrameKeepsTheFramesBefore)
{
    const std::string first = frame_text(0, 3), second = frame_text(100, 3);
    // Cut anywhere in the second frame, except at its very end or within its last number.
    for (size_t keep = 1; keep + 4 < second.size(); keep += 3) {
        SCOPED_TRACE(second.substr(0, keep));
        const DumpSeries series =
            DumpSeries::open(folder_.write("a.dump", GetParam().pack(first + second.substr(0, keep))));
        ASSERT_EQ(series.frame_count(), 1u);
        expect_frame(series, 0, 0, 3);
        if (second.substr(0, keep).find_first_not_of("\n") == std::string::npos) continue;
        EXPECT_THAT(series.warnings(),
                    testing::ElementsAre(testing::AllOf(HasSubstr("a.dump:"), HasSubstr("left out"))));
    }
}

TEST_P(DumpSeriesPacked, CutInTheOnlyFrameIsAnError)
{
    const std::string text = frame_text(0, 3);
    for (size_t keep = 0; keep + 4 < text.size(); ++keep) {
        SCOPED_TRACE(text.substr(0, keep));
        EXPECT_TRUE(test::input_error_of(
            [&] { DumpSeries::open(folder_.write("a.dump", GetParam().pack(text.substr(0, keep)))); }));
    }
}

TEST(DumpSeries, CutCompressedStreamKeepsTheFramesBefore)
{
    const TemporaryFolder folder;
    std::string text;
    for (int i = 0; i < 50; ++i) text += frame_text(i, 2000);
    for (const auto& packed : {test::gzip(text), test::zstd(text)}) {
        const DumpSeries series = DumpSeries::open(folder.write("a.dump", packed.substr(0, packed.size() * 3 / 4)));
        EXPECT_GT(series.frame_count(), 10u);
        EXPECT_LT(series.frame_count(), 50u);
        EXPECT_THAT(series.warnings(), testing::ElementsAre(HasSubstr("truncated compressed data")));
        expect_frame(series, series.frame_count() - 1, int64_t(series.frame_count()) - 1, 2000);
    }
}

TEST(DumpSeries, GzipOfSeveralMembersAndPadding)
{
    const TemporaryFolder folder;
    const std::string text = frame_text(0, 300) + frame_text(1, 300);
    const std::string members = test::gzip(text.substr(0, 1000)) + test::gzip("") + test::gzip(text.substr(1000));
    EXPECT_EQ(DumpSeries::open(folder.write("a.gz", members)).frame_count(), 2u);
    EXPECT_EQ(DumpSeries::open(folder.write("b.gz", members + std::string(512, '\0'))).frame_count(), 2u);
    EXPECT_EQ(DumpSeries::open(folder.write("c.zst", test::zstd(text.substr(0, 1000)) + test::zstd(text.substr(1000))))
                  .frame_count(),
              2u);
}

TEST(DumpSeries, UnfinishedFileOfASeriesIsLeftOut)
{
    const TemporaryFolder folder;
    folder.write("a.0.dump", frame_text(0, 3));
    folder.write("a.1.dump", frame_text(100, 3).substr(0, 60));
    folder.write("a.2.dump", "");
    const DumpSeries series = DumpSeries::open(folder.path("a.*.dump").string());
    EXPECT_EQ(steps_of(series), (std::vector<int64_t>{0}));
    EXPECT_EQ(series.warnings().size(), 2u);
}

TEST(DumpSeries, StepThatComesTwiceIsTold)
{
    const TemporaryFolder folder;
    folder.write("a.0.dump", frame_text(0, 3) + frame_text(100, 3));
    folder.write("a.1.dump", frame_text(100, 3) + frame_text(200, 3));
    const DumpSeries series = DumpSeries::open(folder.path("a.%d.dump").string());
    EXPECT_EQ(steps_of(series), (std::vector<int64_t>{0, 100, 100, 200}));
    EXPECT_THAT(series.warnings(), testing::ElementsAre(HasSubstr("step 100 comes twice")));
}

TEST(DumpSeries, NumbersInNamesAreOrderedAsNumbersWhenStepsAreEqual)
{
    const TemporaryFolder folder;
    for (const char* name : {"a10.dump", "a9.dump", "a2.dump"}) folder.write(name, frame_text(0, 1));
    const DumpSeries series = DumpSeries::open(folder.path("a*.dump").string());
    EXPECT_EQ(series.file(0).filename(), "a2.dump");
    EXPECT_EQ(series.file(2).filename(), "a10.dump");
}

TEST(DumpSeries, FileWithTheVeryNameOfAPattern)
{
    const TemporaryFolder folder;
    for (const char* name : {"a[1].dump", "a%d.dump", "a*.dump"})
        EXPECT_EQ(DumpSeries::open(folder.write(name, frame_text(7, 1))).step(0), 7);
}

TEST(DumpSeries, MissingFilesAndFrames)
{
    const TemporaryFolder folder;
    const std::string file = folder.write("pour.dump", frame_text(0, 1));
    const auto missing = test::input_error_of([&] { DumpSeries::open(folder.path("puor.dump").string()); });
    ASSERT_TRUE(missing);
    EXPECT_THAT(missing->hint(), HasSubstr("pour.dump"));
    EXPECT_TRUE(test::input_error_of([&] { DumpSeries::open(folder.path("*.gz").string()); }));
    EXPECT_TRUE(test::input_error_of([&] { DumpSeries::open(folder.path("p.%d").string()); }));
    EXPECT_TRUE(test::input_error_of([&] { DumpSeries::open(folder.path().string()); }));
    EXPECT_TRUE(test::input_error_of([&] { DumpSeries::open(""); }));
    EXPECT_TRUE(test::input_error_of([&] { DumpSeries::open(file).read(1); }));
}

TEST(DumpSeries, ReadsFromSeveralThreads)
{
    const TemporaryFolder folder;
    std::string text;
    for (int i = 0; i < 12; ++i) text += frame_text(i, 500);
    for (const auto& bytes : {text, test::gzip(text)}) {
        const DumpSeries series = DumpSeries::open(folder.write("a.dump", bytes));
        std::vector<std::thread> threads;
        std::vector<size_t> good(4, 0);
        for (size_t t = 0; t < 4; ++t)
            threads.emplace_back([&, t] {
                for (size_t i = 0; i < 12; ++i)
                    good[t] += series.read((i * (t + 1)) % 12).step == int64_t((i * (t + 1)) % 12);
            });
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(good, (std::vector<size_t>{12, 12, 12, 12}));
    }
}

TEST(DumpSeries, CancelledOpenAndRead)
{
    const TemporaryFolder folder;
    const std::string file = folder.write("a.dump", frame_text(0, 100));
    const DumpSeries series = DumpSeries::open(file);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(DumpSeries::open(file, progress), Cancelled);
    EXPECT_THROW(series.read(0, {}, progress), Cancelled);
}

TEST(DumpSeries, FileThatChangedSinceItWasOpened)
{
    const TemporaryFolder folder;
    const std::string file = folder.write("a.dump", frame_text(0, 100) + frame_text(1, 100));
    const DumpSeries series = DumpSeries::open(file);
    folder.write("a.dump", frame_text(0, 100).substr(0, 500));
    EXPECT_THROW(series.read(0), InputError);
    EXPECT_THROW(series.read(1), InputError);
}

} // namespace
} // namespace scree
