#pragma once

#include "base/drawing/svg_plot.h"
#include "packing/report/packing_report.h"

namespace scree {

/// The plots of a report; each needs a measurement of what it shows.
Plot plot_radii(const RadiusStatistics& radii);
Plot plot_profiles(const PackingReport& report);
Plot plot_overlaps(const NearPairs& near);
Plot plot_margins(const Containment& containment);
/// g(x), with the Percus-Yevick curve if the spheres are nearly of one size.
Plot plot_pair_correlation(const PackingReport& report);
/// g(x) near contact, with the contact values.
Plot plot_contact_value(const PackingReport& report);
Plot plot_contacts(const NearPairs& near);
Plot plot_contact_numbers(const NearPairs& near);
Plot plot_void_chords(const VoidChords& chords);
Plot plot_cells(const LaguerreCells& cells);
Plot plot_bond_order(const BondOrder& bonds);

} // namespace scree
