// Results of walks among the grains of a packing, in cases with a known answer.

#include "base/error.h"
#include "base/sampler.h"
#include "base/warp.h"
#include "packing/tiles/tile_generator.h"
#include "render/equivalent/continuous_equivalent.h"
#include "render/equivalent/decay_constant.h"
#include "render/gsdf/encounter.h"
#include "render/gsdf/gsdf_builder.h"
#include "render/media/homogeneous_medium.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/tile_beds.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace scree {
namespace {

void expect_within(const Measured& measured, double truth, const std::string& what)
{
    EXPECT_LT(std::abs(measured.value - truth), 4 * measured.error)
        << what << ": " << measured.value << " +- " << measured.error << ", not " << truth;
    EXPECT_GT(measured.error, 0) << what;
    std::printf("%-28s %9.5f +- %.5f, truth %9.5f (%+.1f)\n", what.c_str(), measured.value, measured.error, truth,
                (measured.value - truth) / measured.error);
}

double sample_henyey_greenstein(double g, double u)
{
    const double s = (1 - g * g) / (1 - g + 2 * g * u);
    return (1 + g * g - s * s) / (2 * g);
}

/// Batches of walks in a medium of mean free path 1.
std::vector<WalkBatch> walk_medium(double g, const V3d& albedo, uint32_t memory, uint32_t walks)
{
    std::vector<WalkBatch> batches(64, WalkBatch(memory));
    for (uint32_t b = 0; b < batches.size(); ++b) {
        for (uint32_t k = 0; k < walks; ++k) {
            Sampler sampler(3, b, k, 0);
            WalkTrail trail;
            trail.position.emplace_back(0);
            trail.direction.emplace_back(0, 0, 1);
            for (uint32_t i = 0; i < 8 * memory; ++i) {
                const V3d w = trail.direction.back();
                const double s = -std::log(sampler.next()), cosine = sample_henyey_greenstein(g, sampler.next()),
                             phi = 2 * pi * sampler.next();
                const double sine = safe_sqrt(1 - cosine * cosine);
                trail.flight.push_back(s);
                trail.kept.push_back(albedo);
                trail.position.push_back(trail.position.back() + s * w);
                trail.direction.push_back(Frame(w).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine}));
            }
            batches[b].add(trail);
        }
    }
    return batches;
}

TEST(WalkStatistics, GiveBackAHomogeneousMedium)
{
    for (const double g : {-0.4, 0.65, 0.85}) {
        // within the limits that packing_decay.h gives
        const V3d albedo(0.95, g < 0 ? 0.97 : g < 0.8 ? 0.8 : 0.9, 0.99);
        const uint32_t memory = walk_memory(g);
        const auto batches = walk_medium(g, albedo, memory, 1600 / memory);
        const WalkStatistics statistics(batches);
        const std::string name = "g " + std::to_string(g);
        expect_within(statistics.flight(), 1, name + " l");
        expect_within(statistics.cosine(), g, name + " g");
        expect_within(statistics.diffusivity(), 1 / (1 - g), name + " D");
        expect_within(statistics.transport_length(), 1 / (1 - g), name + " l*");
        for (int c = 0; c < 3; ++c) {
            const PackingDecay decay = statistics.decay(c);
            EXPECT_NEAR(decay.albedo, albedo[c], 1e-9);
            expect_within(decay.kappa, decay_constant(albedo[c], g), name + " kappa " + std::to_string(albedo[c]));
            std::printf("    from n = %u; from half of it %.5f +- %.5f\n", decay.steps, decay.check.value,
                        decay.check.error);
        }
    }
}

std::shared_ptr<const Gsdf> white()
{
    static const auto gsdf = build_gsdf({nullptr, lambert(1)}, {0.08});
    return gsdf;
}

std::shared_ptr<const Gsdf> glass()
{
    static const auto gsdf = build_gsdf({nullptr, dielectric(1.5)}, {0.08});
    return gsdf;
}

GrainType cubes()
{
    static const EmbreeDevice device;
    static const auto body = std::make_shared<const Exemplar>(device, cube(), "cube");
    static const auto gsdf = build_gsdf({body.get(), lambert(1)}, {0.08});
    return {"cube", lambert(0.8f), body, gsdf};
}

