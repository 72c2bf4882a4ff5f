#include "packing/report/packing_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr double tile_overlap = 1e-6, soft_overlap = 0.1, freezing = 0.494;

std::string percent(double part) { return fmt::format("{:+.2f} %", 100 * part); }

double worst_overlap(const PackingReport& r) { return r.near.worst.empty() ? 0 : r.near.worst.front().overlap; }

bool crystalline(const PackingReport& r)
{
    // Q6 is about 1 / sqrt(bonds) without order.
    return r.bonds.crystal_fraction > 0.05 ||
           r.bonds.global_q6 > 0.1 + 5 / std::sqrt(double(std::max<uint64_t>(r.bonds.bonds, 1)));
}

Claim fraction_claim(const PackingReport& r)
{
    const SolidFraction& f = r.fraction;
    if (f.points == 0)
        return {"fraction", Verdict::info,
                "unknown: there is no mesh and no periodic box, and there are too few spheres for a bed"};
    // The volume that two spheres share is summed twice but hit once.
    const bool lens_counts = r.near.lens_volume > 1e-6 * f.all_spheres;
    const double shared = lens_counts ? r.near.lens_volume / f.all_spheres * f.by_volume : 0;
    const double expected = f.by_volume - shared;
    const double error = std::sqrt(std::max(0.0, expected * (1 - expected)) / double(f.points));
    if (expected * double(f.points) < 25)
        return {"fraction", Verdict::info,
                fmt::format("{:.4g} by the spheres' volumes: too small to check with random points", f.by_volume)};
    const double apart = error > 0 ? std::abs(expected - f.by_points) / error : 0;
    std::string text = fmt::format("{:.5f} by the spheres' volumes, {:.5f} ± {:.5f} by {} random points", f.by_volume,
                                   f.by_points, f.by_points_error, f.points);
    if (lens_counts) text += fmt::format("; {:.5f} if volume shared by overlapping spheres counts once", expected);
    return {"fraction", apart <= 4 ? Verdict::pass : Verdict::fail,
            text + fmt::format("; {:.1f} standard errors apart (limit 4)", apart)};
}

Claim overlap_claim(const PackingReport& r)
{
    const double worst = worst_overlap(r);
    const std::string some =
        r.near.complete ? "" : "; some spheres have thousands of neighbours, and not all pairs were checked";
    if (worst == 0)
        return {"overlap", r.near.complete ? Verdict::pass : Verdict::fail, "no two spheres overlap" + some};
    const NearPairs::Overlap& w = r.near.worst.front();
    const std::string pairs = fmt::format("worst {:.3g} of the smaller radius (ids {} and {}), {} pairs", worst,
                                          w.ids[0], w.ids[1], r.near.overlapping) +
                              some;
    if (worst <= tile_overlap)
        return {"overlap", r.near.complete ? Verdict::pass : Verdict::fail, pairs + "; limit 1e-6"};
    if (r.source.hard) return {"overlap", Verdict::fail, pairs + "; limit 1e-6"};
    if (worst > soft_overlap)
        return {"overlap", Verdict::fail,
                pairs + "; more than a tenth of a radius, the most that soft spheres of simulations reach: are the "
                        "radii right?"};
    return {"overlap", Verdict::info,
            pairs + fmt::format("; mean {:.3g}: usual in a simulation of {} spheres", r.near.mean_overlap,
                                worst < 0.01 ? "stiff" : "soft")};
}

Claim containment_claim(const PackingReport& r)
{
    const Containment& c = *r.containment;
    if (c.outside == 0) {
        const std::string least =
            c.worst.empty() ? ""
                            : fmt::format("; least margin {:.3g} (id {})", c.worst.front().margin, c.worst.front().id);
        return {"containment", Verdict::pass,
                fmt::format("all {} spheres are wholly inside the mesh{}", r.spheres, least)};
    }
    const Containment::Sphere& w = c.worst.front();
    return {"containment", Verdict::fail,
            fmt::format("{} of {} spheres stick out of the mesh ({} with their centre outside); worst id {}: margin "
                        "{:.4g}, {:.3g} of its radius",
                        c.outside, r.spheres, c.centre_outside, w.id, w.margin, w.margin / w.radius)};
}

