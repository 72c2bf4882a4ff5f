// Time per question to a Domain: the whole-sphere test, inside or not, and the distance; one thread.

#include "base/hash.h"
#include "packing/solids/domain.h"
#include "tests/builders/shapes.h"
#include "tests/packing/solids.h"

#include <fmt/format.h>

#include <chrono>

using namespace scree;
using Imath::V3d;

namespace {

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

V3d random_place(const Imath::Box3d& box, uint64_t index)
{
    const V3d u(unit_double(hash_index(index, 1, 0)), unit_double(hash_index(index, 1, 1)),
                unit_double(hash_index(index, 1, 2)));
    return box.min + u * (box.max - box.min);
}

/// Microseconds a call, the best of three runs; prints how many were true beside it.
template <class Ask>
void time_questions(const char* name, uint64_t count, const Ask& ask)
{
    double best = 1e30;
    uint64_t yes = 0;
    for (int run = 0; run < 3; ++run) {
        yes = 0;
        const auto start = std::chrono::steady_clock::now();
        for (uint64_t k = 0; k < count; ++k) yes += ask(k);
        best = std::min(best, seconds_since(start));
    }
    fmt::print("  {:<32} {:6.3f} us, {:5.1f} % yes\n", name, 1e6 * best / static_cast<double>(count),
               100.0 * static_cast<double>(yes) / static_cast<double>(count));
}

void measure(const char* name, const TriangleMesh& mesh)
{
    const auto start = std::chrono::steady_clock::now();
    const Domain domain(mesh, name);
    fmt::print("{}: {} faces, checked and built in {:.2f} s\n", name, mesh.triangles.size(), seconds_since(start));
    const Imath::Box3d bounds = domain.bounds();
    const double size = bounds.size().x;
    std::vector<V3d> inside;
    for (uint64_t k = 0; inside.size() < 100'000; ++k)
        if (const V3d p = random_place(bounds, k); domain.contains(p)) inside.push_back(p);
    const uint64_t n = 200'000;
    time_questions("contains", n, [&](uint64_t k) { return domain.contains(random_place(bounds, k)); });
    for (const double radius : {0.0005, 0.002, 0.01, 0.05})
        time_questions(fmt::format("contains_sphere, r = {} size", radius).c_str(), n,
                       [&](uint64_t k) { return domain.contains_sphere(random_place(bounds, k), radius * size); });
    time_questions("contains_sphere, 0.002, inside", inside.size(),
                   [&](uint64_t k) { return domain.contains_sphere(inside[k], 0.002 * size); });
    time_questions("distance", n / 4,
                   [&](uint64_t k) { return domain.distance(random_place(bounds, k)) > 0.1 * size; });
}

} // namespace

int main()
{
    measure("sphere", icosphere(6));
    measure("torus", torus(1, 0.4, 320, 160));
    measure("thin shell", double_walled_shell(5, 0.01));
    measure("bored cube", bored_cube(110));
    return 0;
}
