// Media at the ends of what can be asked for: hardly any absorption, scattering straight on or straight back, a million mean free paths.

#include "render/bench/stress/stress_run.h"
#include "render/bench/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

constexpr IntegratorKind medium_kinds[] = {IntegratorKind::vpt, IntegratorKind::stf};

/// A cube of edge 2 from above; sees a narrow square in the middle of its upper face.
StressScene cube_of_medium(double optical_radius, double albedo, double g)
{
    StressScene scene = scene_from_above(8, 0.125, 3);
    scene.meshes["cube.obj"] = cube_mesh(1);
    add_medium(scene, "cube.obj", optical_radius, Weight(albedo), g);
    add_constant(scene, Color(1));
    return scene;
}

/// A ball of radius 1 under a day.
StressScene ball_of_medium(double optical_radius, double albedo, double g)
{
    StressScene scene = empty_scene(24, 18, V3d(-3, -3.5, 2.5), V3d(0), 35);
    scene.meshes["ball.obj"] = ball_mesh(1, 2);
    add_medium(scene, "ball.obj", optical_radius, Weight(albedo), g);
    add_day(scene);
    return scene;
}

/// What an isotropic half-space of an albedo reflects of diffuse light straight up: 1 - sqrt(1 - albedo) H(1), H by iteration of its
/// integral equation (Chandrasekhar 1960, chapter V, equation 12).
double half_space_radiance(double albedo)
{
    constexpr int n = 400;
    std::vector<double> cosine(n), weight(n), h(n, 1);
    for (int i = 0; i < n; ++i) { // squares, as H is steep at 0
        const double x = (i + 0.5) / n;
        cosine[static_cast<size_t>(i)] = x * x;
        weight[static_cast<size_t>(i)] = 2 * x / n;
    }
    const double root = std::sqrt(1 - albedo);
    const auto next = [&](double mu) {
        double sum = 0;
        for (size_t j = 0; j < n; ++j) sum += weight[j] * cosine[j] * h[j] / (mu + cosine[j]);
        return 1 / (root + 0.5 * albedo * sum);
    };
    double change = 1;
    for (int round = 0; round < 4000 && change > 1e-12; ++round) {
        std::vector<double> better(n);
        change = 0;
        for (size_t i = 0; i < n; ++i) {
            better[i] = 0.5 * (h[i] + next(cosine[i])); // the mean of two steps, which converges where steps alone sway
            change = std::max(change, std::abs(better[i] - h[i]));
        }
        h = better;
    }
    return 1 - root * next(1);
}

Placing askew()
{
    Placing placing;
    placing.rotation = Imath::Quatd(0.8, V3d(0.36, 0, 0.48));
    placing.offset = V3d(100.1, -30.3, 7.7);
    return placing;
}

StressFinding against_half_space(double optical_radius, double albedo, const StressView& view, double bias, const Progress& progress, const Placing& placing = {})
{
    const StressPicture picture = StressStage(cube_of_medium(optical_radius, albedo, 0), placing, view, progress).render(view, progress);
    StressFinding finding = compare_truth(picture.film, std::vector<double>(picture.film.pixels().size(), half_space_radiance(albedo)), 4, bias);
    finding.count(picture.statistics);
    finding.remark += fmt::format("; longest path {} segments", finding.longest);
    return finding;
}

StressFinding lossless(const StressScene& scene, const StressView& view, double allowed, const Progress& progress)
{
    const StressPicture picture = StressStage(scene, {}, view, progress).render(view, progress);
    StressFinding finding = compare_exactly(picture.film, 1, allowed);
    finding.count(picture.statistics);
    finding.remark = fmt::format("{:.3g} events and {:.3g} shells a path", static_cast<double>(picture.statistics.events) / static_cast<double>(finding.paths),
                                 static_cast<double>(picture.statistics.shells) / static_cast<double>(finding.paths));
    return finding;
}

StressFinding two_ways(const StressScene& scene, const StressView& one, const StressView& other, double bias, const Progress& progress)
{
    const StressPicture a = StressStage(scene, {}, one, progress).render(one, progress), b = StressStage(scene, {}, other, progress).render(other, progress);
    StressFinding finding = compare_means(a.film, b.film, 6, bias);
    finding.count(a.statistics);
    finding.count(b.statistics);
    return finding;
}

} // namespace

