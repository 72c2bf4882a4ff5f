#include "tests/builders/statistics.h"
#include "tests/builders/scenes.h"
#include "render/integrators/path_tracer.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/combinable.h>
#include <chrono>
#include <cstdio>

namespace scree {
namespace {

TEST(StfTruth, Try)
{
    for (const double tau : {10.0, 100.0}) for (double g : {0.0, 0.75}) for (const double albedo : {1.0, 0.999, 0.9}) {
        double time[3] = {};
        for (const int form : {-1, 0, 1, 3, 4}) {
            TestScene scene;
            const double wide = 1000 * tau;
            scene.add_medium(box_mesh({-wide, -wide, -tau}, {wide, wide, 0}), V3d(1), C3f(static_cast<float>(albedo)), g);
            scene.add_constant_light(1);
            if (form >= 0) scene.use_shells(static_cast<StfForm>(form));
            scene.build();
            const int n = form < 0 ? 20000 : 100000;
            double r = 0, r2 = 0, t = 0;
            uint64_t ev = 0, sh = 0, seg = 0;
            const auto t0 = std::chrono::steady_clock::now();
            for (int i = 0; i < n; ++i) {
                Sampler sampler(5, static_cast<uint32_t>(i), static_cast<uint32_t>(form + 1), 0);
                PathOptions o;
                const PathResult p = trace_path(scene.world(), scene.tracer(), scene.space().point(V3d(0.1, 0.2, 1)), V3d(0, 0, -1), sampler, o);
                (p.last_direction.z > 0 ? r : t) += p.radiance.x;
                if (p.last_direction.z > 0) r2 += p.radiance.x * p.radiance.x;
                ev += p.events; sh += p.shells; seg += p.segments;
            }
            const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
            if (form < 0) time[0] = s / n;
            std::printf("tau %5.0f g %.2f a %.3f form %d: R %.5f +- %.5f T %.5f  %.2f us/path (x %.1f) events %.1f shells %.1f segments %.1f\n", tau, g, albedo, form, r / n, std::sqrt((r2 / n - r * r / n / n) / n), t / n,
                        1e6 * s / n, time[0] * n / s, double(ev) / n, double(sh) / n, double(seg) / n);
        }
    }
}

} // namespace
} // namespace scree
