// The transport plan: every branch of the integrators and accuracies, and the user's switches.

#include "render/build/grain_facts.h"
#include "render/scene/transport_plan.h"

#include <gmock/gmock.h>

#include <set>

namespace scree {
namespace {

using testing::HasSubstr;

/// Many bright grains that fill a large cube, seen from near.
struct Plans : testing::Test {
    IntegratorDescription integrator;
    CameraDescription camera;
    FilmDescription film;
    GrainFacts facts{1000000, 1, 1.5, {V3d(-50), V3d(50)}, 1e-3};

    Plans()
    {
        camera.origin = {0, -120, 0};
        camera.target = V3d(0);
        film.width = film.height = 1000;
    }
    TransportPlan plan(IntegratorKind kind, Accuracy accuracy = Accuracy::standard)
    {
        integrator.kind = kind;
        integrator.accuracy = accuracy;
        return plan_transport(integrator, camera, film, facts);
    }
    TransportPlan automatic(Accuracy accuracy = Accuracy::standard)
    {
        return plan(IntegratorKind::automatic, accuracy);
    }
};

constexpr std::array accuracies{Accuracy::reference, Accuracy::high, Accuracy::standard, Accuracy::draft};
constexpr std::array kinds{IntegratorKind::automatic, IntegratorKind::ept, IntegratorKind::ppt, IntegratorKind::vpt,
                           IntegratorKind::stf};

void expect_every_grain_as_it_is(const TransportPlan& plan)
{
    EXPECT_TRUE(plan.has_exemplars());
    EXPECT_FALSE(plan.has_proxies());
    EXPECT_FALSE(plan.needs_gsdfs());
    EXPECT_FALSE(plan.has_grain_medium);
    EXPECT_THAT(plan.why, HasSubstr("every grain is traced as explicit geometry"));
    EXPECT_EQ(plan.why_no_medium, "the integrator traces grains everywhere");
}

TEST_F(Plans, EptTracesGrainsAsTheyAre)
{
    for (const Accuracy accuracy : accuracies) {
        expect_every_grain_as_it_is(plan(IntegratorKind::ept, accuracy));
        EXPECT_FALSE(plan(IntegratorKind::ept, accuracy).has_shells);
        EXPECT_EQ(plan(IntegratorKind::ept, accuracy).name(), "ept");
    }
    integrator.explicit_grains = 3; // only used by auto and ppt
    expect_every_grain_as_it_is(plan(IntegratorKind::ept));
}

TEST_F(Plans, PptTakesProxies)
{
    for (const Accuracy accuracy : accuracies) {
        const TransportPlan all = plan(IntegratorKind::ppt, accuracy);
        EXPECT_FALSE(all.has_exemplars());
        EXPECT_TRUE(all.has_proxies() && all.needs_gsdfs());
        EXPECT_FALSE(all.has_grain_medium || all.has_shells);
        EXPECT_EQ(all.why, "proxies replace every grain");
        EXPECT_EQ(all.accuracy, accuracy);
        EXPECT_EQ(all.name(), "ppt");
    }
    integrator.explicit_grains = 2;
    const TransportPlan later = plan(IntegratorKind::ppt);
    EXPECT_TRUE(later.has_exemplars() && later.has_proxies());
    EXPECT_EQ(later.explicit_grains, 2u);
    EXPECT_EQ(later.why, "proxies replace all grains except the first 2 of a path");
}

TEST_F(Plans, VptAndStfTakeAMedium)
{
    for (const IntegratorKind kind : {IntegratorKind::vpt, IntegratorKind::stf}) {
        for (const Accuracy accuracy : accuracies) {
            const TransportPlan all = plan(kind, accuracy);
            EXPECT_TRUE(all.replaces_all && all.has_grain_medium && all.needs_gsdfs());
            EXPECT_FALSE(all.has_exemplars() || all.has_proxies());
            EXPECT_EQ(all.has_shells, kind == IntegratorKind::stf);
            EXPECT_EQ(all.why, "a medium replaces all grains");
            EXPECT_EQ(all.why_no_medium, "");
        }
        integrator.grain_depth = 4;
        EXPECT_TRUE(plan(kind).replaces_all);
        EXPECT_EQ(plan(kind).depth_radii, 0) << "the depth has no effect";
        integrator.grain_depth.reset();
    }
}

TEST_F(Plans, AutoGoesByAccuracy)
{
    const TransportPlan reference = automatic(Accuracy::reference);
    expect_every_grain_as_it_is(reference);
    EXPECT_FALSE(reference.has_shells);
    EXPECT_EQ(reference.name(), "ept");
    struct Expected {
        Accuracy accuracy;
        uint32_t explicit_grains;
        double least_pixels, depth_radii, depth_flights;
    };
    for (const Expected& expected :
         {Expected{Accuracy::high, 1, 0.5, 8, 5}, {Accuracy::standard, 1, 1, 4, 2.5}, {Accuracy::draft, 0, 0, 2, 1}}) {
        const TransportPlan made = automatic(expected.accuracy);
        EXPECT_EQ(made.explicit_grains, expected.explicit_grains);
        EXPECT_EQ(made.least_pixels, expected.least_pixels);
        EXPECT_EQ(made.depth_radii, expected.depth_radii);
        EXPECT_EQ(made.depth_flights, expected.depth_flights);
        EXPECT_EQ(made.has_exemplars(), expected.explicit_grains > 0);
        EXPECT_TRUE(made.has_proxies() && made.has_grain_medium && made.has_shells);
        EXPECT_FALSE(made.replaces_all);
        EXPECT_EQ(made.why_no_medium, "");
        EXPECT_EQ(made.name(), "auto");
    }
    EXPECT_EQ(automatic(Accuracy::standard).why, "proxies replace all grains except the first of a path");
    EXPECT_EQ(automatic(Accuracy::draft).why, "proxies replace every grain: the accuracy is draft");
}

TEST_F(Plans, AutoTracesFewGrainsAsTheyAre)
{
    for (const Accuracy accuracy : accuracies) {
        facts.count = 1999;
        expect_every_grain_as_it_is(automatic(accuracy));
        facts.count = 2000;
        EXPECT_EQ(automatic(accuracy).has_proxies(), accuracy != Accuracy::reference);
    }
    facts.count = 10;
    EXPECT_THAT(automatic().why, HasSubstr("fewer than 2000"));
}

TEST_F(Plans, AutoTracesAbsorbingGrainsAsTheyAre)
{
    facts.loss = 0.07; // 3.8 encounters
    expect_every_grain_as_it_is(automatic());
    EXPECT_THAT(automatic().why, HasSubstr("light hits about 3.8 grains"));
    facts.loss = 0.06;
    EXPECT_TRUE(automatic().has_proxies());
    facts.loss = 0;
    EXPECT_TRUE(automatic().has_proxies());
    EXPECT_GT(facts.encounters(), 1e5);
}

TEST_F(Plans, AutoTakesProxiesForGrainsThatAreNotResolved)
{
    camera.origin = {0, -30000, 0}; // 3 / 29950 against a pixel of 0.63 / 1000
    const TransportPlan far = automatic();
    EXPECT_EQ(far.explicit_grains, 0u);
    EXPECT_FALSE(far.has_exemplars());
    EXPECT_THAT(far.why, HasSubstr("the largest looks only 0.16 pixels wide"));
    EXPECT_FALSE(automatic(Accuracy::high).has_exemplars());
    camera.origin = {0, -7000, 0}; // 0.68 pixels: below the 1 of standard, above the 0.5 of high accuracy
    EXPECT_FALSE(automatic().has_exemplars());
    EXPECT_TRUE(automatic(Accuracy::high).has_exemplars());
    camera.origin = {0, 0, 0}; // amid the grains
    EXPECT_TRUE(automatic().has_exemplars());
    camera = {};
    camera.kind = CameraKind::orthographic;
    camera.origin = {0, -120, 0};
    camera.target = V3d(0);
    camera.width = 2000; // a pixel is 2 wide, and the largest grain 3
    EXPECT_TRUE(automatic().has_exemplars());
    camera.width = 4000;
    EXPECT_FALSE(automatic().has_exemplars());
}

TEST_F(Plans, AutoTakesNoMediumInThinBeds)
{
    facts.bounds.min.z = -5.9; // half the thickness must exceed 1.5 depths of 4 radii, which is 6
    facts.bounds.max.z = 5.9;
    EXPECT_FALSE(automatic().has_grain_medium);
    EXPECT_EQ(automatic().why_no_medium, "few grains lie 4 mean radii deep");
    EXPECT_TRUE(automatic().has_proxies() && automatic().needs_gsdfs());
    EXPECT_TRUE(automatic(Accuracy::draft).has_grain_medium);
    facts.bounds.max.z = 6.2;
    EXPECT_TRUE(automatic().has_grain_medium);
}

TEST_F(Plans, TheUserHasTheLastWord)
{
    integrator.explicit_grains = 5;
    EXPECT_EQ(automatic().explicit_grains, 5u);
    EXPECT_EQ(automatic().why, "proxies replace all grains except the first 5 of a path, as asked for");
    camera.origin = {0, -30000, 0};
    EXPECT_TRUE(automatic().has_exemplars());
    EXPECT_EQ(automatic().least_pixels, 0) << "explicit geometry, however small";
    facts.count = 10;
    EXPECT_TRUE(automatic().has_proxies());
    EXPECT_THAT(automatic().why, HasSubstr("as asked for"));
    EXPECT_EQ(automatic().why_no_medium, "the integrator traces grains everywhere");
    EXPECT_TRUE(automatic(Accuracy::reference).has_proxies());
    integrator.explicit_grains = 0;
    EXPECT_EQ(automatic().why, "proxies replace every grain, as asked for");
    EXPECT_FALSE(automatic().has_exemplars());
    integrator = {};

    integrator.grain_depth = 10;
    for (const IntegratorKind kind : {IntegratorKind::automatic, IntegratorKind::ept, IntegratorKind::ppt}) {
        const TransportPlan made = plan(kind);
        EXPECT_TRUE(made.has_grain_medium && made.needs_gsdfs());
        EXPECT_EQ(made.depth_radii, 10);
        EXPECT_EQ(made.depth_flights, 0);
        EXPECT_EQ(made.why_no_medium, "");
        EXPECT_EQ(made.has_proxies(), kind == IntegratorKind::ppt);
    }
    integrator.grain_depth = 60;
    EXPECT_FALSE(plan(IntegratorKind::ept).has_grain_medium);
    EXPECT_FALSE(plan(IntegratorKind::ept).needs_gsdfs());
    EXPECT_EQ(plan(IntegratorKind::ept).why_no_medium, "no place is 60 mean radii deep");
    integrator = {};

    integrator.grain_flights = 3; // with the depth in radii of the accuracy
    EXPECT_EQ(automatic().depth_radii, 4);
    EXPECT_EQ(automatic().depth_flights, 3);
    EXPECT_TRUE(plan(IntegratorKind::ppt).has_grain_medium);
    EXPECT_FALSE(plan(IntegratorKind::vpt).depth_flights > 0) << "begins at the faces";
    integrator.grain_depth = 10;
    EXPECT_EQ(automatic().depth_radii, 10);
    EXPECT_EQ(automatic().depth_flights, 3);
    integrator = {};

    facts.count = 1000000;
    camera.origin = {0, -7000, 0}; // the largest looks 0.68 pixels wide
    integrator.grain_pixels = 0.6;
    EXPECT_TRUE(automatic().has_exemplars());
    EXPECT_EQ(automatic().least_pixels, 0.6);
    EXPECT_EQ(plan(IntegratorKind::ppt).least_pixels, 0.6);
    integrator.explicit_grains = 2;
    EXPECT_EQ(automatic().least_pixels, 0.6);
    EXPECT_EQ(plan(IntegratorKind::ept).least_pixels, 0) << "has no proxies";
    integrator = {};

    EXPECT_EQ(automatic().least_shell, 8);
    EXPECT_TRUE(automatic().shells_must_pay);
    EXPECT_EQ(plan(IntegratorKind::stf).least_shell, 1);
    EXPECT_FALSE(plan(IntegratorKind::stf).shells_must_pay);
    integrator.shells = true;
    EXPECT_EQ(automatic().least_shell, 1);
    EXPECT_FALSE(automatic().shells_must_pay) << "set by the user";
    integrator = {};
    integrator.least_shell = 8;
    EXPECT_FALSE(automatic().shells_must_pay) << "set by the user";
    integrator.least_shell = 3;
    for (const IntegratorKind kind : kinds) EXPECT_EQ(plan(kind).least_shell, 3);
    integrator = {};

    for (const IntegratorKind kind : kinds) {
        for (const bool shells : {false, true}) {
            integrator.shells = shells;
            EXPECT_EQ(plan(kind).has_shells, shells);
            EXPECT_EQ(plan(kind, Accuracy::reference).has_shells, shells);
        }
        for (const auto& [form, name] : stf_form_names) {
            integrator.stf_form = form;
            EXPECT_EQ(plan(kind).stf_form, form);
        }
        integrator.medium_form = EquivalentForm::formula;
        EXPECT_EQ(plan(kind).medium_form, EquivalentForm::formula);
    }
}

TEST_F(Plans, WithoutGrainsThereIsNothingForThem)
{
    facts = {};
    for (const IntegratorKind kind : kinds) {
        for (const Accuracy accuracy : accuracies) {
            for (const bool asked : {false, true}) {
                integrator = {};
                if (asked) integrator.explicit_grains = 1;
                if (asked) integrator.grain_depth = 0;
                const TransportPlan made = plan(kind, accuracy);
                EXPECT_FALSE(made.has_exemplars() || made.has_proxies() || made.needs_gsdfs() ||
                             made.has_grain_medium || made.replaces_all);
                EXPECT_EQ(made.why, "the scene has no grains");
                EXPECT_EQ(made.why_no_medium, "the scene has no grains");
                EXPECT_EQ(made.has_shells, kind == IntegratorKind::stf ||
                                               (kind == IntegratorKind::automatic && accuracy != Accuracy::reference))
                    << "media have them";
            }
        }
    }
}

TEST_F(Plans, EverySwitchTellsEstimatorsApart)
{
    TransportPlan plan = automatic();
    ASSERT_TRUE(plan.has_proxies() && plan.has_grain_medium && plan.has_shells);
    std::vector<uint64_t> hashes{hash_plan(plan)};
    const auto with = [&](const auto& change) {
        TransportPlan other = plan;
        change(other);
        hashes.push_back(hash_plan(other));
    };
    with([](TransportPlan& p) { p.accuracy = Accuracy::high; });
    with([](TransportPlan& p) { p.explicit_grains = 2; });
    with([](TransportPlan& p) { p.explicit_grains = all_grains; });
    with([](TransportPlan& p) { p.least_pixels = 0; });
    with([](TransportPlan& p) { p.has_grain_medium = false; });
    with([](TransportPlan& p) { p.replaces_all = true; });
    with([](TransportPlan& p) { p.depth_radii = 5; });
    with([](TransportPlan& p) { p.depth_flights = 0; });
    with([](TransportPlan& p) { p.medium_form = EquivalentForm::formula; });
    with([](TransportPlan& p) { p.has_shells = false; });
    with([](TransportPlan& p) { p.stf_form = StfForm::diffusion; });
    with([](TransportPlan& p) { p.least_shell = 1; });
    with([](TransportPlan& p) { p.shells_must_pay = false; });
    EXPECT_EQ(std::set<uint64_t>(hashes.begin(), hashes.end()).size(), hashes.size());
}

TEST_F(Plans, SwitchesOfWhatAPlanLacksAreNone)
{
    facts.count = 10;
    integrator.shells = false;
    TransportPlan plan = automatic();
    const uint64_t hash = hash_plan(plan);
    EXPECT_EQ(hash, hash_plan(this->plan(IntegratorKind::ept))) << "auto is ept here";
    plan.least_shell = plan.depth_flights = plan.least_pixels = 77;
    EXPECT_EQ(hash_plan(plan), hash);
    integrator.shells = true; // the same shells, but larger ones only
    EXPECT_NE(hash_plan(automatic()), hash);
}

TEST(FactsOfList, WeighWhatGrainsAbsorbByCrossSection)
{
    std::vector<GrainTypeDescription> types(2);
    types[0].material.reflectance = {0.9f, 0.9f, 0.9f};
    types[1].material.reflectance = {0.5f, 0.5f, 0.5f};
    ParticleFrame frame;
    frame.position = {V3d(0), V3d(10, 0, 0), V3d(-99, 0, 0)};
    frame.radius = {3, 1, 0};
    frame.id = {0, 1, 2};
    const GrainFacts facts = facts_of_list(frame, {0, 1, 1}, types);
    EXPECT_EQ(facts.count, 2u) << "without the one of radius 0";
    EXPECT_EQ(facts.mean_radius, 2);
    EXPECT_EQ(facts.largest_radius, 3);
    EXPECT_NEAR(facts.loss, (9 * 0.1 + 1 * 0.5) / 10, 1e-6);
    EXPECT_EQ(facts.bounds.min, V3d(-3));
    EXPECT_EQ(facts.bounds.max, V3d(11, 3, 3));
    const GrainFacts none = facts_of_list({}, {}, types);
    EXPECT_EQ(none.count, 0u);
    EXPECT_EQ(none.mean_radius, 0);
    EXPECT_TRUE(none.bounds.isEmpty());
}

TEST(RoughLoss, IsOfTheBrightestChannel)
{
    Material material;
    material.reflectance = {0.2f, 0.9f, 0.5f};
    EXPECT_NEAR(rough_loss(material, 1), 0.1, 1e-6);
    material.kind = MaterialKind::dielectric;
    EXPECT_EQ(rough_loss(material, 1), 0);
    material.absorption = {3, 0.1f, 2};
    EXPECT_NEAR(rough_loss(material, 1), 1 - std::exp(-0.1 * 4 / 3 * 1.3), 1e-6);
    EXPECT_GT(rough_loss(material, 10), rough_loss(material, 1));
    material.kind = MaterialKind::conductor;
    EXPECT_NEAR(rough_loss(material, 1), 0.1, 1e-6);
}

} // namespace
} // namespace scree
