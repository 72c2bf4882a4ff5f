#include "packing/report/packing_report.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace scree {

namespace {

using nlohmann::json;

json number(double value) { return std::isfinite(value) ? json(value) : json(); }

json to_json(const Imath::V3d& v) { return {v.x, v.y, v.z}; }

json to_json(const Measured& m) { return {{"value", number(m.value)}, {"standard_error", number(m.standard_error)}}; }

json to_json(const FabricTensor& f)
{
    return {{"directions", f.directions},
            {"tensor_xx_yy_zz_xy_xz_yz", f.tensor},
            {"eigenvalues", f.eigenvalues},
            {"deviatoric", f.deviatoric}};
}

json moments_to_json(const RadiusMoments& m)
{
    json powers = json::array();
    for (int k = 1; k <= 6; ++k) powers.push_back(m.m[k]);
    return powers;
}

json radii_to_json(const RadiusStatistics& s)
{
    json sizes = json::array();
    for (const auto& [radius, count] : s.sizes) sizes.push_back({{"radius", radius}, {"spheres", count}});
    return {{"min", s.least},
            {"max", s.greatest},
            {"mean", s.mean},
            {"standard_deviation", s.deviation},
            {"skewness", s.skewness},
            {"distinct", s.distinct},
            {"sizes", sizes},
            {"histogram", {{"first", s.bin_first}, {"width", s.bin_width}, {"spheres", s.counts}}}};
}

json fraction_to_json(const SolidFraction& f)
{
    return {{"sphere_volume", f.sphere_volume},
            {"container_volume", f.container_volume},
            {"by_volume", f.by_volume},
            {"by_points",
             {{"value", f.by_points}, {"standard_error", f.by_points_error}, {"points", f.points}, {"hits", f.hits}}},
            {"bulk",
             {{"value", f.bulk},
              {"standard_error", f.bulk_error},
              {"points", f.bulk_points},
              {"spheres", f.bulk_spheres},
              {"radius_moments_1_to_6", moments_to_json(f.bulk_moments)}}}};
}

json overlaps_to_json(const NearPairs& n)
{
    json worst = json::array();
    for (const NearPairs::Overlap& o : n.worst)
        worst.push_back({{"ids", o.ids}, {"overlap", o.overlap}, {"place", to_json(o.place)}});
    return {{"pairs", n.overlapping},
            {"complete", n.complete},
            {"mean", n.mean_overlap},
            {"shared_volume", n.lens_volume},
            {"worst", worst},
            {"histogram",
             {{"log10_first", NearPairs::log_first},
              {"bins_per_decade", NearPairs::bins_per_decade},
              {"pairs", n.overlap_counts}}}};
}

json contacts_to_json(const NearPairs& n)
{
    return {{"tolerance_in_mean_radii", NearPairs::contact_tolerance},
            {"bulk_spheres", n.bulk_spheres},
            {"mean", n.mean_contacts},
            {"rattlers", n.rattlers},
            {"mean_without_rattlers", n.mean_contacts_without_rattlers},
            {"spheres_by_contacts", n.contact_counts},
            {"cumulative",
             {{"log10_gap_first", NearPairs::log_gap_first},
              {"gaps_per_decade", NearPairs::gaps_per_decade},
              {"contacts", n.contacts_below_gap}}},
            {"fabric", to_json(n.fabric)}};
}

json containment_to_json(const Containment& c)
{
    json worst = json::array();
    for (const Containment::Sphere& s : c.worst)
        worst.push_back({{"id", s.id}, {"position", to_json(s.position)}, {"radius", s.radius}, {"margin", s.margin}});
    return {{"outside", c.outside},
            {"centre_outside", c.centre_outside},
            {"asked_exactly", c.asked},
            {"worst", worst},
            {"margins_over_radius",
             {{"first", Containment::bin_first}, {"width", Containment::bin_width}, {"spheres", c.margins}}}};
}

json correlation_to_json(const PackingReport& r)
{
    const PairCorrelation& g = r.correlation;
    if (g.x_max == 0) return nullptr;
    return {{"x", "d / (r_i + r_j)"},
            {"bin_width", g.bin_width},
            {"g", g.g},
            {"centres", g.centres},
            {"contact_value",
             {{"best", to_json(g.best_contact)},
              {"extrapolated", to_json(g.contact)},
              {"fitted_pairs", g.fitted_pairs},
              {"free_paths", to_json(g.free_path_contact)},
              {"paths", g.free_paths},
              {"theory", number(r.theory_contact)}}},
            {"reduced_pressure", number(g.reduced_pressure)}};
}

json chords_to_json(const VoidChords& c)
{
    if (c.lines == 0) return nullptr;
    return {{"lines", c.lines},
            {"length", c.length},
            {"entries", c.entries},
            {"mean", to_json(c.mean)},
            {"expected", {{"value", c.expected}, {"standard_error", c.expected_error}}},
            {"solid_part", c.solid_part},
            {"density_in_expected_means",
             {{"width", VoidChords::bin_width}, {"density", c.density}, {"chords", c.chords}}}};
}

json cells_to_json(const LaguerreCells& c)
{
    return {{"cells", c.cells},
            {"hidden", c.hidden},
            {"unbounded", c.unbounded},
            {"whole_box", c.whole_box},
            {"cell_volume", c.cell_volume},
            {"sphere_volume", c.sphere_volume},
            {"mean", c.mean},
            {"standard_deviation", c.deviation},
            {"min", c.least},
            {"max", c.greatest},
            {"histogram", {{"width", LaguerreCells::bin_width}, {"cells", c.counts}}}};
}

json bonds_to_json(const BondOrder& b)
{
    return {{"spheres", b.spheres},
            {"bonds", b.bonds},
            {"mean_neighbours", b.mean_neighbours},
            {"global_q4", b.global_q4},
            {"global_q6", b.global_q6},
            {"mean_local_q4", b.mean_local_q4},
            {"mean_local_q6", b.mean_local_q6},
            {"crystal_fraction", b.crystal_fraction},
            {"histogram", {{"width", BondOrder::bin_width}, {"local_q4", b.local_q4}, {"local_q6", b.local_q6}}},
            {"fabric", to_json(b.fabric)}};
}

} // namespace

json json_of(const PackingReport& r)
{
    json result{{"file", r.source.file},
                {"mesh", r.source.mesh.empty() ? json() : json(r.source.mesh)},
                {"spheres", r.spheres},
                {"container", r.container},
                {"notes", r.source.notes}};
    result["facts"] = json::object();
    for (const auto& [name, value] : r.source.facts) result["facts"][name] = value;
    result["claims"] = json::array();
    for (const Claim& c : r.claims)
        result["claims"].push_back({{"claim", c.key}, {"verdict", word_of(c.verdict)}, {"text", c.text}});
    result["radius"] = radii_to_json(r.radii);
    result["fraction"] = fraction_to_json(r.fraction);
    result["profiles"] = json::array();
    for (const FractionProfile& p : r.profiles)
        result["profiles"].push_back(
            {{"along", p.name}, {"first", p.first}, {"width", p.width}, {"points", p.points}, {"hits", p.hits}});
    result["overlaps"] = overlaps_to_json(r.near);
    result["contacts"] = contacts_to_json(r.near);
    result["containment"] = r.containment ? containment_to_json(*r.containment) : json();
    result["pair_correlation"] = correlation_to_json(r);
    result["void_chords"] = chords_to_json(r.chords);
    result["laguerre_cells"] = cells_to_json(r.cells);
    result["bond_order"] = bonds_to_json(r.bonds);
    return result;
}

} // namespace scree
