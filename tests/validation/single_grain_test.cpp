// One grain under a beam: mean cosine of scattering, and the loss by a tint.

#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

/// A single unit sphere in empty space.
std::unique_ptr<TestScene> one_grain(const Material& material)
{
    auto scene = std::make_unique<TestScene>();
    scene->add_grain(V3d(0), 1, scene->add_type(material));
    scene->add_constant_light(1);
    scene->build();
    return scene;
}

struct Beam {
    Estimate cosine, radiance;
};

/// A parallel beam over the sphere's cross-section; the cosine is that between the entering and the leaving direction.
Beam shine(const TestScene& scene, uint32_t n)
{
    Beam beam;
    std::vector<PathVertex> trail;
    const double r = scene.world().grains.radius(0);
    for (uint32_t i = 0; i < n; ++i) {
        Sampler sampler(23, i, 0, 0);
        const double rho = r * std::sqrt(sampler.next()), phi = 2 * pi * sampler.next();
        const V3d d(0, 0, 1), o(rho * std::cos(phi), rho * std::sin(phi), -5);
        trail.clear();
        const PathResult path = trace_path(scene.world(), scene.tracer(), o, d, sampler, {}, &trail);
        beam.cosine.add(trail.back().d.dot(d));
        beam.radiance.add(path.radiance.x);
    }
    return beam;
}

// Truths: geometric optics of a sphere, Fresnel included (design, section 5). Standard error below 5e-4.
TEST(SingleGrain, DielectricMeanCosine)
{
    for (const auto& [ior, truth] : {std::pair{1.31, 0.78166}, std::pair{1.5, 0.65009}}) {
        const Beam beam = shine(*one_grain(dielectric(ior)), 2000000);
        EXPECT_LT(beam.cosine.standard_error(), 5e-4);
        EXPECT_LT(std::abs(beam.cosine.z(truth)), 4) << beam.cosine.mean() << " +- " << beam.cosine.standard_error();
        std::printf("ior %.2f: %.5f +- %.5f, truth %.5f\n", ior, beam.cosine.mean(), beam.cosine.standard_error(),
                    truth);
    }
}

TEST(SingleGrain, LambertMeanCosine)
{
    const Beam beam = shine(*one_grain(lambert(1)), 2000000);
    EXPECT_LT(std::abs(beam.cosine.z(-4.0 / 9)), 4) << beam.cosine.mean() << " +- " << beam.cosine.standard_error();
    std::printf("lambert: %.5f +- %.5f, truth %.5f\n", beam.cosine.mean(), beam.cosine.standard_error(), -4.0 / 9);
}

// A finely tessellated sphere scatters like the sphere: its facets tilt normals by up to an edge's half-angle, 0.5
// degrees at 81,920 triangles, and lose 1e-4 of the cross-section; the mean cosine moves by less than 1e-3.
TEST(SingleGrain, FineMeshScattersLikeTheSphere)
{
    TestScene scene;
    scene.add_grain(V3d(0), 1, scene.add_type(dielectric(1.5), icosphere(6)));
    scene.add_constant_light(1);
    scene.build();
    const Beam beam = shine(scene, 400000);
    EXPECT_NEAR(beam.cosine.mean(), 0.65009, 1e-3 + 4 * beam.cosine.standard_error());
    std::printf("mesh: %.5f +- %.5f\n", beam.cosine.mean(), beam.cosine.standard_error());
}

// An interface that only tints: the path crosses two interfaces, each with weight 0.98.
TEST(SingleGrain, BothInterfacesCount)
{
    Material tinted = dielectric(1);
    tinted.tint = Color(0.98f);
    const Beam sphere = shine(*one_grain(tinted), 1000);
    EXPECT_NEAR(sphere.radiance.mean(), 0.9604, 1e-6);
    EXPECT_NEAR(sphere.cosine.mean(), 1, 1e-12);

    TestScene scene; // the same for a mesh
    scene.add_grain(V3d(0), 1, scene.add_type(tinted, cube()));
    scene.add_constant_light(1);
    scene.build();
    std::vector<PathVertex> trail;
    Sampler sampler(1, 0, 0, 0);
    const PathResult path =
        trace_path(scene.world(), scene.tracer(), V3d(0.01, 0.02, -5), V3d(0, 0, 1), sampler, {}, &trail);
    EXPECT_NEAR(path.radiance.x, 0.9604, 1e-6);
    EXPECT_EQ(trail.size(), 3u);
}

// exp(-sigma_a chord) averaged over the cross-section of an index-matched sphere:
// 2 integral_0^1 exp(-2 s c) c dc = (1 - (1 + 2s) exp(-2s)) / (2 s^2), with s = sigma_a r.
TEST(SingleGrain, AbsorbsByItsSize)
{
    for (const double r : {0.5, 3.0}) {
        const double sigma = 0.7, s = sigma * r;
        Material tea = dielectric(1);
        tea.absorption = Color(static_cast<float>(sigma));
        TestScene scene;
        scene.add_grain(V3d(0), r, scene.add_type(tea));
        scene.add_constant_light(1);
        scene.build();
        const Beam beam = shine(scene, 200000);
        const double truth = (1 - (1 + 2 * s) * std::exp(-2 * s)) / (2 * s * s);
        EXPECT_LT(std::abs(beam.radiance.z(truth)), 4) << beam.radiance.mean() << " against " << truth;
    }
}

// A clear grain of radius 0.5 in a box of tea 2 wide, without refraction: the path through the middle absorbs over a
// length of 1, however it is divided into segments.
TEST(SingleGrain, SurroundingSurfaceAbsorbsOnTheWayInAndOut)
{
    Material tea = dielectric(1);
    tea.absorption = Color(0.5f);
    TestScene scene;
    scene.add_grain(V3d(0), 0.5, scene.add_type(dielectric(1)));
    scene.add_surface(cube(), tea);
    scene.add_constant_light(1);
    scene.build();
    const double scale = scene.space().length(1);
    Estimate radiance; // roulette makes it noisy
    for (uint32_t i = 0; i < 20000; ++i) {
        Sampler sampler(1, i, 0, 0);
        radiance.add(trace_path(scene.world(), scene.tracer(), scale * V3d(0.001, 0.0005, -5), V3d(0, 0, 1), sampler)
                         .radiance.x);
    }
    EXPECT_LT(std::abs(radiance.z(std::exp(-0.5))), 4) << radiance.mean() << " +- " << radiance.standard_error();
    EXPECT_LT(radiance.standard_error(), 0.005);
}

// A Lambertian sphere of albedo rho in a constant environment of radiance 1 has radiance rho everywhere.
TEST(SingleGrain, LambertShowsItsReflectance)
{
    const Beam beam = shine(*one_grain(lambert(0.3f)), 20000);
    EXPECT_NEAR(beam.radiance.mean(), 0.3, 1e-6); // every path has the same weight
}

} // namespace
} // namespace scree
