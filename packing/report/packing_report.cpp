#include "packing/report/packing_report.h"

#include <fmt/format.h>

namespace scree {

namespace {

std::string words_of(const Imath::V3d& v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

std::string container_words(const PackedSpheres& spheres, const PackingSource& source)
{
    using Container = PackedSpheres::Container;
    const auto& e = spheres.edges();
    switch (spheres.container()) {
    case Container::mesh: return fmt::format("the mesh {}", source.mesh);
    case Container::periodic_box:
        return fmt::format("the periodic box of edges {} {} {}", words_of(e[0]), words_of(e[1]), words_of(e[2]));
    case Container::bed:
        return fmt::format("the middle of the bed, {} to {}: from quartile to quartile of the centres along each axis, "
                           "or a whole period",
                           words_of(spheres.bed().min), words_of(spheres.bed().max));
    case Container::none: break;
    }
    return "none: no mesh, no periodic box, and too few spheres for a bed";
}

} // namespace

PackingReport make_packing_report(const PackedSpheres& spheres, PackingSource source, const Progress& progress)
{
    PackingReport report;
    report.source = std::move(source);
    report.container = container_words(spheres, report.source);
    report.spheres = spheres.size();
    if (spheres.left_out() > 0)
        report.source.notes.push_back(fmt::format("{} spheres of radius 0 are left out", spheres.left_out()));
    report.radii = measure_radii(spheres);
    report.fraction = measure_fraction(spheres, progress);
    report.profiles = measure_profiles(spheres, progress);
    report.near = measure_near_pairs(spheres, progress);
    if (spheres.container() == PackedSpheres::Container::mesh)
        report.containment = check_containment(spheres, progress);
    if (report.fraction.bulk_spheres > 0 && report.fraction.bulk > 0) {
        const double density = report.fraction.number_density();
        report.correlation = measure_pair_correlation(spheres, density, progress);
        report.chords = measure_void_chords(spheres, report.fraction, progress);
        report.bonds = measure_bond_order(spheres, density, progress);
        report.cells = measure_laguerre_cells(spheres, density, progress);
        if (report.fraction.bulk < 1)
            report.theory_contact = bmcsl_contact(report.fraction.bulk, report.fraction.bulk_moments);
    } else if (spheres.container() != PackedSpheres::Container::none) {
        report.source.notes.push_back(
            "no sphere lies three largest radii below the surface: measurements of the bulk are left out");
    }
    report.claims = claims_of(report);
    return report;
}

} // namespace scree
