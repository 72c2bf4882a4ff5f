// Media with extreme parameters: hardly any absorption, scattering almost straight forward or straight back, a million
// mean free paths.

#include "render/stress/stress_furnace.h"
#include "render/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

constexpr IntegratorKind medium_kinds[] = {IntegratorKind::vpt, IntegratorKind::stf};

/// A cube of edge 2 from above: the camera sees a narrow square in the middle of its upper face.
StressScene cube_of_medium(double optical_radius, double albedo, double g)
{
    StressScene scene = scene_from_above(8, 0.125, 3);
    scene.meshes["cube.obj"] = cube_mesh(1);
    add_medium(scene, "cube.obj", optical_radius, Weight(albedo), g);
    add_constant(scene, Color(1));
    return scene;
}

/// The radiance that an isotropic half-space reflects straight up under diffuse light of radiance 1:
/// 1 - sqrt(1 - albedo) H(1), with H by iteration of its integral equation (Chandrasekhar 1960, chapter V, equation
/// 12).
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
            better[i] = 0.5 * (h[i] + next(cosine[i])); // the mean of two steps converges where single steps oscillate
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

/// Compares the light that the isotropic half-space reflects, or the light it absorbs where that is less. Shells may be
/// off by 0.3 % of the reflected light, and by at most 3 % of the absorbed light.
StressFinding against_half_space(double optical_radius, double albedo, const StressView& view, const Progress& progress,
                                 const Placing& placing = {})
{
    const double bias = view.kind == IntegratorKind::stf ? 0.003 : 0, radiance = half_space_radiance(albedo);
    const StressPicture picture =
        StressStage(cube_of_medium(optical_radius, albedo, 0), placing, view, progress).render(view, progress);
    StressFinding finding =
        radiance < 0.5
            ? compare_truth(picture.film, std::vector<double>(picture.film.pixels().size(), radiance), 4, bias)
            : compare_loss(picture.film, 1 - radiance, std::min(0.03, bias * radiance / (1 - radiance)));
    finding.count(picture.statistics);
    finding.remark += fmt::format("; {:.3g} vertices a path, longest {} segments", finding.length(), finding.longest);
    finding.may_leak =
        std::min(2e-4,
                 0x1p-51 * optical_radius); // places within a double's rounding of the face may end up behind it
    return finding;
}

/// The middle of a cube of optical radius 1000, event by event, with almost no loss: a path of n events brings
/// (1 - loss)^n. Counting n leaves no noise.
StressFinding counted_loss(double loss, const Progress& progress)
{
    StressScene scene = empty_scene(4, 4, V3d(0.001, 0.002, 0.003), V3d(1, 0.3, 0.2), 35);
    scene.meshes["cube.obj"] = cube_mesh(1);
    add_medium(scene, "cube.obj", 1000, Weight(1 - loss), 0.0);
    add_constant(scene, Color(1));
    const StressView view{.kind = IntegratorKind::vpt, .spp = 2};
    const StressPicture picture = StressStage(scene, {}, view, progress).render(view, progress);
    StressFinding finding;
    finding.count(picture.statistics);
    double lost = 0;
    for (const Pixel& pixel : picture.film.pixels())
        lost += (pixel.samples - pixel.sum.x) / static_cast<double>(finding.paths);
    const double right = loss * static_cast<double>(finding.events) / static_cast<double>(finding.paths);
    finding.unit = "relative";
    finding.deviation = std::abs(lost / right - 1);
    finding.allowed = finding.sees = finding.must_see = 0.05;
    finding.least_length = 3e5;
    finding.remark = fmt::format("1 minus the mean is {:.4g}, expected {:.4g}", lost, right);
    return finding;
}

/// A ball of isotropic medium seen from its middle, in surroundings of 1.
///
/// Diffusion with D = 1/3: u is proportional to sinh(k r) / r, with k^2 = 3 (1 - albedo) and r in mean free paths. At
/// the surface u + 0.7104 du/dr = 1 (Milne), because light of radiance 1 comes in from everywhere. The error is
/// O(1 - albedo) and O(radius^-2).
StressFinding from_the_middle(double optical_radius, double loss, int pixels, const StressView& view, double bias,
                              const Progress& progress)
{
    const double k = std::sqrt(3 * loss), x = k * optical_radius, milne = 0.7104;
    const double radiance = x / (std::sinh(x) + milne * (k * std::cosh(x) - std::sinh(x) / optical_radius));
    StressScene scene = empty_scene(pixels, pixels, V3d(0.001, 0.002, 0.003), V3d(1, 0.3, 0.2), 90);
    TriangleMesh ball = ball_mesh(1, 4);
    double volume = 0;
    for (const auto& [a, b, c] : ball.triangles)
        volume += ball.positions[a].dot(ball.positions[b].cross(ball.positions[c])) / 6;
    const double stretch = std::cbrt(4 * pi / 3 / std::abs(volume)); // the mean radius over all directions decides
    for (V3d& p : ball.positions) p *= stretch;
    scene.meshes["ball.obj"] = ball;
    add_medium(scene, "ball.obj", optical_radius, Weight(1 - loss), 0.0);
    add_constant(scene, Color(1));
    const StressPicture picture = StressStage(scene, {}, view, progress).render(view, progress);
    StressFinding finding =
        compare_truth(picture.film, std::vector<double>(picture.film.pixels().size(), radiance), pixels, bias);
    finding.count(picture.statistics);
    finding.remark +=
        fmt::format("; expected {:.5g}, without the loss 1; {:.3g} vertices a path", radiance, finding.length());
    return finding;
}

