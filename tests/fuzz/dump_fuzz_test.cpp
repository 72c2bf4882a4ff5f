// However a dump is damaged, reading it gives frames or an InputError: never a crash, a hang or another exception.

#include "ingest/particles/dump_series.h"
#include "tests/builders/test_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

namespace scree {
namespace {

std::string valid_dump(std::mt19937_64& random)
{
    const auto below = [&](int limit) { return std::uniform_int_distribution<int>(0, limit - 1)(random); };
    const auto real = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    std::string text = below(2) ? "ITEM: UNITS\nlj\n" : "";
    const std::vector<std::string> boxes{"BOX BOUNDS pp ff pp\n0 1\n0 1\n0 1\n", "BOX BOUNDS\n-1 1\n-1 1\n-1 1\n",
                                         "BOX BOUNDS xy xz yz pp pp pp\n0 2 0.5\n0 2 0\n0 1 0.1\n",
                                         "BOX BOUNDS abc origin pp pp pp\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"};
    const std::vector<std::string> columns{"id type x y z radius", "xs ys zs diameter id", "id element xu ysu z radius",
                                           "x y z radius quatw quati quatj quatk",
                                           "id type x y z c_q[1] c_q[2] c_q[3] c_q[4] f_radius"};
    const std::string names = columns[size_t(below(int(columns.size())))];
    const int frames = 1 + below(3);
    for (int frame = 0; frame < frames; ++frame) {
        const int count = below(6);
        if (below(2)) text += fmt::format("ITEM: TIME\n{}\n", real());
        text += fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: {}ITEM: ATOMS {}\n", 100 * frame,
                            count, boxes[size_t(below(4))], names);
        for (int i = 0; i < count; ++i) {
            std::string row;
            for (size_t start = 0; start <= names.size();) {
                const size_t end = std::min(names.find(' ', start), names.size());
                const std::string name = names.substr(start, end - start);
                row += name == "id"        ? std::to_string(i + 1)
                       : name == "type"    ? "1"
                       : name == "element" ? (below(2) ? "Si" : "O")
                                           : fmt::format("{:.6g}", real());
                row += ' ';
                start = end + 1;
            }
            text += row + "\n";
        }
    }
    return text;
}

void mutate(std::string& bytes, std::mt19937_64& random)
{
    static const std::vector<std::string> snippets{"ITEM:",
                                                   "ITEM: ATOMS",
                                                   "ITEM: TIMESTEP\n",
                                                   "\n",
                                                   "\r\n",
                                                   " ",
                                                   "-",
                                                   "nan",
                                                   "inf",
                                                   "1e999",
                                                   "9223372036854775807",
                                                   "18446744073709551616",
                                                   "-1",
                                                   "0",
                                                   std::string(1, '\0'),
                                                   "\xff",
                                                   "xs",
                                                   " radius",
                                                   "\n\n",
                                                   "4294967296",
                                                   "e",
                                                   ".",
                                                   "1e-320"};
    const auto below = [&](size_t limit) {
        return std::uniform_int_distribution<size_t>(0, limit == 0 ? 0 : limit - 1)(random);
    };
    const size_t at = below(bytes.size() + 1);
    const size_t length = std::min(bytes.size() - at, below(20));
    switch (below(6)) {
    case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(below(256));
        break;
    case 1: bytes.erase(at, length); break;
    case 2: bytes.insert(at, snippets[below(snippets.size())]); break;
    case 3: bytes.replace(at, length, snippets[below(snippets.size())]); break;
    case 4: bytes.insert(at, bytes.substr(below(bytes.size()), below(60))); break;
    default: bytes.resize(at); break;
    }
}

/// Reads everything; true when it could be read. Checks that each frame keeps the promises of its interface.
bool read_all(const std::string& file)
{
    ParticleReadOptions options;
    options.radius = 1;
    try {
        const DumpSeries series = DumpSeries::open(file);
        for (size_t i = 0; i < series.frame_count(); ++i) {
            const ParticleFrame frame = series.read(i, options);
            EXPECT_EQ(frame.size(), series.particle_count(i));
            EXPECT_EQ(frame.radius.size(), frame.size());
            EXPECT_EQ(frame.type.size(), frame.size());
            EXPECT_EQ(frame.id.size(), frame.size());
            EXPECT_TRUE(frame.orientation.empty() || frame.orientation.size() == frame.size());
            EXPECT_EQ(std::ranges::adjacent_find(frame.id, std::greater_equal<>()), frame.id.end());
            for (size_t k = 0; k < frame.size(); ++k) {
                const Imath::V3f p = frame.relative_position(k);
                EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
                EXPECT_TRUE(std::isfinite(frame.radius[k]) && frame.radius[k] >= 0);
                EXPECT_NEAR(frame.orientation.empty() ? 1.0 : frame.orientation[k].length(), 1, 1e-5);
            }
        }
        return true;
    } catch (const InputError& error) {
        EXPECT_FALSE(error.place().empty());
        EXPECT_FALSE(error.found().empty());
        EXPECT_FALSE(error.expected().empty());
        return false;
    }
}

TEST(DumpFuzz, MutatedDumpsAreReadOrRefused)
{
    const test::TemporaryFolder folder;
    const auto stop = std::chrono::steady_clock::now() + std::chrono::seconds(3);
    size_t good = 0, tried = 0;
    for (uint64_t seed = 0; std::chrono::steady_clock::now() < stop; ++seed) {
        std::mt19937_64 random(seed);
        std::string bytes = valid_dump(random);
        if (seed % 16 == 0) {
            ASSERT_TRUE(read_all(folder.write("a.dump", bytes))) << bytes;
        }
        // Some are compressed first, so that the mutations hit the compressed data.
        if (seed % 5 == 1) bytes = test::gzip(bytes);
        if (seed % 5 == 2) bytes = test::zstd(bytes);
        for (uint64_t i = 0; i <= seed % 4; ++i) mutate(bytes, random);
        if (seed % 5 == 3) bytes = test::gzip(bytes);
        SCOPED_TRACE(fmt::format("seed {}", seed));
        good += read_all(folder.write("a.dump", bytes));
        ++tried;
        if (testing::Test::HasFailure()) FAIL() << bytes;
    }
    // Some dumps must be read and some refused, or the mutations are too weak or too strong.
    EXPECT_GT(good, tried / 50);
    EXPECT_LT(good, tried);
    RecordProperty("tried", static_cast<int>(tried));
}

} // namespace
} // namespace scree
