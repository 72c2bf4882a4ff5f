// One glass sphere, whose radiance is known, with several indices and absorptions.

#include "render/stress/stress_run.h"
#include "render/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

/// The reflectance of an interface for unpolarised light that comes from outside (Fresnel).
double reflectance(double cosine, double ior)
{
    const double sine = safe_sqrt(1 - cosine * cosine) / ior;
    if (sine >= 1) return 1;
    const double within = safe_sqrt(1 - sine * sine);
    const double s = (cosine - ior * within) / (cosine + ior * within),
                 p = (ior * cosine - within) / (ior * cosine + within);
    return 0.5 * (s * s + p * p);
}

/// The radiance of a ray that passes the middle of a glass sphere of radius 1 at distance b, in surroundings of 1:
/// R + (1 - R)^2 T / (1 - R T). All inner reflections have the same angle, and all chords the same transmittance T.
double sphere_radiance(double b, double ior, double absorption)
{
    if (b >= 1) return 1;
    const double r = reflectance(safe_sqrt(1 - b * b), ior);
    if (r >= 1) return 1;
    const double chord = 2 * safe_sqrt(1 - b * b / (ior * ior)), t = std::exp(-absorption * chord);
    return r + (1 - r) * (1 - r) * t / (1 - r * t);
}

/// The part of a ray's light that leaves a lossless glass sphere of radius 1 within an angle `half` of the ray's own
/// direction; b: distance of the ray from the sphere's middle.
///
/// The ray turns by pi - 2 i where it is reflected outside, and by 2 i - 2 k t + (k - 1) pi where it leaves at its k-th
/// hit from inside.
double light_behind(double b, double ior, double half)
{
    if (b >= 1) return 1;
    const auto in_light = [&](double turn) { return std::abs(std::remainder(turn, 2 * pi)) < half; };
    const double r = reflectance(safe_sqrt(1 - b * b), ior), in = std::asin(b),
                 within = std::asin(std::min(1.0, b / ior));
    double sum = in_light(pi - 2 * in) ? r : 0, left = (1 - r) * (1 - r);
    for (int k = 1; k < 40; ++k, left *= r) {
        if (in_light(2 * in - 2 * k * within + (k - 1) * pi)) sum += left;
    }
    return sum;
}

/// The sphere in front of a disc light of radiance 1: the sphere shows a dark ring where it turns rays by more than the
/// angular radius of the disc. A sphere that does not refract has no such ring.
StressFinding before_a_disc(double ior, double edge, const StressView& view, double bias, const Progress& progress)
{
    const double half = 2 * std::abs(std::asin(edge) - std::asin(edge / ior));
    StressScene scene = scene_from_above(16, 2.2, 3);
    add_type(scene, "glass", glass_material(ior));
    scene.grains.push_back({V3d(0), 1, 0, {1, 0, 0, 0}});
    LightDescription disc;
    disc.kind = LightDescription::Kind::distant;
    disc.direction = V3d(0, 0, 1);
    disc.irradiance = Color(static_cast<Real>(pi * std::sin(half) * std::sin(half)));
    disc.angle = 2 * half * 180 / pi;
    scene.description.lights.push_back(disc);
    const StressPicture picture = StressStage(scene, {}, view, progress).render(view, progress);
    const auto seen = [&](double index) {
        return pixel_means(scene, 64,
                           [&](const V3d& o, const V3d&) { return light_behind(std::hypot(o.x, o.y), index, half); });
    };
    StressFinding finding = compare_truth(picture.film, seen(ior), 4, bias);
    finding.count(picture.statistics);
    finding.remark +=
        fmt::format("; against index 1: {:.3g} sigma", compare_truth(picture.film, seen(1), 4, bias).deviation);
    return finding;
}

} // namespace

void add_glass_cases(StressRun& run)
{
    run.begin("glass", "a sphere in surroundings of radiance 1, compared with Fresnel's series, pixel by pixel",
              "noise; 0.1 % because a sum replaces the integral over a pixel, or 2 % for the proxy's records");
    constexpr int pixels = 16;
    for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::ppt}) {
        for (const double ior : {1.0001, 1.5, 4.0}) {
            for (const double absorption : {1e-6, 0.5, 1e6}) {
                const bool quick = kind == IntegratorKind::ept && absorption == 0.5;
                run.add(fmt::format("index {}, absorption {:g}, {}", ior, absorption, name_of(kind)),
                        quick ? StressExtent::quick : StressExtent::full, [&] {
                            StressScene scene = scene_from_above(pixels, 2, 3);
                            add_type(scene, "glass", glass_material(ior, 0, Color(static_cast<Real>(absorption))));
                            scene.grains.push_back({V3d(0), 1, 0, {1, 0, 0, 0}});
                            add_constant(scene, Color(1));
                            const StressView view{.kind = kind, .accuracy = Accuracy::standard, .spp = 2048};
                            const StressPicture picture =
                                StressStage(scene, {}, view, run.progress()).render(view, run.progress());
                            const auto seen = [&](const V3d& o, const V3d&) {
                                return sphere_radiance(std::hypot(o.x, o.y), ior, static_cast<Real>(absorption));
                            };
                            StressFinding finding = compare_truth(picture.film, pixel_means(scene, 64, seen), 4,
                                                                  kind == IntegratorKind::ppt ? 0.02 : 0.001);
                            finding.count(picture.statistics);
                            return finding;
                        });
            }
        }
    }

    run.begin(
        "glass, refraction",
        "a sphere in front of a disc light, where Snell's law makes a part of the sphere dark, compared with this "
        "law, pixel by pixel",
        "noise; 0.2 % because a sum replaces the integral over a pixel");
    for (const double ior : {1.0001, 1.5, 4.0}) {
        for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::ppt}) {
            const bool quick = kind == IntegratorKind::ept;
            if (!quick && ior < 1.01)
                continue; // directions in a proxy's records are off by up to 8e-5, as much as the sphere turns rays
            run.add(fmt::format("index {}, {}", ior, name_of(kind)), quick ? StressExtent::quick : StressExtent::full,
                    [&] {
                        return before_a_disc(ior, 0.7, {.kind = kind, .accuracy = Accuracy::standard, .spp = 2048},
                                             0.002, run.progress());
                    });
        }
    }
}

} // namespace scree
