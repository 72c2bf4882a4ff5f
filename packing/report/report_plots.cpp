#include "packing/report/report_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {

namespace {

using Style = PlotSeries::Style;

constexpr double nearly_one_size = 0.03; // greatest polydispersity at which Percus-Yevick for one size is plotted

std::vector<double> edges_of(double first, double width, size_t bins)
{
    std::vector<double> edges;
    for (size_t k = 0; k <= bins; ++k) edges.push_back(first + double(k) * width);
    return edges;
}

/// The counts over their sum, from the first to the last nonzero bin.
PlotSeries shares(const std::string& name, double first, double width, const std::vector<uint64_t>& counts)
{
    double sum = 0;
    for (const uint64_t n : counts) sum += double(n);
    size_t begin = 0, end = counts.size();
    while (end > begin && counts[end - 1] == 0) --end;
    while (begin < end && counts[begin] == 0) ++begin;
    PlotSeries s{name, Style::bars, edges_of(first + double(begin) * width, width, end - begin), {}, {}};
    for (size_t k = begin; k < end; ++k) s.y.push_back(sum > 0 ? double(counts[k]) / sum : 0);
    return s;
}

/// Percus-Yevick's g from contact to x_max.
PlotSeries percus_yevick_curve(double fraction, double x_max)
{
    constexpr int steps = 200;
    const std::vector<double> g = percus_yevick(fraction, steps, x_max);
    PlotSeries s{"Percus-Yevick", Style::dashes, {}, {}, {}};
    for (size_t k = 0; k < g.size(); k += 2) {
        s.x.push_back(1 + double(k) / steps);
        s.y.push_back(g[k]);
    }
    return s;
}

bool has_theory(const PackingReport& r) { return r.fraction.bulk > 0 && r.fraction.bulk < 0.55; }

PlotSeries measured_g(const PairCorrelation& g, double x_max, Style style)
{
    PlotSeries s{"measured", style, {}, {}, {}};
    for (size_t k = 0; k < g.g.size(); ++k) {
        const double x = (double(k) + 0.5) * g.bin_width;
        if (x > x_max) break;
        if (style == Style::dots && x < 1) continue;
        s.x.push_back(x);
        s.y.push_back(g.g[k]);
    }
    return s;
}

} // namespace

Plot plot_radii(const RadiusStatistics& radii)
{
    Plot plot{"Radii",
              "radius",
              "share of the spheres",
              false,
              false,
              {shares("", radii.bin_first, radii.bin_width, radii.counts)},
              {{radii.mean, "mean", false}},
              {},
              {}};
    if (radii.distinct == 1) plot.x_range = {0.5 * radii.mean, 1.5 * radii.mean};
    return plot;
}

Plot plot_profiles(const PackingReport& report)
{
    const bool mesh = report.containment.has_value();
    Plot plot{"Solid fraction in slices",
              mesh ? "depth below the surface, in mean radii" : "place along the axis, from 0 to 1",
              "solid fraction",
              false,
              false,
              {},
              {},
              {},
              {}};
    for (const FractionProfile& p : report.profiles) {
        PlotSeries s{p.name, mesh ? Style::dots : Style::line, {}, {}, {}};
        const double unit = mesh ? report.radii.mean : p.width * double(p.points.size());
        for (size_t k = 0; k < p.points.size(); ++k) {
            if (p.points[k] < 20) continue;
            const double n = double(p.points[k]), f = double(p.hits[k]) / n;
            s.x.push_back((double(k) + 0.5) * p.width / unit);
            s.y.push_back(f);
            s.error.push_back(std::sqrt(f * (1 - f) / n));
        }
        plot.series.push_back(s);
    }
    if (report.fraction.bulk > 0) plot.marks.push_back({report.fraction.bulk, mesh ? "bulk" : "whole", true});
    double greatest = report.fraction.bulk;
    for (const PlotSeries& s : plot.series)
        for (const double f : s.y) greatest = std::max(greatest, f);
    plot.y_range = {0, std::min(1.0, 1.15 * greatest + 1e-3)};
    return plot;
}

Plot plot_overlaps(const NearPairs& near)
{
    Plot plot{"Overlaps",
              "overlap / smaller radius",
              "pairs",
              true,
              true,
              {},
              {{1e-6, "limit of tiles and fills", false}},
              {},
              {}};
    PlotSeries s{"pairs that overlap", Style::bars, {}, {}, {}};
    size_t last = near.overlap_counts.size();
    while (last > 0 && near.overlap_counts[last - 1] == 0) --last;
    uint64_t most = 1;
    for (size_t k = 0; k <= near.overlap_counts.size(); ++k)
        s.x.push_back(std::pow(10, NearPairs::log_first + double(k) / NearPairs::bins_per_decade));
    for (const uint64_t n : near.overlap_counts) {
        s.y.push_back(double(n));
        most = std::max(most, n);
    }
    plot.x_range = {s.x.front(), std::max(s.x[last], 1e-5)};
    plot.y_range = {0.5, 2 * double(most)};
    plot.series.push_back(s);
    return plot;
}

