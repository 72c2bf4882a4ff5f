// One grain, averaged over its rotations, under the sun: proxy path tracing against explicit path tracing.

#include "base/warp.h"
#include "render/grains/library/grain_library.h"
#include "render/gsdf/gsdf_builder.h"
#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>

namespace scree {
namespace {

constexpr uint32_t rotations = 256;
constexpr std::array<double, 5> angles{10, 50, 90, 130, 170}; // scattering angles in degrees
constexpr double half_width = 2; // of the sun's disc, in degrees

Light sun(const V3d& towards, double degrees)
{
    Light light;
    light.kind = LightKind::distant;
    light.direction = towards;
    light.one_minus_cos = 2 * std::pow(std::sin(degrees * pi / 720), 2); // of half the angular diameter
    light.radiance =
        Color(static_cast<float>(1 / (pi * light.one_minus_cos * (2 - light.one_minus_cos)))); // irradiance 1
    return light;
}

/// A single grain of a library type under a light; its absorption at its natural size is the material's.
std::unique_ptr<TestScene> grain_under(const Light& light, const LibraryGrain& grain,
                                       std::shared_ptr<const Exemplar> body, std::shared_ptr<const Gsdf> gsdf,
                                       uint64_t id)
{
    auto scene = std::make_unique<TestScene>();
    Material material = grain.material;
    material.absorption *= static_cast<float>(grain.typical_radius);
    const uint32_t type = scene->add_type(material, std::move(body));
    scene->set_gsdf(type, std::move(gsdf));
    scene->add_grain(V3d(0), 1, type);
    scene->set_first_id(id);
    scene->add_light(light);
    scene->build();
    return scene;
}

/// Traces `paths` camera rays along d over each grain's cross-section; each(grain, path) for every one.
template <class Each>
void look(const std::vector<std::unique_ptr<TestScene>>& scenes, const V3d& d, uint32_t paths,
          const PathOptions& options, uint64_t seed, const Each& each)
{
    tbb::parallel_for(size_t{0}, scenes.size(), [&](size_t i) {
        flush_subnormals();
        const double r = scenes[i]->world().sphere(0).radius;
        const Frame frame(d);
        std::vector<PathVertex> trail;
        for (uint32_t p = 0; p < paths; ++p) {
            Sampler sampler(seed, p, static_cast<uint32_t>(i), 0);
            const double u1 = sampler.next(), u2 = sampler.next();
            const V2d disk = r * sample_disk(u1, u2);
            trail.clear();
            const PathResult path =
                trace_path(scenes[i]->world(), scenes[i]->tracer(), frame.s * disk.x + frame.t * disk.y - 4.0 * d, d,
                           sampler, options, &trail);
            each(i, path, trail.back());
        }
    });
}

Estimate over(const std::vector<double>& sums, uint32_t paths)
{
    Estimate estimate;
    for (const double sum : sums) estimate.add(sum / paths);
    return estimate;
}

/// Radiance under each of the suns. If light cannot be sampled, paths are counted by their last direction, over all
/// suns at the same angle.
std::array<Estimate, 5> radiance_as_is(const std::vector<std::unique_ptr<TestScene>>& scenes, uint32_t paths)
{
    std::array<std::vector<double>, 5> sums;
    for (auto& sum : sums) sum.resize(scenes.size());
    const V3d d(0, 0, 1);
    look(scenes, d, paths, {}, 1, [&](size_t grain, const PathResult& path, const PathVertex& last) {
        const double turned = std::atan2(last.d.cross(d).length(), last.d.dot(d)) * 180 / pi;
        for (size_t k = 0; k < angles.size(); ++k) {
            if (std::abs(turned - angles[k]) >= half_width) continue;
            const double ring =
                2 * pi *
                (std::cos((angles[k] - half_width) * pi / 180) - std::cos((angles[k] + half_width) * pi / 180));
            sums[k][grain] += path.radiance.y / ring;
        }
    });
    std::array<Estimate, 5> estimates;
    for (size_t k = 0; k < angles.size(); ++k) estimates[k] = over(sums[k], paths);
    return estimates;
}

class GrainUnderSun : public testing::TestWithParam<std::string> {};

TEST_P(GrainUnderSun, ProxyIsTheMeanGrain)
{
    const LibraryGrain& grain = *find_library_grain(GetParam());
    std::shared_ptr<const Exemplar> body;
    const auto device = std::make_shared<EmbreeDevice>();
    if (grain.default_triangles > 0)
        body = std::make_shared<Exemplar>(*device, make_grain_shape(grain, {0, 2000, {}}, "test"), "test");
    const auto gsdf = build_gsdf({body.get(), grain.material}, {0.08});
    // The hairball's fibres intersect each other and, as coarse as here, themselves: there are closed pockets without
    // an exit.
    const double lost =
        static_cast<double>(gsdf->data().quality.lost) / static_cast<double>(gsdf->data().quality.paths);
    EXPECT_LE(lost, grain.name == "hairball" ? 2e-3 : 0.0);
    Light sky;
    std::vector<std::unique_ptr<TestScene>> in_sky, under_sun;
    for (uint32_t i = 0; i < rotations; ++i) in_sky.push_back(grain_under(sky, grain, body, gsdf, i));
    for (uint32_t i = 0; i < 16; ++i)
        under_sun.push_back(grain_under(sun(V3d(0, 0, 1), 2 * half_width), grain, body, gsdf, i));
    const auto as_is = radiance_as_is(in_sky, 1000);
    double worst = 0;
    for (size_t k = 0; k < angles.size(); ++k) {
        const double a = angles[k] * pi / 180;
        const V3d d(std::sin(a), 0, std::cos(a)); // turned by a, towards the sun
        PathOptions options;
        options.explicit_grains = 0;
        constexpr uint32_t paths = 6000;
        std::vector<double> sums(under_sun.size());
        look(under_sun, d, paths, options, 2,
             [&](size_t i, const PathResult& path, const PathVertex&) { sums[i] += path.radiance.y; });
        const Estimate proxy = over(sums, paths);
        // The density of directions was itself estimated from two counts per path, in rows of the polar angle.
        const double counts = 2 * static_cast<double>(gsdf->data().quality.paths) * proxy.mean() * 2 * pi *
                              std::sin(a) * DirectionGrid::row_width;
        const double error =
            std::hypot(as_is[k].standard_error(), proxy.standard_error(), proxy.mean() / std::sqrt(counts));
        EXPECT_LT(std::abs(as_is[k].mean() - proxy.mean()), 4 * error) << grain.name << " at " << angles[k];
        const double difference = 100 * (proxy.mean() / as_is[k].mean() - 1);
        worst = std::max(worst, std::abs(difference));
        std::printf("%-18s %3.0f deg: as it is %.5f +- %.5f, proxy %.5f, %+6.2f %% +- %.2f\n", grain.name.c_str(),
                    angles[k], as_is[k].mean(), as_is[k].standard_error(), proxy.mean(), difference,
                    100 * error / as_is[k].mean());
    }
    std::printf("%-18s worst %.2f %%\n", grain.name.c_str(), worst);
}

std::vector<std::string> all_names()
{
    std::vector<std::string> names;
    for (const LibraryGrain& grain : grain_library()) names.push_back(grain.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Library, GrainUnderSun, testing::ValuesIn(all_names()),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace scree
