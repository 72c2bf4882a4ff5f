// What `scree render --error` claims against what is true, and its time against that of as many samples everywhere, on the scenes of a suite.
// usage: error_bench [suite, default examples/bench/suite.json] [errors, default 0.05,0.02] [seconds of a scene's reference, default 20]
//                    [pictures of each error, default 2] [size, of the suite's, default 0.5] [only the scene of this name]

#include "ingest/support/error.h"
#include "mixtures/hash.h"
#include "render/bench/bench_suite.h"
#include "render/bench/error_estimate.h"
#include "render/bench/text_table.h"
#include "render/bench/work_meter.h"
#include "render/render_setup.h"

#include <fmt/format.h>

#include <sstream>

namespace {

using namespace scree;

/// A scene of the suite, ready to be rendered as it is by default.
class Stage {
public:
    explicit Stage(const RenderJob& job) : builder_(load_scene(job)), frame_(job.frames ? job.frames->first : 0), setup_(builder_, builder_.build(frame_, Progress()), job) {}

    Film film() const
    {
        const FilmDescription& film = builder_.scene().film;
        return {film.width, film.height, 0, 0, film.width, film.height};
    }
    /// On with a film, to so many samples or to an error.
    RenderStatistics render(Film& film, uint64_t seed, uint32_t spp, double error) const
    {
        RenderOptions options = setup_.options();
        options.timeout = 0;
        options.seed = seed;
        options.spp = spp;
        options.error = error;
        return scree::render(setup_.world(), setup_.tracer(), setup_.camera(), setup_.filter(), film, options, Progress());
    }

private:
    WorldBuilder builder_;
    size_t frame_;
    RenderSetup setup_;
};

/// Pictures of two seeds with the same number of samples everywhere, and what they took.
struct Uniform {
    HalfPictures picture;
    double seconds = 0, samples = 0;
};

Uniform render_uniform(const Stage& stage, double wall_seconds)
{
    std::vector<Film> films{stage.film(), stage.film()};
    const WorkMeter meter;
    uint32_t spp = 4;
    for (; meter.time().wall < wall_seconds; spp *= 2) {
        for (size_t s = 0; s < 2; ++s) stage.render(films[s], mix64(1000 + s), spp, 0);
    }
    return {make_halves(films), meter.time().processor, static_cast<double>(spp)}; // spp / 2 of each half
}

using Row = std::vector<std::string>;

/// Mean over pictures, each of another seed.
Row row_of(const std::string& name, const Stage& stage, const Uniform& uniform, double error, int pictures)
{
    double squared = 0, doubt = 0, claim = 0, samples = 0, seconds = 0;
    for (int k = 0; k < pictures; ++k) {
        Film film = stage.film();
        const WorkMeter meter;
        const RenderStatistics statistics = stage.render(film, mix64(static_cast<uint64_t>(k)), 1u << 24, error);
        seconds += meter.time().processor / pictures;
        std::vector<V3d> means;
        for (const Pixel& pixel : film.pixels()) means.push_back(pixel.mean());
        const Measured e = squared_error(means, uniform.picture);
        squared += e.value / pictures;
        doubt += e.error * e.error / (pictures * pictures);
        claim += statistics.error->picture * statistics.error->picture / pictures;
        samples += statistics.mean_spp / pictures;
    }
    const double noise = estimate_error(uniform.picture, uniform.picture).noise.value;
    const double truth = std::sqrt(std::max(0.0, squared)), times = noise / squared; // of the uniform pictures' work, to the same error
    return {name, fmt::format("{:.3g} %", 100 * error), fmt::format("{:.2f} +- {:.2f} %", 100 * truth, 50 * std::sqrt(doubt) / truth), fmt::format("{:.2f} %", 100 * std::sqrt(claim)),
            fmt::format("{:.0f}", samples), fmt::format("{:.0f}", uniform.samples * times), fmt::format("{:.2f}", seconds), fmt::format("{:.2f}", uniform.seconds * times),
            fmt::format("{:.2f}", uniform.seconds * times / seconds)};
}

} // namespace

int main(int argc, char** argv)
try {
    const auto argument = [&](int i, const char* absent) { return std::string(argc > i ? argv[i] : absent); };
    std::vector<double> errors;
    std::istringstream list(argument(2, "0.05,0.02"));
    for (std::string word; std::getline(list, word, ',');) errors.push_back(std::stod(word));
    const double reference_seconds = std::stod(argument(3, "20")), size = std::stod(argument(5, "0.5"));
    std::vector<Row> rows{{"scene", "asked", "true", "claimed", "samples", "uniform", "seconds", "uniform", "ratio"}};
    for (const BenchJob& bench : read_suite(argument(1, "examples/bench/suite.json"), 1)) {
        if (argc > 6 && bench.title != argv[6]) continue;
        RenderJob job = bench.scene;
        job.frames = FrameRange{bench.frame, bench.frame, 1};
        if (job.size) job.size = std::pair(static_cast<int>(job.size->first * size), static_cast<int>(job.size->second * size));
        const Stage stage(job);
        const Uniform uniform = render_uniform(stage, reference_seconds);
        for (const double error : errors) rows.push_back(row_of(bench.title, stage, uniform, error, std::stoi(argument(4, "2"))));
        fmt::print(stderr, "{}\n", bench.title);
    }
    fmt::print("\nErrors: root of the mean squared relative error; true: against the uniform pictures, less their noise. Samples: a pixel. Seconds: of processors. Uniform: with as many samples everywhere,\n"
               "to the same true error.\n\n{}", text_table(rows));
    return 0;
} catch (const scree::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
}
