#include "packing/report/packing_report.h"
#include "packing/report/report_page.h"
#include "packing/solids/distance_field.h"
#include "packing/solids/domain.h"
#include "packing/solids/interior_sampler.h"
#include "tests/builders/shapes.h"
#include "tests/packing/report_builders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace scree {
namespace {

using Imath::V3d;

/// The cube -1..1 filled with the spheres of a fluid at fraction 0.3 that are wholly inside.
class ReportMesh : public testing::Test {
protected:
    static ParticleFrame filled()
    {
        static const ParticleFrame fluid = test::scaled(test::hard_sphere_fluid(16, 0.3, 100, 11), 0.08);
        ParticleFrame frame;
        const V3d middle = 0.5 * (fluid.box->edges[0] + fluid.box->edges[1] + fluid.box->edges[2]);
        for (size_t i = 0; i < fluid.size(); ++i) {
            const V3d p = fluid.position[i] - middle;
            const double r = fluid.radius[i];
            if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 1 - r) add(frame, p, fluid.radius[i]);
        }
        return frame;
    }
    static void add(ParticleFrame& frame, const V3d& place, float radius)
    {
        frame.position.push_back(place);
        frame.radius.push_back(radius);
        frame.type.push_back(1);
        frame.id.push_back(frame.id.size() + 1000);
    }
    PackedSpheres packed(const ParticleFrame& frame) const
    {
        return PackedSpheres(frame, "filled", {&domain_, &sampler_, &field_});
    }
    static std::map<std::string, Verdict> verdicts_of(const PackingReport& r)
    {
        std::map<std::string, Verdict> verdicts;
        for (const Claim& c : r.claims) verdicts[c.key] = c.verdict;
        return verdicts;
    }

    Domain domain_{cube(), "cube"};
    InteriorSampler sampler_{domain_};
    DistanceField field_{domain_, 100};
};

TEST_F(ReportMesh, AFillIsWhatItClaims)
{
    const ParticleFrame frame = filled();
    ASSERT_GT(frame.size(), 7000u);
    PackingSource source;
    source.hard = true;
    source.mesh = "cube.off";
    const PackingReport r = make_packing_report(packed(frame), source);
    EXPECT_NEAR(r.fraction.container_volume, 8, 1e-9);
    EXPECT_NEAR(r.fraction.by_points, r.fraction.by_volume, 4 * r.fraction.by_points_error);
    EXPECT_LT(r.fraction.by_volume, 0.29); // whole spheres only: less at the faces
    EXPECT_NEAR(r.fraction.bulk, 0.3, 4 * r.fraction.bulk_error + 0.01);
    ASSERT_TRUE(r.containment);
    EXPECT_EQ(r.containment->outside, 0u);
    EXPECT_NEAR(r.chords.mean.value, r.chords.expected,
                4 * std::hypot(r.chords.mean.standard_error, r.chords.expected_error));
    EXPECT_GT(r.chords.lines, 1000u);
    EXPECT_EQ(r.cells.unbounded, 0u);
    EXPECT_GT(r.cells.cells, 500u);
    EXPECT_NEAR(r.cells.sphere_volume / r.cells.cell_volume, 0.3, 0.01);
    EXPECT_NEAR(r.correlation.free_path_contact.value, r.theory_contact,
                4 * r.correlation.free_path_contact.standard_error);
    const auto verdicts = verdicts_of(r);
    for (const char* key : {"fraction", "overlap", "containment", "chords", "contact_value", "crystal"})
        EXPECT_EQ(verdicts.at(key), Verdict::pass) << key;

    // The profile against depth: 0 at the surface, the full fraction beyond two radii.
    ASSERT_EQ(r.profiles.size(), 1u);
    const FractionProfile& p = r.profiles[0];
    EXPECT_NEAR(p.width, 0.01, 1e-9);
    EXPECT_LT(double(p.hits[0]) / double(p.points[0]), 0.05);
    uint64_t points = 0, hits = 0;
    for (size_t k = 10; k < 30; ++k) {
        points += p.points[k];
        hits += p.hits[k];
    }
    EXPECT_NEAR(double(hits) / double(points), 0.3, 0.015);
}

TEST_F(ReportMesh, ASphereThatSticksOutIsNamed)
{
    ParticleFrame frame = filled();
    add(frame, V3d(0.99, 0.3, 0.3), 0.04f);
    const uint64_t sticking = frame.id.back();
    Containment c = check_containment(packed(frame));
    EXPECT_EQ(c.outside, 1u);
    EXPECT_EQ(c.centre_outside, 0u);
    ASSERT_EQ(c.worst.size(), 10u);
    EXPECT_EQ(c.worst[0].id, sticking);
    EXPECT_NEAR(c.worst[0].margin, 0.01 - double(0.04f), 1e-12);
    EXPECT_GE(c.worst[1].margin, 0);

    add(frame, V3d(1.5, 0, 0), 0.04f);
    c = check_containment(packed(frame));
    EXPECT_EQ(c.outside, 2u);
    EXPECT_EQ(c.centre_outside, 1u);
    EXPECT_EQ(c.worst[0].id, sticking + 1);
    EXPECT_NEAR(c.worst[0].margin, -0.5 - double(0.04f), 1e-12);
    EXPECT_EQ(c.worst[1].id, sticking);
    EXPECT_EQ(verdicts_of(make_packing_report(packed(frame), {})).at("containment"), Verdict::fail);
}

TEST_F(ReportMesh, TouchingIsInside)
{
    ParticleFrame frame;
    add(frame, V3d(0.5, 0, 0), 0.5f);
    add(frame, V3d(-0.5, 0, 0), 0.5f);
    const Containment c = check_containment(packed(frame));
    EXPECT_EQ(c.outside, 0u);
    ASSERT_EQ(c.worst.size(), 2u);
    EXPECT_EQ(c.worst[0].margin, 0);
}

TEST_F(ReportMesh, NoBulkIsSaidAndNotGuessed)
{
    ParticleFrame frame;
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5})
            for (const double z : {-0.5, 0.5}) add(frame, V3d(x, y, z), 0.5f);
    const PackingReport r = make_packing_report(packed(frame), {});
    EXPECT_EQ(r.fraction.bulk_spheres, 0u);
    EXPECT_NEAR(r.fraction.by_volume, M_PI / 6, 1e-6);
    const auto verdicts = verdicts_of(r);
    EXPECT_EQ(verdicts.at("fraction"), Verdict::pass);
    EXPECT_EQ(verdicts.at("containment"), Verdict::pass);
    for (const char* key : {"chords", "contact_value", "crystal", "cells", "contacts", "profile"})
        EXPECT_EQ(verdicts.at(key), Verdict::info) << key;
    EXPECT_NE(html_of(r).find("measurements of the bulk are left out"), std::string::npos);
}

} // namespace
} // namespace scree