Plot plot_margins(const Containment& c)
{
    Plot plot{"Margins to the mesh",
              "(distance to the surface − radius) / radius",
              "spheres",
              false,
              false,
              {},
              {{0, "touching", false}},
              {},
              {}};
    PlotSeries s{"", Style::bars, edges_of(Containment::bin_first, Containment::bin_width, c.margins.size()), {}, {}};
    for (const uint64_t n : c.margins) s.y.push_back(double(n));
    plot.series.push_back(s);
    return plot;
}

Plot plot_pair_correlation(const PackingReport& report)
{
    const PairCorrelation& g = report.correlation;
    Plot plot{"Pair correlation",
              "x = d / (r₁ + r₂)",
              "g(x)",
              false,
              false,
              {measured_g(g, g.x_max, Style::line)},
              {},
              {},
              {}};
    if (has_theory(report) && report.fraction.bulk_moments.polydispersity() < nearly_one_size)
        plot.series.push_back(percus_yevick_curve(report.fraction.bulk, g.x_max));
    plot.x_range = {0, g.x_max};
    // The contact peak of a jammed packing is so high that all else would look flat.
    const double most = *std::max_element(g.g.begin(), g.g.end());
    plot.y_range = {0, std::min(1.08 * most, 8.0)};
    return plot;
}

Plot plot_contact_value(const PackingReport& report)
{
    const PairCorrelation& g = report.correlation;
    Plot plot{"Close to contact",
              "x = d / (r₁ + r₂)",
              "g(x)",
              false,
              false,
              {measured_g(g, 1.5, Style::dots)},
              {},
              std::pair(0.98, 1.5),
              {}};
    if (has_theory(report)) {
        if (report.fraction.bulk_moments.polydispersity() < nearly_one_size)
            plot.series.push_back(percus_yevick_curve(report.fraction.bulk, 1.5));
        plot.series.push_back({"Carnahan-Starling", Style::dots, {1}, {report.theory_contact}, {}});
        plot.series.push_back({"extrapolated", Style::dots, {0.995}, {g.contact.value}, {g.contact.standard_error}});
        plot.series.push_back(
            {"by free paths", Style::dots, {0.99}, {g.free_path_contact.value}, {g.free_path_contact.standard_error}});
    }
    return plot;
}

Plot plot_contacts(const NearPairs& near)
{
    Plot plot{"Contacts against tolerance",
              "gap that counts as contact, in mean radii",
              "contacts per sphere",
              true,
              false,
              {},
              {},
              {},
              {}};
    PlotSeries s{"contacts", Style::line, {}, near.contacts_below_gap, {}};
    for (size_t k = 0; k < s.y.size(); ++k)
        s.x.push_back(std::pow(10, NearPairs::log_gap_first + double(k) / NearPairs::gaps_per_decade));
    plot.series.push_back(s);
    plot.marks = {{NearPairs::contact_tolerance, "tolerance of this report", false}, {6, "isostatic", true}};
    plot.y_range = {0, std::max(8.0, 1.05 * s.y.back())};
    return plot;
}

Plot plot_contact_numbers(const NearPairs& near)
{
    Plot plot{"Contacts of a sphere",
              "contacts",
              "share of the spheres",
              false,
              false,
              {shares("", -0.5, 1, near.contact_counts)},
              {{near.mean_contacts, "mean", false}},
              {},
              {}};
    plot.x_range = {-0.5, std::max(13.5, double(near.contact_counts.size()) - 0.5)};
    return plot;
}

Plot plot_void_chords(const VoidChords& chords)
{
    Plot plot{"Void chords",       "chord / expected mean", "probability density", false, true, {}, {},
              std::pair(0.0, 8.0), std::pair(1e-4, 2.0)};
    PlotSeries measured{"measured", Style::dots, {}, {}, {}},
        exponential{"exponential", Style::dashes, {0, 9}, {1, std::exp(-9)}, {}};
    double most = 1;
    for (size_t k = 0; k < chords.density.size(); ++k) {
        measured.x.push_back((double(k) + 0.5) * VoidChords::bin_width);
        measured.y.push_back(chords.density[k]);
        measured.error.push_back(std::sqrt(chords.density[k] / (double(chords.chords) * VoidChords::bin_width)));
        most = std::max(most, chords.density[k]);
    }
    plot.y_range->second = 2 * most;
    plot.series = {measured, exponential};
    return plot;
}

Plot plot_cells(const LaguerreCells& cells)
{
    return {"Local fraction",
            "sphere's part of its Laguerre cell",
            "share of the spheres",
            false,
            false,
            {shares("", 0, LaguerreCells::bin_width, cells.counts)},
            {{cells.mean, "mean", false}},
            {},
            {}};
}

Plot plot_bond_order(const BondOrder& bonds)
{
    Plot plot{
        "Local bond order",
        "q4, q6 of a sphere",
        "share of the spheres",
        false,
        false,
        {shares("q6", 0, BondOrder::bin_width, bonds.local_q6), shares("q4", 0, BondOrder::bin_width, bonds.local_q4)},
        {{0.57452, "q6 of fcc", false}, {0.48476, "hcp", false}, {0.51069, "bcc", false}},
        {},
        {}};
    plot.x_range = {0, 0.8};
    return plot;
}

} // namespace scree
