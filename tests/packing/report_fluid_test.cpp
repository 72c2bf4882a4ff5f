#include "base/error.h"
#include "packing/report/packing_report.h"
#include "packing/report/report_page.h"
#include "tests/builders/packings.h"
#include "tests/packing/report_builders.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace scree {
namespace {

using Imath::V3d;

std::map<std::string, Verdict> verdicts_of(const PackingReport& r)
{
    std::map<std::string, Verdict> verdicts;
    for (const Claim& c : r.claims) verdicts[c.key] = c.verdict;
    return verdicts;
}

PackingSource tile_source()
{
    PackingSource source;
    source.file = "fluid";
    source.hard = true;
    return source;
}

/// 16,384 equal spheres in equilibrium at fraction 0.3.
const ParticleFrame& fluid()
{
    static const ParticleFrame frame = test::hard_sphere_fluid(16, 0.3, 150, 7);
    return frame;
}

const PackingReport& fluid_report()
{
    static const PackingReport report = make_packing_report(PackedSpheres(fluid(), "fluid"), tile_source());
    return report;
}

/// Each test runs in a process of its own, and a report takes seconds, so one test checks all of it.
TEST(ReportFluid, IsWhatTheorySays)
{
    {
        SCOPED_TRACE("the contact value is Carnahan and Starling's");
        const PairCorrelation& g = fluid_report().correlation;
        const double expected = carnahan_starling_contact(0.3);
        EXPECT_NEAR(g.free_path_contact.value, expected, 4 * g.free_path_contact.standard_error);
        EXPECT_LT(g.free_path_contact.standard_error, 0.02 * expected);
        EXPECT_NEAR(g.contact.value, expected, 4 * g.contact.standard_error);
        EXPECT_LT(g.contact.standard_error, 0.025 * expected);
        EXPECT_NEAR(fluid_report().theory_contact, expected, 1e-5);
    }
    {
        SCOPED_TRACE("the pair correlation follows Percus and Yevick");
        // At this fraction Percus-Yevick is within 4 % of the fluid beyond 1.1 diameters (Verlet, Weis 1972); bins
        // scatter by 2 %.
        const PairCorrelation& g = fluid_report().correlation;
        const std::vector<double> theory = percus_yevick(0.3, 100, 5);
        ASSERT_EQ(g.g.size(), 250u);
        for (size_t k = 56; k < g.g.size(); ++k) EXPECT_NEAR(g.g[k], theory[2 * k + 1 - 100], 0.1) << k;
        for (size_t k = 0; k < 49; ++k) EXPECT_EQ(g.g[k], 0);
    }
    {
        SCOPED_TRACE("the mean chord is within one percent");
        const VoidChords& c = fluid_report().chords;
        EXPECT_NEAR(c.mean.value / (4 * 0.7 * 0.5 / 0.9), 1, 0.01);
        EXPECT_NEAR(c.mean.value, c.expected, 4 * c.mean.standard_error);
        EXPECT_LT(c.mean.standard_error, 0.003 * c.expected);
        EXPECT_NEAR(c.solid_part, 0.3, 2e-3);
        // The distribution is a density of complete chords, few of which are longer than eight means.
        double sum = 0, mean = 0;
        for (size_t k = 0; k < c.density.size(); ++k) {
            sum += c.density[k] * VoidChords::bin_width;
            mean += c.density[k] * VoidChords::bin_width * (double(k) + 0.5) * VoidChords::bin_width;
        }
        EXPECT_NEAR(sum, 1, 1e-3);
        EXPECT_NEAR(mean, 1, 0.01);
    }
    {
        SCOPED_TRACE("the claims");
        for (const auto& [key, verdict] : verdicts_of(fluid_report())) {
            const bool info = key == "contacts" || key == "profile" || key == "radii";
            EXPECT_EQ(verdict, info ? Verdict::info : Verdict::pass) << key;
        }
        EXPECT_LT(fluid_report().bonds.crystal_fraction, 0.005);
        EXPECT_LT(fluid_report().bonds.global_q6, 0.02);
    }
}

TEST(ReportFluid, CompressedFluidThatIsNoneFails)
{
    // The fluid at 0.3 expanded to the box of fraction 0.2: there is a gap around every sphere, so the contact value is
    // 0.
    ParticleFrame frame = test::scaled(fluid(), std::cbrt(1.5));
    for (float& r : frame.radius) r = 0.5f;
    EXPECT_EQ(verdicts_of(make_packing_report(PackedSpheres(frame, "blown up"), tile_source())).at("contact_value"),
              Verdict::fail);
}

TEST(ReportFluid, TwoSizes)
{
    const ParticleFrame frame = test::hard_sphere_fluid(13, 0.25, 150, 3, {1, 1.4});
    const PackingReport r = make_packing_report(PackedSpheres(frame, "two sizes"), tile_source());
    const Measured& paths = r.correlation.free_path_contact;
    EXPECT_NEAR(paths.value, r.theory_contact, 4 * paths.standard_error);
    EXPECT_LT(paths.standard_error, 0.03 * r.theory_contact);
    EXPECT_NEAR(r.correlation.contact.value, r.theory_contact, 4 * r.correlation.contact.standard_error);
    EXPECT_NEAR(r.chords.mean.value, r.chords.expected, 4 * r.chords.mean.standard_error);
    EXPECT_EQ(r.radii.distinct, 2u);
    ASSERT_EQ(r.radii.sizes.size(), 2u);
    EXPECT_EQ(r.radii.sizes[0].second + r.radii.sizes[1].second, frame.size());
    EXPECT_NEAR(r.cells.cell_volume / r.fraction.container_volume, 1, 1e-9);
    EXPECT_EQ(verdicts_of(r).at("crystal"), Verdict::pass);
}

TEST(ReportFluid, TheSameOnAnyNumberOfThreads)
{
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const PackingReport again = make_packing_report(PackedSpheres(fluid(), "fluid"), tile_source());
    EXPECT_EQ(json_of(again), json_of(fluid_report()));
    EXPECT_EQ(html_of(again), html_of(fluid_report()));
}

TEST(ReportFluid, TheSameInAnyUnit)
{
    const double factor = 0x1p-20;
    const PackingReport small =
        make_packing_report(PackedSpheres(test::scaled(fluid(), factor), "fluid"), tile_source());
    const PackingReport& large = fluid_report();
    EXPECT_EQ(small.fraction.hits, large.fraction.hits);
    EXPECT_EQ(small.chords.mean.value, factor * large.chords.mean.value);
    EXPECT_EQ(small.correlation.g, large.correlation.g);
    EXPECT_EQ(small.correlation.free_path_contact.value, large.correlation.free_path_contact.value);
    EXPECT_EQ(small.cells.mean, large.cells.mean);
    EXPECT_EQ(small.bonds.global_q6, large.bonds.global_q6);
    EXPECT_EQ(small.near.contacts_below_gap, large.near.contacts_below_gap);
}

TEST(ReportPacking, ABedWithoutBoxIsMeasuredInItsMiddle)
{
    // The same fluid without the information that it is periodic.
    const PackedSpheres spheres(test::without_box(fluid()), "bed");
    ASSERT_EQ(spheres.container(), PackedSpheres::Container::bed);
    const SolidFraction f = measure_fraction(spheres);
    EXPECT_NEAR(f.by_points, f.by_volume, 4 * f.by_points_error + 1e-4);
    EXPECT_NEAR(f.bulk, 0.3, 0.03); // an eighth of 16,384 spheres: their number scatters by sqrt(S(0) / 2048), 0.7 %
    const VoidChords c = measure_void_chords(spheres, f);
    ASSERT_GT(c.lines, 1000u);
    EXPECT_NEAR(c.mean.value / c.expected, 1, 0.03);
    const PairCorrelation g = measure_pair_correlation(spheres, f.number_density());
    EXPECT_GE(g.x_max, 2);
    EXPECT_NEAR(g.contact.value, carnahan_starling_contact(0.3), 0.25);
    const LaguerreCells cells = measure_laguerre_cells(spheres, f.number_density());
    EXPECT_EQ(cells.unbounded, 0u);
    EXPECT_FALSE(cells.whole_box);
    EXPECT_EQ(cells.cells, f.bulk_spheres);
    EXPECT_NEAR(cells.sphere_volume / cells.cell_volume, 0.3, 0.02);
}

TEST(ReportPacking, OverlapsAreFoundWithTheirIds)
{
    ParticleFrame frame = fluid();
    frame.position[100] = frame.position[2000] + V3d(0.6, 0, 0);
    const NearPairs n = measure_near_pairs(PackedSpheres(frame, "fluid"));
    ASSERT_FALSE(n.worst.empty());
    EXPECT_LE(n.worst.size(), 10u);
    bool found = false;
    for (const NearPairs::Overlap& o : n.worst)
        found = found || (o.ids[0] == 101 && o.ids[1] == 2001 && std::abs(o.overlap - 0.8) < 1e-9);
    EXPECT_TRUE(found);
    EXPECT_GE(n.overlapping, 1u);
    const PackingReport r = make_packing_report(PackedSpheres(frame, "fluid"), tile_source());
    EXPECT_EQ(verdicts_of(r).at("overlap"), Verdict::fail);
    EXPECT_EQ(verdicts_of(r).at("fraction"), Verdict::pass); // the claim corrects for the shared volume
}

TEST(ReportPacking, LensVolumeIsWhatIsSummedTwice)
{
    // Two balls at distance d, with radii 1 and 0.7: pi (r+s-d)^2 (d^2 + 2d(r+s) - 3(r-s)^2) / 12d.
    const ParticleFrame frame = test::periodic_frame({V3d(2), V3d(3, 2, 2)}, {1, 0.7f}, V3d(6));
    const NearPairs n = measure_near_pairs(PackedSpheres(frame, "two"));
    const double d = 1, r = 1, s = 0.7f;
    EXPECT_NEAR(n.lens_volume,
                M_PI * (r + s - d) * (r + s - d) * (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) / (12 * d), 1e-12);
    EXPECT_NEAR(n.worst.at(0).overlap, (r + s - d) / s, 1e-12);
}

TEST(ReportPacking, PushedApartBedIsNoCrystalButSoft)
{
    const std::vector<PackedSphere> bed = push_apart(4000, 0.62, 0.6, 1e-3, 5);
    const double edge = packing_edge(bed, 0.62);
    std::vector<V3d> positions;
    std::vector<float> radii;
    for (const PackedSphere& s : bed) {
        positions.push_back(s.center);
        radii.push_back(static_cast<float>(s.radius));
    }
    const PackedSpheres spheres(test::periodic_frame(positions, radii, V3d(edge)), "bed");
    const PackingReport r = make_packing_report(spheres, {});
    EXPECT_NEAR(r.fraction.by_volume, 0.62, 1e-6);
    const double worst = largest_overlap(bed, edge);
    ASSERT_FALSE(r.near.worst.empty());
    EXPECT_NEAR(r.near.worst.front().overlap, worst, 1e-6); // radii as floats
    const auto verdicts = verdicts_of(r);
    EXPECT_EQ(verdicts.at("crystal"), Verdict::pass);
    EXPECT_EQ(verdicts.at("overlap"), Verdict::info);
    EXPECT_EQ(verdicts.at("fraction"), Verdict::pass);
    EXPECT_NEAR(r.cells.cell_volume / spheres.volume(), 1, 1e-9);
}

TEST(ReportPacking, RattlersAreTakenOutAgainAndAgain)
{
    // An fcc crystal in which one sphere has half the size: it has no contacts, and its twelve neighbours are still
    // held by the others.
    ParticleFrame frame = test::lattice("fcc", 4);
    frame.radius[10] = 0.25f;
    const NearPairs n = measure_near_pairs(PackedSpheres(frame, "defect"));
    EXPECT_EQ(n.rattlers, 1u);
    EXPECT_EQ(n.contact_counts.at(0), 1u);
    EXPECT_EQ(n.contact_counts.at(11), 12u);
    // In a chain only neighbours hold each other, so it falls apart from its ends.
    std::vector<V3d> chain;
    for (int i = 0; i < 6; ++i) chain.emplace_back(i, 5, 5);
    const NearPairs c =
        measure_near_pairs(PackedSpheres(test::periodic_frame(chain, std::vector<float>(6, 0.5f), V3d(20)), "chain"));
    EXPECT_EQ(c.rattlers, 6u);
    EXPECT_NEAR(c.mean_contacts, 10.0 / 6, 1e-12);
    EXPECT_NEAR(c.fabric.deviatoric, 1, 1e-12);
}

TEST(ReportPacking, CancelledWorkStops)
{
    Progress progress;
    progress.cancel();
    EXPECT_THROW(PackedSpheres(fluid(), "fluid", {}, progress), Cancelled);
    const PackedSpheres spheres(fluid(), "fluid");
    EXPECT_THROW(make_packing_report(spheres, {}, progress), Cancelled);
}

} // namespace
} // namespace scree
