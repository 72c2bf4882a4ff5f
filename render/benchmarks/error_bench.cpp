// Compares the error that `scree render --error` claims with the true error, and its time with that of uniform
// sampling, on the scenes of a suite. usage: error_bench [suite, default examples/bench/suite.json] [errors, default
// 0.05,0.02] [seconds of a scene's reference, default 20]
//                    [pictures of each error, default 2] [size, of the suite's, default 0.5] [only the scene of this
//                    name]

#include "base/error.h"
#include "base/hash.h"
#include "base/text_table.h"
#include "render/bench/bench_suite.h"
#include "render/bench/bench_words.h"
#include "render/bench/method_run.h"

#include <fmt/format.h>

#include <sstream>

namespace {

using namespace scree;
using Row = std::vector<std::string>;

/// Pictures rendered to the same error, each with its own seed, and their cost.
struct Adaptive {
    double asked = 0, claim = 0, samples = 0, seconds = 0; ///< claim: squared; all but the first are sums
    std::vector<std::vector<V3d>> pictures;

    void render(const MethodRun& run)
    {
        Film film = run.empty_film();
        const WorkMeter meter;
        const RenderStatistics statistics = run.render_apart(film, mix64(pictures.size()), 1u << 24, asked);
        seconds += meter.time().processor;
        claim += statistics.error->picture * statistics.error->picture;
        samples += statistics.mean_spp;
        pictures.emplace_back();
        for (const Pixel& pixel : film.pixels()) pictures.back().push_back(pixel.mean());
    }
};

/// The root of a squared number as "4.8 +- 0.2 %".
std::string error_of(const Measured& squared, const Measured& reference_noise)
{
    if (!(squared.value > squared.error))
        return fmt::format("< {} (ref.)", root_words(std::max(squared.high(), reference_noise.value)));
    const double root = std::sqrt(squared.value);
    return fmt::format("{:.2f} +- {:.2f} %", 100 * root, 50 * squared.error / root);
}

/// uniform: two pictures with equally many samples in all pixels, the reference. Errors are means over pictures.
Row row_of(const std::string& name, const Adaptive& adaptive, const MethodRun& uniform)
{
    const auto n = static_cast<double>(adaptive.pictures.size());
    const HalfPictures reference = make_halves(uniform.films());
    const Measured squared = squared_error(adaptive.pictures, reference),
                   noise = estimate_error(reference, reference).noise;
    Row row{name,
            fmt::format("{:.3g} %", 100 * adaptive.asked),
            error_of(squared, noise),
            root_words(adaptive.claim / n),
            root_words(noise.value),
            fmt::format("{:.0f}", adaptive.samples / n),
            "-",
            fmt::format("{:.2f}", adaptive.seconds / n),
            "-",
            "-"};
    if (!(squared.value > squared.error) || !(noise.value > 0)) return row;
    const Measured part = part_to_error(adaptive.pictures, reference);
    const double seconds = uniform.total_time().processor, ratio = seconds * n / adaptive.seconds;
    row[6] = fmt::format("{:.0f}", static_cast<double>(uniform.total_samples()) * part.value);
    row[8] = fmt::format("{:.2f}", seconds * part.value);
    row[9] = fmt::format("{:.2f} +- {:.2f}", ratio * part.value, ratio * part.error);
    return row;
}

} // namespace

int main(int argc, char** argv)
try {
    const auto argument = [&](int i, const char* absent) { return std::string(argc > i ? argv[i] : absent); };
    std::vector<double> errors;
    std::istringstream list(argument(2, "0.05,0.02"));
    for (std::string word; std::getline(list, word, ',');) errors.push_back(std::stod(word));
    const double reference_seconds = std::stod(argument(3, "20")), size = std::stod(argument(5, "0.5"));
    const size_t pictures = std::stoul(argument(4, "2"));
    std::vector<Row> rows{
        {"scene", "asked", "true", "claimed", "reference", "samples", "uniform", "seconds", "uniform", "ratio"}};
    for (BenchJob job : read_suite(argument(1, "examples/bench/suite.json"), 1)) {
        if (argc > 6 && job.title != argv[6]) continue;
        const FilmDescription film = load_scene(job.scene).film;
        const auto scaled = [size](int pixels) { return static_cast<int>(pixels * size); };
        job.scene.set("--size", fmt::format("{}x{}", scaled(film.width), scaled(film.height)));
        MethodRun run(job, {"as it is", {}}, mix64(1000), 2, Progress());
        std::vector<Adaptive> adaptives;
        for (const double error : errors) adaptives.push_back({error, 0, 0, 0, {}});
        const double each = reference_seconds * this_machine(0).threads / static_cast<double>(pictures * errors.size());
        double until = 0;
        for (size_t k = 0; k < pictures; ++k) {
            for (Adaptive& adaptive : adaptives) { // in turns, as the machine's speed may change
                adaptive.render(run);
                until += each;
                for (size_t h = 0; h < 2; ++h) run.render_until(h, until / 2, Progress());
            }
        }
        for (const Adaptive& adaptive : adaptives) rows.push_back(row_of(job.title, adaptive, run));
        fmt::print(stderr, "{}\n", job.title);
    }
    fmt::print(
        "\nErrors: root of the mean squared relative error. True: of one picture against the uniform ones, minus "
        "their noise (reference), with a standard error that includes this noise. Samples: a pixel.\n"
        "Seconds: processor time. Uniform: equally many samples in all pixels, to the same true error. (ref.): "
        "below the reference's noise, not measurable.\n\n{}",
        text_table(rows));
    return 0;
} catch (const scree::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
}
