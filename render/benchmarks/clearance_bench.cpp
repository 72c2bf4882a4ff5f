// The cost and tightness of bounds on distances to triangles, by the distance; one thread.
// usage: clearance_bench [--quick]

#include "base/noise.h"
#include "render/media/clearance_field.h"
#include "tests/builders/shapes.h"

#include <fmt/format.h>

#include <cstring>
#include <ctime>
#include <random>

namespace scree {
namespace {

/// Processor seconds of this program: other programs on a busy machine do not count.
double busy_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Mesh {
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
};

Mesh sphere(int level)
{
    Mesh mesh;
    TriangleMesh from = icosphere(level);
    for (const V3d& p : from.positions) mesh.positions.emplace_back(V3f(p));
    mesh.triangles = std::move(from.triangles);
    return mesh;
}

/// A sphere of latitudes and longitudes with octaves of noise on its radius: 4 n^2 triangles, small ones at the poles.
Mesh rough(uint32_t n)
{
    NoiseOptions options;
    options.scale = V3d(0.5);
    options.octaves = 8;
    options.seed = 3;
    const FractalNoise noise(options);
    Mesh mesh;
    for (uint32_t i = 0; i <= n; ++i)
        for (uint32_t j = 0; j < 2 * n; ++j) {
            const double theta = pi * i / n, phi = pi * j / n;
            const V3d p(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            mesh.positions.emplace_back(V3f(p * (0.8 + 0.5 * noise(p))));
        }
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < 2 * n; ++j) {
            const uint32_t a = i * 2 * n + j, b = i * 2 * n + (j + 1) % (2 * n);
            mesh.triangles.push_back({a, a + 2 * n, b});
            mesh.triangles.push_back({b, a + 2 * n, b + 2 * n});
        }
    return mesh;
}

/// Points about `from` to `to` away from the surface: random points of triangles, moved along the normals. The longest
/// edge of the box is about 2.
std::vector<V3d> places_near(const Mesh& mesh, const Imath::Box3d& box, double from, double to, size_t count)
{
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform;
    std::vector<V3d> places;
    while (places.size() < count) {
        const auto& t = mesh.triangles[random() % mesh.triangles.size()];
        const V3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
        const double u = std::sqrt(uniform(random)), v = uniform(random) * u;
        const V3d p = a * (1 - u) + b * (u - v) + c * v, n = (b - a).cross(c - a).normalized();
        const V3d place = p - n * (from * std::pow(to / from, uniform(random)));
        if (box.intersects(place)) places.push_back(place);
    }
    return places;
}

void run(const char* name, const Mesh& mesh, bool quick)
{
    Imath::Box3d box;
    for (const V3f& p : mesh.positions) box.extendBy(V3d(p));
    const std::vector<TriangleView> view{{mesh.positions, mesh.triangles}};
    const double start = busy_seconds();
    const ClearanceField field(view, box, Progress());
    const double seconds = busy_seconds() - start, longest = std::max({box.size().x, box.size().y, box.size().z});
    const TriangleTree exact(view, 1, Progress());
    const double bytes = static_cast<double>(field.bytes()), triangles = static_cast<double>(mesh.triangles.size());
    fmt::print("{}: {} triangles, {:.2f} s of one core, {:.1f} MB, {:.0f} bytes a triangle with the grid.\n\n", name,
               mesh.triangles.size(), seconds, bytes / 1e6, bytes / triangles);
    fmt::print("{:>20} {:>10} {:>10} {:>8} {:>8} {:>8}\n", "distance / box", "ns, walk", "scattered", "mean", "1 %",
               "least");
    const size_t count = quick ? 20000 : 200000;
    for (const auto& [lo, hi] : {std::pair{1e-6, 1e-5},
                                 {1e-5, 1e-4},
                                 {1e-4, 1e-3},
                                 {1e-3, 3e-3},
                                 {3e-3, 1e-2},
                                 {1e-2, 3e-2},
                                 {3e-2, 0.1},
                                 {0.1, 0.3}}) {
        std::vector<V3d> places = places_near(mesh, box, lo * longest, hi * longest, count);
        std::vector<float> ratio;
        double sum = 0;
        for (size_t i = 0; i < count; i += 8) {
            // The tree alone loses no more than its own share.
            const double d = exact.distance(places[i]);
            if (!(d > 0)) continue;
            ratio.push_back(static_cast<float>(field.clearance(places[i]) / d));
            sum += double{ratio.back()};
        }
        std::ranges::sort(ratio);
        const auto time = [&] {
            double best = 1e9, check = 0;
            for (int pass = 0; pass < 3; ++pass) {
                const double begin = busy_seconds();
                for (const V3d& p : places) check += field.clearance(p);
                best = std::min(best, busy_seconds() - begin);
            }
            return check < 0 ? 0 : best * 1e9 / static_cast<double>(count);
        };
        const double scattered = time();
        // Sixteen steps each in a small neighbourhood, as in a walk; the first ones find nothing in the caches.
        std::mt19937_64 random(9);
        std::uniform_real_distribution<double> uniform(-0.5, 0.5);
        for (size_t i = 0; i < count; ++i)
            if (i % 16)
                places[i] =
                    places[i - i % 16] + V3d(uniform(random), uniform(random), uniform(random)) * (lo * longest);
        const double local = time();
        fmt::print("{:>9.1e}..{:>9.1e} {:10.1f} {:10.1f} {:8.4f} {:8.4f} {:8.4f}\n", lo, hi, local, scattered,
                   sum / static_cast<double>(ratio.size()), ratio[ratio.size() / 100], ratio[0]);
    }
    fmt::print("\n");
}

} // namespace
} // namespace scree

int main(int argc, char** argv)
{
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    scree::run("icosphere", scree::sphere(5), quick);
    scree::run("icosphere", scree::sphere(8), quick);
    scree::run("rough sphere", scree::rough(500), quick);
    return 0;
}
