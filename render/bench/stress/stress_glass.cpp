// One sphere of glass, whose radiance is known: every index and absorption.

#include "render/bench/stress/stress_run.h"
#include "render/bench/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

/// The reflectance of an interface for unpolarised light that comes from outside (Fresnel).
double reflectance(double cosine, double ior)
{
    const double sine = safe_sqrt(1 - cosine * cosine) / ior;
    if (sine >= 1) return 1;
    const double within = safe_sqrt(1 - sine * sine);
    const double s = (cosine - ior * within) / (cosine + ior * within), p = (ior * cosine - within) / (ior * cosine + within);
    return 0.5 * (s * s + p * p);
}

/// A ray that meets a sphere of glass of radius 1 at a distance b from its middle, in a surrounding of 1: R + (1 - R)^2 T / (1 - R T), as
/// every reflection within is at the same angle and T is the transmittance of the same chord.
double sphere_radiance(double b, double ior, double absorption)
{
    if (b >= 1) return 1;
    const double r = reflectance(safe_sqrt(1 - b * b), ior);
    if (r >= 1) return 1;
    const double chord = 2 * safe_sqrt(1 - b * b / (ior * ior)), t = std::exp(-absorption * chord);
    return r + (1 - r) * (1 - r) * t / (1 - r * t);
}

/// Means over the pixels of a square of width 2 around the sphere.
std::vector<double> sphere_picture(int pixels, double ior, double absorption)
{
    constexpr int parts = 64;
    std::vector<double> means;
    for (int y = 0; y < pixels; ++y) {
        for (int x = 0; x < pixels; ++x) {
            double sum = 0;
            for (int j = 0; j < parts; ++j) {
                for (int i = 0; i < parts; ++i) {
                    const double u = 2 * (x + (i + 0.5) / parts) / pixels - 1, v = 2 * (y + (j + 0.5) / parts) / pixels - 1;
                    sum += sphere_radiance(std::hypot(u, v), ior, absorption);
                }
            }
            means.push_back(sum / (parts * parts));
        }
    }
    return means;
}

} // namespace

void add_glass_cases(StressRun& run)
{
    run.begin("glass", "a sphere in a surrounding of 1 with Fresnel's series, pixel by pixel", "noise; 0.1 % for the sum that stands for the integral over a pixel, and for the proxy's records 2 %");
    constexpr int pixels = 16;
    for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::ppt}) {
        for (const double ior : {1.0001, 1.5, 4.0}) {
            for (const double absorption : {1e-6, 0.5, 1e6}) {
                const bool quick = kind == IntegratorKind::ept && absorption == 0.5;
                run.add(fmt::format("index {}, absorption {:g}, {}", ior, absorption, name_of(kind)), quick ? StressExtent::quick : StressExtent::full, [&] {
                    StressScene scene = scene_from_above(pixels, 2, 3);
                    add_type(scene, "glass", glass_material(ior, 0, Color(static_cast<Real>(absorption))));
                    scene.grains.push_back({V3d(0), 1, 0, {1, 0, 0, 0}});
                    add_constant(scene, Color(1));
                    const StressView view{.kind = kind, .accuracy = Accuracy::standard, .spp = 1024};
                    const StressPicture picture = StressStage(scene, {}, view, run.progress()).render(view, run.progress());
                    StressFinding finding = compare_truth(picture.film, sphere_picture(pixels, ior, static_cast<Real>(absorption)), 4, kind == IntegratorKind::ppt ? 0.02 : 0.001);
                    finding.count(picture.statistics);
                    return finding;
                });
            }
        }
    }
}

} // namespace scree
