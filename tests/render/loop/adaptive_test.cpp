// Rendering up to an error: the samples decide how many samples are drawn, and this must not bias the picture.

#include "base/sampler.h"
#include "render/film/checkpoint.h"
#include "render/loop/adaptive.h"
#include "tests/builders/scene_files.h"
#include "tests/builders/statistics.h"

#include <gmock/gmock.h>

namespace scree {
namespace {

using namespace test;

/// A sample of mean 1: 0.5, and with probability p also 0.5 / p.
struct RareLight {
    double p;
    Color operator()(Sampler& sampler) const
    {
        return Color(static_cast<float>(0.5 + (sampler.next() < p ? 0.5 / p : 0.0)));
    }
};

/// each: half of every pixel.
void draw(Film& film, int tile, const std::array<uint32_t, 2>& each, uint64_t seed, const RareLight& light)
{
    TileState& state = film.tile_states().tiles[static_cast<size_t>(tile)];
    const int x0 = tile % film.tile_columns() * Film::tile_size, y0 = tile / film.tile_columns() * Film::tile_size;
    for (int y = y0; y < std::min(y0 + Film::tile_size, film.y1()); ++y) {
        for (int x = x0; x < std::min(x0 + Film::tile_size, film.x1()); ++x) {
            PixelHalves& halves = film.halves_at(x, y);
            while (const std::optional<uint32_t> s = halves.next(each)) {
                Sampler sampler(seed, static_cast<uint32_t>(x), static_cast<uint32_t>(y), *s);
                const Color radiance = light(sampler);
                film.at(x, y).add(radiance, {});
                state.work[*s & 1] += radiance.x > 1 ? 100 : 1; // bright samples cost more
                halves.note_drawn(*s);
                halves.add(*s, radiance, state.counts);
            }
        }
    }
}

/// Does what `render` does, but with samples that cost no time; false when the limit of samples was reached.
bool draw_to_error(Film& film, double error, uint32_t most, uint64_t seed, const RareLight& light)
{
    film.keep_halves();
    TileStates& states = film.tile_states();
    AdaptivePlan plan(states, film.tile_columns(), error);
    while (!plan.finished()) {
        bool limited = false;
        for (size_t i = 0; i < states.tiles.size(); ++i) {
            std::array<uint32_t, 2> each = plan.asked(i);
            for (uint32_t& n : each) {
                limited = limited || n > most;
                n = std::min(n, most);
            }
            draw(film, static_cast<int>(i), each, seed, light);
        }
        if (limited) return false;
        estimate_tiles(film, plan);
        plan.decide();
    }
    return true;
}

/// The obvious rule, which is biased: a tile stops at the first level at which its own samples allow it.
double naive_mean(double error, uint32_t most, uint64_t seed, const RareLight& light)
{
    Film film(64, 64, 0, 0, 64, 64);
    film.keep_halves();
    double sum = 0;
    for (int tile = 0; tile < film.tile_columns() * film.tile_rows(); ++tile) {
        double mean = 0;
        for (uint32_t level = AdaptivePlan::least_samples(error);;
             level = AdaptivePlan::next_level(level, AdaptivePlan::least_samples(error))) {
            draw(film, tile, {level, level}, seed, light);
            double variance = 0;
            mean = 0;
            for (int y = 0; y < Film::tile_size; ++y) {
                for (int x = 0; x < Film::tile_size; ++x) {
                    const Pixel& pixel = film.at(tile % 4 * Film::tile_size + x, tile / 4 * Film::tile_size + y);
                    mean += pixel.mean().x / 256;
                    variance += pixel.variance().x / 256;
                }
            }
            if (variance <= error * error * mean * mean || level >= most) break;
        }
        sum += mean / 16;
    }
    return sum;
}

TEST(Adaptive, IsUnbiasedWhereTheNaiveRuleIsNot)
{
    const RareLight light{3e-4};
    constexpr double error = 1;
    constexpr uint32_t most = 1024;
    Estimate halves, naive, told;
    for (uint64_t seed = 0; seed < 16; ++seed) {
        Film film(64, 64, 0, 0, 64, 64);
        draw_to_error(film, error, most, seed, light);
        film.take_halves();
        double mean = 0, squares = 0, variance = 0;
        for (const Pixel& pixel : film.pixels()) {
            mean += pixel.mean().x / 4096;
            squares += (pixel.mean().x - 1) * (pixel.mean().x - 1) / 4096;
            variance += pixel.variance().x / 4096;
        }
        halves.add(mean);
        told.add(variance - squares);
        naive.add(naive_mean(error, most, seed, light));
    }
    std::printf("truth 1: two halves %.4f +- %.4f, naive %.4f +- %.4f; variance told %.4f +- %.4f more than it is\n",
                halves.mean(), halves.standard_error(), naive.mean(), naive.standard_error(), told.mean(),
                told.standard_error());
    EXPECT_LT(std::abs(halves.z(1)), 4);
    EXPECT_LT(halves.standard_error(), 0.025);
    EXPECT_LT(naive.z(1), -6);
    EXPECT_LT(std::abs(told.z(0)), 4);
}

TEST(Adaptive, ClaimsTheErrorThereIs)
{
    const RareLight light{0.02};
    for (const double error : {0.2, 0.1}) {
        Estimate difference, truth, claims;
        for (uint64_t seed = 0; seed < 10; ++seed) {
            Film film(64, 48, 0, 0, 64, 48);
            ASSERT_TRUE(draw_to_error(film, error, 1u << 20, seed, light));
            const RelativeError measure(V3d(1));
            double squares = 0;
            for (const PixelHalves& pixel : film.halves()) {
                const V3d off = pixel.mean() - V3d(1);
                squares += measure.of(off.dot(off), V3d(1));
            }
            squares /= static_cast<double>(film.halves().size());
            const double claim = claimed_error(film)->picture;
            truth.add(squares);
            claims.add(claim * claim);
            difference.add(claim * claim - squares);
        }
        std::printf("error asked for %.3f, claimed %.4f, true %.4f\n", error, std::sqrt(claims.mean()),
                    std::sqrt(truth.mean()));
        EXPECT_LT(std::sqrt(truth.mean()), 1.05 * error);
        EXPECT_GT(std::sqrt(truth.mean()), 0.6 * error);
        EXPECT_LT(std::abs(std::sqrt(claims.mean() / truth.mean()) - 1), 0.05 + error * error);
    }
}

TEST(Adaptive, DecidesForAHalfByTheOtherAlone)
{
    TileStates states;
    states.tiles.resize(2);
    states.level = 100;
    AdaptivePlan plan(states, 2, 0.1);
    for (TileState& tile : states.tiles) {
        tile.estimates[0] = {256, V3d(256), 0.5, 0}; // needs 25 of each half
        tile.estimates[1] = {256, V3d(256), 8, 0}; // needs 400
    }
    plan.decide();
    for (const TileState& tile : states.tiles) {
        EXPECT_EQ(tile.counts.counts[1], 100u);
        EXPECT_EQ(tile.counts.counts[0], undecided);
    }
    EXPECT_FALSE(plan.judges(0, 0));
    EXPECT_TRUE(plan.judges(0, 1));
    states.level = 500;
    plan.decide();
    EXPECT_TRUE(plan.finished());
    EXPECT_EQ(states.tiles[0].counts.counts, (std::array<uint32_t, 2>{500, 100}));
}

TEST(Adaptive, GivesTilesByTheRootOfTheirVarianceAndLooksAround)
{
    TileStates states;
    states.tiles.resize(5);
    AdaptivePlan plan(states, 5, 0.05);
    const double variances[] = {0, 1, 1, 0, 0};
    const auto decide = [&](double deviation) {
        for (size_t i = 0; i < 5; ++i) {
            states.tiles[i].counts = {};
            for (TileEstimate& estimate : states.tiles[i].estimates)
                estimate = {256, V3d(256), variances[i], deviation * variances[i]};
        }
        states.level = AdaptivePlan::least_samples(0.05);
        plan.decide();
    };
    decide(1); // about one sighting per tile
    EXPECT_TRUE(states.tiles[0].counts.going()) << "a quiet tile beside a noisy one";
    EXPECT_TRUE(states.tiles[3].counts.going());
    EXPECT_FALSE(states.tiles[4].counts.going()) << "nothing there, nor in the tiles around";
    decide(0.01);
    EXPECT_FALSE(states.tiles[0].counts.going()) << "surely quiet";
    EXPECT_TRUE(states.tiles[1].counts.going());
}

TEST(Adaptive, GivesTilesByTheRootOfWhatTheirSamplesCost)
{
    // Samples wanted of each half at 5 %: (1 + 2) / 2 / sqrt(work) / (2 * 0.05^2), 300 and 150, decided by half as
    // many.
    for (const uint32_t level : {70, 80, 140, 160, 310}) {
        TileStates states;
        states.tiles.resize(2);
        states.level = level;
        AdaptivePlan plan(states, 2, 0.05);
        for (TileEstimate& estimate : states.tiles[0].estimates) estimate = {256, V3d(256), 1, 0, 1};
        for (TileEstimate& estimate : states.tiles[1].estimates) estimate = {256, V3d(256), 1, 0, 4};
        plan.decide();
        for (const uint32_t count : states.tiles[0].counts.counts)
            EXPECT_EQ(count, level < 150 ? undecided : std::max(level, 300u)) << level;
        for (const uint32_t count : states.tiles[1].counts.counts)
            EXPECT_EQ(count, level < 75 ? undecided : std::max(level, 150u)) << level;
    }
}

TEST(Adaptive, DrawsOfAHalfWhatCountsAndWhatItJudgesBy)
{
    TileStates states;
    states.tiles.resize(1);
    AdaptivePlan plan(states, 1, 0.1);
    const auto asked = [&](uint32_t count0, uint32_t count1, uint32_t level) {
        states.tiles[0].counts.counts = {count0, count1};
        states.level = level;
        return plan.asked(0);
    };
    using Each = std::array<uint32_t, 2>;
    EXPECT_EQ(asked(undecided, undecided, 50), (Each{50, 50}));
    EXPECT_EQ(asked(40, undecided, 50), (Each{50, 50})) << "half 0 judges past its count";
    EXPECT_EQ(asked(70, undecided, 50), (Each{50, 50}));
    EXPECT_EQ(asked(40, 70, 60), (Each{40, 60}));
    EXPECT_FALSE(plan.finished());
    EXPECT_EQ(asked(40, 70, 90), (Each{40, 70}));
    plan.decide();
    EXPECT_TRUE(plan.finished());
    EXPECT_EQ(states.tiles[0].counts.counts, (Each{40, 70}));
}

TEST(Adaptive, DrawsTheSamplesOfAPixelByTheirNumber)
{
    PixelHalves pixel;
    std::vector<uint32_t> drawn;
    for (const std::array<uint32_t, 2>& each : {std::array{1u, 1u}, std::array{2u, 4u}}) {
        while (const std::optional<uint32_t> s = pixel.next(each)) {
            pixel.note_drawn(*s);
            drawn.push_back(*s);
        }
    }
    EXPECT_THAT(drawn, testing::ElementsAre(0, 1, 2, 3, 5, 7));
}

TEST(Adaptive, GoesOnWhereOnlyPartOfAPictureIsAskedFor)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    const Picture part = render_picture(scene, [](RenderJob& job) {
        job.spp = 100000;
        job.options.error = 0.2;
        job.pixel_bounds = {3, 22, 5, 16}; // no whole tile
    });
    EXPECT_LT(part.numbers.at("relativeError"), 0.25);
    EXPECT_GE(*std::ranges::min_element(part.integers.at("samples")), 2 * AdaptivePlan::least_samples(0.2));
    EXPECT_LT(*std::ranges::max_element(part.integers.at("samples")), 100000u);
}

TEST(Adaptive, ClaimsNothingOfPixelsThatHaveNoSpread)
{
    Film film(16, 16, 0, 0, 16, 16);
    film.keep_halves();
    const RareLight light{0.1};
    draw(film, 0, {1, 0}, 1, light);
    EXPECT_FALSE(claimed_error(film));
    draw(film, 0, {1, 1}, 1, light);
    EXPECT_TRUE(claimed_error(film));
}

TEST(Adaptive, KeepsInACheckpointWhatItDecidesBy)
{
    const TemporaryFolder folder;
    Film film(40, 24, 0, 0, 40, 24), again = film;
    film.keep_halves();
    again.keep_halves();
    film.halves_at(3, 0).note_drawn(0);
    film.tile_states().level = 77;
    film.tile_states().done = 61;
    film.tile_states().tiles[2].work = {12, 34};
    film.tile_states().tiles[1].counts.counts = {5, 6};
    film.tile_states().tiles[0].estimates[1] = {1, V3d(2), 3, 4, 5};
    const std::filesystem::path path = folder.path("a.checkpoint");
    write_checkpoint(path, film, {1, 2});
    read_checkpoint(path, again, {1, 2});
    EXPECT_EQ(again.halves_at(3, 0).next({9, 9}), 1u);
    EXPECT_EQ(again.tile_states().level, 77u);
    EXPECT_EQ(again.tile_states().done, 61u);
    EXPECT_EQ(again.tile_states().tiles[2].work, (std::array<uint64_t, 2>{12, 34}));
    EXPECT_EQ(again.tile_states().tiles[1].counts.counts, (std::array<uint32_t, 2>{5, 6}));
    EXPECT_EQ(again.tile_states().tiles[0].estimates[1].work, 5);
}

// The samples of a half must not decide how many of its own samples count, only how many of the other half's.
TEST(Adaptive, CountsOfAHalfDoNotDependOnWhatItSaw)
{
    const auto counts = [](bool brighter) {
        Film film(48, 32, 0, 0, 48, 32);
        film.keep_halves();
        TileStates& states = film.tile_states();
        AdaptivePlan plan(states, film.tile_columns(), 0.05);
        while (!plan.finished()) {
            for (size_t tile = 0; tile < states.tiles.size(); ++tile) {
                const auto each = plan.asked(tile);
                const int x0 = static_cast<int>(tile) % film.tile_columns() * Film::tile_size,
                          y0 = static_cast<int>(tile) / film.tile_columns() * Film::tile_size;
                for (int y = y0; y < y0 + Film::tile_size; ++y)
                    for (int x = x0; x < x0 + Film::tile_size; ++x) {
                        PixelHalves& halves = film.halves_at(x, y);
                        while (const std::optional<uint32_t> s = halves.next(each)) {
                            Sampler sampler(3, static_cast<uint32_t>(x), static_cast<uint32_t>(y), *s);
                            Color radiance = RareLight{0.02 + 0.01 * static_cast<double>(tile)}(sampler);
                            if (brighter && (*s & 1) == 0) radiance = radiance * radiance;
                            halves.note_drawn(*s);
                            halves.add(*s, radiance, states.tiles[tile].counts);
                            states.tiles[tile].work[*s & 1] += brighter && (*s & 1) == 0 ? 3 : 1;
                        }
                    }
            }
            estimate_tiles(film, plan);
            plan.decide();
        }
        std::vector<std::array<uint32_t, 2>> all;
        for (const TileState& tile : states.tiles) all.push_back(tile.counts.counts);
        return all;
    };
    const auto plain = counts(false), changed = counts(true);
    for (size_t tile = 0; tile < plain.size(); ++tile) {
        EXPECT_EQ(plain[tile][0], changed[tile][0]) << tile;
        EXPECT_LT(plain[tile][1], changed[tile][1]) << tile << ": half 0 is noisier";
    }
}

TEST(Adaptive, IsTheSamePictureWithAnyThreadsAndResumed)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    const auto part = [&](int threads, double timeout, bool resume, uint32_t spp) {
        return render_picture(scene, [&](RenderJob& job) {
            job.spp = spp;
            job.threads = threads;
            job.options.error = 0.2;
            job.options.timeout = timeout;
            job.resume = resume;
        });
    };
    const Picture whole = part(1, 0, false, 100000);
    EXPECT_LT(whole.numbers.at("relativeError"), 0.25);
    EXPECT_GT(whole.numbers.at("worstTileError"), whole.numbers.at("relativeError"));
    const auto& samples = whole.integers.at("samples");
    EXPECT_GT(*std::ranges::max_element(samples), *std::ranges::min_element(samples));
    EXPECT_EQ(difference(part(2, 0, false, 100000), whole), "");
    const Picture begun = part(2, 1e-9, false, 100000);
    EXPECT_EQ(begun.numbers.at("spp"), 2);
    EXPECT_GT(begun.numbers.at("relativeError"), 0.2);
    const std::filesystem::path checkpoint = folder.path("out.exr.checkpoint");
    ASSERT_TRUE(std::filesystem::exists(checkpoint));
    EXPECT_TRUE(input_error_of([&] { render_picture(scene, [](RenderJob& job) { job.resume = true; }); }))
        << "a picture without an error";
    for (int i = 0; i < 4; ++i) part(1, 0.02, true, 100000);
    EXPECT_EQ(difference(part(1, 0, true, 100000), whole), "");
    EXPECT_FALSE(std::filesystem::exists(checkpoint));
    part(1, 1e-9, false, 21);
    part(1, 1e-9, true, 2);
    EXPECT_TRUE(std::filesystem::exists(checkpoint)) << "the limit was not reached in time";
    const Picture limited = part(1, 0, false, 21);
    EXPECT_EQ(*std::ranges::max_element(limited.integers.at("samples")), 20u) << "both halves alike";
}

} // namespace
} // namespace scree