Claim chord_claim(const PackingReport& r)
{
    const VoidChords& c = r.chords;
    if (c.lines == 0) return {"chords", Verdict::info, "not measured: no line in the bulk meets a sphere"};
    const double apart = c.mean.value / c.expected - 1,
                 error = std::hypot(c.mean.standard_error / c.mean.value, c.expected_error / c.expected);
    const std::string text =
        fmt::format("mean void chord {:.5g} ± {:.2g} along {} lines, 4(1-f)<r³>/(3f<r²>) = {:.5g}: {}", c.mean.value,
                    c.mean.standard_error, c.lines, c.expected, percent(apart));
    if (worst_overlap(r) > 1e-3) return {"chords", Verdict::info, text + " (exact only where spheres do not overlap)"};
    const bool good = std::abs(apart) <= 0.01 || std::abs(apart) <= 4 * error;
    return {"chords", good ? Verdict::pass : Verdict::fail,
            text + fmt::format(", standard error {:.2f} % (limit 1 % or 4 standard errors)", 100 * error)};
}

Claim contact_value_claim(const PackingReport& r)
{
    const PairCorrelation& g = r.correlation;
    if (g.x_max == 0) return {"contact_value", Verdict::info, "not measured: no sphere is deep enough in the packing"};
    const bool mixed = r.fraction.bulk_moments.polydispersity() > 1e-6;
    const std::string theory = fmt::format(
        "{} {:.4f}",
        mixed ? "Boublík-Mansoori-Carnahan-Starling-Leland" : "Carnahan-Starling (1-f/2)/(1-f)³ =", r.theory_contact);
    std::string measured = fmt::format("g(1+) = {:.4f} ± {:.4f}", g.best_contact.value, g.best_contact.standard_error);
    if (g.free_paths > 0)
        measured +=
            fmt::format(" ({:.4f} ± {:.4f} by extrapolation, {:.4f} ± {:.4f} by free paths)", g.contact.value,
                        g.contact.standard_error, g.free_path_contact.value, g.free_path_contact.standard_error);
    if (r.fraction.bulk >= freezing || r.fraction.bulk >= 1) {
        return {"contact_value", Verdict::info,
                fmt::format("no fluid in equilibrium: f = {:.4f} is above freezing, 0.494; {:.2f} contacts per sphere "
                            "instead of a contact value",
                            r.fraction.bulk, r.near.mean_contacts)};
    }
    if (worst_overlap(r) > 1e-3)
        return {"contact_value", Verdict::info, "spheres overlap, but the theory is for hard spheres: " + theory};
    if (crystalline(r)) return {"contact_value", Verdict::info, "crystal, not a fluid: " + measured + "; " + theory};
    const Measured& m = g.best_contact;
    if (!(m.value > 0)) return {"contact_value", Verdict::info, "too few pairs near contact to decide; " + theory};
    const double apart = m.value / r.theory_contact - 1, error = m.standard_error / r.theory_contact;
    const std::string text =
        fmt::format("{}; {}: {}, standard error {:.2f} %", measured, theory, percent(apart), 100 * error);
    if (!r.source.hard) return {"contact_value", Verdict::info, text + " (a simulation need not be in equilibrium)"};
    if (!std::isfinite(m.standard_error) || error > 0.1)
        return {"contact_value", Verdict::info, text + ": too few spheres to decide"};
    // Carnahan-Starling itself is off by some 0.3 %.
    const bool good = std::abs(apart) <= 0.01 || std::abs(apart) <= 4 * error + 0.003;
    return {"contact_value", good ? Verdict::pass : Verdict::fail,
            text + " (limit 1 % or 4 standard errors); a fluid in equilibrium is within this limit"};
}

Claim crystal_claim(const PackingReport& r)
{
    if (r.bonds.spheres == 0) return {"crystal", Verdict::info, "not measured: no bulk"};
    const std::string text = fmt::format("{:.2f} % of the spheres are crystal-like (limit 5 %), Q6 of all bonds {:.4f} "
                                         "(0 when disordered; fcc 0.5745, hcp 0.4848, bcc 0.5107)",
                                         100 * r.bonds.crystal_fraction, r.bonds.global_q6);
    return {"crystal", crystalline(r) ? Verdict::fail : Verdict::pass,
            (crystalline(r) ? "crystal: " : "no crystal: ") + text};
}