void add_medium_cases(StressRun& run)
{
    run.begin("media, furnace", "a lossless cube of medium in a surrounding of 1 with 1", "1e-6 an optical radius of 16; so little is lost that no sample sees it");
    for (const IntegratorKind kind : medium_kinds) {
        for (const double g : {0.0, 0.999, -0.999}) {
            run.add(fmt::format("albedo 1 - 1e-12, g {}, {}", g, name_of(kind)), kind == IntegratorKind::vpt ? StressExtent::quick : StressExtent::full, [&] {
                return lossless(cube_of_medium(16, 1 - 1e-12, g), {.kind = kind, .accuracy = Accuracy::draft, .spp = 16}, 1e-6, run.progress());
            });
        }
    }

    run.begin("media, thick", "a cube of optical radius 1e6 with the isotropic half-space (Chandrasekhar's H)", "noise; shells 0.3 %");
    for (const IntegratorKind kind : medium_kinds) {
        for (const double albedo : {0.5, 0.9, 0.99, 0.9999, 0.999999}) {
            const bool deep = albedo > 0.999;
            run.add(fmt::format("optical radius 1e6, albedo {}, {}", albedo, name_of(kind)), albedo == 0.9 && kind == IntegratorKind::vpt ? StressExtent::quick : StressExtent::full, [&] {
                return against_half_space(1e6, albedo, {.kind = kind, .accuracy = Accuracy::draft, .spp = deep ? 256u : 4096u}, kind == IntegratorKind::stf ? 0.003 : 0, run.progress());
            });
        }
    }

    run.begin("media, forward and back", "a ball of optical radius 16 by scatterings, by shells and by scattered light alone, in the mean", "noise; shells 1 %");
    for (const double g : {0.999, -0.999, 0.9}) {
        const StressScene ball = ball_of_medium(16, 0.99, g);
        const StressView stepwise{.kind = IntegratorKind::vpt, .spp = 512}, shells{.kind = IntegratorKind::stf, .accuracy = Accuracy::standard, .spp = 512, .seed = 2},
            scattered{.kind = IntegratorKind::vpt, .spp = 512, .seed = 3, .direct_light = DirectLight::scattering_only};
        run.add(fmt::format("g {}, vpt and stf", g), StressExtent::full, [&] { return two_ways(ball, stepwise, shells, 0.01, run.progress()); });
        run.add(fmt::format("g {}, lights sampled or not", g), g == 0.999 ? StressExtent::quick : StressExtent::full, [&] { return two_ways(ball, stepwise, scattered, 0, run.progress()); });
    }

    run.begin("media, ends", "extinctions and colours at their ends with what they must be", "noise; 1e-5 where light only passes or is only scattered");
    for (const IntegratorKind kind : medium_kinds) {
        const StressView view{.kind = kind, .accuracy = Accuracy::draft, .spp = 1024};
        const StressView many{.kind = kind, .accuracy = Accuracy::draft, .spp = 4096};
        run.add("sigma_t 1e12, albedo 0.5, " + name_of(kind), StressExtent::full, [&] { return against_half_space(1e12, 0.5, many, kind == IntegratorKind::stf ? 0.003 : 0, run.progress()); });
        for (const double sigma_t : {1e8, 1e11}) {
            const bool quick = kind == IntegratorKind::vpt && sigma_t < 1e9;
            run.add(fmt::format("sigma_t {:g}, albedo 0.5, turned, {}", sigma_t, name_of(kind)), quick ? StressExtent::quick : StressExtent::full, [&] {
                return against_half_space(sigma_t, 0.5, many, kind == IntegratorKind::stf ? 0.003 : 0, run.progress(), askew());
            });
        }
        run.add("sigma_t 1e-30, albedo 0.5, " + name_of(kind), StressExtent::quick, [&] { return lossless(cube_of_medium(1e-30, 0.5, 0), view, 1e-5, run.progress()); });
        if (kind == IntegratorKind::stf) run.add("optical radius 1e6, albedo 0.9999, g 0.999, vpt and stf", StressExtent::full, [&] {
            const StressScene cube = cube_of_medium(1e6, 0.9999, 0.999);
            StressView other = view;
            other.spp = 8;
            StressView stepwise = other;
            stepwise.kind = IntegratorKind::vpt;
            other.seed = 2;
            return two_ways(cube, stepwise, other, 0.01, run.progress());
        });
        for (const Color& sigma : {Color(16, 4, 1), Color(1e3f, 1, 1e-3f)}) {
            run.add(fmt::format("sigma_t {:g}, {:g}, {:g}, lossless, {}", sigma.x, sigma.y, sigma.z, name_of(kind)), sigma.x < 100 ? StressExtent::quick : StressExtent::full, [&] {
                StressScene cube = cube_of_medium(1, 1, 0);
                cube.description.media[0].sigma_t = sigma;
                StressView few = view;
                few.spp = sigma.x > 100 ? 16 : 1024;
                const StressPicture picture = StressStage(cube, {}, few, run.progress()).render(few, run.progress());
                StressFinding finding = compare_truth(picture.film, std::vector<double>(picture.film.pixels().size(), 1), 4);
                finding.count(picture.statistics);
                return finding;
            });
        }
    }
}

} // namespace scree
