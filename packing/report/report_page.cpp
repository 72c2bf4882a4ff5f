#include "packing/report/report_page.h"

#include "packing/report/report_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace scree {

namespace {

constexpr const char* style = R"(
body { margin: 0; background: #f4f6f8; color: #1d2733; font: 15px/1.5 system-ui, -apple-system, "Segoe UI", sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 28px 20px 60px; }
h1 { font-size: 26px; margin: 0 0 2px; font-weight: 650; }
h2 { font-size: 18px; margin: 0 0 6px; font-weight: 650; }
.file { color: #5a6775; margin: 0 0 18px; overflow-wrap: anywhere; }
section { background: #fff; border: 1px solid #dde3e9; border-radius: 8px; padding: 18px 20px; margin: 0 0 16px; }
p { margin: 4px 0 10px; max-width: 85ch; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin: 6px 0 10px; }
td, th { text-align: left; padding: 3px 18px 3px 0; vertical-align: top; font-weight: normal; }
thead th { color: #5a6775; border-bottom: 1px solid #dde3e9; }
.facts th { color: #5a6775; white-space: nowrap; }
.figures td, .figures th { white-space: nowrap; }
.verdicts { width: 100%; }
.verdicts td { border-top: 1px solid #edf0f3; padding-top: 6px; padding-bottom: 6px; }
.verdicts th { border-top: 1px solid #edf0f3; padding-top: 6px; white-space: nowrap; font-weight: 600; }
.tag { display: inline-block; min-width: 42px; text-align: center; border-radius: 4px; padding: 0 6px; font-size: 12px; font-weight: 700; letter-spacing: .04em; }
.PASS { background: #d8f0df; color: #14602f; }
.FAIL { background: #fbdcd9; color: #96180d; }
.INFO { background: #e3eaf2; color: #34506e; }
.beside { display: grid; grid-template-columns: repeat(auto-fit, minmax(420px, 1fr)); gap: 4px 26px; align-items: start; }
.plots { display: flex; flex-wrap: wrap; gap: 14px; }
figure { margin: 0; flex: 1 1 440px; max-width: 560px; }
figcaption { font-weight: 600; font-size: 13px; color: #34414f; }
.note { color: #5a6775; }
@media print { body { background: #fff; } section { break-inside: avoid; } }
)";

using Rows = std::vector<std::pair<std::string, std::string>>;

std::string title_of(const std::string& key)
{
    static const std::map<std::string, std::string> titles{{"fraction", "Solid fraction"},
                                                           {"overlap", "Overlaps"},
                                                           {"containment", "Containment"},
                                                           {"chords", "Void chords"},
                                                           {"contact_value", "Contact value"},
                                                           {"crystal", "Bond order"},
                                                           {"isotropy", "Isotropy"},
                                                           {"cells", "Laguerre cells"},
                                                           {"contacts", "Contacts"},
                                                           {"profile", "Profiles"},
                                                           {"radii", "Radii"}};
    return titles.at(key);
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::string tag(Verdict verdict) { return fmt::format("<span class=\"tag {0}\">{0}</span>", word_of(verdict)); }

std::string rows_table(const Rows& rows)
{
    std::string html = "<table class=\"facts\">\n";
    for (const auto& [name, value] : rows)
        html += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", xml_escaped(name), xml_escaped(value));
    return html + "</table>\n";
}

std::string figures(const std::vector<Plot>& plots)
{
    std::string html = "<div class=\"plots\">\n";
    for (const Plot& plot : plots)
        html +=
            fmt::format("<figure><figcaption>{}</figcaption>\n{}</figure>\n", xml_escaped(plot.title), svg_of(plot));
    return html + "</div>\n";
}

/// A section with the claims of these keys, then further text; a single plot is put beside the text.
std::string section(const PackingReport& r, const std::string& title, const std::vector<std::string>& keys,
                    const std::string& about, const Rows& rows, const std::vector<Plot>& plots,
                    const std::string& more = "")
{
    std::string text;
    for (const Claim& c : r.claims)
        if (std::ranges::find(keys, c.key) != keys.end())
            text += fmt::format("<p>{} {}</p>\n", tag(c.verdict), xml_escaped(c.text));
    if (!about.empty()) text += fmt::format("<p class=\"note\">{}</p>\n", xml_escaped(about));
    if (!rows.empty()) text += rows_table(rows);
    text += more;
    const std::string heading = fmt::format("<section>\n<h2>{}</h2>\n", xml_escaped(title));
    if (plots.size() == 1)
        return heading + "<div class=\"beside\">\n<div>\n" + text + "</div>\n" + figures(plots) +
               "</div>\n</section>\n";
    return heading + text + (plots.empty() ? "" : figures(plots)) + "</section>\n";
}

std::string head(const PackingReport& r)
{
    std::string html = "<section>\n<h2>Verdicts</h2>\n<table class=\"verdicts\">\n";
    for (const Claim& c : r.claims)
        html += fmt::format("<tr><td>{}</td><th>{}</th><td>{}</td></tr>\n", tag(c.verdict), title_of(c.key),
                            xml_escaped(c.text));
    html += "</table>\n</section>\n<section>\n<h2>What was measured</h2>\n";
    Rows rows = r.source.facts;
    rows.emplace_back("spheres", fmt::format("{}", r.spheres));
    rows.emplace_back("container", r.container);
    rows.emplace_back("bulk", fmt::format("{} spheres", r.fraction.bulk_spheres));
    html += rows_table(rows);
    for (const std::string& note : r.source.notes)
        html += fmt::format("<p class=\"note\">Note: {}.</p>\n", xml_escaped(note));
    return html + "</section>\n";
}

std::string fraction_section(const PackingReport& r)
{
    const SolidFraction& f = r.fraction;
    if (f.points == 0) return section(r, "Solid fraction", {"fraction"}, "", {}, {});
    const Rows rows{{"volume of the spheres", number(f.sphere_volume)},
                    {"volume of the container", number(f.container_volume)},
                    {"fraction by volume", fmt::format("{:.6f}", f.by_volume)},
                    {"fraction by points",
                     fmt::format("{:.6f} ± {:.6f}, {} of {} hit", f.by_points, f.by_points_error, f.hits, f.points)},
                    {"fraction of the bulk",
                     fmt::format("{:.6f}{}", f.bulk, f.bulk_error > 0 ? fmt::format(" ± {:.6f}", f.bulk_error) : "")}};
    const std::string about =
        r.containment ? "A fill has whole spheres only, so the fraction falls towards the surface; the bulk begins "
                        "three largest radii below the surface."
                      : "Where spheres overlap, the fraction by volume counts their shared volume twice.";
    return section(r, "Solid fraction", {"fraction", "profile"}, about, rows, {plot_profiles(r)});
}

std::string overlap_section(const PackingReport& r)
{
    std::string table;
    if (!r.near.worst.empty()) {
        table = "<table class=\"figures\">\n<thead><tr><th>worst pairs: ids</th><th>overlap / smaller "
                "radius</th><th>place</th></tr></thead>\n<tbody>\n";
        for (const NearPairs::Overlap& o : r.near.worst)
            table += fmt::format("<tr><td>{}, {}</td><td>{:.4g}</td><td>{:.6g}, {:.6g}, {:.6g}</td></tr>\n", o.ids[0],
                                 o.ids[1], o.overlap, o.place.x, o.place.y, o.place.z);
        table += "</tbody>\n</table>\n";
    }
    const Rows rows{{"pairs that overlap", fmt::format("{}", r.near.overlapping)},
                    {"mean overlap of these", number(r.near.mean_overlap)}};
    return section(r, "Overlaps", {"overlap"},
                   "Overlap of a pair: (r₁ + r₂ − d) / min(r₁, r₂), periodic images included.", rows,
                   r.near.overlapping > 0 ? std::vector<Plot>{plot_overlaps(r.near)} : std::vector<Plot>{}, table);
}

std::string containment_section(const PackingReport& r)
{
    const Containment& c = *r.containment;
    std::string table = "<table class=\"figures\">\n<thead><tr><th>least margins: "
                        "id</th><th>margin</th><th>radius</th><th>place</th></tr></thead>\n<tbody>\n";
    for (const Containment::Sphere& s : c.worst)
        table += fmt::format("<tr><td>{}</td><td>{:.5g}</td><td>{:.5g}</td><td>{:.6g}, {:.6g}, {:.6g}</td></tr>\n",
                             s.id, s.margin, s.radius, s.position.x, s.position.y, s.position.z);
    table += "</tbody>\n</table>\n";
    return section(r, "Containment", {"containment"},
                   "Margin: distance of the centre from the surface (negative outside) minus the radius. The test "
                   "whether a sphere is wholly inside is exact.",
                   {}, {plot_margins(c)}, c.worst.empty() ? "" : table);
}

std::string radii_section(const PackingReport& r)
{
    const RadiusStatistics& s = r.radii;
    Rows rows{{"mean", number(s.mean)},
              {"standard deviation", number(s.deviation)},
              {"skewness", number(s.skewness)},
              {"least and greatest", number(s.least) + " and " + number(s.greatest)},
              {"different values", fmt::format("{}", s.distinct)}};
    for (const auto& [radius, count] : s.sizes)
        if (s.distinct > 1) rows.emplace_back("radius " + number(radius), fmt::format("{} spheres", count));
    return section(r, "Radii", {"radii"}, "", rows, {plot_radii(s)});
}

std::string correlation_section(const PackingReport& r)
{
    const PairCorrelation& g = r.correlation;
    if (g.x_max == 0) return section(r, "Pair correlation", {"contact_value"}, "", {}, {});
    Rows rows{{"around", fmt::format("{} spheres, out to x = {:g}", g.centres, g.x_max)}};
    if (r.fraction.bulk < 0.494) { // the narrow peak of a jammed packing cannot be extrapolated
        rows.emplace_back("g(1+) by extrapolation",
                          fmt::format("{:.5g} ± {:.2g}, {} pairs up to x = {:g}", g.contact.value,
                                      g.contact.standard_error, g.fitted_pairs, PairCorrelation::fit_end));
        if (g.free_paths > 0)
            rows.emplace_back("g(1+) by free paths", fmt::format("{:.5g} ± {:.2g}, {} paths", g.free_path_contact.value,
                                                                 g.free_path_contact.standard_error, g.free_paths));
        rows.emplace_back("both together",
                          fmt::format("{:.5g} ± {:.2g}", g.best_contact.value, g.best_contact.standard_error));
        rows.emplace_back("g(1+) by theory", number(r.theory_contact));
    }
    if (g.free_paths > 0) rows.emplace_back("reduced pressure PV/NkT", number(g.reduced_pressure));
    return section(r, "Pair correlation", {"contact_value"},
                   "Free paths: on a random line, a sphere in equilibrium is equally likely to be anywhere between the "
                   "two spheres it would hit; this gives the contact value without extrapolation. "
                   "Errors are jackknife estimates over 64 blocks of space.",
                   rows, {plot_pair_correlation(r), plot_contact_value(r)});
}

std::string chord_section(const PackingReport& r)
{
    const VoidChords& c = r.chords;
    if (c.lines == 0) return section(r, "Void chords", {"chords"}, "", {}, {});
    const Rows rows{
        {"mean", fmt::format("{:.6g} ± {:.2g}", c.mean.value, c.mean.standard_error)},
        {"expected", number(c.expected)},
        {"lines", fmt::format("{} of {:.5g} in all, {} entries into spheres", c.lines, c.length, c.entries)}};
    return section(r, "Void chords", {"chords"},
                   "The mean is the length in voids divided by the number of entries into spheres, on pieces of "
                   "isotropic lines chosen independently of the spheres: chords cut by the pieces' ends cause no bias. "
                   "It is exact for spheres that do not overlap, in any arrangement; the distribution is close to "
                   "exponential if the spheres are disordered.",
                   rows, {plot_void_chords(c)});
}

std::string order_section(const PackingReport& r)
{
    const BondOrder& b = r.bonds;
    if (b.spheres == 0) return section(r, "Order and anisotropy", {"crystal", "isotropy"}, "", {}, {});
    const auto fabric = [](const FabricTensor& f) {
        return f.directions == 0
                   ? std::string("none")
                   : fmt::format("{} directions, eigenvalues {:.5f} {:.5f} {:.5f}, deviatoric {:.5f}", f.directions,
                                 f.eigenvalues[0], f.eigenvalues[1], f.eigenvalues[2], f.deviatoric);
    };
    const Rows rows{{"global Q4 and Q6", fmt::format("{:.5f} and {:.5f}", b.global_q4, b.global_q6)},
                    {"mean local q4 and q6", fmt::format("{:.5f} and {:.5f}", b.mean_local_q4, b.mean_local_q6)},
                    {"near neighbours", fmt::format("{:.3f} per sphere", b.mean_neighbours)},
                    {"crystal-like", fmt::format("{:.3f} % of {} spheres", 100 * b.crystal_fraction, b.spheres)},
                    {"fabric of contacts", fabric(r.near.fabric)},
                    {"fabric of neighbours", fabric(b.fabric)}};
    return section(r, "Order and anisotropy", {"crystal", "isotropy"},
                   "Crystal-like: the sphere's bonds agree with those of at least seven neighbours (normalised product "
                   "of q6 above 0.7; Steinhardt et al. 1983, ten Wolde et al. 1996).",
                   rows, {plot_bond_order(b)});
}

} // namespace

std::string html_of(const PackingReport& r)
{
    std::string html =
        fmt::format("<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
                    "charset=\"utf-8\"/>\n"
                    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>Packing report: "
                    "{0}</title>\n<style>{1}</style>\n</head>\n"
                    "<body>\n<main>\n<h1>Packing report</h1>\n<p class=\"file\">{0}</p>\n",
                    xml_escaped(r.source.file), style);
    html += head(r) + fraction_section(r) + overlap_section(r);
    if (r.containment) html += containment_section(r);
    html += radii_section(r) + correlation_section(r) + chord_section(r);
    const NearPairs& n = r.near;
    const Rows contacts{{"contacts per sphere", fmt::format("{:.4f}", n.mean_contacts)},
                        {"rattlers", fmt::format("{} of {}", n.rattlers, n.bulk_spheres)},
                        {"contacts without rattlers", fmt::format("{:.4f}", n.mean_contacts_without_rattlers)}};
    html += section(r, "Contacts", {"contacts"},
                    "A jammed packing shows a plateau near the isostatic number over decades of tolerance; without a "
                    "plateau, the number of contacts depends on the tolerance. "
                    "Rattlers are spheres with fewer than four contacts, removed repeatedly.",
                    n.bulk_spheres > 0 ? contacts : Rows{},
                    n.bulk_spheres > 0 ? std::vector<Plot>{plot_contacts(n), plot_contact_numbers(n)}
                                       : std::vector<Plot>{});
    const LaguerreCells& c = r.cells;
    const Rows cells{{"cells", fmt::format("{}", c.cells)},
                     {"mean and deviation", fmt::format("{:.5f} and {:.5f}", c.mean, c.deviation)},
                     {"least and greatest", fmt::format("{:.5f} and {:.5f}", c.least, c.greatest)},
                     {"hidden or unbounded", fmt::format("{} and {}", c.hidden, c.unbounded)}};
    html += section(r, "Laguerre cells", {"cells"},
                    "The power tessellation with weights r²; of large packings, a block in the middle.",
                    c.cells > 0 ? cells : Rows{}, c.cells > 0 ? std::vector<Plot>{plot_cells(c)} : std::vector<Plot>{});
    return html + order_section(r) + "</main>\n</body>\n</html>\n";
}

} // namespace scree
