// Over the frames of a film no sphere changes its type or rotation.

#include "base/json.h"
#include "ingest/particles/dump_series.h"
#include "mixtures/identity.h"
#include "mixtures/mixture_series.h"
#include "mixtures/read_mixture.h"
#include "tests/builders/test_files.h"
#include "tests/mixtures/mixture_builders.h"

#include <gtest/gtest.h>

#include <map>

namespace scree {
namespace {

const std::vector<std::string> mixtures{
    R"({"kind": "explicit"})",
    R"({"kind": "random", "types": ["a", "b", "c"]})",
    R"({"kind": "random", "types": ["a", "b"], "by": "volume"})",
    R"({"kind": "perlin", "types": ["a", "b"], "scale": 5})",
    R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 4})",
    R"({"kind": "layers", "types": ["a", "b", "c"], "thicknesses": 2})",
    R"({"kind": "radius", "types": ["a", "b"], "thresholds": [0.4]})",
    R"({"kind": "blend", "by": {"kind": "checkerboard", "types": ["m", "n"], "cell": 5},
        "mixtures": {"m": "a", "n": {"kind": "explicit"}}})",
};

MixtureSeries series_of(const std::string& text)
{
    const JsonDocument document = JsonDocument::parse(text, "test", ".");
    return {read_mixture(document.root()), {"a", "b", "c", "d"}, {{1, "a"}, {2, "b"}, {3, "c"}}, "dump"};
}

TEST(MixtureSeries, NoSphereOfThePourChangesItsType)
{
    const DumpSeries pour = DumpSeries::open(std::string(SCREE_EXAMPLES) + "/pour/pour.*.dump.gz");
    std::vector<ParticleFrame> frames;
    for (size_t f = 0; f < pour.frame_count(); ++f) frames.push_back(pour.read(f));
    ASSERT_EQ(frames.size(), 10u);
    for (const std::string& text : mixtures) {
        MixtureSeries series = series_of(text);
        if (const auto deciding = series.deciding_frame(frames.size())) series.decide(frames[*deciding]);
        std::map<uint64_t, uint32_t> type_of;
        std::vector<uint64_t> count(4, 0);
        for (const ParticleFrame& frame : frames) {
            const auto types = test::types_of(*series.mixture(frame), frame);
            for (size_t i = 0; i < frame.size(); ++i) {
                const auto [known, fresh] = type_of.try_emplace(frame.id[i], types[i]);
                ASSERT_EQ(known->second, types[i]) << text << ", id " << frame.id[i];
                count[types[i]] += fresh;
            }
        }
        EXPECT_EQ(type_of.size(), 20000u);
        EXPECT_GT(count[0], 1000u);
        EXPECT_GT(count[1], 1000u);
    }
    // Rotations follow from the id alone.
    for (uint64_t id = 1; id < 100; ++id) EXPECT_EQ(rotation_of_id(id), rotation_of_id(id));
}

TEST(MixtureSeries, TheDecidingFrame)
{
    const std::string board = R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 4)";
    EXPECT_EQ(series_of(board + "}").deciding_frame(10), 9u);
    EXPECT_EQ(series_of(board + R"(, "frame": 2})").deciding_frame(10), 2u);
    EXPECT_EQ(series_of(board + R"(, "frame": -10})").deciding_frame(10), 0u);
    EXPECT_EQ(series_of(board + R"(, "frame": "each"})").deciding_frame(10), std::nullopt);
    EXPECT_EQ(series_of(board + "}").deciding_frame(1), std::nullopt);
    EXPECT_EQ(series_of(R"({"kind": "random", "types": ["a", "b"]})").deciding_frame(10), std::nullopt);
    EXPECT_TRUE(test::input_error_of([&] { series_of(board + R"(, "frame": 10})").deciding_frame(10); }));
}

TEST(MixtureSeries, SpheresThatTheDecidingFrameLacksAreDecidedWhereTheyAre)
{
    ParticleFrame frame = test::random_spheres(500, 40), last = frame;
    last.position.resize(300);
    last.radius.resize(300);
    last.type.resize(300);
    last.id.resize(300);
    for (Imath::V3d& p : last.position) p += Imath::V3d(4, 0, 0); // into the neighbour cell
    MixtureSeries series = series_of(R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 4})");
    const auto before = test::types_of(*series.mixture(frame), frame);
    series.decide(last);
    EXPECT_TRUE(series.decided());
    const auto after = test::types_of(*series.mixture(frame), frame);
    for (size_t i = 0; i < frame.size(); ++i) EXPECT_EQ(after[i], i < 300 ? 1 - before[i] : before[i]);
}

} // namespace
} // namespace scree
