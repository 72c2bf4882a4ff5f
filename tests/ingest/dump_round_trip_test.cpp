// Random frames written as text read back the same, in any layout, order and compression.

#include "ingest/particles/dump_series.h"
#include "tests/builders/test_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace scree {
namespace {

struct Layout {
    bool shuffle = false, crlf = false, ids = true, orientations = false, diameter = false;
};

ParticleFrame random_frame(std::mt19937_64& random, const Layout& layout)
{
    const auto real = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random); };
    ParticleFrame frame;
    const size_t count = std::uniform_int_distribution<size_t>(0, 3000)(random);
    const double scale = std::pow(10.0, real(-9, 9));
    const Imath::V3d middle(real(-1e3, 1e3) * scale, 0, real(-1, 1) * scale);
    uint64_t id = 0;
    for (size_t i = 0; i < count; ++i) {
        id += random() % 3 == 0 ? 1 + random() % 1000 : 1;
        frame.id.push_back(layout.ids ? id : i);
        frame.position.push_back(middle + scale * Imath::V3d(real(-1, 1), real(-1, 1), real(-1, 1)));
        frame.radius.push_back(static_cast<float>(scale * real(0, 1)));
        frame.type.push_back(static_cast<int32_t>(random() % 5));
        if (layout.orientations)
            frame.orientation.push_back(
                Imath::Quatf(float(real(-1, 1)), float(real(-1, 1)), float(real(-1, 1)), float(real(0.1, 1)))
                    .normalized());
    }
    frame.step = static_cast<int64_t>(random() >> 2);
    frame.time = real(0, 1e6);
    frame.has_ids = layout.ids;
    SimulationBox box;
    box.lo = middle - Imath::V3d(scale);
    for (int axis = 0; axis < 3; ++axis) box.edges[size_t(axis)][axis] = 2 * scale;
    frame.box = box;
    return frame;
}

std::string text_of(const ParticleFrame& frame, const Layout& layout, std::mt19937_64& random)
{
    std::vector<std::string> rows;
    for (size_t i = 0; i < frame.size(); ++i) {
        const Imath::V3d& p = frame.position[i];
        // fmt writes the shortest text that reads back as the same number.
        std::string row = fmt::format("{} {} {} {} {}", p.x, p.y, p.z, frame.type[i],
                                      layout.diameter ? 2 * frame.radius[i] : frame.radius[i]);
        if (layout.ids) row += fmt::format(" {}", frame.id[i]);
        if (layout.orientations) {
            const Imath::Quatf& q = frame.orientation[i];
            row += fmt::format(" {} {} {} {}", q.r, q.v.x, q.v.y, q.v.z);
        }
        rows.push_back(row);
    }
    if (layout.shuffle) std::ranges::shuffle(rows, random);
    const SimulationBox& box = *frame.box;
    const Imath::V3d hi = box.lo + box.edges[0] + box.edges[1] + box.edges[2];
    std::string text = fmt::format("ITEM: TIME\n{}\nITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff "
                                   "ff ff\n{} {}\n{} {}\n{} {}\nITEM: ATOMS x y z type {}{}{}\n",
                                   *frame.time, frame.step, frame.size(), box.lo.x, hi.x, box.lo.y, hi.y, box.lo.z,
                                   hi.z, layout.diameter ? "diameter" : "radius", layout.ids ? " id" : "",
                                   layout.orientations ? " quatw quati quatj quatk" : "");
    text += test::join_lines(rows);
    return layout.crlf ? test::replace_all(text, "\n", "\r\n") : text;
}

void expect_same(const ParticleFrame& found, const ParticleFrame& written)
{
    EXPECT_EQ(found.position, written.position);
    EXPECT_EQ(found.radius, written.radius);
    EXPECT_EQ(found.type, written.type);
    EXPECT_EQ(found.id, written.id);
    EXPECT_EQ(found.has_ids, written.has_ids);
    EXPECT_EQ(found.step, written.step);
    EXPECT_EQ(found.time, written.time);
    ASSERT_EQ(found.orientation.size(), written.orientation.size());
    for (size_t i = 0; i < found.orientation.size(); ++i)
        EXPECT_LT((found.orientation[i] - written.orientation[i]).length(), 1e-6f);
    EXPECT_EQ(found.box->lo, written.box->lo);
}

class DumpRoundTrip : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Seeds, DumpRoundTrip, testing::Range(0, 24));

TEST_P(DumpRoundTrip, FramesComeBackAsTheyWereWritten)
{
    const test::TemporaryFolder folder;
    std::mt19937_64 random(static_cast<uint64_t>(GetParam()));
    Layout layout;
    layout.ids = random() % 4 != 0;
    layout.shuffle = layout.ids && random() % 2;
    layout.crlf = random() % 2;
    layout.orientations = random() % 2;
    layout.diameter = random() % 2;

    std::vector<ParticleFrame> frames;
    std::string text;
    for (int i = 0; i < 4; ++i) {
        frames.push_back(random_frame(random, layout));
        text += text_of(frames.back(), layout, random);
    }
    for (const std::string& bytes : {text, test::gzip(text), test::zstd(text)}) {
        const DumpSeries series = DumpSeries::open(folder.write("a.dump", bytes));
        ASSERT_EQ(series.frame_count(), frames.size());
        EXPECT_TRUE(series.warnings().empty());
        for (size_t i = 0; i < frames.size(); ++i) expect_same(series.read(i), frames[i]);
        expect_same(series.read(1), frames[1]);
    }
}

} // namespace
} // namespace scree