StressFinding two_ways(const StressScene& scene, const StressView& one, const StressView& other, double bias,
                       const Progress& progress)
{
    const StressPicture a = StressStage(scene, {}, one, progress).render(one, progress),
                        b = StressStage(scene, {}, other, progress).render(other, progress);
    StressFinding finding = compare_means(a.film, b.film, 6, bias);
    finding.count(a.statistics);
    finding.count(b.statistics);
    return finding;
}

} // namespace

void add_medium_cases(StressRun& run)
{
    run.begin("media, furnace", "a lossless cube of medium in surroundings of radiance 1, compared with 1",
              "1e-6: a weight that no event changes is not rounded");
    for (const IntegratorKind kind : medium_kinds) {
        for (const double g : {0.0, 0.999, -0.999}) {
            run.add(fmt::format("optical radius 16, g {}, {}", g, name_of(kind)),
                    kind == IntegratorKind::vpt ? StressExtent::quick : StressExtent::full, [&] {
                        return furnace(cube_of_medium(16, 1.0, g),
                                       {.kind = kind, .accuracy = Accuracy::draft, .spp = 16}, run.progress(), 1e-6);
                    });
        }
    }

    run.begin(
        "media, thick",
        "a cube of optical radius 1e6, compared with the isotropic half-space (Chandrasekhar's H): the light that "
        "it reflects, or, if that is more than half, the light that it absorbs",
        "noise; for shells 0.3 % of the reflected light, and at most 3 % of the absorbed light");
    struct Thick {
        double albedo;
        uint32_t steps, shells; // samples for each of 64 pixels; steps is 0 where single events take too long
        double must_see; // of the absorbed light where that is little: at 0.9999, 10 % of it is 0.3 % of the light
    };
    for (const Thick& t : {Thick{0.5, 4096, 4096, 0.03},
                           {0.9, 4096, 4096, 0.03},
                           {0.99, 4096, 8192, 0.03},
                           {0.9999, 2048, 4096, 0.12},
                           {0.999999, 0, 16384, 0.15}}) {
        for (const IntegratorKind kind : medium_kinds) {
            const uint32_t spp = kind == IntegratorKind::vpt ? t.steps : t.shells;
            if (spp == 0) continue;
            run.add(fmt::format("albedo {}, {}", t.albedo, name_of(kind)),
                    t.albedo == 0.9 && kind == IntegratorKind::vpt ? StressExtent::quick : StressExtent::full, [&] {
                        StressFinding finding = against_half_space(
                            1e6, t.albedo, {.kind = kind, .accuracy = Accuracy::draft, .spp = spp}, run.progress());
                        finding.must_see = t.must_see;
                        return finding;
                    });
        }
    }

    run.begin("media, hardly a loss",
              "a ball of medium seen from its middle, where about four in ten paths are lost, compared with diffusion",
              "noise; for shells 1 %");
    run.add("albedo 1 - 1e-12, events counted, vpt", StressExtent::full,
            [&] { return counted_loss(1e-12, run.progress()); });
    run.add("albedo 1 - 4e-4, optical radius 50, vpt", StressExtent::full, [&] {
        return from_the_middle(50, 4e-4, 8, {.kind = IntegratorKind::vpt, .spp = 512}, 0.002, run.progress());
    });
    struct Deep {
        double radius, loss;
        int pixels;
        uint32_t spp; // the largest shells are some 1000 mean free paths: a path of the last case crosses 700,000
        double must_see;
    };
    for (const Deep& deep : {Deep{50, 4e-4, 8, 1024, 0.03},
                             {1e4, 1e-8, 8, 1024, 0.03},
                             {1e5, 1e-10, 8, 48, 0.15},
                             {1e6, 1e-12, 4, 3, 0.7}}) {
        run.add(fmt::format("albedo 1 - {:.0e}, optical radius {:g}, stf", deep.loss, deep.radius),
                deep.radius == 50 ? StressExtent::quick : StressExtent::full, [&, deep] {
                    StressFinding finding =
                        from_the_middle(deep.radius, deep.loss, deep.pixels,
                                        {.kind = IntegratorKind::stf, .accuracy = Accuracy::standard, .spp = deep.spp},
                                        0.01, run.progress());
                    finding.must_see = deep.must_see;
                    return finding;
                });
    }

    run.begin("media, forward and back",
              "a ball of optical radius 16 rendered event by event, with shells, and without sampling lights; compares "
              "means",
              "noise; for shells 1 %");
    for (const double g : {0.999, -0.999, 0.9}) {
        const StressScene ball = ball_of_medium(16, Weight(0.99), g);
        const StressView stepwise{.kind = IntegratorKind::vpt, .spp = 512},
            shells{.kind = IntegratorKind::stf, .accuracy = Accuracy::standard, .spp = 512, .seed = 2},
            scattered{.kind = IntegratorKind::vpt, .spp = 512, .seed = 3, .direct_light = DirectLight::scattering_only};
        run.add(fmt::format("g {}, vpt and stf", g), StressExtent::full,
                [&] { return two_ways(ball, stepwise, shells, 0.01, run.progress()); });
        run.add(fmt::format("g {}, lights sampled or not", g), g == 0.999 ? StressExtent::quick : StressExtent::full,
                [&] { return two_ways(ball, stepwise, scattered, 0, run.progress()); });
    }

    run.begin("media, ends", "extreme extinctions and colours, compared with known values",
              "noise; 1e-5 where light only passes or is only scattered");
    for (const IntegratorKind kind : medium_kinds) {
        const StressView view{.kind = kind, .accuracy = Accuracy::draft, .spp = 1024};
        const StressView many{.kind = kind, .accuracy = Accuracy::draft, .spp = 4096};
        run.add("sigma_t 1e12, albedo 0.5, " + name_of(kind), StressExtent::full,
                [&] { return against_half_space(1e12, 0.5, many, run.progress()); });
        for (const double sigma_t : {1e8, 1e11}) {
            const bool quick = kind == IntegratorKind::vpt && sigma_t < 1e9;
            run.add(fmt::format("sigma_t {:g}, albedo 0.5, turned, {}", sigma_t, name_of(kind)),
                    quick ? StressExtent::quick : StressExtent::full,
                    [&] { return against_half_space(sigma_t, 0.5, many, run.progress(), askew()); });
        }
        run.add("sigma_t 1e-30, albedo 0.5, " + name_of(kind), StressExtent::quick,
                [&] { return furnace(cube_of_medium(1e-30, 0.5, 0), view, run.progress()); });
        if (kind == IntegratorKind::stf)
            run.add("optical radius 1e6, g 0.999, at 3 degrees, vpt and stf", StressExtent::full, [&] {
                StressScene cube = cube_of_medium(1e6, 0.99, 0.999); // from above hardly any light would come back
                cube.description.camera.origin = V3d(-3 * std::cos(0.05), 0, 1 + 3 * std::sin(0.05));
                cube.description.camera.target = V3d(0, 0, 1);
                cube.description.camera.width = 0.01;
                const StressView stepwise{.kind = IntegratorKind::vpt, .spp = 2048},
                    shells{.kind = kind, .accuracy = Accuracy::draft, .spp = 2048, .seed = 2};
                StressFinding finding = two_ways(cube, stepwise, shells, 0.01, run.progress());
                finding.must_see = 0.06; // most paths end inside
                return finding;
            });
        // A channel that scatters much less than the channel a path was sampled for is noisy: it needs many paths.
        struct Coloured {
            Color sigma;
            uint32_t spp;
            StressExtent extent;
        };
        const Coloured apart = kind == IntegratorKind::vpt ? Coloured{Color(32, 0.1f, 1e-3f), 1408, StressExtent::full}
                                                           : Coloured{Color(1e3f, 1, 1e-3f), 2048, StressExtent::full};
        for (const auto& [sigma, spp, extent] : {Coloured{Color(16, 4, 1), 1024, StressExtent::quick}, apart}) {
            run.add(fmt::format("sigma_t {:g}, {:g}, {:g}, lossless, {}", sigma.x, sigma.y, sigma.z, name_of(kind)),
                    extent, [&, sigma = sigma, spp = spp] {
                        StressScene cube = cube_of_medium(1, 1, 0);
                        cube.description.media[0].sigma_t = sigma;
                        const StressView coloured{.kind = kind, .accuracy = Accuracy::draft, .spp = spp};
                        const StressPicture picture =
                            StressStage(cube, {}, coloured, run.progress()).render(coloured, run.progress());
                        StressFinding finding =
                            compare_truth(picture.film, std::vector<double>(picture.film.pixels().size(), 1), 4);
                        finding.count(picture.statistics);
                        return finding;
                    });
        }
    }
}

} // namespace scree