PackingWalkOptions walk_options(const TileBed& bed, uint64_t scatterings)
{
    PackingWalkOptions options;
    options.scatterings = scatterings;
    options.start_radius = 0.2 * bed.half();
    options.safe_radius = 0.95 * bed.half();
    return options;
}

TEST(PackingWalk, OfFewGrainsIsThatOfIndependentFlights)
{
    Material tea = dielectric(1.5);
    tea.absorption = Color(0, 0.05f, 0.2f);
    for (const GrainType& type :
         {GrainType{"white", lambert(0.9f), nullptr, white()}, GrainType{"tea", tea, nullptr, glass()}, cubes()}) {
        const GrainShare share{type.gsdf.get(), nullptr, type.material, 1, 1};
        const MixtureMoments mixture = mixture_moments({&share, 1}, 0.02);
        const TileBed bed(sphere_tile(0.02, 1000), 1, type, 200 * mixture.flight);
        const PackingWalk walk = walk_packing(bed.world(), bed.tracer(), walk_options(bed, 150000));
        EXPECT_LT(walk.left, 1e-3 * static_cast<double>(walk.walks));
        expect_within(walk.void_flight, mixture.void_flight, type.name + " l_v");
        expect_within(walk.flight, mixture.flight, type.name + " l");
        expect_within(walk.cosine, mixture.g, type.name + " g");
        expect_within(walk.diffusivity, mixture.diffusivity(), type.name + " D");
        expect_within(walk.transport_length, mixture.transport_length(), type.name + " l*");
    }
}

// The mean chord of the voids is 4 times their volume over their surface, for any packing of spheres.
TEST(PackingWalk, MeetsTheVoidChordsOfAnyPacking)
{
    for (const GrainType& type : {GrainType{"glass", dielectric(1.5), nullptr, glass()}, cubes()}) {
        for (const double f : {0.1, 0.3, 0.5, 0.6}) {
            const GrainShare share{type.gsdf.get(), nullptr, type.material, 1, 1};
            const MixtureMoments mixture = mixture_moments({&share, 1}, f);
            const TileBed bed(sphere_tile(f, 600), 1, type, 200 * mixture.flight);
            const PackingWalk walk = walk_packing(bed.world(), bed.tracer(), walk_options(bed, 60000));
            const std::string name = type.name + " f " + std::to_string(f);
            expect_within(walk.void_flight, mixture.void_flight, name + " l_v");
            expect_within(walk.flight, mixture.flight, name + " l");
            expect_within(walk.cosine, mixture.g, name + " g"); // impacts are uniform in q
            EXPECT_LT(walk.left, 1e-3 * static_cast<double>(walk.walks));
        }
    }
}

TEST(PackingWalk, MeetsTheVoidChordsOfManySizes)
{
    std::vector<double> radii(800);
    double r1 = 0, r2 = 0, r3 = 0;
    for (size_t i = 0; i < radii.size(); ++i) {
        const double r = radii[i] = 0.4 + 0.6 * std::pow(static_cast<double>(i) / 800, 3);
        r1 += r / 800;
        r2 += r * r / 800;
        r3 += r * r * r / 800;
    }
    TileOptions options;
    options.fraction = 0.55;
    options.variants = 2;
    const auto tile = std::make_shared<const PackingTile>(make_tile(radii, options, {}).tile);
    const TileBed bed(tile, r1, {"glass", dielectric(1.5), nullptr, glass()}, 300);
    const PackingWalk walk = walk_packing(bed.world(), bed.tracer(), walk_options(bed, 150000));
    expect_within(walk.void_flight, 4 * (1 - 0.55) * r3 / (3 * 0.55 * r2), "many sizes l_v");
}

