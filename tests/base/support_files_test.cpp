#include "base/atomic_file.h"
#include "base/byte_source.h"
#include "base/line_reader.h"
#include "base/text.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>

#include <fstream>

namespace scree {
namespace {

using test::TemporaryFolder;

std::string read_all(ByteSource& source, size_t step)
{
    std::string bytes, part(step, '\0');
    while (const size_t got = source.read(part.data(), step)) bytes.append(part, 0, got);
    return bytes;
}

TEST(ByteSource, GivesTheSameBytesHoweverPackedAndAskedFor)
{
    const TemporaryFolder folder;
    std::string bytes;
    for (unsigned i = 0; i < 200000; ++i) bytes += static_cast<char>(i * i >> 5);
    for (const std::string& packed :
         {bytes, test::gzip(bytes), test::zstd(bytes), test::gzip(bytes.substr(0, 7)) + test::gzip(bytes.substr(7))})
        for (const size_t step : {1u, 7u, 4096u, 1000000u}) {
            ByteSource source(folder.write("a", packed));
            EXPECT_EQ(read_all(source, step), bytes);
            EXPECT_FALSE(source.truncated());
            EXPECT_EQ(source.fraction(), 1);
        }
}

TEST(ByteSource, CutPackedDataAreTruncated)
{
    const TemporaryFolder folder;
    std::string bytes;
    for (int i = 0; i < 5000; ++i) bytes += std::to_string(i * i);
    for (const std::string& packed : {test::gzip(bytes), test::zstd(bytes)})
        for (size_t keep = 12; keep < packed.size(); keep += packed.size() / 40 + 1) {
            ByteSource source(folder.write("a", packed.substr(0, keep)));
            const std::string found = read_all(source, 1000);
            EXPECT_TRUE(source.truncated());
            EXPECT_TRUE(bytes.starts_with(found));
        }
}

TEST(ByteSource, SeeksInPlainFilesAndKeepsWhatItReads)
{
    const TemporaryFolder folder;
    ByteSource source(folder.write("a", "0123456789abcdef"));
    ASSERT_TRUE(source.seekable());
    std::string part(4, '\0');
    for (const uint64_t offset : {10u, 2u, 0u}) {
        source.seek(offset);
        source.read(part.data(), 4);
        EXPECT_EQ(part, std::string("0123456789abcdef").substr(offset, 4));
    }
    ByteSource packed(folder.write("b", test::gzip("hello")));
    EXPECT_FALSE(packed.seekable());
    packed.keep(5);
    read_all(packed, 2);
    ASSERT_TRUE(packed.kept());
    EXPECT_EQ(*packed.kept(), "hello");
    ByteSource larger(folder.write("c", test::gzip("hello!")));
    larger.keep(5);
    read_all(larger, 2);
    EXPECT_FALSE(larger.kept());
}

TEST(LineReader, LinesBlocksAndPlaces)
{
    const TemporaryFolder folder;
    LineReader reader(ByteSource(folder.write("a", "one\r\ntwo\n\nITEM: x\nlast")));
    EXPECT_EQ(reader.next()->text, "one");
    EXPECT_EQ(reader.offset(), 5u);
    const LineBlocks block = reader.next_block(10, "ITEM:");
    EXPECT_EQ(block.lines, 2u);
    EXPECT_EQ(block.blocks.at(0).text, "two\n\n");
    EXPECT_EQ(reader.next_block(10, "ITEM:").lines, 0u);
    EXPECT_EQ(reader.next()->number, 4u);
    const LineBlocks last = reader.next_block(10, "ITEM:");
    EXPECT_EQ(last.blocks.at(0).text, "last\n");
    EXPECT_FALSE(last.terminated);
    EXPECT_FALSE(reader.next());
    EXPECT_TRUE(reader.skip_to(5, 2));
    EXPECT_EQ(reader.next()->text, "two");
    EXPECT_EQ(reader.line(), 3u);
}

TEST(AtomicFile, AppearsWholeOrNotAtAll)
{
    const TemporaryFolder folder;
    const std::filesystem::path target = folder.write("out.csv", "old");
    {
        AtomicFile file(target);
        EXPECT_EQ(file.temporary().parent_path(), target.parent_path());
        EXPECT_EQ(file.temporary().extension(), ".csv");
        std::ofstream(file.temporary()) << "half";
        EXPECT_EQ(test::read_bytes(target), "old");
    }
    EXPECT_EQ(test::read_bytes(target), "old");
    {
        AtomicFile file(target);
        std::ofstream(file.temporary()) << "new";
        file.commit();
    }
    EXPECT_EQ(test::read_bytes(target), "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
    EXPECT_THROW(AtomicFile(folder.path("none/out.csv")), InputError);
    EXPECT_THROW(AtomicFile(folder.path()), InputError);
}

TEST(Text, NumbersWordsAndQuotes)
{
    EXPECT_EQ(to_double("+1.5e3"), 1500);
    EXPECT_EQ(to_double("1e"), std::nullopt);
    EXPECT_EQ(to_double(""), std::nullopt);
    EXPECT_EQ(to_double("+"), std::nullopt);
    EXPECT_EQ(to_int64("-9223372036854775808"), std::numeric_limits<int64_t>::min());
    EXPECT_EQ(to_int64("9223372036854775808"), std::nullopt);
    EXPECT_EQ(to_int64("1e3"), 1000);
    EXPECT_EQ(to_int64("1.5"), std::nullopt);
    EXPECT_EQ(split_words("  a\tbc \r").size(), 2u);
    EXPECT_EQ(in_quotes("a\n\xff"), "'a\\x0a\\xff'");
    EXPECT_LT(in_quotes(std::string(1000, 'x')).size(), 70u);
}

} // namespace
} // namespace scree
