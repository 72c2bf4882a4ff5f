#include "render/stf/stf_builder.h"

#include "base/error.h"
#include "base/stopwatch.h"
#include "render/stf/shell_walk.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <numeric>

namespace scree {

namespace {

/// The walks of a shell; a walk that does not scatter is made again.
std::vector<ShellWalk> walk_all(const PhaseFunction& phase, size_t shell, std::span<const ShellSampler> smaller,
                                const StfOptions& options, const Progress& progress)
{
    std::vector<ShellWalk> walks(options.walks);
    constexpr uint64_t block = 1024;
    tbb::parallel_for(uint64_t{0}, (options.walks + block - 1) / block, [&](uint64_t b) {
        if (progress.cancelled()) return;
        for (uint64_t i = b * block; i < std::min(options.walks, (b + 1) * block); ++i) {
            Sampler sampler(options.seed, static_cast<uint32_t>(i), static_cast<uint32_t>(shell), 0x5f3759u);
            do walks[i] = walk_in_shell(phase, Stf::radius(shell), smaller, sampler);
            while (walks[i].exit.events == 0);
        }
    });
    if (progress.cancelled()) throw Cancelled();
    return walks;
}

/// Sorts each run of `length`; equal keys by index, so that the order depends on the records alone.
template <class Key>
void sort_runs(std::vector<uint32_t>& order, size_t length, const Key& key)
{
    for (size_t i = 0; i < order.size(); i += length) {
        const auto first = order.begin() + static_cast<std::ptrdiff_t>(i),
                   last = order.begin() + static_cast<std::ptrdiff_t>(std::min(i + length, order.size()));
        std::sort(first, last, [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    }
}

/// Keeps `count` of the records, evenly by mass among records of similar number of events, place and direction.
///
/// Records of few events are kept more often than by mass (a quarter of all evenly over the logarithm of the quantile),
/// because they count for more where light is absorbed.
template <class Record, class Place, class Direction>
void thin(const std::vector<Record>& records, const std::vector<double>& mass, uint32_t count, const Place& place,
          const Direction& direction, std::vector<Record>& kept, std::vector<float>& weights)
{
    std::vector<uint32_t> order(records.size());
    std::iota(order.begin(), order.end(), 0u);
    constexpr size_t like_events = 1024, like_places = 32;
    sort_runs(order, order.size(), [&](uint32_t i) { return records[i].events; });
    sort_runs(order, like_events, [&](uint32_t i) { return place(records[i]); });
    sort_runs(order, like_places, [&](uint32_t i) { return direction(records[i]); });
    const double total = std::accumulate(mass.begin(), mass.end(), 0.0),
                 least = 1.0 / static_cast<double>(records.size()), scale = 1 - std::log(least);
    const auto density = [&](double quantile) { return 0.75 + 0.25 / (scale * std::max(quantile, least)); };
    std::vector<double> share(order.size());
    double before = 0, all = 0;
    for (size_t i = 0; i < order.size(); ++i) {
        const double m = mass[order[i]] / total;
        share[i] = m * density(before + 0.5 * m);
        before += m;
        all += share[i];
    }
    kept.clear();
    weights.clear();
    double sum = 0, weight_sum = 0;
    for (size_t i = 0; i < order.size() && kept.size() < count; ++i) {
        sum += share[i] / all * count;
        while (kept.size() < count && static_cast<double>(kept.size()) + 0.5 < sum) {
            kept.push_back(records[order[i]]);
            weights.push_back(static_cast<float>(mass[order[i]] / share[i]));
            weight_sum += weights.back();
        }
    }
    for (float& w : weights) w = static_cast<float>(w / weight_sum);
}

constexpr double most_cut = 1.25; // largest sum of tilted weights; above it, too few records to find the tilt

/// Tilts the weights of exits so that two means are exact; the noise of walks makes them inexact, and larger shells
/// would add up that error.
///
/// Along any walk the mean of (1 - g) x + w is constant (x the place in mean free paths, w the direction), and so is
/// the mean of |x|^2 + 2 x.w / (1 - g) - 2 n / (1 - g) after n scatterings. So over all light from a centre (1 - g) R
/// E[cos theta_t] + E[cos(w, axis)] = 1 and E[n] = (1 - g) R^2 / 2 + R E[cos(w, normal)].
void calibrate(double g, StfShell& shell)
{
    const double radius = shell.radius, straight = std::exp(-radius), scattered = -std::expm1(-radius);
    const double drift = (1 - straight * ((1 - g) * radius + 1)) / scattered,
                 growth = (0.5 * (1 - g) * radius * radius + straight * radius) / scattered;
    double cosine = 0, events = 0, out = 0;
    const size_t n = shell.exits.size();
    std::vector<double> along(n), excess(n); // each exit's terms of the two known means
    for (size_t i = 0; i < n; ++i) {
        const ShellExit& exit = shell.exits[i];
        const ShellPlace there = place_of(exit);
        const double w = shell.exit_weights[i], mu = there.place.dot(there.direction);
        along[i] = (1 - g) * radius * exit.cos_t + there.direction.z;
        excess[i] = exit.events - radius * mu;
        cosine += w * exit.cos_t;
        events += w * exit.events;
        out += w * mu;
    }
    // Two linear equations for the tilt by cos theta_t and by events.
    double a00 = 0, a01 = 0, a10 = 0, a11 = 0, b0 = drift, b1 = growth;
    for (size_t i = 0; i < n; ++i) {
        const double w = shell.exit_weights[i], u = shell.exits[i].cos_t - cosine,
                     v = shell.exits[i].events / events - 1;
        a00 += w * u * along[i];
        a01 += w * v * along[i];
        a10 += w * u * excess[i];
        a11 += w * v * excess[i];
        b0 -= w * along[i];
        b1 -= w * excess[i];
    }
    const double determinant = a00 * a11 - a01 * a10;
    if (!(std::abs(determinant) > 1e-6 * (std::abs(a00 * a11) + std::abs(a01 * a10))))
        return; // the records cannot separate the two tilts
    const double by_cosine = (b0 * a11 - b1 * a01) / determinant, by_events = (a00 * b1 - a10 * b0) / determinant;
    std::vector<double> tilted(n);
    double sum = 0; // 1, unless some weights are cut off at 0: then the means are improved, but not exact
    for (size_t i = 0; i < n; ++i) {
        const double tilt =
            1 + by_cosine * (shell.exits[i].cos_t - cosine) + by_events * (shell.exits[i].events / events - 1);
        tilted[i] = shell.exit_weights[i] * std::max(0.0, tilt);
        sum += tilted[i];
    }
    if (!std::isfinite(sum) || sum > most_cut) return;
    for (size_t i = 0; i < n; ++i) shell.exit_weights[i] = static_cast<float>(tilted[i] / sum);
}

StfShell make_shell(const PhaseFunction& phase, size_t number, std::span<const ShellSampler> smaller,
                    const StfOptions& options, const Progress& progress)
{
    const std::vector<ShellWalk> walks = walk_all(phase, number, smaller, options, progress);
    StfShell shell;
    shell.radius = Stf::radius(number);
    std::vector<ShellExit> exits;
    std::vector<ShellEvent> events;
    std::vector<double> mass;
    for (const ShellWalk& walk : walks) {
        exits.push_back(walk.exit);
        events.push_back(walk.event);
        mass.push_back(walk.event_sum);
        shell.event_sum += walk.event_sum;
    }
    shell.event_sum /= static_cast<double>(walks.size());
    thin(
        exits, std::vector<double>(walks.size(), 1.0), options.records, [](const ShellExit& e) { return e.cos_t; },
        [](const ShellExit& e) { return e.away; }, shell.exits, shell.exit_weights);
    calibrate(phase.mean_cosine(), shell);
    thin(
        events, mass, options.records, [](const ShellEvent& e) { return e.along; },
        [](const ShellEvent& e) { return e.direction.z; }, shell.events, shell.event_weights);
    return shell;
}

} // namespace

std::vector<double> extend_stf(Stf& stf, size_t shells, const StfOptions& options, const Progress& progress)
{
    if (options.walks < 1u << 10 || options.walks > 1u << 24 || options.records < 1u << 6 ||
        options.records > 1u << 20) {
        throw InputError("shell transport functions",
                         fmt::format("{} walks, {} records", options.walks, options.records),
                         "2^10 to 2^24 walks, 2^6 to 2^20 records");
    }
    stf.shells.reserve(shells); // samplers point at the shells, which must not move
    std::vector<ShellSampler> smaller;
    for (const StfShell& shell : stf.shells) smaller.emplace_back(shell, 1.0);
    std::vector<double> seconds;
    while (stf.shells.size() < shells) {
        const Stopwatch watch;
        const size_t number = stf.shells.size();
        progress.update(fmt::format("shell of {:.3g} mean free paths", Stf::radius(number)),
                        static_cast<double>(number) / static_cast<double>(shells));
        stf.shells.push_back(make_shell(stf.phase, number, smaller, options, progress));
        smaller.emplace_back(stf.shells.back(), 1.0);
        seconds.push_back(watch.seconds());
    }
    return seconds;
}

} // namespace scree