// Light that leaves an opaque grain finds the path free by which it came.
TEST(PackingWalk, OfOpaqueGrainsSpreadsLessThanIndependentFlights)
{
    const GrainType type{"white", lambert(0.9f), nullptr, white()};
    const GrainShare share{type.gsdf.get(), nullptr, type.material, 1, 1};
    const MixtureMoments mixture = mixture_moments({&share, 1}, 0.6);
    const TileBed bed(sphere_tile(0.6, 600), 1, type, 200);
    const PackingWalk walk = walk_packing(bed.world(), bed.tracer(), walk_options(bed, 100000));
    EXPECT_LT(walk.diffusivity.value + 4 * walk.diffusivity.error, 0.8 * mixture.diffusivity());
    // An independent tracer found 0.39 at f 0.6 (two digits).
    EXPECT_LT(std::abs(walk.diffusivity.value - 0.39), 4 * walk.diffusivity.error + 0.005);

    const auto medium = continuous_equivalent(mixture, EquivalentForm::decay, &walk);
    const auto lossless = continuous_equivalent(mixture, EquivalentForm::walk, &walk);
    EXPECT_NEAR(lossless.diffusivity, walk.diffusivity.value, 1e-12);
    EXPECT_NEAR(lossless.transport_length, walk.transport_length.value, 1e-12);
    EXPECT_NEAR(medium.albedo.x, mixture.albedo.x, 1e-6); // the albedo, and so the reflectance, is that of the grains
    EXPECT_EQ(medium.g, lossless.g);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(medium.decay[c], walk.decay[0].kappa.value, 1e-6);
        EXPECT_EQ(walk.decay[static_cast<size_t>(c)].kappa.value, walk.decay[0].kappa.value); // grey
    }
    EXPECT_EQ(medium.doubt, "");
    EXPECT_THROW(continuous_equivalent(mixture, EquivalentForm::walk), std::invalid_argument);
}

/// The decay rate of the light that hits grains, with the distance from the plane where it starts, measured between two
/// distances by separate weighted walks.
Measured fall_off(const TileBed& bed, double near, double far, uint32_t walks)
{
    constexpr uint32_t batches = 20;
    const GrainType& type = bed.world().types[0];
    const double width = 0.5 * (far - near);
    std::vector<double> slopes;
    for (uint32_t b = 0; b < batches; ++b) {
        double at_near = 0, at_far = 0;
        for (uint32_t i = 0; i < walks / batches; ++i) {
            Sampler sampler(77, b, i, 0);
            double u = sampler.next(), v = sampler.next();
            const V3d start = 0.2 * bed.half() * std::cbrt(sampler.next()) * sample_sphere(u, v);
            u = sampler.next();
            v = sampler.next();
            V3d d = sample_sphere(u, v), p = start;
            Place from;
            for (double weight = 1; weight > 0;) {
                const Hit hit = bed.tracer().intersect(p, d, from, GrainDetail::proxy);
                if (hit.place.kind != HitKind::grain) break; // the walk left the bed, which takes some hundred radii
                const V3d way = hit.point - start;
                for (int axis = 0; axis < 3; ++axis) { // planes across each axis
                    const double z = std::abs(way[axis]);
                    if (z >= near && z < near + width) at_near += weight;
                    if (z >= far && z < far + width) at_far += weight;
                }
                const GrainSphere sphere = bed.world().sphere(hit.place.index);
                const Encounter encounter(hit.normal, d);
                const uint32_t stratum = Gsdf::stratum(encounter.q, sampler.next()),
                               cell = type.gsdf->sample_cell(stratum, sampler.next());
                const uint32_t number = type.gsdf->pick(stratum, cell, sampler.next());
                weight *= type.gsdf->weight(number, type.material, sphere.radius).x;
                if (weight < 1e-3) weight = sampler.next() < 0.5 ? 2 * weight : 0;
                p = sphere.centre + sphere.radius * encounter.to_world(type.gsdf->record(number).point.unpack());
                d = encounter.to_world(type.gsdf->record(number).direction.unpack()).normalized();
                from = hit.place;
            }
        }
        slopes.push_back(std::log(at_near / at_far) / (far - near));
    }
    return measured_ratio(slopes, std::vector<double>(batches, 1));
}

