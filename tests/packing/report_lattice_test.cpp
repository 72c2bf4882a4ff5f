#include "packing/report/packing_report.h"
#include "tests/packing/report_builders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace scree {
namespace {

using Imath::V3d;

struct Truth {
    const char* kind;
    int cells;
    double fraction;
    double contacts, neighbours;
    double q4, q6;
    std::vector<std::pair<double, double>> shells; ///< distance in diameters, spheres there
};

// Q4 and Q6: Steinhardt, Nelson, Ronchetti 1983 (fcc, hcp: 12 neighbours) and Mickel et al. 2013 (bcc: 14; sc: 6).
const std::vector<Truth> truths{
    {"sc",
     8,
     std::numbers::pi / 6,
     6,
     6,
     0.76376,
     0.35355,
     {{1, 6}, {std::sqrt(2.0), 12}, {std::sqrt(3.0), 8}, {2, 6}}},
    {"bcc",
     7,
     std::numbers::pi* std::sqrt(3.0) / 8,
     8,
     14,
     0.03637,
     0.51069,
     {{1, 8}, {std::sqrt(4.0 / 3), 6}, {std::sqrt(8.0 / 3), 12}}},
    {"fcc",
     6,
     std::numbers::pi / (3 * std::sqrt(2.0)),
     12,
     12,
     0.19094,
     0.57452,
     {{1, 12}, {std::sqrt(2.0), 6}, {std::sqrt(3.0), 24}, {2, 12}}},
    {"hcp",
     6,
     std::numbers::pi / (3 * std::sqrt(2.0)),
     12,
     12,
     0.09722,
     0.48476,
     {{1, 12}, {std::sqrt(2.0), 6}, {std::sqrt(8.0 / 3), 2}, {std::sqrt(3.0), 18}}},
};

class ReportLattice : public testing::TestWithParam<size_t> {
protected:
    const Truth& truth_ = truths[GetParam()];
    PackedSpheres spheres_{test::lattice(truth_.kind, truth_.cells), "lattice"};
    double density_ = double(spheres_.size()) / spheres_.volume();
};

TEST_P(ReportLattice, FractionBothWays)
{
    const SolidFraction f = measure_fraction(spheres_);
    EXPECT_NEAR(f.by_volume, truth_.fraction, 1e-6); // radii are floats
    EXPECT_NEAR(f.by_points, truth_.fraction, 4 * f.by_points_error);
    EXPECT_LT(f.by_points_error, 6e-4);
    EXPECT_EQ(f.bulk_spheres, spheres_.size());
}

TEST_P(ReportLattice, ContactsAndFabric)
{
    const NearPairs n = measure_near_pairs(spheres_);
    EXPECT_TRUE(n.complete);
    EXPECT_DOUBLE_EQ(n.mean_contacts, truth_.contacts);
    EXPECT_EQ(n.rattlers, 0u);
    ASSERT_EQ(n.contact_counts.size(), static_cast<size_t>(truth_.contacts) + 1);
    EXPECT_EQ(n.contact_counts.back(), spheres_.size());
    EXPECT_NEAR(n.fabric.deviatoric, 0, 1e-12);
    for (const double e : n.fabric.eigenvalues) EXPECT_NEAR(e, 1.0 / 3, 1e-12);
    if (!n.worst.empty()) { // by rounding alone
        EXPECT_LT(n.worst.front().overlap, 1e-12);
    }
}

TEST_P(ReportLattice, BondOrderSeesACrystal)
{
    const BondOrder b = measure_bond_order(spheres_, density_);
    EXPECT_DOUBLE_EQ(b.mean_neighbours, truth_.neighbours);
    EXPECT_NEAR(b.global_q4, truth_.q4, 1e-5);
    EXPECT_NEAR(b.global_q6, truth_.q6, 1e-5);
    EXPECT_NEAR(b.mean_local_q6, truth_.q6, 1e-5);
    EXPECT_DOUBLE_EQ(b.crystal_fraction, 1);
}

TEST_P(ReportLattice, CellsAreEqualAndFillTheBox)
{
    const LaguerreCells c = measure_laguerre_cells(spheres_, density_);
    EXPECT_TRUE(c.whole_box);
    EXPECT_EQ(c.cells, spheres_.size());
    EXPECT_EQ(c.hidden + c.unbounded, 0u);
    EXPECT_NEAR(c.cell_volume / spheres_.volume(), 1, 1e-12);
    EXPECT_NEAR(c.least, truth_.fraction, 1e-6);
    EXPECT_NEAR(c.greatest - c.least, 0, 1e-11);
}

TEST_P(ReportLattice, PeaksOfThePairCorrelation)
{
    const PairCorrelation g = measure_pair_correlation(spheres_, density_);
    ASSERT_EQ(g.x_max, 5);
    ASSERT_EQ(g.centres, spheres_.size());
    for (const auto& [distance, count] : truth_.shells) {
        // A peak may lie on the edge between two bins.
        double found = 0;
        for (const double side : {-0.5, 0.5}) {
            const size_t bin = static_cast<size_t>(std::floor(distance / g.bin_width + side));
            const double lo = double(bin) * g.bin_width,
                         shell = 4.0 / 3 * std::numbers::pi * (std::pow(lo + g.bin_width, 3) - lo * lo * lo);
            found += g.g[bin] * density_ * shell;
        }
        EXPECT_NEAR(found, count, 1e-3 * count) << truth_.kind << " at " << distance;
    }
    for (size_t bin = 0; double(bin + 1) * g.bin_width < 0.99; ++bin) EXPECT_EQ(g.g[bin], 0);
}

TEST_P(ReportLattice, ChordsAreExactInCrystalsToo)
{
    const SolidFraction f = measure_fraction(spheres_);
    const VoidChords c = measure_void_chords(spheres_, f);
    EXPECT_NEAR(c.mean.value, 4 * (1 - truth_.fraction) / (3 * truth_.fraction) * 0.5, 4 * c.mean.standard_error);
    EXPECT_LT(c.mean.standard_error, 0.003 * c.mean.value);
}

TEST_P(ReportLattice, ClaimsSayCrystal)
{
    const PackingReport r = make_packing_report(spheres_, {});
    std::map<std::string, Verdict> verdicts;
    for (const Claim& c : r.claims) verdicts[c.key] = c.verdict;
    EXPECT_EQ(verdicts.at("crystal"), Verdict::fail);
    EXPECT_EQ(verdicts.at("fraction"), Verdict::pass);
    EXPECT_EQ(verdicts.at("overlap"), Verdict::pass);
    EXPECT_EQ(verdicts.at("chords"), Verdict::pass);
    EXPECT_EQ(verdicts.at("cells"), Verdict::pass);
    EXPECT_EQ(verdicts.at("isotropy"), Verdict::pass);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ReportLattice, testing::Range<size_t>(0, truths.size()),
                         [](const auto& test) { return std::string(truths[test.param].kind); });

TEST(ReportLatticeImages, OneCellIsAsGoodAsMany)
{
    // Four spheres whose neighbours are images, including images of themselves.
    const PackedSpheres one(test::lattice("fcc", 1), "lattice");
    const double density = 4 / one.volume();
    EXPECT_DOUBLE_EQ(measure_near_pairs(one).mean_contacts, 12);
    EXPECT_NEAR(measure_bond_order(one, density).global_q6, 0.57452, 1e-5);
    const LaguerreCells c = measure_laguerre_cells(one, density);
    EXPECT_TRUE(c.whole_box);
    EXPECT_NEAR(c.cell_volume / one.volume(), 1, 1e-12);
    const PackedSpheres single(test::lattice("sc", 1), "lattice");
    EXPECT_DOUBLE_EQ(measure_near_pairs(single).mean_contacts, 6);
    EXPECT_EQ(measure_near_pairs(single).rattlers, 0u);
}

TEST(ReportLatticeImages, TiltedBox)
{
    // The primitive cell of fcc, triclinic.
    ParticleFrame frame = test::periodic_frame({V3d(0.3, 0.2, 0.1)}, {0.5f}, V3d(1));
    const double h = std::sqrt(0.5);
    frame.box->edges = {V3d(0, h, h), V3d(h, 0, h), V3d(h, h, 0)};
    frame.box->triclinic = true;
    const PackedSpheres spheres(frame, "primitive");
    EXPECT_DOUBLE_EQ(measure_near_pairs(spheres).mean_contacts, 12);
    const double density = 1 / spheres.volume();
    EXPECT_NEAR(measure_bond_order(spheres, density).global_q6, 0.57452, 1e-5);
    EXPECT_NEAR(measure_laguerre_cells(spheres, density).cell_volume / spheres.volume(), 1, 1e-12);
    const SolidFraction f = measure_fraction(spheres);
    EXPECT_NEAR(f.by_volume, std::numbers::pi / (3 * std::sqrt(2.0)), 1e-6);
    EXPECT_NEAR(f.by_points, f.by_volume, 4 * f.by_points_error);
}

} // namespace
} // namespace scree