Claim contacts_claim(const PackingReport& r)
{
    const NearPairs& n = r.near;
    if (n.bulk_spheres == 0) return {"contacts", Verdict::info, "not measured: no bulk"};
    const double rattlers = 100 * double(n.rattlers) / double(n.bulk_spheres);
    return {"contacts", Verdict::info,
            fmt::format("{:.3f} contacts per sphere at gaps below {:g} mean radii; {:.2f} % rattlers, {:.3f} contacts "
                        "per sphere without rattlers (isostatic without friction: 6)",
                        n.mean_contacts, NearPairs::contact_tolerance, rattlers, n.mean_contacts_without_rattlers)};
}

Claim isotropy_claim(const PackingReport& r)
{
    const bool contacts = r.near.fabric.directions >= 100;
    const FabricTensor& f = contacts ? r.near.fabric : r.bonds.fabric;
    if (f.directions == 0) return {"isotropy", Verdict::info, "not measured: no contacts and no neighbours"};
    const double limit = std::max(0.02, 4 / std::sqrt(double(f.directions)));
    return {"isotropy", f.deviatoric <= limit ? Verdict::pass : Verdict::info,
            fmt::format(
                "{}: fabric of {} {} has a deviatoric part of {:.4f} (limit {:.4f}), eigenvalues {:.4f} {:.4f} {:.4f}",
                f.deviatoric <= limit ? "isotropic" : "anisotropic", f.directions,
                contacts ? "contacts" : "near neighbours", f.deviatoric, limit, f.eigenvalues[0], f.eigenvalues[1],
                f.eigenvalues[2])};
}

Claim cells_claim(const PackingReport& r)
{
    const LaguerreCells& c = r.cells;
    if (c.cells == 0) return {"cells", Verdict::info, "not measured: no sphere of the bulk has a bounded cell"};
    const std::string local =
        fmt::format("local fraction {:.4f}, deviation {:.4f}, over {} cells", c.mean, c.deviation, c.cells);
    if (!c.whole_box)
        return {"cells", Verdict::info, local + fmt::format("; {:.4f} by volume", c.sphere_volume / c.cell_volume)};
    const double apart = c.cell_volume / r.fraction.container_volume - 1;
    return {"cells", std::abs(apart) <= 1e-9 ? Verdict::pass : Verdict::fail,
            local + fmt::format("; the cells' volumes add up to the box's volume within {:.1g} (limit 1e-9)",
                                std::abs(apart))};
}

Claim radii_claim(const PackingReport& r)
{
    const RadiusStatistics& s = r.radii;
    if (s.distinct == 1) return {"radii", Verdict::info, fmt::format("all {:.6g}", s.mean)};
    return {"radii", Verdict::info,
            fmt::format("{} sizes, {:.6g} to {:.6g}; mean {:.6g}, standard deviation {:.4g} ({:.2f} % of the mean)",
                        s.distinct, s.least, s.greatest, s.mean, s.deviation, 100 * s.deviation / s.mean)};
}

Claim profile_claim(const PackingReport& r)
{
    if (r.profiles.empty()) return {"profile", Verdict::info, "not measured"};
    if (r.containment) {
        if (r.fraction.bulk_points == 0)
            return {"profile", Verdict::info, "the mesh is nowhere deeper than three largest radii"};
        return {
            "profile", Verdict::info,
            fmt::format("{:.5f} ± {:.5f} deeper than three largest radii below the surface, {:.5f} in the whole mesh",
                        r.fraction.bulk, r.fraction.bulk_error, r.fraction.by_points)};
    }
    double least = 1, greatest = 0;
    for (const FractionProfile& p : r.profiles) {
        for (size_t i = 0; i < p.points.size(); ++i) {
            if (p.points[i] == 0) continue;
            const double f = double(p.hits[i]) / double(p.points[i]);
            least = std::min(least, f);
            greatest = std::max(greatest, f);
        }
    }
    return {"profile", Verdict::info, fmt::format("{:.3f} to {:.3f} in slices across the three axes", least, greatest)};
}

} // namespace

const char* word_of(Verdict verdict)
{
    return verdict == Verdict::pass ? "PASS" : verdict == Verdict::fail ? "FAIL" : "INFO";
}

std::vector<Claim> claims_of(const PackingReport& report)
{
    std::vector<Claim> claims{fraction_claim(report), overlap_claim(report)};
    if (report.containment) claims.push_back(containment_claim(report));
    for (const auto& claim : {chord_claim, contact_value_claim, crystal_claim, isotropy_claim, cells_claim,
                              contacts_claim, profile_claim, radii_claim})
        claims.push_back(claim(report));
    return claims;
}

} // namespace scree