// The purpose of the form `decay`: the lossless numbers do not give the decay of light in a dense bed of absorbing
// grains.
TEST(PackingWalk, DecayIsThatOfLightFromAPlane)
{
    Material smoky = dielectric(1.5);
    smoky.absorption = Color(0.05f);
    struct Case {
        GrainType type;
        double near, far;
        uint32_t walks;
    };
    for (const Case& c : {Case{{"white 0.9", lambert(0.9f), nullptr, white()}, 3, 7, 40000},
                          Case{{"smoky", smoky, nullptr, glass()}, 15, 35, 10000}}) {
        const GrainShare share{c.type.gsdf.get(), nullptr, c.type.material, 1, 1};
        const MixtureMoments mixture = mixture_moments({&share, 1}, 0.6);
        const TileBed bed(sphere_tile(0.6, 600), 1, c.type, 400);
        const PackingWalk walk = walk_packing(bed.world(), bed.tracer(), walk_options(bed, 600000));
        const Measured measured = fall_off(bed, c.near, c.far, c.walks), kappa = walk.decay[0].kappa;
        std::printf("%s: falls off by %.4f +- %.4f, kappa %.4f +- %.4f; media by formula %.4f, by walk %.4f\n",
                    c.type.name.c_str(), measured.value, measured.error, kappa.value, kappa.error,
                    continuous_equivalent(mixture, EquivalentForm::formula).decay.x,
                    continuous_equivalent(mixture, EquivalentForm::walk, &walk).decay.x);
        // Paths of some ten scatterings do not cover all of the packing's memory: 1.5 %.
        EXPECT_LT(std::abs(kappa.value - measured.value),
                  0.015 * measured.value + 4 * std::hypot(kappa.error, measured.error));
        EXPECT_NEAR(continuous_equivalent(mixture, EquivalentForm::decay, &walk).decay.x, kappa.value, 1e-6);
    }
}

TEST(PackingWalk, LosslessStaysLossless)
{
    Material tea = dielectric(1.5);
    tea.absorption = Color(0, 0.05f, 0.2f);
    const GrainType type{"tea", tea, nullptr, glass()};
    const GrainShare share{type.gsdf.get(), nullptr, type.material, 1, 1};
    const MixtureMoments mixture = mixture_moments({&share, 1}, 0.5);
    const TileBed bed(sphere_tile(0.5, 600), 1, type, 300);
    const PackingWalk walk = walk_packing(bed.world(), bed.tracer(), walk_options(bed, 60000));
    const auto medium = continuous_equivalent(mixture, EquivalentForm::decay, &walk);
    EXPECT_EQ(medium.albedo.x, 1);
    EXPECT_EQ(medium.decay.x, 0);
    EXPECT_LT(medium.albedo.y, 1);
    EXPECT_LT(medium.albedo.z, medium.albedo.y);
    for (int c = 1; c < 3; ++c) EXPECT_NEAR(medium.decay[c], walk.decay[static_cast<size_t>(c)].kappa.value, 1e-6);
}

TEST(PackingWalk, IsTheSameOnAnyNumberOfThreads)
{
    const TileBed bed(sphere_tile(0.5, 600), 1, {"white", lambert(0.9f), nullptr, white()}, 200);
    PackingWalk walks[2];
    for (int i = 0; i < 2; ++i) {
        const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, i == 0 ? 1 : 5);
        walks[i] = walk_packing(bed.world(), bed.tracer(), walk_options(bed, 20000));
    }
    EXPECT_EQ(walks[0].diffusivity.value, walks[1].diffusivity.value);
    EXPECT_EQ(walks[0].transport_length.error, walks[1].transport_length.error);
    EXPECT_EQ(walks[0].decay[0].kappa.value, walks[1].decay[0].kappa.value);
    EXPECT_EQ(walks[0].scatterings, walks[1].scatterings);
}

TEST(PackingWalk, SaysWhatItCannotWalkIn)
{
    const TileBed bed(sphere_tile(0.5, 600), 1, {"white", lambert(0.9f), nullptr, white()}, 50);
    PackingWalkOptions outside = walk_options(bed, 1000);
    outside.centre = V3d(300, 0, 0);
    outside.start_radius = 1;
    EXPECT_THROW(walk_packing(bed.world(), bed.tracer(), outside), InputError);
    Progress stopped;
    stopped.cancel();
    EXPECT_THROW(walk_packing(bed.world(), bed.tracer(), walk_options(bed, 1000), stopped), Cancelled);
    const TileBed unknown(sphere_tile(0.5, 600), 1, {"white", lambert(0.9f), nullptr, nullptr}, 50);
    EXPECT_THROW(walk_packing(unknown.world(), unknown.tracer(), walk_options(bed, 1000)), InputError);
}

} // namespace
} // namespace scree
